"""The verification study: its cheap themes pass, and a red row cannot be overlooked."""

from __future__ import annotations

import math

import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_table
from asphalt_nscd.verification.mutations import MUTANTS, mutate
from asphalt_nscd.verification.row import FAILED, PASSED, Checks, Row, order
from asphalt_nscd.verification.study import COLUMNS, THEMES, joined, require_passed, summarised, table, verify
from asphalt_nscd.workflow_support.sources import PACKAGE

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("theme", ["law", "facets", "films", "accounts", "methods"])
def test_cheap_themes_pass(theme):
    rows = verify(theme)
    assert list(rows.columns) == COLUMNS and len(rows) >= 9
    assert rows.loc[rows["verdict"] != PASSED, "name"].tolist() == []


def test_rows_are_judged():
    assert Row("a", 2.0, 2.002, 1.1e-3, "").verdict == PASSED
    assert Row("a", 2.0, 2.002, 0.9e-3, "").verdict == FAILED
    assert Row("a", 0.0, 1e-3, 1e-2, "").error == 1e-3
    assert Row("a", 1.0, math.nan, 1.0, "").verdict == FAILED
    assert Row("a", -2.0, 2.0, 1.0, "").verdict == FAILED
    assert order([8.0, 4.0, 1.0]) == 2.0


def test_a_check_that_raises_is_a_failed_row():
    checks = Checks()

    @checks
    def broken_core():
        raise ZeroDivisionError("no mass")

    checks(lambda: [Row("b", 1.0, 1.0, 0.0, ""), Row("c", 1.0, 1.0, 0.0, "")])
    rows = checks.rows()
    assert [row.verdict for row in rows] == [FAILED, PASSED, PASSED]
    assert rows[0].name == "broken core" and rows[0].source == "ZeroDivisionError: no mass"


def test_a_failed_row_is_named(tmp_path):
    for theme, found in (("one", 1.0), ("two", 3.0)):
        write_table(tmp_path / f"{theme}.csv", table(theme, [Row("x", 1.0, found, 0.1, "")]))
    require_passed([tmp_path / "one.csv"])
    both = [tmp_path / "one.csv", tmp_path / "two.csv"]
    assert isinstance(joined(both), pd.DataFrame) and len(joined(both)) == 2
    with pytest.raises(InputError, match="1 of 2 rows of the verification failed: two: x"):
        require_passed(both)


def test_unknown_theme():
    with pytest.raises(InputError, match="'weather' is not a theme"):
        verify("weather")


def test_mutants_still_fit_the_sources():
    assert len(MUTANTS) >= 10
    for what, theme, file, right, wrong in MUTANTS:
        assert theme in THEMES and right != wrong
        assert right in (PACKAGE / file).read_text(encoding="utf-8"), what


def test_a_mutant_is_noticed():
    assert mutate(*MUTANTS[0]).verdict == PASSED


def test_a_mutant_that_changes_nothing_is_not():
    what, theme, file, right, _ = MUTANTS[0]
    assert mutate(what, theme, file, right, right + "0.0 +").verdict == FAILED


def test_summary():
    rows = [Row("x", 1.0, 1.05, 0.1, ""), Row("y", 1.0, 3.0, 0.5, ""), Row("z", 0.0, 0.0, 0.0, "")]
    found = summarised(pd.concat([table("one", rows), table("two", rows[2:])]))
    assert found["theme"].tolist() == ["one", "two"]
    assert found["rows"].tolist() == [3, 1] and found["passed"].tolist() == [2, 1]
    assert found["largest_error_over_tolerance"].tolist()[0] == 4.0
