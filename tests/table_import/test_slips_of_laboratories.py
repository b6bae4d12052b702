"""Slips that laboratories make in tables and exports: each is read rightly and said, or refused in one sentence."""

from __future__ import annotations

from pathlib import Path

import openpyxl
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.dates import later
from asphalt_nscd.table_import.names import one_of_another
from asphalt_nscd.table_import.quantities import recognise

EXPORTS = Path(__file__).parents[2] / "data/tutorial/exports"
HEADER = ["specimen", "T (°C)", "f (Hz)", "E (MPa)", "phi (°)"]
ROWS = [
    [s, t, f, 9000 + 100 * f - 50 * t + k, 20.5] for k, s in enumerate("AB") for t in (4, 21) for f in (10, 1)
]


def read(folder, rows, name="t.csv", **chosen):
    path = folder / name
    if name.endswith(".xlsx"):
        _workbook(path, rows if isinstance(rows, dict) else {"results": rows})
    else:
        lines = [",".join("" if cell is None else str(cell) for cell in row) for row in rows]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return read_campaign([path], chosen=chosen)[0]


def _workbook(path, sheets):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)


def columns(campaign, *names):
    return [campaign.table.columns[name] for name in names]


def said(campaign, part):
    return [note for note in campaign.notes if part in note]


def refusal(folder, rows, name="t.csv", **chosen):
    with pytest.raises(InputError) as error:
        read(folder, rows, name, **chosen)
    assert "t." in str(error.value) and "\n" not in str(error.value)
    return str(error.value)


def as_is(folder):
    return read(folder, [HEADER, *ROWS]).table.columns


# Columns twice


def test_a_quantity_in_two_languages_and_units_is_read_once_and_said(tmp_path):
    header = [*HEADER, "Frequenz (Hz)", "Module complexe (GPa)", "T (°F)", "Déphasage (rad)", "omega (rad/s)"]
    rows = [
        [
            *row,
            row[2],
            f"{row[3] / 1e3:.2f}",
            row[1] * 1.8 + 32,
            f"{row[4] * 0.01745329:.3f}",
            f"{row[2] * 6.2832:.3f}",
        ]
        for row in ROWS
    ]
    campaign = read(tmp_path, [header, *rows])
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "column 'E (MPa)' is read; the same stands in 'Module complexe (GPa)'")
    assert said(campaign, "column 'T (°C)' is read; the same stands in 'T (°F)'")
    rows[3][6] = "9.0"
    assert (
        "columns 'E (MPa)' and 'Module complexe (GPa)' may each be E_MPa; say which with --column E_MPa="
        in refusal(tmp_path, [header, *rows])
    )


def test_a_column_twice_counts_once_only_if_it_holds_the_same(tmp_path):
    twice = [[*HEADER, "E (MPa)"], *([*row, row[3]] for row in ROWS)]
    campaign = read(tmp_path, twice)
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "column 'E (MPa)' stands there twice with the same values")
    twice[2][5] += 1
    assert "column 'E (MPa)' appears twice; remove one" in refusal(tmp_path, twice)
    assert "(in line 3 they hold 8900 and 8901)" in refusal(tmp_path, twice)


EXPORT = """\
Target test temperature,4
Identification,Mix-{}
{}
,25 Hz,{} Hz,1 Hz
Dynamic modulus (MPa),9100,{},5000
Phase angle (Degrees),12.5,13.25,19
"""


def exports(folder, **files):
    for name, text in files.items():
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")
    return read_campaign([folder])[0]


def test_a_frequency_above_two_columns_of_an_export(tmp_path):
    with pytest.raises(
        InputError, match=r"a\.csv, line 4: 25 Hz stands above two columns with different results; rem"
    ):
        exports(tmp_path, a=EXPORT.format("A", "", "25.0", 8000))
    equal = EXPORT.format("A", "", "25", 9100).replace("13.25", "12.5")
    campaign = exports(tmp_path, a=equal)
    assert columns(campaign, "frequency_Hz", "E_MPa") == [["25", "1"], ["9100", "5000"]]
    assert said(campaign, "25 Hz stands above two columns with equal results, which count once")


