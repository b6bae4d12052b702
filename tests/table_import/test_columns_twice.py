"""A quantity or frequency that stands twice: read once and said, or refused in one sentence."""

from __future__ import annotations

from table_import.slips import EXPORT, HEADER, ROWS, as_is, columns, exports, plain, read, refused, said


def test_a_quantity_in_two_languages_and_units_is_read_once_and_said(tmp_path):
    header = [*HEADER, "Frequenz (Hz)", "Module complexe (GPa)", "T (°F)", "Déphasage (rad)", "omega (rad/s)"]
    rows = [
        [s, t, f, e, p, f, f"{e / 1e3:.2f}", t * 1.8 + 32, f"{p * 0.01745329:.3f}", f"{f * 6.2832:.3f}"]
        for s, t, f, e, p in ROWS
    ]
    campaign = read(tmp_path, [header, *rows])
    assert plain(campaign.table) == as_is(tmp_path)
    assert said(campaign, "'E (MPa)' is read", "'Module complexe (GPa)'")
    assert said(campaign, "'T (°C)' is read", "'T (°F)'")
    rows[3][6] = "9.0"
    refused(read, tmp_path, [header, *rows], names=["t.csv", "'E (MPa)'", "'Module complexe (GPa)'", "E_MPa"])


def test_a_column_twice_counts_once_only_if_it_holds_the_same(tmp_path):
    twice = [[*HEADER, "E (MPa)"], *([*row, row[3]] for row in ROWS)]
    assert plain(read(tmp_path, twice).table) == as_is(tmp_path)
    twice[2][5] += 1
    refused(read, tmp_path, twice, names=["'E (MPa)'", "line 3", "8900 and 8901"])


def test_a_frequency_above_two_columns_of_an_export(tmp_path):
    different = EXPORT.format("A", "", "25.0", 8000)
    refused(exports, tmp_path, a=different, names=["a.csv, line 4: 25 Hz"])
    equal = EXPORT.format("A", "", "25", 9100).replace("13.25", "12.5")
    campaign = exports(tmp_path, a=equal)
    assert columns(campaign, "frequency_Hz", "E_MPa") == [[25, 1], [9100, 5000]]
    of_one_digit = EXPORT.format("A", "", "1", 5000).replace("13.25", "19")
    assert columns(exports(tmp_path, a=of_one_digit), "frequency_Hz") == [[25, 1]]


def test_a_frequency_in_two_names_of_a_wide_table(tmp_path):
    header = ["T (°C)", *(f"{name} at {f} Hz" for f in ("10", "10.0") for name in ("E (MPa)", "phi (°)"))]
    names = ["'E (MPa) at 10 Hz'", "'E (MPa) at 10.0 Hz'"]
    refused(read, tmp_path, [header, [4, 9000, 10, 9001, 10]], names=names)
