from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.bending.collect import COLUMNS, collect
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import save


@pytest.fixture
def test_file(tmp_path):
    def write(name, **attributes):
        row = {column: 1.0 for column in COLUMNS} | {"specimen": name, "head": "free", "law_source": "fitted"}
        save(tmp_path / f"{name}.h5", "test", {"force_N": np.zeros(3)}, row | attributes)
        return tmp_path / f"{name}.h5"

    return write


def test_rows_in_the_order_given_and_columns_in_that_of_the_issue(test_file):
    frame = collect([test_file("s2"), test_file("s1", frequency_Hz=10.0)])
    assert list(frame.columns) == [*COLUMNS, "head", "law_source"]
    assert frame["specimen"].tolist() == ["s2", "s1"]
    assert frame["frequency_Hz"].tolist() == [1.0, 10.0]


def test_scaled_law_gives_parameter_and_factor(test_file):
    frame = collect([test_file("s1", law_source="eta_k:0.5"), test_file("s2", law_source="Em:1e-05")])
    assert frame["parameter"].tolist() == ["eta_k", "Em"]
    assert frame["factor"].tolist() == [0.5, 1e-5]


def test_file_that_lacks_a_column_or_is_of_another_kind(test_file, tmp_path):
    save(tmp_path / "old.h5", "test", {}, {"specimen": "s1"})
    with pytest.raises(InputError, match=r"old.h5: has no temperature_C, .* delete it"):
        collect([tmp_path / "old.h5"])
    save(tmp_path / "model.h5", "model", {}, {})
    with pytest.raises(InputError, match="expected a test file; found a model file"):
        collect([test_file("s1"), tmp_path / "model.h5"])