def test_a_frequency_in_two_names_of_a_wide_table(tmp_path):
    header = ["T (°C)", *(f"{name} at {f} Hz" for f in ("10", "10.0") for name in ("E (MPa)", "phi (°)"))]
    message = refusal(tmp_path, [header, [4, 9000, 10, 9001, 10]])
    assert "'E (MPa) at 10 Hz' and 'E (MPa) at 10.0 Hz' hold one quantity at one condition" in message


# Retests

DECEMBER_7 = "Test date and time,Sat, Dec 7, 2019, 10:25 AM"
DECEMBER_8 = "Test date and time,Sun, Dec 8, 2019, 9:05 AM"


@pytest.mark.parametrize("names", [("a", "b"), ("b", "a")])
def test_of_two_tests_the_later_by_date_is_taken_and_said(tmp_path, names):
    first, second = EXPORT.format("A", DECEMBER_7, 10, 8000), EXPORT.format("A", DECEMBER_8, 10, 7000)
    campaign = exports(tmp_path, **dict(zip(names, (first, second), strict=True)))
    assert columns(campaign, "E_MPa") == [["9100", "7000", "5000"]]
    assert said(
        campaign,
        f"{names[1]}.csv is taken instead of {names[0]}.csv: Mix-A at 4 degC was tested again later, Sun",
    )
    assert said(campaign, f"leave {names[1]}.csv out to use the other")
    assert said(campaign, "1 of 2 files is not used: it was tested again later")
    assert campaign.notes.index("1 of 2 files is not used: it was tested again later") < min(
        place for place, note in enumerate(campaign.notes) if "is taken instead" in note
    )


def test_a_retest_of_some_frequencies_replaces_these_only(tmp_path):
    second = EXPORT.format("A", DECEMBER_8, 5, 7000).replace("9100", "9200")
    campaign = exports(tmp_path, a=EXPORT.format("A", DECEMBER_7, 10, 8000), b=second)
    tests = dict(zip(*columns(campaign, "frequency_Hz", "E_MPa"), strict=True))
    assert tests == {"25": "9200", "10": "8000", "5": "7000", "1": "5000"}
    assert said(campaign, "b.csv is taken instead of a.csv for 2 of its 3 tests")


@pytest.mark.parametrize("mark", ["", "-Repeated"])
def test_a_retest_that_must_be_another_material_is_refused(tmp_path, mark):
    soft = EXPORT.format(f"A-4C{mark}", DECEMBER_8, 10, 2600).replace("9100", "3000").replace("5000", "1700")
    with pytest.raises(InputError) as error:
        exports(tmp_path, a=EXPORT.format("A", DECEMBER_7, 10, 8000), b=soft)
    assert str(error.value) == (
        "b.csv and a.csv both hold specimen Mix-A at 4 degC, but |E*| in the first is 0.33 times that in the second, "
        "which is too far apart for a retest: leave the wrong one out, or, if it is another specimen or temperature, "
        "correct the name and the header of its file."
    )


def test_one_header_for_specimens_that_the_file_names_tell_apart_is_refused(tmp_path):
    files = {
        f"K-{name}-{t}C_Sum": EXPORT.format("7", DECEMBER_7 if name == 10 else DECEMBER_8, 10, 8000 + name)
        .replace("temperature,4", f"temperature,{t}")
        .replace("9100", str(9100 + name - 10 * t))
        for name in (10, 11, 13)
        for t in (4, 21)
    }
    with pytest.raises(InputError) as error:
        exports(tmp_path, **files)
    assert str(error.value) == (
        "K-10-21C_Sum.csv and 5 more: the file names say K-10, K-11 and K-13, and the header says Mix-7 in all; "
        "correct the Identification, or leave it empty."
    )
    for path in tmp_path.glob("*.csv"):
        path.write_text(path.read_text().replace("Identification,Mix-7", "Identification,"))
    assert set(read_campaign([tmp_path])[0].table.columns["specimen"]) == {"K-10", "K-11", "K-13"}


