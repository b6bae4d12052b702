from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.store import save
from asphalt_nscd.reporting.tables import preparation


def test_two_rows_for_a_vibrated_sample_and_one_for_another(tmp_path):
    """Heights in mm, overlaps in parts of the smallest radius, each stage with its own numbers."""
    vibrated = {name: 10.0 + k for k, name in enumerate(preparation.OF_A_STAGE)}
    vibrated |= {"layer_height_m": 0.060, "largest_overlap_m": 1e-5, "largest_overlap_moving_m": 2e-4}
    poured = {f"poured_{name}": value / 2.0 for name, value in vibrated.items()}
    arrays = {"radius": np.array([2e-3, 1e-3])}
    save(tmp_path / "s1.h5", "deposit", arrays, vibrated | poured | {"vibration_s": 1.0})
    save(tmp_path / "s2.h5", "deposit", arrays, vibrated | poured | {"vibration_s": 0.0})
    table = preparation.make(deposits=[tmp_path / "s1.h5", tmp_path / "s2.h5"])
    assert list(zip(table["sample"], table["stage"])) == [
        ("s1", "poured"),
        ("s1", "vibrated"),
        ("s2", "poured"),
    ]
    assert table["height_mm"].tolist() == pytest.approx([30.0, 60.0, 30.0])
    assert table["largest_overlap"].tolist() == pytest.approx([5e-3, 1e-2, 5e-3])
    assert table["largest_overlap_moving"].tolist() == pytest.approx([0.1, 0.2, 0.1])
    assert table["solid_fraction"].tolist() == [5.0, 10.0, 5.0]
    assert table.columns[0] == "sample" and not table.columns.str.endswith("_m").any()
