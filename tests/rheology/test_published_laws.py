"""One law for each temperature of Table 3."""

import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.rheology.published_laws import published_law, read_published

TABLE = """temperature_C,Em_kPa,eta_m_kPa_s,Ek_kPa,eta_k_kPa_s
-10,3.98e7,6.28e7,9.56e8,1.49e7
15,2.43e7,3.71e6,4.84e7,7.73e5
"""


@pytest.fixture
def table3(tmp_path):
    path = tmp_path / "table3.csv"
    path.write_text(TABLE)
    return path


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
        ("15,", "-10,", "line 3: -10 degC appears twice"),
    ]:
        table3.write_text(TABLE.replace(old, new))
        with pytest.raises(InputError, match=words):
            read_published(table3)
