"""Two tests of one condition, and two mixes in one folder: told apart rightly and said, or refused."""

from __future__ import annotations

import pytest
from table_import.slips import EXPORT, HEADER, ROWS, as_is, columns, exports, plain, read, refused, said

from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.dates import later
from asphalt_nscd.table_import.names import one_of_another

DECEMBER_7 = "Test date and time,Sat, Dec 7, 2019, 10:25 AM"
DECEMBER_8 = "Test date and time,Sun, Dec 8, 2019, 9:05 AM"


def dated(specimen, date, modulus=8000, frequency=10):
    return EXPORT.format(specimen, date, frequency, modulus)


@pytest.mark.parametrize("names", [("a", "b"), ("b", "a")])
def test_of_two_tests_the_later_by_date_is_taken_and_said(tmp_path, names):
    files = {names[0]: dated("A", DECEMBER_7), names[1]: dated("A", DECEMBER_8, 7000)}
    campaign = exports(tmp_path, **files)
    assert columns(campaign, "E_MPa") == [[9100, 7000, 5000]]
    (taken,) = said(campaign, f"{names[1]}.csv is taken instead of {names[0]}.csv: Mix-A at 4 degC")
    (counted,) = said(campaign, "1 of 2 files is not used")
    assert campaign.notes.index(counted) < campaign.notes.index(taken)


def test_a_retest_of_some_frequencies_replaces_these_only(tmp_path):
    second = dated("A", DECEMBER_8, 7000, 5).replace("9100", "9200")
    campaign = exports(tmp_path, a=dated("A", DECEMBER_7), b=second)
    tests = dict(zip(*columns(campaign, "frequency_Hz", "E_MPa"), strict=True))
    assert tests == {25: 9200, 10: 8000, 5: 7000, 1: 5000}
    assert said(campaign, "b.csv is taken instead of a.csv for 2 of its 3 tests")


SOFT = {"9100": "3000", "8000": "2600", "5000": "1700"}


def soft(specimen):
    text = dated(specimen, DECEMBER_8)
    for stiff, value in SOFT.items():
        text = text.replace(stiff, value)
    return text


@pytest.mark.parametrize(
    ("first", "second", "text", "names"),
    [
        ("a", "b", soft("A-4C"), ["b.csv and a.csv", "Mix-A at 4 degC", "0.33 times"]),
        ("a", "b", soft("A-4C-Repeated"), ["b.csv and a.csv", "Mix-A at 4 degC", "0.33 times"]),
        ("Mix-A-4C", "Mix-B-4C_Sum", dated("A", DECEMBER_8, 7900),
         ["Mix-B-4C_Sum.csv and Mix-A-4C.csv", "Mix-A at 4 degC", "called Mix-B"]),
        ("a", "b", dated("A", "", 7000), ["a.csv", "b.csv", "Mix-A"]),  # no date: the choice is the user's
    ],
)  # fmt: skip
def test_what_may_be_another_material_is_no_retest(tmp_path, first, second, text, names):
    refused(exports, tmp_path, **{first: dated("A", DECEMBER_7), second: text, "names": names})


def test_one_header_for_specimens_that_the_file_names_tell_apart_is_refused(tmp_path):
    files = {
        f"K-{name}-{t}C_Sum": dated("7", DECEMBER_7 if name == 10 else DECEMBER_8, 8000 + name)
        .replace("temperature,4", f"temperature,{t}")
        .replace("9100", str(9100 + name - 10 * t))
        for name in (10, 11, 13)
        for t in (4, 21)
    }
    names = ["K-10-21C_Sum.csv and 5 more", "K-10, K-11 and K-13", "Mix-7"]
    refused(exports, tmp_path, **files, names=names)
    nameless = {name: text.replace("Identification,Mix-7", "Identification,") for name, text in files.items()}
    assert set(exports(tmp_path, **nameless).table.columns["specimen"]) == {"K-10", "K-11", "K-13"}


