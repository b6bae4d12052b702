"""Two tests of one condition, and two mixes in one folder: told apart rightly and said, or refused."""

from __future__ import annotations

import pytest
from table_import.slips import EXPORT, HEADER, ROWS, as_is, columns, exports, read, refusal, said

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.dates import later
from asphalt_nscd.table_import.names import one_of_another

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
