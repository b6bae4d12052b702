"""Which sweeps to order next: by gain per hour, doubtful tests before all else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np

from asphalt_nscd.diagnosis.next_tests.further_tests import Possible
from asphalt_nscd.diagnosis.next_tests.information import Inquiry, Question
from asphalt_nscd.diagnosis.next_tests.sweeps import METAL, Sweep

MOST = 5  # orders
ALIKE = 1e-6  # relative difference of gains that is rounding
LEAST = 0.3  # nats, below which a sweep tells nothing


@dataclass
class Order:
    """One order to the laboratory: hours, gain [nats], and the strength before and after of each question helped."""

    sweep: Sweep
    specimens: list[str]
    hours: float
    nats: float
    helps: dict[int, tuple[float, float]]


def choose(model: Possible, questions: Sequence[Question], kinds: Sequence[str]) -> list[Order]:
    """Sweeps by gain per hour, each given those before it; the same sweep on several specimens is one order.

    `kinds` are those of the questions, as in `words.order_words.Open`.
    """
    inquiry = Inquiry(model.linear, model.old, list(questions), model.known)
    orders: list[Order] = []
    waiting = list(model.sweeps)
    doubtful = [k for k, kind in enumerate(kinds) if kind in ("repeat", "level")]
    while questions and waiting:
        gains = inquiry.gains([sweep.tested for sweep in waiting])
        totals = gains.sum(axis=1)
        per_hour = np.where(totals > LEAST, totals / [sweep.hours for sweep in waiting], 0.0)
        # What makes tests doubtful comes first: all else rests on them.
        of_doubtful = gains[:, doubtful].sum(axis=1) > LEAST
        score = np.where(of_doubtful.any() & ~of_doubtful, 0.0, per_hour)
        # Specimens of the same tests tell the same to rounding, which differs between processors: the first is taken.
        best = int(np.argmax(score >= (1.0 - ALIKE) * score.max()))
        sweep, gain, nats = waiting.pop(best), gains[best], float(totals[best])
        alike = next((order for order in orders if _same(order.sweep, sweep)), None)
        if per_hour[best] == 0.0 or (alike is None and len(orders) == MOST):
            break
        before = inquiry.strengths()
        inquiry.take(sweep.tested)
        after = inquiry.strengths()
        # Nats from which an order is said to help: a tenth of its gain; of metal, whose gain is small, less.
        least = [0.05 if kind == "metal" else max(0.1 * nats, 0.05) for kind in kinds]
        helped = [int(k) for k in np.argsort(-gain) if gain[k] >= least[k]]
        if alike is None:
            alike = Order(sweep, [], 0.0, 0.0, {})
            orders.append(alike)
        tested = (*alike.specimens, sweep.specimen)
        alike.specimens = [name for name in model.table.names if name in tested] or [METAL]
        waiting = [other for other in waiting if not _again(other, sweep)]
        alike.hours, alike.nats = alike.hours + sweep.hours, alike.nats + nats
        for k in helped:
            alike.helps[k] = alike.helps.get(k, (before[k], 0.0))[0], after[k]
    return orders


def _same(one: Sweep, other: Sweep) -> bool:
    conditions = attrgetter("temperature", "frequencies", "half_strain")
    return conditions(one) == conditions(other) and METAL not in (one.specimen, other.specimen)


def _again(one: Sweep, other: Sweep) -> bool:
    """Whether a sweep repeats tests of another; once metal is mounted, one sweep is all that it has to say."""
    if METAL in (one.specimen, other.specimen):
        return one.specimen == other.specimen
    conditions = attrgetter("specimen", "temperature", "half_strain")
    return conditions(one) == conditions(other) and not {*one.frequencies}.isdisjoint(other.frequencies)
