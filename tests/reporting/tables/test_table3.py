"""Table 3: units and the pairing of fitted with published parameters."""

from __future__ import annotations

import pytest

from asphalt_nscd.reporting.tables.table3 import make
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import write_law

ERRORS = {"modulus_m": 2e8, "viscosity_m": 3e7, "modulus_k": 4e9, "viscosity_k": 5e6}


@pytest.fixture
def data(tmp_path):
    fitted = []
    for temperature in (20.0, 5.0):
        fitted.append(tmp_path / f"T{temperature:g}.json")
        law = Burgers(22e9, 2e9, 30e9, 0.5e9)
        write_law(fitted[-1], law, source="fitted", temperature=temperature, std_error=ERRORS)
    (measured := tmp_path / "measured.csv").write_text(
        "specimen,temperature_C,frequency_Hz,origin,E_MPa,phase_deg\n"
        "1,5,3,measured,15000,20\n1,20,3,reconstructed,9000,25\n"
    )
    (published := tmp_path / "table3.csv").write_text(
        "temperature_C,Em_kPa,eta_m_kPa_s,Ek_kPa,eta_k_kPa_s\n20,2.0e7,1.6e6,2.5e7,4e5\n"
    )
    return {"fitted": fitted, "measured": [measured], "published": [published]}


def test_parameters_in_megapascals_beside_the_published(data):
    table = make(**data)
    assert list(table["temperature_C"]) == [5.0] * 4 + [20.0] * 4
    row = table[(table["temperature_C"] == 20.0) & (table["parameter"] == "Em")].iloc[0]
    assert (row["unit"], row["fitted_to"]) == ("MPa", "reconstructed")
    assert row[["published", "fitted", "standard_error", "fitted_over_published"]].tolist() == pytest.approx(
        [20000.0, 22000.0, 200.0, 1.1]
    )
    viscosity = table[(table["temperature_C"] == 20.0) & (table["parameter"] == "eta_k")].iloc[0]
    assert viscosity["unit"] == "MPa s"
    assert viscosity[["published", "fitted", "standard_error"]].tolist() == pytest.approx([400.0, 500.0, 5.0])


def test_temperature_that_was_not_published_stands_alone(data):
    table = make(**data)
    assert table.loc[table["temperature_C"] == 5.0, "published"].isna().all()
    assert set(table.loc[table["temperature_C"] == 5.0, "fitted_to"]) == {"measured"}


def test_fit_with_as_many_unknowns_as_data_has_an_empty_standard_error(data, tmp_path):
    write_law(path := tmp_path / "exact.json", Burgers(1e9, 1e9, 1e9, 1e9), source="fitted", temperature=20.0)
    table = make([path], data["measured"])
    assert table["standard_error"].isna().all() and table["fitted"].notna().all()
