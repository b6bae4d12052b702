"""Every statement of sections 2 to 5 has a judgement or a reason, in the list and in what was published."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest
import yaml
from judgements import STATEMENTS

from asphalt_nscd.files.errors import InputError
from studies.paper.audit import judged, told
from studies.paper.finding import DIFFERS, HOLDS, LEFT_OPEN, NOT_JUDGED, REPRODUCED, UNCHECKED, Finding

ROOT = Path(__file__).parents[3]
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
ROW = {"id": "strain", "where": "2.1", "statement": "It is small.", "needs": "text", "below": 5.0}


@pytest.fixture
def listed(tmp_path):
    path = tmp_path / "statements.yaml"
    choice = {"id": "choice", "where": "2.1", "statement": "So.", "needs": "text", "not_judged": "A choice."}
    path.write_text(yaml.safe_dump([ROW, choice]))
    return path


def test_a_statement_has_its_judgement_or_its_reason(listed):
    table = told(listed, [Finding("strain", 4.0)])
    assert list(table["verdict"]) == [HOLDS, NOT_JUDGED]
    assert list(table["evidence"]) == ["", "A choice."]


@pytest.mark.parametrize("ids", [[], ["choice", "strain"], ["strain", "other"]])
def test_a_gap_between_list_and_audit_is_refused(listed, ids):
    with pytest.raises(InputError, match="mend the list or the audit"):
        told(listed, [Finding(id, 1.0) for id in ids])


def test_a_verdict_is_that_of_the_finding_or_of_its_bounds():
    given = [None, True, False, UNCHECKED]
    verdicts = [judged(ROW, Finding("strain", 6.0, verdict))["verdict"] for verdict in given]
    assert verdicts == [DIFFERS, HOLDS, DIFFERS, UNCHECKED]
    above = ROW | {"needs": "particles", "above": 1.0}
    assert [judged(above, Finding("strain", ours))["verdict"] for ours in (0.5, 2.0)] == [DIFFERS, REPRODUCED]
    assert judged(ROW | {"verdict": LEFT_OPEN}, Finding("strain", 6.0))["verdict"] == LEFT_OPEN


def test_a_text_has_the_sentences_whose_values_are_known_and_those_of_its_verdict():
    row = ROW | {
        "evidence": ["At {where:g} mm.", "Of {rest}."],
        "otherwise": {"holds": "More.", "else": "Less."},
    }

    def texts(ours, rest):
        told = judged(row, Finding("strain", ours, values={"where": 48.0, "rest": rest}))
        return told["evidence"], told["otherwise"]

    assert texts(4.0, "all") == ("At 48 mm. Of all.", "More.") and texts(6.0, None) == ("At 48 mm.", "Less.")
    with pytest.raises(KeyError, match="rest"):
        judged(row, Finding("strain", 4.0, values={"where": 48.0}))


def test_the_list_covers_all_sections_equations_figures_and_tables():
    table = pd.DataFrame(yaml.safe_load(STATEMENTS.read_text(encoding="utf-8")))
    assert table["id"].is_unique and set(table["needs"]) == {"text", "particles", "measurements"}
    where = "; ".join(table["where"])
    assert set(SECTIONS) <= set(where.replace("; ", ", ").split(", "))
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
    table = pd.DataFrame(yaml.safe_load(STATEMENTS.read_text(encoding="utf-8")))
    columns = ["id", "where", "statement", "needs"]
    assert published[columns].to_dict("records") == table[columns].to_dict("records")
    reasons = table["not_judged"].notna()
    assert (published["verdict"] == NOT_JUDGED).equals(reasons)
    assert (published.loc[~reasons, ["evidence", "otherwise"]] != "").all(axis=None)
    # only what particles could have refuted counts as reproduced
    assert set(published.loc[published["verdict"] == REPRODUCED, "needs"]) == {"particles"}
    assert set(published.loc[published["verdict"] == HOLDS, "needs"]) == {"text"}
