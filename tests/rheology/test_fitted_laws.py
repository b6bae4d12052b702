"""One law for each temperature from measurements."""

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.fitted_laws import fit_temperature
from asphalt_nscd.rheology.laws_io import read_law

LAW = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)


@pytest.fixture
def measured(tmp_path):
    """Three specimens at 15 degC that scatter about LAW, and one test at 12.5 degC."""
    frequency = np.array([3.0, 6, 10, 25, 40])
    modulus = LAW.complex_modulus(2 * np.pi * frequency)
    rows = [("0", 12.5, 10.0, 25000.0, 14.0)]
    for specimen, factor in (("1", 0.97), ("2", 1.0), ("3", 1 / 0.97)):
        for f, e in zip(frequency, factor * modulus, strict=True):
            rows.append((specimen, 15.0, f, abs(e) * 1e-6, np.degrees(np.angle(e))))
    columns = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
    path = tmp_path / "measured.csv"
    pd.DataFrame(rows, columns=columns).to_csv(path, index=False)
    return path


def test_fit_of_one_temperature(measured, tmp_path):
    content = fit_temperature(measured, 15, tmp_path / "T15.json")
    law = read_law(tmp_path / "T15.json")
    assert law.modulus_m == pytest.approx(LAW.modulus_m, rel=1e-5)
    assert law.viscosity_k == pytest.approx(LAW.viscosity_k, rel=1e-4)
    assert content["source"] == "fitted" and content["temperature_C"] == 15.0
    assert content["rms_log_residual"] == pytest.approx(-np.log(0.97) * np.sqrt(2 / 3), rel=1e-6)
    assert 0 < content["std_error"]["Em_Pa"] < 0.1 * content["Em_Pa"]


def test_temperature_without_tests_or_with_too_few(measured, tmp_path):
    with pytest.raises(
        InputError, match=r"measured.csv, 20 degC: no test at 20 degC; the table has 12.5, 15\."
    ):
        fit_temperature(measured, 20, tmp_path / "law.json")
    with pytest.raises(
        InputError, match="measured.csv, 12.5 degC: a Burgers law needs at least two frequencies"
    ):
        fit_temperature(measured, 12.5, tmp_path / "law.json")
    assert not (tmp_path / "law.json").exists()
