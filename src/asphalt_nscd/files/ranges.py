"""Ranges of numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Range:
    """Finite numbers between limits; `above` and `below` are excluded, `low` and `high` included.

    >>> str(Range(above=0.0, high=60.0)), Range(above=0.0).holds(float("inf"))
    ('greater than 0 and at most 60', False)
    """

    above: float = -math.inf
    low: float = -math.inf
    below: float = math.inf
    high: float = math.inf

    def holds(self, number: float) -> bool:
        """Whether a number is one of them; False for what is not finite."""
        return math.isfinite(number) and self.above < number < self.below and self.low <= number <= self.high

    @property
    def limits(self) -> dict[str, float]:
        """Those of its limits that are finite, by name."""
        return {name: limit for name, limit in vars(self).items() if math.isfinite(limit)}

    def __str__(self) -> str:
        words = {"above": "greater than", "low": "at least", "below": "less than", "high": "at most"}
        return " and ".join(f"{words[name]} {limit:g}" for name, limit in self.limits.items()) or "finite"
