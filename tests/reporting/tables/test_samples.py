"""Samples against hand calculation."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.store import save
from asphalt_nscd.reporting.tables.samples import make


@pytest.fixture
def data(tmp_path):
    (simulations := tmp_path / "simulations.csv").write_text(
        "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg,E_law_MPa,phase_law_deg,spheres,bonds,broken_bonds\n"
        "s1,0,3,120,21,100,20,9000,70000,2\ns1,20,3,110,30.1,100,30,9000,70000,0\n"
        "s1,20,10,224,29.8,200,30,9000,70000,0\n"
    )
    save(tmp_path / "s1.h5", "deposit", {"x": np.zeros(1)}, {"solid_fraction": 0.67})
    return {"simulations": [simulations], "deposits": [tmp_path / "s1.h5"]}


def test_tests_with_broken_bonds_do_not_count(data):
    row = make(**data).iloc[0]
    assert (row["sample"], row["spheres"], row["bonds"], row["solid_fraction"]) == ("s1", 9000, 70000, 0.67)
    assert row["E_over_law"] == pytest.approx(1.11)
    assert (row["E_over_law_lowest"], row["E_over_law_highest"]) == pytest.approx((1.10, 1.12))
    assert row["largest_phase_difference_deg"] == pytest.approx(0.2)
    assert (row["tests"], row["tests_with_broken_bonds"]) == (3, 1)
