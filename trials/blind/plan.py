"""What the campaign tries: every case, listed before the first is drawn.

A case is a seed and what to hide. Cases that share a seed share mix and scatter; the first of them is
empty, and its diagnosis says what the limits of this design are, by which the others are scaled.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import pandas as pd

from .causes import CATALOGUE
from .design import factorial
from .laws import SHAPES
from .outside import OUTSIDE

SEED = 20261126  # of the campaign; another one draws other mixes, places and signs
RATIOS = (1.0, 2.0, 3.0, 5.0)
JUDGED = 3.0  # ratio at which the campaign is judged
AT_LIMIT = 5.3  # visible strength of an effect at its limit: threshold 3.7 and 1.6 for 95 %
SEEDS = {"single": 10, "outside": 8, "empty": 60}  # per cause, per effect, in all
RECORDS_EVERY = 10  # one case in ten as sampled records
MIXES = (13, 14, 15, 16)  # seeds of the mixes whose effects are hidden inside NSCD runs
INSIDE = ("channel_delay", "phase_offset", "moving_mass", "guide_friction", "loose_clamp", "temperature_bias")
CHUNK = 24  # cases a job runs

DESIGNS = {
    "paper": {},
    "two amplitudes": {"specimens": "ABC", "frequencies": (3.0, 10.0, 40.0), "amplitudes": (30e-6, 63e-6)},
    "shuffled order": {"order": "shuffled"},
    # Warm enough for the mix to come near its static modulus, against which a spring in parallel shows.
    "warm": {"temperatures": (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)},
}
NEEDS = {"strain_softening": "two amplitudes", "damage": "shuffled order", "guide_stiffness": "warm"}


@dataclass(frozen=True)
class Case:
    """suite: single, pair, outside, empty, limits or removal; hidden: causes; ratio: amplitude over limit.

    removed: cause the catalogue lacks; static_known: whether the diagnosis is told the static modulus.
    """

    seed: int
    suite: str
    hidden: tuple[str, ...] = ()
    ratio: float = np.nan
    design: str = "paper"
    form: str = "peaks"
    shape: str = ""
    removed: str = ""
    static_known: bool = False

    @property
    def needs_limits(self) -> bool:
        return self.suite in ("single", "pair", "removal")


def design_of(case: Case) -> pd.DataFrame:
    """The tests of a case."""
    return factorial(**DESIGNS[case.design])


def chunks(seed: int = SEED) -> list[list[Case]]:
    """All cases in groups of about CHUNK; a seed's cases stay together, the empty one first."""
    out: list[list[Case]] = [[]]
    for group in _groups(seed):
        if len(out[-1]) + len(group) > CHUNK:
            out.append([])
        out[-1] += group
    return out


def _groups(seed: int) -> Iterator[list[Case]]:
    for number, group in enumerate(_kinds()):
        own = int(np.random.SeedSequence([seed, number]).generate_state(1)[0])
        shape = list(SHAPES)[number % len(SHAPES)]
        form = "records" if number % RECORDS_EVERY == RECORDS_EVERY - 1 else "peaks"
        # Of a seed's cases the one that is judged comes as records; those of other ratios say no more.
        yield [
            replace(case, seed=own, shape=shape, form=form if case.ratio == JUDGED else "peaks")
            for case in group
        ]


def _kinds() -> Iterator[list[Case]]:
    for _ in range(SEEDS["single"]):
        for cause in CATALOGUE:
            yield _single(cause)
    ordinary = [cause for cause in CATALOGUE if cause not in NEEDS]
    for pair in combinations(ordinary, 2):
        yield [Case(0, "limits"), Case(0, "pair", pair, JUDGED)]
    for _ in range(SEEDS["outside"]):
        for effect in OUTSIDE:
            yield [Case(0, "outside", (effect,), ratio) for ratio in RATIOS]
    for _ in range(SEEDS["empty"]):
        yield [Case(0, "empty")]


def _single(cause: str) -> list[Case]:
    common = {"design": NEEDS.get(cause, "paper"), "static_known": cause == "guide_stiffness"}
    return [
        Case(0, "limits", **common),
        *(Case(0, "single", (cause,), ratio, **common) for ratio in RATIOS),
        Case(0, "removal", (cause,), JUDGED, removed=cause, **common),
    ]