def test_a_file_called_after_another_specimen_is_no_retest(tmp_path):
    first, second = EXPORT.format("A", DECEMBER_7, 10, 8000), EXPORT.format("A", DECEMBER_8, 10, 7900)
    with pytest.raises(InputError) as error:
        exports(tmp_path, **{"Mix-A-4C": first, "Mix-B-4C_Sum": second})
    assert str(error.value) == (
        "Mix-B-4C_Sum.csv and Mix-A-4C.csv both hold specimen Mix-A at 4 degC, but the first is called Mix-B: correct "
        "the specimen in its header, or the name of the file."
    )
    (tmp_path / "Mix-B-4C_Sum.csv").rename(tmp_path / "Mix-A-4C-Repeated_Sum.csv")
    assert columns(read_campaign([tmp_path])[0], "E_MPa") == [["9100", "7900", "5000"]]


@pytest.mark.parametrize(
    ("first", "second", "other"),
    [
        ("Mix-B", "Mix-C", True),
        ("K10", "K11", True),
        ("Mix-B", "mix_b", False),
        ("Mix-B", "retest", False),
        ("core1", "test2", False),
        ("Mix-B", "Mix-B2", False),
    ],
)
def test_names_of_one_series(first, second, other):
    assert one_of_another(first, second) is other


def test_a_retest_may_mend_one_frequency(tmp_path):
    campaign = exports(
        tmp_path, a=EXPORT.format("A", DECEMBER_7, 10, 2000), b=EXPORT.format("A", DECEMBER_8, 10, 8000)
    )
    assert columns(campaign, "E_MPa") == [["9100", "8000", "5000"]]


def test_a_mark_that_the_date_contradicts_is_said(tmp_path):
    marked = EXPORT.format("A-4C-Repeated", DECEMBER_7, 10, 7000)
    campaign = exports(tmp_path, a=EXPORT.format("A", DECEMBER_8, 10, 8000), b=marked)
    assert columns(campaign, "E_MPa") == [["9100", "8000", "5000"]]
    assert said(campaign, "although b.csv is marked as repeated")


def test_without_dates_the_choice_is_the_users(tmp_path):
    with pytest.raises(
        InputError, match="no date in both tells which was tested later. The choice is yours: leave one"
    ):
        exports(tmp_path, a=EXPORT.format("A", DECEMBER_7, 10, 8000), b=EXPORT.format("A", "", 10, 7000))


@pytest.mark.parametrize(
    ("first", "second", "after"),
    [
        ("Sat, Dec 7, 2019, 12:44 AM", "Sat, Dec 7, 2019, 10:25 AM", True),
        ("Sat, Dec 7, 2019, 12:44 PM", "Sat, Dec 7, 2019, 10:25 AM", False),
        ("2019-12-07 00:00:00", "7 Dec 2019 9:00", True),
        ("07.12.2019", "01.02.2020", True),
        ("31/12/2019", "05/01/2020", True),
        ("8. März 2021", "7 févr. 2021", False),
        ("1/2/2020", "2/1/2020", None),  # the day first, or the month
        ("3/2/20", "4/5/2020", True),  # either way
        ("Dec 7, 2019", "2019-12-07 10:00", None),
        ("in May", "2019-12-07", None),
        ("2019-13-45", "2019-12-07", None),
        ("", "", None),
    ],
)
def test_which_date_is_later(first, second, after):
    assert later(first, second) is after
    assert later(second, first) is (None if after is None else not after)


# Several mixes


def test_several_mixes_in_one_table_or_in_several(tmp_path):
    table = [["Mix", *HEADER], *(["M1", *row] for row in ROWS), *(["M2", *row] for row in ROWS)]
    message = refusal(tmp_path, table)
    assert (
        "column 'Mix' holds 2 mixes (M1, M2), and a diagnosis is of one mix: save the rows of each mix"
        in message
    )
    one = [table[0], *table[1:9]]
    assert said(read(tmp_path, one), "mix from column 'Mix'")
    read(tmp_path, [["Mix", *HEADER], *(["M2", row[0] + "2", *row[1:4], 21] for row in ROWS)], "u.csv")
    with pytest.raises(InputError, match=r"2 mixes are given together \(M1 in t\.csv, M2 in u\.csv\)"):
        read_campaign([tmp_path])


