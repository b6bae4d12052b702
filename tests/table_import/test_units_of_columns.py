"""Units that are missing, contradicted or in a line of their own."""

from __future__ import annotations

import pytest
from table_import.slips import HEADER, ROWS, as_is, read, refusal, said

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.quantities import recognise


@pytest.mark.parametrize(
    ("name", "chosen", "sentence"),
    [
        ("E* [ksi]", {"E_MPa": "E* [ksi]"}, "column 'E* [ksi]' says ksi; write --column E_ksi=\"E* [ksi]\""),
        ("Wert / GPa", {"E_MPa": "Wert / GPa"}, "says GPa"),
        ("Wert (°C)", {"E_MPa": "Wert (°C)"}, "is in C, which is no unit of E_MPa"),
    ],
)
def test_a_unit_that_the_name_of_the_column_contradicts(tmp_path, name, chosen, sentence):
    assert sentence in refusal(tmp_path, [[*HEADER[:3], name, HEADER[4]], *ROWS], **chosen)


def test_a_unit_that_the_name_of_the_column_confirms(tmp_path):
    table = [[*HEADER[:3], "Wert (N/mm²)", HEADER[4]], *ROWS]
    assert read(tmp_path, table, E_MPa="Wert (N/mm²)").table.columns == as_is(tmp_path)
    below = [[*HEADER[:3], "Wert", HEADER[4]], ["", "", "", "ksi", ""], *ROWS]
    with pytest.raises(InputError, match="says ksi"):
        read(tmp_path, below, E_MPa="Wert")
    assert read(tmp_path, below, E_ksi="Wert").table.columns["E_MPa"][0] == "67568.62147"


def test_degrees_under_a_heading_of_radians(tmp_path):
    table = [[*HEADER[:4], "Phase (rad)"], *ROWS]
    assert (
        "a phase of 4.2 rad is 241 deg, more than any material has; if the numbers are degrees, write deg"
        in refusal(tmp_path, [table[0], [*ROWS[0][:4], "4.2"], *ROWS[1:]])
    )


@pytest.mark.parametrize(
    ("name", "quantity", "unit"),
    [
        ("|E*| (MPa)", "E_MPa", "MPa"), ("Norme du module complexe (MPa)", "E_MPa", "MPa"),
        ("Komplexer E-Modul [N/mm²]", "E_MPa", "N/mm2"), ("DYNAMIC MODULUS, PSI", "E_MPa", "psi"),
        ("Dyn. Modulus (Mpa)", "E_MPa", "MPa"), ("|E*| MN/m²", "E_MPa", "MN/m2"), ("E* (kgf/cm²)", "E_MPa", "kgf/cm2"),
        ("Módulo dinámico (MPa)", "E_MPa", "MPa"), ("FREQUENCY, HZ", "frequency_Hz", "Hz"),
        ("Fréquence de sollicitation (Hz)", "frequency_Hz", "Hz"), ("fréq. (Hz)", "frequency_Hz", "Hz"),
        ("Frequency (f) [Hz]", "frequency_Hz", "Hz"), ("Kreisfrequenz (rad/s)", "frequency_Hz", "rad/s"),
        ("Phasenverschiebung (Grad)", "phase_deg", "deg"), ("Angle de phase φ (degrés)", "phase_deg", "deg"),
        ("Phase Lag (deg.)", "phase_deg", "deg"), ("Phase angle, degrees", "phase_deg", "deg"),
        ("Température d'essai (°C)", "temperature_C", "C"), ("Temperature (deg. C)", "temperature_C", "C"),
        ("TEMPERATURE (DEG F)", "temperature_C", "F"), ("Temperature (degrees Celsius)", "temperature_C", "C"),
        ("Pruefkoerper-Nr.", "specimen", ""), ("N° éprouvette", "specimen", ""), ("Sample #", "specimen", ""),
        ("tan delta", "tan_delta", ""), ("tan(φ) [-]", "tan_delta", "-"), ("Storage modulus (MPa)", "E1_MPa", "MPa"),
        ("Loss modulus E'' (MPa)", "E2_MPa", "MPa"), ("E1 (MPa)", "E1_MPa", "MPa"), ("E_2 [GPa]", "E2_MPa", "GPa"),
        ("E″ (MPa)", "E2_MPa", "MPa"), ("T° (°C)", "temperature_C", "C"), ("Storage modulus E'' (MPa)", None, None),
        ("Resilient modulus (MPa)", None, None), ("Sample diameter (mm)", None, None),
    ],
)  # fmt: skip
def test_labels_are_taken_liberally_and_meant_strictly(name, quantity, unit):
    column = recognise(name)
    assert (column and column.quantity, column and column.unit) == (quantity, unit)


