"""One law for each temperature, from measurements and from Table 3."""

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.errors import InputError
from asphalt_nscd.laws import fit_temperature, published_law, read_published
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import read_law

LAW = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
TABLE = """temperature_C,Em_kPa,eta_m_kPa_s,Ek_kPa,eta_k_kPa_s
-10,3.98e7,6.28e7,9.56e8,1.49e7
15,2.43e7,3.71e6,4.84e7,7.73e5
"""


@pytest.fixture
def table3(tmp_path):
    path = tmp_path / "table3.csv"
    path.write_text(TABLE)
    return path


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
    with pytest.raises(InputError, match=r"measured.csv: no test at 20 degC; give one of 12.5, 15\."):
        fit_temperature(measured, 20, tmp_path / "law.json")
    with pytest.raises(
        InputError, match="measured.csv, 12.5 degC: a Burgers law needs at least two frequencies"
    ):
        fit_temperature(measured, 12.5, tmp_path / "law.json")
    assert not (tmp_path / "law.json").exists()


@pytest.mark.parametrize(("unit", "factor"), [("kPa", 1.0), ("Pa", 1e-3)])
def test_published_law_in_both_readings(table3, tmp_path, unit, factor):
    published_law(table3, 15, unit, tmp_path / "T15.json")
    law = read_law(tmp_path / "T15.json")
    assert law.modulus_m == pytest.approx(24.3e9 * factor, rel=1e-12)
    assert law.viscosity_k == pytest.approx(0.773e9 * factor, rel=1e-12)


def test_published_table_is_checked(table3, tmp_path):
    with pytest.raises(InputError, match="no law at 20 degC; give one of -10, 15"):
        published_law(table3, 20, "kPa", tmp_path / "law.json")
    with pytest.raises(InputError, match="unit 'MPa' is not known"):
        published_law(table3, 15, "MPa", tmp_path / "law.json")
    for old, new, words in [
        ("Em_kPa", "Em_Pa", "column 'Em_Pa' must be 'Em_kPa'"),
        ("3.71e6", "-3.71e6", "line 3: eta_m_kPa_s"),
        ("15,", "-10,", "line 3: -10 degC stands twice"),
    ]:
        table3.write_text(TABLE.replace(old, new))
        with pytest.raises(InputError, match=words):
            read_published(table3)
