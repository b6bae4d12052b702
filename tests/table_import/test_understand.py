"""What is understood of a user's columns, and what is refused as ambiguous."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from table_import.slips import plain, refused

from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.cells import Cells
from asphalt_nscd.table_import.quantities import SIEVES, recognise
from asphalt_nscd.table_import.understand import understand


def table(header, *rows):
    return Cells(Path("t.csv"), header.split(";"), [(n, row.split(";")) for n, row in enumerate(rows, 2)])


def columns(header, *rows, **chosen):
    return plain(understand(table(header, *rows), chosen).table)


@pytest.mark.parametrize(
    ("name", "quantity", "one"),
    [
        ("E (MPa)", "E_MPa", 1), ("|E*| [GPa]", "E_MPa", 1e3), ("E_Pa", "E_MPa", 1e-6), ("E / MPa", "E_MPa", 1),
        ("Dynamic Modulus, ksi", "E_MPa", 6.894757293), ("Dynamic Modulus (ksi)", "E_MPa", 6.894757293),
        ("E* (N/mm²)", "E_MPa", 1), ("phi (deg)", "phase_deg", 1), ("delta_rad", "phase_deg", 180 / math.pi),
        ("Phase angle (°)", "phase_deg", 1), ("φ [mrad]", "phase_deg", 0.18 / math.pi), ("psi_deg", "psi_deg", 1),
        ("Temp °C", "temperature_C", 1), ("T_C", "temperature_C", 1), ("T(K)", "temperature_C", -272.15),
        ("Test temperature (°F)", "temperature_C", -155 / 9), ("Temp°C", "temperature_C", 1),
        ("T core [°C]", "temperature_C", 1), ("f_Hz", "frequency_Hz", 1),
        ("omega (rad/s)", "frequency_Hz", 0.5 / math.pi),
        ("Loading frequency [Hz]", "frequency_Hz", 1), ("F0 (N)", "F0_N", 1), ("F [kN]", "F0_N", 1e3),
        ("z0 (µm)", "z0_m", 1e-6), ("z0 (μm)", "z0_m", 1e-6), ("displacement mm", "z0_m", 1e-3),
        ("Steifigkeitsmodul |E*| [GPa]", "E_MPa", 1e3), ("Komplexer Modul (MPa)", "E_MPa", 1),
        ("Dynamic modulus E* (MPa)", "E_MPa", 1), ("Phase angle δ (°)", "phase_deg", 1),
        ("Phasenwinkel (Grad)", "phase_deg", 1), ("Temperatur (Grad C)", "temperature_C", 1),
        ("Frequenz in Hz", "frequency_Hz", 1), ("Dynamic modulus E' (MPa)", None, None),
        ("Phase angle E* (°)", None, None), ("Operator", None, None),
        ("E' (MPa)", "E1_MPa", 1), ("E'' (MPa)", "E2_MPa", 1), ("|G*| (MPa)", None, None), ("e (mm)", None, None),
        ("t (s)", None, None), ("Load cycles", "cycles", 1), ("Norme du module complexe (MPa)", "E_MPa", 1),
        ("Komplexer E-Modul [N/mm²]", "E_MPa", 1), ("DYNAMIC MODULUS, PSI", "E_MPa", 6.894757293e-3),
        ("Dyn. Modulus (Mpa)", "E_MPa", 1), ("|E*| MN/m²", "E_MPa", 1), ("E* (kgf/cm²)", "E_MPa", 0.0980665),
        ("Módulo dinámico (MPa)", "E_MPa", 1), ("FREQUENCY, HZ", "frequency_Hz", 1),
        ("Fréquence de sollicitation (Hz)", "frequency_Hz", 1), ("fréq. (Hz)", "frequency_Hz", 1),
        ("Frequency (f) [Hz]", "frequency_Hz", 1), ("Kreisfrequenz (rad/s)", "frequency_Hz", 0.5 / math.pi),
        ("Phasenverschiebung (Grad)", "phase_deg", 1), ("Angle de phase φ (degrés)", "phase_deg", 1),
        ("Phase Lag (deg.)", "phase_deg", 1), ("Phase angle, degrees", "phase_deg", 1),
        ("Température d'essai (°C)", "temperature_C", 1), ("Temperature (deg. C)", "temperature_C", 1),
        ("TEMPERATURE (DEG F)", "temperature_C", -155 / 9), ("Temperature (degrees Celsius)", "temperature_C", 1),
        ("Pruefkoerper-Nr.", "specimen", 1), ("N° éprouvette", "specimen", 1), ("Sample #", "specimen", 1),
        ("tan delta", "tan_delta", 1), ("tan(φ) [-]", "tan_delta", 1), ("Storage modulus (MPa)", "E1_MPa", 1),
        ("Loss modulus E'' (MPa)", "E2_MPa", 1), ("E1 (MPa)", "E1_MPa", 1), ("E_2 [GPa]", "E2_MPa", 1e3),
        ("E″ (MPa)", "E2_MPa", 1), ("T° (°C)", "temperature_C", 1), ("Storage modulus E'' (MPa)", None, None),
        ("Resilient modulus (MPa)", None, None), ("Sample diameter (mm)", None, None),
    ],
)  # fmt: skip
def test_names_and_units_are_taken_liberally_and_meant_strictly(name, quantity, one):
    column = recognise(name)
    assert (column and column.quantity) == quantity
    if column:
        assert column.factor + column.offset == pytest.approx(one, rel=1e-9)


FOREIGN = ["E (mPa)", "E (deg)", "phi (Hz)", "phi (grad)", "f (1/min)", "specimen (mm)", "E* (10^3 MPa)"]


@pytest.mark.parametrize("name", FOREIGN)
def test_foreign_units_are_refused(name):
    refused(recognise, name, names=[f"'{name.partition('(')[2][:-1]}'"])


@pytest.mark.parametrize(
    ("name", "quantity"),
    [
        ("Sieve (mm)", "diameter_mm"),
        ("% passing", "passing_percent"),
        ("Passing (%)", "passing_percent"),
        ("Siebweite (mm)", "diameter_mm"),
        ("Durchgang (M.-%)", "passing_percent"),
    ],
)
def test_sieves(name, quantity):
    assert recognise(name, SIEVES).quantity == quantity


def test_decimal_commas_giga_pascals_and_radians():
    read = columns("Sample;Temp °C;f (Hz);|E*| [GPa];delta_rad", "A;-10;0,1;19,864;0,1", "A;12,5;25;8;0,5")
    assert read == {
        "specimen": ["A", "A"],
        "temperature_C": [-10, 12.5],
        "frequency_Hz": [0.1, 25],
        "E_MPa": [19864, 8000],
        "phase_deg": [5.729577951, 28.64788976],
    }


def test_peaks_with_micrometres_and_extra_columns():
    header = "replicate;T (°C);f (Hz);F0 (N);z0 (µm);psi (°);operator;E' (MPa)"
    read = understand(table(header, "1;15;10;100;63;20;me;9000"))
    assert read.form == "peaks"
    assert plain(read.table)["z0_m"] == [6.3e-05]
    assert "ignored: 'operator', \"E' (MPa)\"" in read.notes


def test_moduli_are_taken_where_peaks_stand_beside_them():
    read = understand(table("T_C;f_Hz;E_MPa;phi_deg;F0_N;z0_m;psi_deg", "15;10;9000;20;100;6e-5;19"))
    assert read.form == "moduli" and "F0_N" not in read.table.columns
    assert plain(read.table)["amplitude_m"] == [6e-5]


def test_degrees_fahrenheit_to_a_hundredth():
    assert columns("T (°F);f_Hz;E_MPa;phi_deg", "68.9;10;9000;20", "39.2;10;9000;20")["temperature_C"] == [
        20.5,
        4,
    ]


@pytest.mark.parametrize(
    ("header", "row", "words"),
    [
        ("T_C;f_Hz;E_MPa;phi_deg", "15;10;20;9000", "exchange the two names"),
        ("T_C;f_Hz;phi_deg;lag", "15;10;9000;20", "'phi_deg' are as moduli"),
    ],
)
def test_a_modulus_and_a_phase_that_are_exchanged_are_refused(header, row, words):
    refused(columns, header, row, row.replace("15", "20"), names=["t.csv", words])


def test_units_in_a_line_of_their_own():
    read = columns("T;f;E*;phi", "°C;Hz;GPa;deg", "15;10;9;20")
    assert read["E_MPa"] == [9000]


def test_frequencies_of_headings_have_a_mark_of_their_own():
    """`0.5 Hz` above cells with decimal commas; digits that may be grouped are refused all the same."""
    header = "T_C;E (MPa) 10 Hz;phi (deg) 10 Hz;E (MPa) 0.5 Hz;phi (deg) 0.5 Hz"
    read = columns(header, "4,5;9100,5;12,5;5000;19")
    assert read["frequency_Hz"] == [10, 0.5] and read["E_MPa"] == [9100.5, 5000]
    refused(columns, header, "4;9,100;12;5,000;19", names=["t.csv", "9,100", "0.5"])


def test_wide_table_becomes_long():
    read = columns(
        "f (Hz);E (GPa) at -10 °C;phi (deg) at -10 °C;E (GPa) at 12,5 °C;phi (deg) at 12,5 °C",
        "10;27,5;4;9;20",
        "1;25;5;;",
    )
    assert read["temperature_C"] == [-10, -10, 12.5]
    assert read["E_MPa"] == [27500, 25000, 9000] and read["phase_deg"] == [4, 5, 20]
    assert read["frequency_Hz"] == [10, 1, 10]


@pytest.mark.parametrize("ways", ["E* ph", "E' E''", "E* tan", "E' tan", "E' ph", "E'' ph", "E'' tan"])
def test_each_two_that_give_the_whole_modulus(ways):
    """The triangle of 3, 4 and 5."""
    phase = f"{math.degrees(math.atan(0.75))}"
    cells = {"E*": "5000", "E'": "4000", "E''": "3000", "ph": phase, "tan": "0.75"}
    names = {"ph": "phase (deg)", "tan": "tan delta"}
    header = ";".join(names.get(way, f"{way} (MPa)") for way in ways.split())
    read = columns("T_C;f_Hz;" + header, "15;10;" + ";".join(cells[way] for way in ways.split()))
    assert float(read["E_MPa"][0]) == pytest.approx(5000, rel=1e-9)
    assert float(read["phase_deg"][0]) == pytest.approx(36.86989765, rel=1e-9)


LONG = "T_C;f_Hz;E_MPa;phi_deg"


@pytest.mark.parametrize(
    ("header", "rows", "names"),
    [
        ("T set (°C);T core (°C);f_Hz;E_MPa;phi_deg", ["15;15.1;10;9;2"],
         ["'T set (°C)' and 'T core (°C)'", "temperature_C"]),
        ("T_C;f_Hz;E_MPa;E_MPa;phi_deg", ["15;10;9000;9001;20"], ["'E_MPa'", "twice"]),
        ("T_C;f_Hz;E;phi_deg", ["15;10;9000;20"], ["'E'", "unit"]),
        ("T_C;f_Hz;F0_N;z0_m;phi_rad", ["15;10;9;9;2"], ['--column psi_rad="phi_rad"']),
        ("T_C;f_Hz;E_MPa;lag", ["15;10;9000;20"], ["phase", "T_C, f_Hz, E_MPa, lag"]),
        ("f_Hz;E_MPa at 15 °C;phi_deg at 20 °C", ["10;9000;20"], ["not the same for all quantities"]),
        ("T_C;f_Hz;E_MPa at 15 °C;phi_deg at 15 °C", ["10;9;9000;20"], ["not the same for all quantities"]),
        (LONG, ["15;10;9000,5;20.1"], ["'9000,5' (line 2)", "'20.1' (line 2)"]),
        (LONG, ["15;10;1.234,5;20"], ["'1.234,5' seems to group its digits"]),
        (LONG, ["15;10;;20"], ["line 2: E_MPa", "empty"]),
        (LONG, ["15;10;9e3x;20"], ["'9e3x'"]),
        (LONG, ["15;10;9_000;20"], ["'9_000'"]),
        (LONG, ["15;10;9000;20", "15;10;9100;20"], ["line 3", "line 2"]),  # a test that repeats, without specimens
        ("specimen;" + LONG, ["=cmd();15;10;9000;20"], ["specimen '=cmd()'"]),
        ("origin;" + LONG, ["guess;15;10;9000;20"], ["origin 'guess'", "measured"]),
    ],
)  # fmt: skip
def test_ambiguous_tables_are_refused(header, rows, names):
    refused(columns, header, *rows, names=["t.csv", *names])


@pytest.mark.parametrize("name", ["Mix 21 °C", "N°5", "Köln_3", "A & B", "d'Arc"])
def test_a_specimen_may_be_called_as_people_call_it(name):
    assert columns("specimen;" + LONG, f"{name};15;10;9000;20")["specimen"] == [name]


def test_columns_can_be_named():
    header, row = "T set (°C);T core (°C);f_Hz;Steifigkeit;phi", "15;15.1;10;9;0.3"
    chosen = {"temperature_C": "T set (°C)", "E_GPa": "Steifigkeit", "phase_rad": "phi"}
    read = columns(header, row, **chosen)
    assert (read["temperature_C"], read["E_MPa"], read["phase_deg"]) == ([15], [9000], [17.18873385])
    refused(columns, header, row, temperature_C="Temp", names=["t.csv", "'Temp'"])
    refused(columns, header, row, stiffness="Steifigkeit", names=["--column stiffness"])


def test_records_without_a_column_of_specimens_are_asked_for_it(tmp_path):
    path = tmp_path / "r.csv"
    path.write_text("record,temperature_C,frequency_Hz\na.csv,20,10\n")
    refused(read_campaign, [path], names=["r.csv: column 'specimen'", "record, temp"])
    path.write_text("record,replicate,temperature_C,frequency_Hz\na.csv,B,20,10\n")
    assert read_campaign([path])[0].table.columns["specimen"] == ["B"]
