"""Statements of the paper, and what we judge of each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.errors import InputError

REPRODUCED = "reproduced"  # particles were needed, they could have said otherwise, and did not
HOLDS = "holds"  # arithmetic or algebra of the paper that comes out right
DIFFERS = "differs"
INCONSISTENT = "inconsistent in itself"  # against the paper's own numbers or a law of mechanics
LEFT_OPEN = "left open"  # the text can be read in several ways, which give different results
UNCHECKED = "cannot be checked"
NOT_JUDGED = "not judged"  # a choice, a definition or an outlook; the reason stands beside it
NEEDS = ("text", "particles", "measurements")


@dataclass(frozen=True)
class Judgement:
    """What we find of one statement of statements.csv.

    `published` by the paper and `ours` found here are words, or numbers in `unit`; `verdict` is REPRODUCED, DIFFERS or
    another of these constants; `otherwise` says what would have changed the verdict.
    """

    id: str
    published: str | float
    ours: str | float
    unit: str
    verdict: str
    evidence: str
    otherwise: str


def compared(
    id: str,
    published: float,
    ours: float,
    unit: str,
    tolerance: float,
    evidence: str,
    agrees: str = REPRODUCED,
) -> Judgement:
    """Judge a published number by ours: verdict `agrees` within the relative `tolerance`, else they differ."""
    close = abs(ours - published) <= tolerance * abs(published)
    otherwise = f"A number {'beyond' if close else 'within'} {100.0 * tolerance:g} % of the paper's."
    return Judgement(id, published, ours, unit, agrees if close else DIFFERS, evidence, otherwise)


def spanned(values: Sequence[float] | NDArray[np.float64], form: str) -> str:
    """The range of values in words, each end by the format `form`; one number where both ends read alike."""
    low, high = f"{min(values):{form}}", f"{max(values):{form}}"
    return low if low == high else f"{low} to {high}"


def judged(holds: bool, agrees: str = REPRODUCED) -> str:
    """Verdict on a statement that either holds (then `agrees`) or does not."""
    return agrees if holds else DIFFERS


def told(statements: str | Path, judgements: Iterable[Judgement]) -> pd.DataFrame:
    """All statements in the order of the paper, each with its judgement or the reason why there is none.

    `statements` is a CSV with id, where, statement, needs (one of NEEDS), not_judged (a reason, or nothing). Raises
    InputError for a judgement without a statement, or the other way round.
    """
    listed = pd.read_csv(statements, keep_default_na=False)
    made = list(judgements)
    found, names = {one.id: one for one in made}, set(listed["id"])
    often = Counter(one.id for one in made)
    # The list and the judgements are kept by hand in two places, and drift apart.
    wrong = {
        "stands twice": listed["id"][listed["id"].duplicated()],
        "is judged twice": [name for name, times in often.items() if times > 1],
        "is judged but not listed": found.keys() - names,
        "has neither a judgement nor a reason": set(listed.loc[listed["not_judged"] == "", "id"])
        - found.keys(),
        "has both a judgement and a reason": set(listed.loc[listed["not_judged"] != "", "id"]) & found.keys(),
        f"needs none of {', '.join(NEEDS)}": listed.loc[~listed["needs"].isin(NEEDS), "id"],
    }
    for what, ids in wrong.items():
        for name in sorted(ids):
            raise InputError(f"{statements}: the statement {name} {what}; mend the list or the audit.")
    empty = Judgement("", "", "", "", NOT_JUDGED, "", "")
    rows = []
    for row in listed.itertuples(index=False):
        one = asdict(found.get(row.id, empty)) | {"id": row.id}
        one["evidence"] = one["evidence"] or row.not_judged
        rows.append({"where": row.where, "statement": row.statement} | one | {"needs": row.needs})
    order = [
        "id",
        "where",
        "statement",
        "published",
        "ours",
        "unit",
        "verdict",
        "needs",
        "evidence",
        "otherwise",
    ]
    return pd.DataFrame(rows)[order].map(_rounded)


def _rounded(value: object) -> object:
    # Six digits, which another processor gives too.
    return float(f"{value:.6g}") if isinstance(value, float) else value
