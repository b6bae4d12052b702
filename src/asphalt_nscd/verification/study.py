"""The verification study from themes to one table with a verdict."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.verification.row import FAILED, PASSED, Row

THEMES = (
    "spheres",
    "edges",
    "contacts",
    "coupled",
    "law",
    "beams",
    "facets",
    "films",
    "methods",
    "accounts",
    "fracture",
    "determinism",
)
MUTATIONS = "mutations"  # a theme too, but one that takes many times as long
COLUMNS = ["theme", "name", "expected", "found", "error", "tolerance", "verdict", "source"]


def verify(theme: str) -> pd.DataFrame:
    """All rows of one theme."""
    themes = (*THEMES, MUTATIONS)
    if theme not in themes:
        raise InputError(f"{theme!r} is not a theme of the verification; give one of {', '.join(themes)}.")
    return table(theme, import_module(f"asphalt_nscd.verification.{theme}").checks.rows())


def table(theme: str, rows: Iterable[Row]) -> pd.DataFrame:
    """Rows as a table of COLUMNS."""
    return pd.DataFrame(
        [
            (theme, row.name, row.expected, row.found, row.error, row.tolerance, row.verdict, row.source)
            for row in rows
        ],
        columns=COLUMNS,
    )


def joined(paths: Iterable[str | Path]) -> pd.DataFrame:
    """Tables of several themes as one."""
    return pd.concat([pd.read_csv(path) for path in paths], ignore_index=True)


def summarised(rows: pd.DataFrame) -> pd.DataFrame:
    """For each theme: rows, how many passed, and the largest error over its tolerance where that is not zero."""
    share = (rows["error"] / rows["tolerance"]).where(rows["tolerance"] > 0.0)
    counted = rows.assign(share=share, passed=rows["verdict"] == PASSED)
    groups = counted.groupby("theme", sort=False)
    return groups.agg(
        rows=("passed", "size"), passed=("passed", "sum"), largest_error_over_tolerance=("share", "max")
    ).reset_index()


def require_passed(paths: Iterable[str | Path]) -> None:
    """InputError that names every row that has failed."""
    rows = joined(paths)
    red = rows[rows["verdict"] == FAILED]
    if len(red):
        names = "; ".join(f"{row.theme}: {row.name}" for row in red.itertuples())
        raise InputError(f"{len(red)} of {len(rows)} rows of the verification failed: {names}.")
