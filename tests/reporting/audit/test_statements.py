"""Every statement of sections 2 to 5 has a judgement or a reason, in the list and in what was published."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.reporting.audit.statement import HOLDS, NOT_JUDGED, REPRODUCED, Judgement, told

ROOT = Path(__file__).parents[3]
LIST = ROOT / "data/paper/statements.csv"
SECTIONS = [
    "2.1",
    "2.2",
    "3.1",
    "3.1.1",
    "3.1.2",
    "3.2.1",
    "3.2.2",
    "4.1",
    "4.2",
    "5",
]  # with text of their own


def judgement(id):
    return Judgement(id, 1.0, 1.0, "", HOLDS, "evidence", "another number")


@pytest.fixture
def listed(tmp_path):
    path = tmp_path / "statements.csv"
    path.write_text(
        'id,where,statement,needs,not_judged\nstrain,2.1,It is small.,text,\nchoice,2.1,So.,text,"A choice."\n'
    )
    return path


def test_a_statement_has_its_judgement_or_its_reason(listed):
    table = told(listed, [judgement("strain")])
    assert list(table["verdict"]) == [HOLDS, NOT_JUDGED]
    assert list(table["evidence"]) == ["evidence", "A choice."]


@pytest.mark.parametrize(
    ("ids", "message"),
    [
        ([], "strain has neither a judgement nor a reason"),
        (["strain", "strain"], "strain is judged twice"),
        (["strain", "choice"], "choice has both"),
        (["strain", "other"], "other is judged but not listed"),
    ],
)
def test_a_gap_between_list_and_audit_is_refused(listed, ids, message):
    with pytest.raises(InputError, match=message):
        told(listed, map(judgement, ids))


def test_the_list_covers_all_sections_equations_figures_and_tables():
    table = pd.read_csv(LIST, keep_default_na=False)
    sections = set(", ".join(table["where"]).split(", "))
    assert set(SECTIONS) <= sections
    where = "; ".join(table["where"])
    assert numbers(r"\((\d+)\)(?:-\((\d+)\))?", where) == set(range(1, 34))
    assert numbers(r"Figs?\. (\d+)(?:-(\d+))?", where) == set(range(1, 15))
    assert numbers(r"Table (\d)()", where) == set(range(1, 5))


def numbers(pattern, text):
    """Of all matches, ranges of two numbers filled."""
    return {
        number
        for first, last in re.findall(pattern, text)
        for number in range(int(first), int(last or first) + 1)
    }


def test_what_was_published_judges_the_list_of_today():
    published = pd.read_csv(ROOT / "results/published/paper/audit.csv", keep_default_na=False)
    table = pd.read_csv(LIST, keep_default_na=False)
    columns = ["id", "where", "statement", "needs"]
    assert published[columns].to_dict("records") == table[columns].to_dict("records")
    reasons = table["not_judged"] != ""
    assert (published["verdict"] == NOT_JUDGED).equals(reasons)
    assert (published.loc[~reasons, ["evidence", "otherwise"]] != "").all(axis=None)
    # only what particles could have refuted counts as reproduced
    assert set(published.loc[published["verdict"] == REPRODUCED, "needs"]) == {"particles"}
    assert set(published.loc[published["verdict"] == HOLDS, "needs"]) == {"text"}