def test_specimens_under_the_name_of_mixes_can_be_said(tmp_path):
    table = [["Mix", *HEADER[1:]], *ROWS]
    assert 'of one mix, say so with --column specimen="Mix"' in refusal(tmp_path, table)
    assert read(tmp_path, table, specimen="Mix").table.columns == as_is(tmp_path)


# Units


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
        ("tan delta (deg)", None, None), ("Storage modulus (MPa)", None, None), ("Loss modulus E'' (MPa)", None, None),
        ("Resilient modulus (MPa)", None, None), ("E1 (MPa)", None, None), ("Sample diameter (mm)", None, None),
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


# Sheets


def by_specimen(*more):
    return {name: [HEADER[1:], *(row[1:] for row in ROWS if row[0] == name)] for name in "AB"} | dict(more)


def test_all_sheets_of_one_layout_are_read_as_specimens(tmp_path):
    info = ("Info", [["Project", "X"], ["Operator", "me"]])
    mean = ("Mean", [HEADER[1:], *([*row[1:3], row[3] + 3, row[4]] for row in ROWS[:4])])
    campaign = read(tmp_path, by_specimen(info, mean), "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "2 sheets of t.xlsx read: A, B; --sheet takes one alone")
    assert said(campaign, "specimen from the name of the sheet")
    assert said(campaign, "skipped sheet Info of t.xlsx (") and said(
        campaign, "skipped sheet Mean of t.xlsx (its name"
    )
    alone = read_campaign([tmp_path / "t.xlsx"], sheet="B")[0]
    assert len(alone.table.lines) == 4 and alone.files == (tmp_path / "t.xlsx",)


def test_each_sheet_may_have_its_line_of_units(tmp_path):
    units = [["T", "f", "E*", "phi"], ["°C", "Hz", "MPa", "°"]]
    sheets = {f"{name}1": [*units, *rows[1:]] for name, rows in by_specimen().items()}
    columns = read(tmp_path, sheets, "t.xlsx").table.columns
    whole = as_is(tmp_path)
    assert columns == whole | {"specimen": [f"{name}1" for name in whole["specimen"]]}


def test_a_sheet_of_all_tests_is_not_read_twice(tmp_path):
    campaign = read(tmp_path, by_specimen(("All", [HEADER, *ROWS])), "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(
        campaign, "skipped t.xlsx, sheet All (holds the same tests as t.xlsx, sheet A, t.xlsx, sheet B)"
    )


def test_sheets_of_temperatures(tmp_path):
    sheets = {
        f"{t} °C": [[HEADER[0], *HEADER[2:]], *([r[0], *r[2:]] for r in ROWS if r[1] == t)] for t in (4, 21)
    }
    campaign = read(tmp_path, sheets, "t.xlsx")
    assert sorted(zip(*campaign.table.columns.values(), strict=True)) == sorted(
        zip(*as_is(tmp_path).values(), strict=True)
    )
    both = {
        f"{s} {t}C": [HEADER[2:], *(r[2:] for r in ROWS if r[:2] == [s, t])] for s in "AB" for t in (4, 21)
    }
    assert read(tmp_path, both, "t.xlsx").table.columns == as_is(tmp_path)


def test_an_error_in_one_sheet_names_it(tmp_path):
    sheets = by_specimen()
    sheets["B"][2][2] = "many"
    assert "t.xlsx, sheet B, line 3: E (MPa): 'many' is not a number" in refusal(tmp_path, sheets, "t.xlsx")


def test_a_hidden_sheet_is_not_read(tmp_path):
    read(tmp_path, by_specimen(), "t.xlsx")
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    book["A"].sheet_state = "hidden"
    book.save(tmp_path / "t.xlsx")
    campaign, _ = read_campaign([tmp_path / "t.xlsx"])
    assert len(campaign.table.lines) == 4 and said(campaign, "hidden sheet A not read")


# Cells


def test_cells_merged_below_a_temperature_and_a_specimen(tmp_path):
    merged = [
        [s if n % 4 == 0 else None, t if n % 2 == 0 else None, *rest] for n, (s, t, *rest) in enumerate(ROWS)
    ]
    campaign = read(tmp_path, [HEADER, *merged], "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "'T (°C)': 4 empty cells with the value above, as in merged cells")


def test_a_gap_is_filled_only_if_both_sides_agree(tmp_path):
    gap = [list(row) for row in ROWS]
    gap[1][0] = None
    assert read(tmp_path, [HEADER, *gap]).table.columns == as_is(tmp_path)
    gap[4][0] = None  # the first of specimen B
    assert "line 6: specimen is empty between A and B; fill it in" in refusal(tmp_path, [HEADER, *gap])
    gap[0][1] = None
    gap[4][0] = "B"
    assert "line 2: T (°C): the cell is empty" in refusal(tmp_path, [HEADER, *gap])


@pytest.mark.parametrize(
    "header",
    [
        [
            ["specimen", "f (Hz)", "4 °C", None, "21 °C", None],
            [None, None, "E (MPa)", "phi (°)", "E (MPa)", "phi (°)"],
        ],
        [
            [None, None, "T = 4 °C", None, "T = 21 °C"],
            ["specimen", "f (Hz)", "E (MPa)", "phi (°)", "E (MPa)", "phi (°)"],
        ],
        [
            ["T (°C)", None, 4, None, 21, None],
            ["specimen", "f (Hz)", "E (MPa)", "phi (°)", "E (MPa)", "phi (°)"],
        ],
    ],
)
def test_names_in_two_lines_with_merged_cells(tmp_path, header):
    cells = {(s, t, f): (e, p) for s, t, f, e, p in ROWS}
    rows = [[s, f, *cells[s, 4, f], *cells[s, 21, f]] for s in "AB" for f in (10, 1)]
    campaign = read(tmp_path, [["Results", None, None], *header, *rows], "t.xlsx")
    assert sorted(
        zip(*columns(campaign, "specimen", "temperature_C", "frequency_Hz", "E_MPa"), strict=True)
    ) == sorted((s, str(t), str(f), str(e)) for s, t, f, e, _ in ROWS)
    assert said(campaign, "names of columns from lines 2 and 3")


def test_quantities_merged_above_temperatures(tmp_path):
    header = [
        ["specimen", "f (Hz)", "E (MPa)", None, "phi (°)", None],
        [None, None, "4 °C", "21 °C", "4 °C", "21 °C"],
    ]
    cells = {(s, t, f): (e, p) for s, t, f, e, p in ROWS}
    rows = [[s, f, *(cells[s, t, f][q] for q in (0, 1) for t in (4, 21))] for s in "AB" for f in (10, 1)]
    assert len(read(tmp_path, [*header, *rows], "t.xlsx").table.lines) == len(ROWS)


def test_a_preface_is_passed_over_and_said(tmp_path):
    preface = [["Project", "A 13"], ["Operator", "me"], [], ["Test", "", "", "Result"]]
    campaign = read(tmp_path, [*preface, HEADER, *ROWS])
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "lines above the names passed over: 'Project', 'Operator', 'Test'")


def test_what_is_no_test_is_left_out_and_said(tmp_path):
    table = [
        HEADER,
        *ROWS[:2],
        HEADER,
        *ROWS[2:],
        ["A", 30, 10, "#N/A", "#N/A"],
        ["A", 30, 1, "n.a.", ""],
        ["Mean", "", "", 9000, 20],
        ["Std. dev.", "", "", 100, 1],
        ["Note: LVDT 2 was replaced"],
        ["Checked by", "", "J. Doe"],
    ]
    campaign = read(tmp_path, table)
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "left out, names of columns repeated: line 4")
    assert said(campaign, "left out, neither modulus nor phase: lines 11, 12")
    assert said(campaign, "left out, means and deviations of other lines: lines 13, 14")
    assert said(campaign, "left out, no number of a test: lines 15, 16 ('Note: LVDT 2 was replaced')")


