"""Units that are missing, contradicted or in a line of their own."""

from __future__ import annotations

import pytest
from table_import.slips import HEADER, ROWS, as_is, plain, read, refused, said


def headed(at, name, rows=ROWS):
    return [[*HEADER[:at], name, *HEADER[at + 1 :]], *rows]


BEHIND = [[s, f"{t} °C", f"{f} Hz", f"{e} MPa", f"{p}°"] for s, t, f, e, p in ROWS]
PLAIN = ["specimen", "Temperature", "Frequency", "Modulus", "Phase"]
BELOW = headed(3, "Wert", [["", "", "", "ksi", ""], *ROWS])
UNITS = ["", "°C", "Hz", "MPa", "deg"]


@pytest.mark.parametrize(
    ("rows", "chosen", "names"),
    [
        (headed(3, "E* [ksi]"), {"E_MPa": "E* [ksi]"}, ["'E* [ksi]'", "--column E_ksi"]),
        (headed(3, "Wert / GPa"), {"E_MPa": "Wert / GPa"}, ["'Wert / GPa'", "GPa"]),
        (headed(3, "Wert (°C)"), {"E_MPa": "Wert (°C)"}, ["'Wert (°C)'", "E_MPa"]),
        (BELOW, {"E_MPa": "Wert"}, ["'Wert (ksi)'", "--column E_ksi"]),
        (headed(4, "Phase (rad)", [[*ROWS[0][:4], "4.2"], *ROWS[1:]]), {}, ["4.2 rad", "241 deg"]),
        (headed(2, "omega"), {}, ["'omega'", "unit"]),
        (headed(2, "omega (Hz)"), {}, ["'omega (Hz)'", "rad/s"]),
        (headed(3, "E"), {}, ["'E'", "unit"]),
        (
            [PLAIN, *BEHIND[:2], [*BEHIND[2][:3], "9 GPa", BEHIND[2][4]], *BEHIND[3:]],
            {},
            ["line 2: Modulus", "'9800 MPa'"],
        ),
        ([HEADER, [*UNITS[:3], "GPa", "deg"], *ROWS], {}, ["line 2", "'GPa'", "'E (MPa)'"]),
    ],
)
def test_a_unit_that_is_contradicted_or_left_out_is_refused(tmp_path, rows, chosen, names):
    refused(read, tmp_path, rows, **chosen, names=["t.csv", *names])


@pytest.mark.parametrize(
    ("rows", "chosen"),
    [
        (headed(3, "Wert (N/mm²)"), {"E_MPa": "Wert (N/mm²)"}),
        ([PLAIN, *BEHIND], {}),
        ([HEADER, UNITS, *ROWS], {}),
        *(([["specimen", "T", "f", "E*", "phi"], [mark, "[°C]", "[Hz]", "[MPa]", "[°]"], *ROWS], {})
          for mark in ("", "-", "[-]")),
    ],
)  # fmt: skip
def test_a_unit_that_is_confirmed_or_stands_elsewhere(tmp_path, rows, chosen):
    assert plain(read(tmp_path, rows, **chosen).table) == as_is(tmp_path)


def test_a_quantity_without_a_unit_names_none_that_is_empty(tmp_path):
    table = [[*HEADER[:4], "tan delta (%)"], *ROWS]
    refused(read, tmp_path, table, names=["'%' is not a unit of tan_delta; give one of -, 1."])


def test_a_unit_that_is_chosen_and_stands_below(tmp_path):
    assert read(tmp_path, BELOW, E_ksi="Wert").table.numbers("E_MPa")[0] == pytest.approx(67568.62147)


@pytest.mark.parametrize("name", ["Air voids", "Air voids (%)", "VMA (%)", "VFA"])
def test_volumes_as_shares_of_one_are_refused(tmp_path, name):
    """A cell that a spreadsheet shows as 7.0 % holds 0.07, and was read as 0.07 %."""
    share = {"A": 0.07, "B": 0.081}
    refused(
        read,
        tmp_path,
        [[*HEADER, name], *([*row, share[row[0]]] for row in ROWS)],
        names=[name, "0.081 %", "per cent"],
    )
    percent = read(tmp_path, [[*HEADER, name], *([*row, 100 * share[row[0]]] for row in ROWS)])
    assert any(column.endswith("_percent") for column in percent.table.columns)


def test_a_unit_that_is_not_said_is_taken_only_if_the_numbers_leave_one(tmp_path):
    names = ["specimen", "Temperatur", "Frequenz", "E (MPa)", "Phasenwinkel"]
    rows = [[s, t, f, e + 10 * f, p] for s, t, f, e, p in [*ROWS, *(("A", 40, f, 3000, 30) for f in (10, 1))]]
    campaign = read(tmp_path, [names, *rows])
    said_units = read(tmp_path, [HEADER, *rows])
    assert plain(campaign.table) == plain(said_units.table)
    for name, unit in (("Frequenz", "Hz"), ("Temperatur", "C"), ("Phasenwinkel", "deg")):
        assert said(campaign, f"'{name}'", f"{unit} taken")
    warm = [[s, 40 + t, f, e, p] for s, t, f, e, p in rows]
    refused(read, tmp_path, [names, *warm], names=["'Temperatur'"])
    refused(
        read, tmp_path, [names, *(row for row in rows if row[1] < 40)], names=["'Temperatur'"]
    )  # two alone
    small = [[*row[:4], 0.3] for row in rows]
    refused(read, tmp_path, [names, *small], names=["'Phasenwinkel'"])


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
    assert read(tmp_path, table).table.numbers("E_MPa").tolist() == pytest.approx(
        [8080.0, 8240.0, 8800.0], rel=1e-6
    )


@pytest.mark.parametrize(
    ("second", "names"),
    [
        (["E* B (GPa)", "phi B (deg)"], ["'E* A (MPa)'", "'E* B (GPa)'"]),
        (["E* B (MPa)", "phi B (rad)"], ["'phi A (deg)'", "'phi B (rad)'"]),
    ],
)
def test_columns_of_one_quantity_in_two_units_are_refused(tmp_path, second, names):
    """Below each other all would be read in the unit of the first: 9.8 GPa as 9.8 MPa."""
    wide = [["T (°C)", "f (Hz)", "E* A (MPa)", "phi A (deg)", *second]]
    wide += [[t, f, e, p, e, p] for s, t, f, e, p in ROWS if s == ROWS[0][0]]
    refused(read, tmp_path, wide, names=["t.csv", *names, "give all in one unit"])


def test_two_spellings_of_one_unit_are_one(tmp_path):
    wide = [["T (°C)", "f (Hz)", "E* A (MPa)", "phi A (deg)", "E* B (N/mm²)", "phi B (°)"]]
    wide += [[t, f, e, p, e, p] for s, t, f, e, p in ROWS if s == ROWS[0][0]]
    moduli = read(tmp_path, wide).table.numbers("E_MPa")
    assert list(moduli[: len(moduli) // 2]) == list(moduli[len(moduli) // 2 :])
