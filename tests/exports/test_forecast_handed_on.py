"""The law of a forecast in other programs: nobody has tested the mix, and the file says so."""

from __future__ import annotations

import pytest

import asphalt_nscd as an

GRADING = {19: 100, 9.5: 85, 4.75: 60, 2.36: 42, 0.6: 20, 0.15: 8, 0.075: 5}
KNOWN = {
    "binder_percent_by_mass": 5.2,
    "air_voids_percent": 7.0,
    "grading": GRADING,
    "frequencies_Hz": [0.1, 10],
}
ONE_TEMPERATURE = {
    "E00_MPa": 0,
    "E0_MPa": 1000,
    "delta": 2.2,
    "k": 0.22,
    "h": 0.63,
    "beta": 50,
    "tau_s": 2e-3,
}


def said(path):
    return " ".join(line.lstrip("# ") for line in path.read_text(encoding="utf-8").splitlines())


@pytest.mark.parametrize("binder", [{"grade": "PG 64-22"}, ONE_TEMPERATURE])
def test_a_forecast_is_not_told_to_be_near_tests(tmp_path, binder):
    law = an.forecast(KNOWN | {"binder": binder}).law
    an.export(law, tmp_path / "law.csv", "csv")
    head = said(tmp_path / "law.csv")
    assert "A forecast: no test of the mix was made." in head
    assert "single tests" not in head and "chain of bonds" not in head
    if "grade" in binder:
        an.export(law, tmp_path / "table.csv", "mepdg")
        assert "Tested: nothing, taken to hold for -10 to 40 degC" in said(tmp_path / "table.csv")