@pytest.mark.parametrize(
    ("factor", "told"), [(1.45, ""), (1.55, "0.65 times"), (0.69, ""), (0.65, "1.5 times")]
)
def test_a_retest_is_not_1_5_times_stiffer_at_most_frequencies(tmp_path, factor, told):
    """The median of 9100, 8000 and 5000 MPa: one that is off may be what was mended."""
    first = EXPORT.format("A", DECEMBER_7, 10, 8000 * factor).replace("5000", "500")
    files = {"a": first.replace("9100", f"{9100 * factor}"), "b": dated("A", DECEMBER_8)}
    if told:
        refused(exports, tmp_path, **files, names=["b.csv and a.csv", told])
    else:
        assert columns(exports(tmp_path, **files), "E_MPa") == [[9100, 8000, 5000]]


@pytest.mark.parametrize(
    ("files", "moduli"),
    [
        ({"Mix-A-4C": dated("A", DECEMBER_7), "Mix-A-4C-Repeated_Sum": dated("A", DECEMBER_8, 7900)}, 7900),
        # a retest may mend one frequency
        ({"a": dated("A", DECEMBER_7, 2000), "b": dated("A", DECEMBER_8)}, 8000),
        # the date decides against a mark
        ({"a": dated("A", DECEMBER_8), "b": dated("A-4C-Repeated", DECEMBER_7, 7000)}, 8000),
    ],
)
def test_which_of_two_tests_is_taken(tmp_path, files, moduli):
    assert columns(exports(tmp_path, **files), "E_MPa") == [[9100, moduli, 5000]]


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
        ("2019-02-05", "2019-03-04", True),  # behind a year the month
        ("05.02.2019", "04.03.2019", True),  # between points the day first
        ("Dec 7, 2019", "2019-12-07 10:00", None),
        ("in May", "2019-12-07", None),
        ("2019-13-45", "2019-12-07", None),
        ("", "", None),
    ],
)
def test_which_date_is_later(first, second, after):
    assert later(first, second) is after
    assert later(second, first) is (None if after is None else not after)


def test_several_mixes_in_one_table_or_in_several(tmp_path):
    table = [["Mix", *HEADER], *(["M1", *row] for row in ROWS), *(["M2", *row] for row in ROWS)]
    refused(read, tmp_path, table, names=["t.csv", "'Mix'", "M1, M2", '--only-mix "M1"'])
    assert plain(read_campaign([tmp_path / "t.csv"], mix="M2")[0].table) == as_is(tmp_path / "..")
    refused(read_campaign, [tmp_path / "t.csv"], mix="M3", names=["'M3'", "M1, M2"])
    read(tmp_path, table[:9])
    read(tmp_path, [["Mix", *HEADER], *(["M2", row[0] + "2", *row[1:4], 21] for row in ROWS)], "u.csv")
    refused(read_campaign, [tmp_path], names=["M1 in t.csv, M2 in u.csv"])


def test_specimens_under_the_name_of_mixes_can_be_said(tmp_path):
    table = [["Mix", *HEADER[1:]], *ROWS]
    refused(read, tmp_path, table, names=["t.csv", '--column specimen="Mix"'])
    assert plain(read(tmp_path, table, specimen="Mix").table) == as_is(tmp_path)


@pytest.mark.parametrize(("column", "values"), [("order", (1, 2)), ("amplitude_m", (5e-5, 2e-5))])
def test_tests_that_differ_in_order_or_amplitude_alone_are_no_retests(tmp_path, column, values):
    parts = [
        [[*row[:3], row[3] * (1.0 + 0.01 * k), row[4], value] for row in ROWS]
        for k, value in enumerate(values)
    ]
    campaign = read(tmp_path, [[*HEADER, column], *parts[0], *parts[1]])
    assert len(campaign.table.columns["E_MPa"]) == 2 * len(ROWS)
    for k, rows in enumerate(parts):
        read(tmp_path, [[*HEADER, column], *rows], f"{k}.csv")
    together, _ = read_campaign([tmp_path / "0.csv", tmp_path / "1.csv"])
    assert len(together.table.columns["E_MPa"]) == 2 * len(ROWS)


def test_tests_in_another_order_are_of_one_specimen_that_nobody_named(tmp_path):
    parts = [
        [[*row[1:3], row[3] + order, row[4], order] for row in ROWS if row[0] == "A"] for order in (1, 2)
    ]
    table = read(tmp_path, [[*HEADER[1:], "order"], *parts[0], *parts[1]]).table
    assert set(table.columns["specimen"]) == {"1"} and len(table.columns["E_MPa"]) == len(ROWS)