def test_a_table_of_formulas_that_were_not_computed(tmp_path):
    empty = [[*row[:3], "=A1", "=A1"] for row in ROWS]
    assert "no line has a number in 'E (MPa)' and 'phi (°)' (formulas" in refusal(
        tmp_path, [HEADER, *empty], "t.xlsx"
    )


def test_a_table_lying_on_its_side(tmp_path):
    assert "t.csv: each test has a column; turn the table" in refusal(
        tmp_path, list(zip(HEADER, *ROWS, strict=True))
    )


def test_specimens_called_by_a_number_sign_are_no_comments(tmp_path):
    assert "specimen '#1' must begin with a letter" in refusal(
        tmp_path, [HEADER, *(["#1", *row[1:]] for row in ROWS)]
    )
    numbered = [["#", *HEADER], *([n, *row] for n, row in enumerate(ROWS))]
    assert read(tmp_path, numbered).table.columns == as_is(tmp_path)


@pytest.mark.parametrize("minus", ["−", "–"])
def test_a_minus_of_a_word_processor(tmp_path, minus):
    rows = [[s, f"{minus}{t}", *rest] for s, t, *rest in ROWS]
    assert columns(read(tmp_path, [HEADER, *rows]), "temperature_C")[0][:3] == ["-4", "-4", "-21"]


