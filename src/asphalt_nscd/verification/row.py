"""Rows of the verification table and how they are judged."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

PASSED, FAILED = "passed", "failed"


@dataclass(frozen=True)
class Row:
    """What was expected from theory, what was found, and how far apart they may be."""

    name: str
    expected: float
    found: float
    tolerance: float  # of |found - expected| over `scale`
    source: str  # equation or reference
    scale: float = math.nan  # |expected|, or one where nothing is expected

    @property
    def error(self) -> float:
        """|found - expected|, relative where something is expected."""
        scale = self.scale if math.isfinite(self.scale) else abs(self.expected) or 1.0
        return abs(self.found - self.expected) / scale

    @property
    def verdict(self) -> str:
        """PASSED or FAILED; what is not a number has failed."""
        return PASSED if self.error <= self.tolerance else FAILED


Check = Callable[[], Row | list[Row]]


class Checks(list[Check]):
    """The checks of one theme; used as a decorator it adds one."""

    def __call__(self, check: Check) -> Check:
        """Add this check."""
        self.append(check)
        return check

    def rows(self) -> list[Row]:
        """All rows. A check that raises gives a row that has failed and says why."""
        rows: list[Row] = []
        for check in self:
            try:
                found = check()
            except Exception as error:  # a broken core may break in any way, and the others count still
                name = getattr(check, "__name__", str(check)).replace("_", " ")
                found = Row(name, math.nan, math.nan, 0.0, f"{type(error).__name__}: {error}")
            rows.extend([found] if isinstance(found, Row) else found)
        return rows


def order(errors: ArrayLike) -> float:
    """Order of convergence from the last two errors, of steps halved each time."""
    coarse, fine = np.asarray(errors, float)[-2:]
    return math.log2(abs(coarse / fine))
