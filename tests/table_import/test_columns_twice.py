"""A quantity or frequency that stands twice: read once and said, or refused in one sentence."""

from __future__ import annotations

import pytest
from table_import.slips import EXPORT, HEADER, ROWS, as_is, columns, exports, read, refusal, said

from asphalt_nscd.files.errors import InputError


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


def test_a_frequency_above_two_columns_of_an_export(tmp_path):
    with pytest.raises(
        InputError, match=r"a\.csv, line 4: 25 Hz stands above two columns with different results; rem"
    ):
        exports(tmp_path, a=EXPORT.format("A", "", "25.0", 8000))
    equal = EXPORT.format("A", "", "25", 9100).replace("13.25", "12.5")
    campaign = exports(tmp_path, a=equal)
    assert columns(campaign, "frequency_Hz", "E_MPa") == [["25", "1"], ["9100", "5000"]]
    assert said(campaign, "25 Hz stands above two columns with equal results, which count once")
    of_one_digit = EXPORT.format("A", "", "1", 5000).replace("13.25", "19")
    assert said(exports(tmp_path, a=of_one_digit), "1 Hz stands above two columns with equal results")


def test_a_frequency_in_two_names_of_a_wide_table(tmp_path):
    header = ["T (°C)", *(f"{name} at {f} Hz" for f in ("10", "10.0") for name in ("E (MPa)", "phi (°)"))]
    message = refusal(tmp_path, [header, [4, 9000, 10, 9001, 10]])
    assert "'E (MPa) at 10 Hz' and 'E (MPa) at 10.0 Hz' hold one quantity at one condition" in message
