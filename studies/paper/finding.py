"""What is found of a statement of the paper, and the verdicts that a statement can have."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

REPRODUCED = "reproduced"  # particles were needed, they could have said otherwise, and did not
HOLDS = "holds"  # arithmetic or algebra of the paper that comes out right
DIFFERS = "differs"
INCONSISTENT = "inconsistent in itself"  # against the paper's own numbers or a law of mechanics
LEFT_OPEN = "left open"  # the text can be read in several ways, which give different results
UNCHECKED = "cannot be checked"
NOT_JUDGED = "not judged"  # a choice, a definition or an outlook; the reason stands beside it


@dataclass(frozen=True)
class Finding:
    """What we find of the statement `id` of statements.yaml.

    `ours` is a word, or a number in the unit that stands there; `verdict` says whether it agrees, or is one of the
    constants above; where it is None, statements.yaml has the verdict or the bounds of it. `values` go into its texts.
    """

    id: str
    ours: str | float
    verdict: bool | str | None = None
    values: Mapping[str, Any] = field(default_factory=dict)


def spanned(values: Sequence[float] | np.ndarray, form: str) -> str | None:
    """The range of values in words, each end by the format `form`; one number where both ends read alike."""
    if not len(values):
        return None
    low, high = f"{min(values):{form}}", f"{max(values):{form}}"
    return low if low == high else f"{low} to {high}"
