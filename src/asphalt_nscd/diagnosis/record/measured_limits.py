"""Stated limits held against what is found: every cause put into the user's own table, and the table diagnosed again.

A cause is put in at one, two and three times its stated limit, with either sign where it has two, at every place where
it may sit. The table keeps its own scatter, its own discrepancy and its own causes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import ndtr

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import Place
from asphalt_nscd.diagnosis.criteria import CONFIDENCE, USUAL_THRESHOLD, Z_95
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.record import report, rungs
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose
from asphalt_nscd.diagnosis.search.ladder import Rung
from asphalt_nscd.diagnosis.written import name_at
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.cores import cores

TIMES = (1.0, 2.0, 3.0)
DRAWS = 1000  # of the chance level in each of many diagnoses
Progress = Callable[[str, float, float], None]


@dataclass(frozen=True)
class Hidden:
    """A cause to be put in. own: its amplitude that the table has already; times: multiple of the stated limit."""

    candidate: Candidate
    own: float
    times: float


@dataclass(frozen=True)
class Trials:
    """How the diagnoses are run: with which stated scatter, seed and number of processes (None: one a core)."""

    scatter: tuple[float, float] | None = None
    seed: int = 0
    processes: int | None = None


def verify(diagnosis: Diagnosis, trials: Trials, progress: Progress = lambda *_: None) -> pd.DataFrame:
    """Hold the stated limits against what is found, by cause, place, sign and multiple; equal on one core or many."""
    work = [(diagnosis, one, trials) for one in plan(diagnosis)]
    rows = []
    with ProcessPoolExecutor(min(trials.processes or cores(), max(len(work), 1))) as pool:
        # In the order of the plan, whichever is ready first.
        for row in pool.map(_tried, work):
            rows.append(row)
            progress("Verify limits", len(rows), len(work))
    return pd.DataFrame(rows)


def plan(diagnosis: Diagnosis) -> Iterator[Hidden]:
    """What to put in within the bounds of each cause, wherever it has a limit; on top of its own if it was named."""
    observed, active = diagnosis.observed, {c.key: c.values for c in diagnosis.ladder.fitted.active}
    limits = report.physical_limits(diagnosis)
    for cause in CATALOGUE:
        shapes = cause.shapes(observed)
        for place in cause.places(observed):
            limit = limits.get((cause.name, place))
            if limit is None:
                continue
            own, *shape = active.get((cause.name, place), (0.0, *shapes[len(shapes) // 2]))
            first = cause.parameters[0]
            for times in TIMES:
                for sign in (1.0,) if cause.one_sided else (1.0, -1.0):
                    amplitude = own + sign * times * limit
                    if first.low <= amplitude <= first.high:
                        yield Hidden(Candidate(cause, place, (amplitude, *shape)), own, sign * times)


def put_in(diagnosis: Diagnosis, hidden: Hidden) -> Observations:
    """The whole table, tests left out too, each modulus times what the cause does to that of the law."""
    whole, ladder = diagnosis.whole or diagnosis.observed, diagnosis.ladder
    # `apparent` asks for no scatter, which is that of the tests used and not of the whole table.
    joint = Joint(whole, ladder.joint.base, ladder.joint.noise)
    fitted = ladder.fitted
    rest = tuple(c for c in fitted.active if c.key != hidden.candidate.key)
    before = joint.apparent(fitted.law, fitted.active, fitted.scales)[0]
    after = joint.apparent(fitted.law, (*rest, hidden.candidate), fitted.scales)[0]
    return replace(whole, modulus=whole.modulus * after / before)


def _tried(work: tuple[Diagnosis, Hidden, Trials]) -> dict[str, Any]:
    """One row: what was put in, and what the diagnosis made of it."""
    diagnosis, hidden, trials = work
    candidate = hidden.candidate
    named: dict[tuple[str, Place], Rung] = {}
    established, value, error = False, np.nan, np.nan
    with suppress(InputError):  # a table that is refused names nothing
        found = diagnose(put_in(diagnosis, hidden), trials.scatter, draws=DRAWS, seed=trials.seed)
        named = {rung.candidate.key: rung for rung in found.ladder.rungs}
        if candidate.key in named:
            established = found.established(named[candidate.key])
            value, error = rungs.amplitude(found, candidate)
    known = {candidate.key, *(rung.candidate.key for rung in diagnosis.ladder.rungs)}
    return {
        "cause": candidate.cause.name,
        "where": "" if candidate.place is None else candidate.place,
        "times_limit": hidden.times,
        "put_in": candidate.values[0] - hidden.own,
        "unit": candidate.cause.parameters[0].unit,
        "named": int(candidate.key in named),
        "established": int(established),
        "change_found": value - hidden.own,
        "std_error": error,
        "within_interval": int(abs(value - candidate.values[0]) <= CONFIDENCE * error),
        "named_instead": "; ".join(name_at(*key) for key in named if key not in known),
    }


def summarised(table: pd.DataFrame) -> dict[str, Any]:
    """Content of `measured_limits`: how often each cause was named, and how often it should have been."""
    counts = table.assign(tried=1, other_named=(table["named_instead"] != "").astype(int))
    counts = counts[["tried", "named", "within_interval", "other_named"]]
    out: dict[str, Any] = {}
    for (cause, multiple), row in (
        counts.groupby([table["cause"], table["times_limit"].abs()]).sum().iterrows()
    ):
        out.setdefault(cause, {})[f"{multiple:g}"] = row.to_dict() | {"stated_power": stated_power(multiple)}
    return out


def stated_power(multiple: float) -> float:
    """Phi(multiple (c + 1.645) - c), the chance to find a cause at a multiple of its limit; c: usual threshold."""
    return float(ndtr(multiple * (USUAL_THRESHOLD + Z_95) - USUAL_THRESHOLD))