def test_a_unit_that_is_not_said_is_taken_only_if_the_numbers_leave_one(tmp_path):
    names = ["specimen", "Temperatur", "Frequenz", "E (MPa)", "Phasenwinkel"]
    rows = [[s, t, f, e + 10 * f, p] for s, t, f, e, p in [*ROWS, *(("A", 40, f, 3000, 30) for f in (10, 1))]]
    campaign = read(tmp_path, [names, *rows])
    assert said(campaign, "'Frequenz' does not say its unit: Hz taken")
    assert said(campaign, "'Temperatur' does not say its unit: C taken, because 40 degF would be too cold")
    assert said(
        campaign, "'Phasenwinkel' does not say its unit: deg taken, because no phase in rad is that large"
    )
    warm = [[s, 40 + t, f, e, p] for s, t, f, e, p in rows]
    assert "'Temperatur' does not say its unit" in refusal(tmp_path, [names, *warm])
    small = [[*row[:4], 0.3] for row in rows]
    assert "'Phasenwinkel' does not say its unit" in refusal(tmp_path, [names, *small])
    assert "'omega' does not say its unit" in refusal(tmp_path, [[*HEADER[:2], "omega", *HEADER[3:]], *ROWS])
    assert "an angular frequency is in rad/s" in refusal(
        tmp_path, [[*HEADER[:2], "omega (Hz)", *HEADER[3:]], *ROWS]
    )
    assert "'E' does not say its unit" in refusal(tmp_path, [[*HEADER[:3], "E", HEADER[4]], *ROWS])


def test_units_behind_the_numbers(tmp_path):
    rows = [[s, f"{t} °C", f"{f} Hz", f"{e} MPa", f"{p}°"] for s, t, f, e, p in ROWS]
    campaign = read(tmp_path, [["specimen", "Temperature", "Frequency", "Modulus", "Phase"], *rows])
    assert campaign.table.columns == as_is(tmp_path)
    rows[2][3] = "9 GPa"
    assert "line 2: Modulus: '9800 MPa' has a unit that the column or other cells have not" in refusal(
        tmp_path, [["specimen", "Temperature", "Frequency", "Modulus", "Phase"], *rows]
    )


@pytest.mark.parametrize("first", ["", "-", "[-]"])
def test_a_line_of_units_with_a_dash_for_names(tmp_path, first):
    table = [["specimen", "T", "f", "E*", "phi"], [first, "[°C]", "[Hz]", "[MPa]", "[°]"], *ROWS]
    assert read(tmp_path, table).table.columns == as_is(tmp_path)


def test_a_line_of_units_that_contradicts_the_names(tmp_path):
    units = ["", "°C", "Hz", "GPa", "deg"]
    assert "line 2: the unit 'GPa' below column 'E (MPa)' is another" in refusal(
        tmp_path, [HEADER, units, *ROWS]
    )
    units[3] = "MPa"
    assert read(tmp_path, [HEADER, units, *ROWS]).table.columns == as_is(tmp_path)


@pytest.mark.parametrize(
    ("unit", "pascals"),
    [
        ("kgf/cm²", 9.80665 / 1e-4), ("psi", 4.4482216 / 0.0254**2), ("ksi", 4448.2216 / 0.0254**2), ("kPa", 1e3),
        ("GPa", 1e9),
    ],
)  # fmt: skip
def test_units_of_modulus_are_their_definitions(tmp_path, unit, pascals):
    """Eight thousand megapascals, given in each unit, are eight thousand megapascals."""
    given = 8e9 / pascals
    table = [["specimen", "temperature_C", "frequency_Hz", f"E ({unit})", "phase_deg"]]
    table += [["A", "20", str(f), f"{given * (1 + 0.01 * f):.10g}", "25"] for f in (1, 3, 10)]
    columns = read(tmp_path, table).table.columns
    assert [float(x) for x in columns["E_MPa"]] == pytest.approx([8080.0, 8240.0, 8800.0], rel=1e-6)
