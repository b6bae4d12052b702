"""Tables of people: where each value stood, and in one sentence what is wrong and how to mend it."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.csvinput import Limits, Table, plain_number, read_csv
from asphalt_nscd.files.errors import InputError


@pytest.fixture
def table(tmp_path):
    def make(text):
        (tmp_path / "t.csv").write_bytes(text.encode("utf-8-sig"))
        return read_csv(tmp_path / "t.csv")

    return make


def test_values_come_with_the_lines_they_stood_in(table):
    """Below a mark of Excel's, comments and blank lines; a quoted field may hold commas."""
    read = table('# a remark\nname, E_MPa\n\n"a, b",1e3\n# another\n c ,-2.5\n,\n d,\n')
    assert read.columns == {"name": ["a, b", "c", "d"], "E_MPa": ["1e3", "-2.5", ""]}
    assert read.lines == [4, 6, 8] and read.place(1) == f"{read.path}, line 6"
    np.testing.assert_array_equal(read.numbers_or_nan("E_MPa"), [1000.0, -2.5, np.nan])
    np.testing.assert_array_equal(read.numbers_or_nan("phase_deg"), 3 * [np.nan])
    own = Table(read.path, {"x": np.array([1.0, np.nan])}, [7, 8], [read.path.with_name("u.csv")] * 2)
    assert own.numbers_or_nan("x") is own.columns["x"]
    with pytest.raises(InputError, match=r"u\.csv, line 8: x is empty"):
        own.numbers("x")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the file is empty; give a header line"),
        ("a,b\n", "has a header but no rows; add at least one"),
        ("a;b\n1;2\n", "columns are not separated by commas"),
        ("a\tb\n1\t2\n", "columns are not separated by commas"),
        ("a,a\n1,2\n", "appears twice in the header"),
        ("a,\n1,2\n", "a column name is empty"),
        ("a,b\n1,2\n1,2,3\n", "line 3: 3 fields under 2 column names"),
        ('a,b\n1,"2\n', "cannot be read as CSV text"),
    ],
)
def test_what_is_no_table_is_refused(table, text, said):
    with pytest.raises(InputError, match=said):
        table(text)
    assert table("a\n1\n").numbers("a").tolist() == [1.0]  # of one column, and one row


@pytest.mark.parametrize(
    ("cell", "said"),
    [
        ("", "x is empty; write a number"),
        ("1,5", "x = '1,5' is not a number"),
        ("17_715", "x = '17_715' is not a number"),
        ("\N{ARABIC-INDIC DIGIT FOUR}", "is not a number"),
        ("inf", "x = inf is not finite"),
        ("nan", "x = nan is not finite"),
        ("0.999", r"x = 0.999 is outside 1 to 2; give it in m\."),
        ("2.001", "x = 2.001 is outside 1 to 2"),
    ],
)
def test_a_number_is_finite_plain_and_within_its_limits(table, cell, said):
    limits = Limits(1.0, 2.0, "give it in m")
    assert table("x,y\n1,a\n2,b\n").numbers("x", limits).tolist() == [1.0, 2.0]
    with pytest.raises(InputError, match=rf"t\.csv, line 3: .*{said}"):
        table(f'x,y\n1,a\n"{cell}",b\n').numbers("x", limits)
    assert plain_number("-inf") == -np.inf


@pytest.mark.parametrize(
    ("cell", "said"), [("", "name is empty"), ("=1", "would be a formula"), ("@a", "formula")]
)
def test_a_text_is_there_and_no_formula(table, cell, said):
    with pytest.raises(InputError, match=rf"line 3: name .*{said}|line 3: {said}"):
        table(f"name,x\nA-1,1\n{cell},2\n").text("name")
    assert table("name,x\nA-1,1\n").text("name") == ["A-1"]


@pytest.mark.parametrize(
    ("given", "wanted", "advice"),
    [
        ("E_GPa", "E_MPa", "multiply by 1000"),
        ("E_kPa", "E_MPa", "divide by 1000"),
        ("|E*| [Pa]", "E_MPa", "divide by 1e6"),
        ("phase (rad)", "phase_deg", "multiply by 180/pi"),
        ("h_mm", "h_m", "divide by 1000"),
        ("z0 (um)", "z0_m", "divide by 1e6"),
        ("h_m", "h_mm", "multiply by 1000"),
        ("h_cm", "h_mm", "multiply by 10"),
        ("F0_kN", "F0_N", "multiply by 1000"),
        ("mass_g", "mass_kg", "divide by 1000"),
        ("Temperature_K", "temperature_C", "subtract 273.15"),
        ("t_ms", "t_s", "divide by 1000"),
        ("frequency (rad/s)", "frequency_Hz", "divide by 2 pi"),
        ("phase", "phase_deg", "give it in deg"),
    ],
)
def test_another_unit_is_told_how_to_become_the_one_wanted(table, given, wanted, advice):
    with pytest.raises(InputError) as told:
        table(f"{given},x\n1,2\n").require(["x", wanted])
    assert str(told.value).endswith(f"column {given!r} must be {wanted!r}; {advice} and rename it.")


def test_a_column_that_is_missing_is_not_taken_for_a_symbol_of_another_case_or_for_a_wanted_one(table):
    """e is a thickness and E a modulus; E_MPa is wanted itself."""
    read = table("e_mm,E_MPa\n1,2\n")
    assert read.lookalike("E_GPa") == "E_MPa" and read.lookalike("E_GPa", ["E_MPa"]) is None
    with pytest.raises(InputError, match=r"column 'E_kPa' is missing \(found: e_mm, E_MPa\)"):
        read.require(["E_MPa", "E_kPa"])
