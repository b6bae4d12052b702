"""The small parts of an import, by value: what each makes of a few cells or numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from table_import.slips import HEADER, ROWS, read, refused

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.computed import computed_specimens
from asphalt_nscd.table_import.duration import duration
from asphalt_nscd.table_import.grid import grid
from asphalt_nscd.table_import.header_lines import require_rows, tabulated, told_above
from asphalt_nscd.table_import.skipped_files import SkippedFile, common_mend, listed
from asphalt_nscd.table_import.skipped_files import refused as refused_file
from asphalt_nscd.table_import.storage_loss import whole_modulus


@pytest.mark.parametrize(
    ("cells", "told"),
    [
        (["T = 4 °C"], {"T (°C)": "4"}),
        (["Temperature (°F):", "39.2"], {"T (°F)": "39.2"}),
        (["Temperature", "39.2"], {"Temperature": "39.2"}),
        (["Freq. (Hz) = 5"], {"f (Hz)": "5"}),
        (["Specimen: A 3"], {"specimen": "A 3"}),
        (["", "Temp.", "20 °C", "Frequency", "5 Hz"], {"T (°C)": "20", "f (Hz)": "5"}),
        (["Mix", "AC 16", "Temp.", "cold"], {"mix": "AC 16"}),
        (["Operator", "me"], {}),
        (["T = 4 °C and more"], {}),
    ],
)
def test_what_a_line_above_a_table_says_of_all_its_tests(cells, told):
    assert told_above([(1, cells)]) == (told, {0} if told else set())
    # of two lines the first
    both = told_above([(1, cells), (2, ["x"]), (3, ["T = 21 °C"])])
    assert both == ({"T (°C)": "21"} | told, {0, 2} if told else {2})


def test_of_two_lines_above_names_the_nearer_says_the_temperature():
    rows = [["", "4 °C"], ["", "21 °C"], ["f (Hz)", "E (MPa)", "phi (°)"], ["10", "9000", "20"]]
    cells = tabulated(Path("t.csv"), list(enumerate(rows, 1)), [])
    assert cells.at == [{}, {"T (°C)": "21"}, {"T (°C)": "21"}] and cells.rows == [(4, rows[3])]


@pytest.mark.parametrize(("warmest", "turned"), [("6.9", False), ("7.1", True)])
def test_a_column_for_each_test_is_an_export_of_one_temperature_or_to_be_turned(warmest, turned):
    rows = [(1, ["T (°C)", "4", warmest]), (2, ["f (Hz)", "1", "10"]), (3, ["E (MPa)", "9000", "9900"])]
    if turned:
        refused(require_rows, Path("t.csv"), rows, names=["t.csv", "each test has a column"])
    else:
        require_rows(Path("t.csv"), rows)


CONDITIONS = [(t, f) for t in (5, 20) for f in (1.0, 10.0)]
MODULI = np.array([[9001.0, 9313, 9957], [12016, 12002, 13271], [3003, 3332, 3058], [4407, 4493, 4991]])


def table(conditions, **moduli):
    rows = [(name, t, f, e) for name, own in moduli.items() for (t, f), e in zip(conditions, own) if e == e]
    names = ("specimen", "temperature_C", "frequency_Hz", "E_MPa")
    columns = {name: list(map(str, column)) for name, column in zip(names, zip(*rows))}
    return Table(Path("t.csv"), columns, [*range(2, len(rows) + 2)])


@pytest.mark.parametrize(
    "statistic",
    [
        lambda x: x.mean(axis=1).round(),
        lambda x: np.median(x, axis=1).round(),
        lambda x: x.std(axis=1).round(1),
        lambda x: x.std(axis=1, ddof=1).round(1),
        lambda x: (x.std(axis=1, ddof=1) / x.mean(axis=1)).round(3),
        lambda x: (100.0 * x.std(axis=1) / x.mean(axis=1)).round(1),
    ],
)
def test_a_specimen_computed_of_those_before_or_behind_it(statistic):
    own, (a, b, c) = statistic(MODULI), MODULI.T
    assert computed_specimens(table(CONDITIONS, a=a, b=b, c=c, x=own)) == ["x"]
    assert computed_specimens(table(CONDITIONS, x=own, a=a, b=b, c=c)) == ["x"]
    assert computed_specimens(table(CONDITIONS, a=a, x=own, b=b, c=c)) == []
    # half of a per cent off in one test, or three tests alone: it may have been measured
    off = own * [1.0, 1.0, 1.05, 1.0]
    assert computed_specimens(table(CONDITIONS, a=a, b=b, c=c, x=off)) == []
    assert computed_specimens(table(CONDITIONS[:3], a=a, b=b, c=c, x=own)) == []


def test_a_mean_is_of_the_specimens_that_were_tested():
    """Where b was not, the spreadsheet took it over the others, and nothing is told by that."""
    conditions, (a, b, c) = [*CONDITIONS, (30, 1.0)], np.vstack([MODULI, [1001, np.nan, 1405]]).T
    mean = np.nanmean([a, b, c], axis=0).round()
    assert computed_specimens(table(conditions, a=a, b=b, c=c, x=mean)) == ["x"]


def test_specimens_that_differ_by_their_rounding_have_no_mean():
    (a,) = MODULI.T[:1]
    assert computed_specimens(table(CONDITIONS, a=a, b=a + 10, c=a + [10, 0, 10, 0])) == []


@pytest.mark.parametrize(
    ("study", "told"),
    [
        # 974 s of pouring and 20 times 4 samples of 71 500 steps of 4 us and five starts of 1.7 s; 240 s apart
        ((14160, 4, 6, [3, 6, 10, 25, 40], 5e-5), "about 16 minutes"),
        ((14160, 4, 6, [0.001, 40], 5e-5), "about 4.7 hours"),
        ((14160, 1, 1, [10], 1e-3), "about 4 minutes"),
        ((14160, 4, 6, [0.001, 40], None), "about 12 minutes"),  # 2000 steps a test, whatever its frequency
        ((0, 1, 20, [10] * 100, 1e-3), "about 70 minutes"),
        ((0, 1, 30, [10] * 100, 1e-3), "about 1.6 hours"),
    ],
)
def test_how_long_a_study_takes_on_two_cores(study, told):
    assert duration(*study) == told


def frame(tests):
    rows = [(t, f) for t, frequencies in tests.items() for f in frequencies]
    return pd.DataFrame(rows, columns=["temperature_C", "frequency_Hz"])


@pytest.mark.parametrize(
    ("tests", "temperatures", "frequencies"),
    [
        ({5: [1, 2, 4, 8, 16, 32], 10: [3, 6, 9], 20: [3, 6, 9], 30: [3, 6, 9]}, [10, 20, 30], [3, 6, 9]),
        ({5: [1, 2, 3], 10: [1, 2, 5], 20: [1, 2, 7]}, [5, 10, 20], [1, 2]),  # those that all have
        ({5.0: [10, 10.3], 5.5: [10, 10.3]}, [5.0, 5.5], [10, 10.3]),  # as near as they may be
    ],
)
def test_the_largest_full_grid(tests, temperatures, frequencies):
    given = frame(tests)
    found = grid(given, Path("t.csv"))
    assert found[:2] == (temperatures, frequencies)
    outside = len(given) - len(temperatures) * len(frequencies)
    assert [note.partition(" are")[0] for note in found[2]] == [f"{outside} of {len(given)} tests"] * bool(
        outside
    )


@pytest.mark.parametrize(
    ("tests", "names"),
    [({5.0: [1, 2], 5.4: [1, 2]}, ["temperatures 5 and 5.4 degC"]), ({5: [1, 10, 10.1]}, ["10 and 10.1 Hz"])],
)
def test_two_readings_of_one_set_value_are_no_grid(tests, names):
    refused(grid, frame(tests), Path("t.csv"), names=["t.csv", *names])


def test_a_loss_modulus_at_phase_zero_says_nothing():
    size, phase = whole_modulus({"E2_MPa": np.array([5.0, 5.0]), "phase_deg": np.array([0.0, 30.0])})
    assert (
        np.isnan(size[0]) and size[1] == pytest.approx(10.0) and phase.tolist() == pytest.approx([0.0, 30.0])
    )


def test_files_passed_over_are_told_by_reason():
    empty = [SkippedFile(f"{n}.csv", "the file is empty", "export it anew.") for n in range(5)]
    assert listed(empty[:3]) == "0.csv, 1.csv, 2.csv (the file is empty)"
    other = refused_file(
        "d.csv", InputError("d.csv, line 2: no column for phase (found: a); name it."), Path("d.csv")
    )
    assert other == SkippedFile("d.csv", "line 2: no column for phase", "name it.")
    assert listed([*empty[:4], other, empty[4]]) == (
        "0.csv, 1.csv, 2.csv and 2 more (the file is empty); d.csv (line 2: no column for phase)"
    )
    assert (common_mend(empty), common_mend([*empty, other])) == ("export it anew.", "")


@pytest.mark.parametrize(
    ("real", "imaginary"),
    [
        ("Re(E*)", "Im(E*)"),
        ("E real", "E imag"),
        ("E_real", "E_imaginary"),
        ("Real E*", "Imaginary E*"),
        ("E* real part", "E* imaginary part"),
        ("Storage E'", "Loss E''"),
        ("E prime", "E double prime"),
    ],
)
def test_real_and_imaginary_part_by_the_names_that_people_give_them(tmp_path, real, imaginary):
    """The refusal of an unknown one asked to write |E*| for both."""
    table = [[*HEADER[:3], f"{real} (MPa)", f"{imaginary} (MPa)"], *([*row[:3], 4000, 3000] for row in ROWS)]
    campaign = read(tmp_path, table)
    assert campaign.table.numbers("E_MPa") == pytest.approx(5000.0)
    assert campaign.table.numbers("phase_deg") == pytest.approx(36.8699)
