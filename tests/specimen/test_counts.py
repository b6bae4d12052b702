from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.specimen.counts import read_counts


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("diameter_mm,count\n2,1.5\n", "count = 1.5 is not a whole number"),
        ("diameter_mm,count\n2,0\n3,0\n", "counts no sphere"),
        ("diameter_mm,count\n2,-4\n", "count"),
        ("diameter_mm,count\n0,4\n", "diameter_mm"),
        ("diameter_mm,count\n2,nan\n", "count"),
        ("diameter_mm\n2\n", "count"),
        ("diameter_mm,count\n2,6e6\n3,4000001\n", "counts 1e.07 spheres; give at most 1e.07"),
        ("diameter_mm,count\n0.009,4\n", "diameter_mm"),
        ("diameter_mm,count\n100.1,4\n", "diameter_mm"),
    ],
)
def test_counts_that_cannot_be_poured(tmp_path, text, message):
    (path := tmp_path / "counts.csv").write_text(text)
    with pytest.raises(InputError, match=message) as error:
        read_counts(path)
    assert str(path) in str(error.value)


def test_counts_are_read_in_metres(tmp_path):
    (path := tmp_path / "counts.csv").write_text("diameter_mm,count\n0.01,9999700\n3,300\n100,0\n")
    diameters, counts = read_counts(path)
    np.testing.assert_allclose(diameters, [1e-5, 3e-3, 0.1], rtol=1e-15)
    assert counts.tolist() == [9_999_700, 300, 0] and counts.dtype.kind == "i"