def test_grouped_digits_are_named_as_such(tmp_path):
    for text in ("27'470", "27 470"):
        rows = [[*row[:3], text, 20] for row in ROWS]
        assert "470' seems to group its digits" in refusal(tmp_path, [HEADER, *rows]).replace('"', "'")
    rows = [[*row[:3], '"27,470"', 20.5] for row in ROWS]
    assert (
        "or '27,470' groups its digits in thousands; write all numbers with the same and without"
        in refusal(tmp_path, [HEADER, *rows])
    )


def test_parts_of_the_modulus_and_tangents_are_answered(tmp_path):
    parts = [*HEADER[:3], "E' (MPa)", "E'' (MPa)"]
    assert "give |E*| = sqrt(E'^2 + E''^2) and the phase atan(E''/E')" in refusal(tmp_path, [parts, *ROWS])
    assert "give the phase itself in place of its tangent" in refusal(
        tmp_path, [[*HEADER[:4], "tan delta"], *ROWS]
    )


def test_a_table_repeated_under_its_names_is_no_export(tmp_path):
    """Names of columns are no header of a machine, even if one of them is `specimen`."""
    campaign = read(tmp_path, [HEADER, *ROWS[:4], HEADER, *ROWS[4:]])
    assert campaign.table.columns == as_is(tmp_path) and campaign.test_type == "bending"


def test_names_without_a_line_of_tests(tmp_path):
    """Found by damaged tables: names in the last line, and a number beyond all."""
    assert "no line below the names of columns" in refusal(tmp_path, [["Project", "A 13"], HEADER])
    twice = [[*HEADER, "Frequenz"], *([*row, f"{row[2]}e0000310"] for row in ROWS)]
    assert "columns 'f (Hz)' and 'Frequenz' may each be frequency_Hz" in refusal(tmp_path, twice)


@pytest.mark.parametrize(
    "label", ["Mean", "Avg", "average of 3", "Mittelwert", "Moyenne", "Std dev", "COV", "CV %"]
)
def test_lines_of_means_are_no_specimen(tmp_path, label):
    head = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg"
    tests = [
        f"{s},{t},{f},{9000 - 100 * t + 500 * f},{20 - f}" for s in "123" for t in (5, 20) for f in (1, 10)
    ]
    means = [f"{label},{t},{f},{9000 - 100 * t + 500 * f},{20 - f}" for t in (5, 20) for f in (1, 10)]
    (tmp_path / "t.csv").write_text("\n".join([head, *tests, *means]) + "\n")
    campaign, _ = read_campaign([tmp_path / "t.csv"])
    assert set(campaign.table.columns["specimen"]) == {"1", "2", "3"}
    assert any(
        "left out, means and deviations of other lines: lines 14, 15, 16, 17" in n for n in campaign.notes
    )


def test_a_table_of_means_alone_and_a_specimen_called_standard(tmp_path):
    head = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg"
    (tmp_path / "t.csv").write_text(f"{head}\nMean,5,1,9000,20\nMean,5,10,12000,15\n")
    assert set(read_campaign([tmp_path / "t.csv"])[0].table.columns["specimen"]) == {"Mean"}
    (tmp_path / "t.csv").write_text(f"{head}\nStandard 1,5,1,9000,20\nB,5,10,12000,15\n")
    assert set(read_campaign([tmp_path / "t.csv"])[0].table.columns["specimen"]) == {"Standard 1", "B"}
