"""What to test next: the few sweeps that answer most of what a diagnosis leaves open, per hour of the machine.

Open questions are: does a named cause show without the tests that carry it, and on a metal specimen; which of two
causes that look alike; does a test that cannot be used repeat itself; is an isotherm that contradicts itself out of
the linear range; is a cause there that these tests could not show. The expected gain of each is evidence for the right
answer in nats (ln of the Bayes factor), no more than is needed. `next_tests.choice` takes the sweep of largest gain per
hour, then the next, given the first.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.criteria import CONFIDENCE, HIDES, SURVIVES, USUAL_THRESHOLD, Z_95
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.next_tests import fixed_orders
from asphalt_nscd.diagnosis.next_tests.choice import MOST, choose
from asphalt_nscd.diagnosis.next_tests.further_tests import Departure, Possible, possible
from asphalt_nscd.diagnosis.next_tests.information import Question
from asphalt_nscd.diagnosis.next_tests.sweeps import METAL, Costs
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.record import rungs
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.words.order_words import Context, Open, act, purpose, reasons
from asphalt_nscd.diagnosis.words.sentences import article, size_left, typed
from asphalt_nscd.diagnosis.written import cause_at, round_to_interval, shown, three_digits, widening
from asphalt_nscd.files.words import joined, specimen_named

FOUND = (USUAL_THRESHOLD + Z_95) ** 2  # strength of a cause that is found in 19 of 20 cases
KEPT = (SURVIVES + Z_95) ** 2
# With 2 ln of the Bayes factor scattering by 2 d about d^2: d^2 - 1.645 * 2 d = 6 at d^2 = 21.
TOLD_APART = 21.0  # expected 2 ln of the Bayes factor, of which 6 are reached in 19 of 20 cases
PRESENT = 0.1  # chance that a cause nobody has seen is there
REACH = 3.0  # typical amplitudes, each an effect of a per cent or so, that should be seen


def instructions(
    diagnosis: Diagnosis, costs: Costs | None = None, ahead: fixed_orders.Orders | None = None
) -> dict[str, Any]:
    """`instructions` of diagnosis.json: at most five orders, `ahead`, then doubtful tests, then by gain per hour."""
    costs = costs or Costs()
    model = possible(diagnosis, costs)
    questions = open_questions(diagnosis, model)
    done = diagnosis.whole or diagnosis.observed
    checks = fixed_orders.gauges(done, costs)
    first = [*(ahead or []), *checks]
    first += [] if diagnosis.replicated else fixed_orders.second_specimen(done, costs)
    last = fixed_orders.order_temperatures(done, costs) if diagnosis.replicated else []
    chosen = choose(model, [one.question for one in questions], [one.kind for one in questions])
    told = []
    for k, one in enumerate(chosen):
        why = reasons(one, questions, Context(bool(k or first), bool(checks), not done.quality))
        at = [] if one.sweep.specimen == METAL else [one.sweep.temperature]
        tests, words = (one.specimens, at, list(one.sweep.frequencies)), (purpose(one, questions), why)
        order = fixed_orders.content(act(one, done), words, one.hours, tests, one.sweep.half_strain)
        told += [order | {"nats": round(one.nats, 2)}] * bool(why)
    return {"costs": costs.sentence, "orders": [*[*first, *told][: MOST - len(last)], *last]}


def open_questions(diagnosis: Diagnosis, model: Possible) -> list[Open]:
    """What stays open: causes to confirm and to tell apart, departures to repeat, then causes out of reach."""
    active = tuple(range(len(diagnosis.ladder.fitted.active)))
    others = list(enumerate(model.candidates))[len(active) :]
    everything = np.ones(model.linear.nuisance.shape[0], bool)
    known = model.known.information
    found: list[Open] = []
    rivals = {rung.candidate.key: {one.key for one in rung.rivals} for rung in diagnosis.ladder.rungs}
    for k in active:
        found += _named_questions(diagnosis, model, k, active)
        named = model.candidates[k]
        for j, other in others:
            question = Question(k, _amplitude(named), (*active, j), TOLD_APART, everything)
            if question.strength(known) < TOLD_APART:
                words, as_good = (cause_at(*named.key), cause_at(*other.key)), other.key in rivals[named.key]
                found.append(Open("apart", question, *words, named, other, alike=as_good))
    for n, departure in enumerate(model.departures):
        question = Question(len(model.candidates) + n, 1.0, active, TOLD_APART, everything)
        found.append(
            Open(departure.kind, question, *_departure_words(diagnosis, departure), departure=departure)
        )
    places = Counter(candidate.cause.name for candidate in model.candidates)
    spread = diagnosis.ladder.estimates_spread  # by which an effect is harder to find
    shapeless = max(diagnosis.ladder.discrepancy.values(), default=0.0) > HIDES
    for j, other in others:
        if shapeless and len(other.values) > 1:
            continue  # a cause with a shape of its own gets no name beside a discrepancy
        # That a cause is there at all is shared by the places where it may be.
        chance = PRESENT / places[other.cause.name]
        question = Question(j, REACH / spread, active, FOUND, everything, chance)
        hidden = max(float(question.strength(known)) - _strength_by_limit(diagnosis, other), 0.0)
        about, size, short = _sized(other, REACH)
        found.append(Open("reach", question, about, size, other, hidden=hidden, short=short))
    return found


def _departure_words(diagnosis: Diagnosis, one: Departure) -> tuple[str, str]:
    """What a departure is, and what speaks of its size or of what new tests show if they are sound, in words."""
    if one.odd is not None:
        return levels.described(one.odd)[0], levels.if_sound(one.odd)
    if one.specimen is None:
        return f"{one.isotherm:g} degC", _unexplained(diagnosis, one.isotherm)
    return f"{specimen_named(one.specimen)} at {one.isotherm:g} degC, {one.frequency:g} Hz", ""


def _unexplained(diagnosis: Diagnosis, isotherm: float | None) -> str:
    """What the causes leave at an isotherm [degC], in words."""
    of_modulus, of_phase = diagnosis.noise.sigma
    scatter = {"modulus_percent": 100.0 * of_modulus, "phase_deg": float(np.degrees(of_phase))}
    sizes = diagnosis.ladder.noticed.items()
    return joined([size_left(one.part, size, scatter) for one, size in sizes if one.isotherm == isotherm])


def _strength_by_limit(diagnosis: Diagnosis, candidate: Candidate) -> float:
    """Strength of a typical effect in the tests done, by the detection limit; none where no effect shows."""
    ladder = diagnosis.ladder
    limit = ladder.limits.get(candidate.key, np.inf) * ladder.estimates_spread
    return float(((USUAL_THRESHOLD + Z_95) * REACH * candidate.typical[0] / limit) ** 2)


def _named_questions(diagnosis: Diagnosis, model: Possible, k: int, active: tuple[int, ...]) -> list[Open]:
    """Does a named cause show without what it hangs on, and on metal?"""
    candidate = model.candidates[k]
    words, amplitude = cause_at(*candidate.key), _amplitude(candidate)
    rows = model.linear.nuisance.shape[0]
    found = []
    hangs_on = diagnosis.ladder.hangs_on.get(candidate.key, [])
    for label, kept in _parts(model.table, rows):
        if label in hangs_on:
            question = Question(k, amplitude, active, KEPT, kept)
            found.append(Open("kept", question, words, label, candidate))
    metal = np.arange(rows) >= model.table.size
    if np.abs(model.linear.effects[metal, k]).max(initial=0.0) > 0.0:
        question = Question(k, amplitude, active, FOUND, metal)
        value, error = rungs.amplitude(diagnosis, candidate)
        share = widening(diagnosis.ladder.estimates_spread) * CONFIDENCE * error / abs(value)
        found.append(Open("metal", question, words, _metal_effect(model, k, amplitude, share), candidate))
    return found


def _parts(table: Observations, rows: int) -> Iterator[tuple[str, NDArray[np.bool_]]]:
    """What may be left out, as `hangs_on` names it, and the rows (N,) of the model that stay."""
    for values, words in (
        (table.isotherm, lambda t: f"{t:g} degC"),
        (table.frequency, lambda f: f"{f:g} Hz"),
        (np.array(table.names)[table.specimen], specimen_named),
    ):
        for value in np.unique(values):
            yield words(value), np.concatenate([values != value, np.ones(rows - table.size, bool)])


def _metal_effect(model: Possible, k: int, amplitude: float, share: float) -> str:
    """What a cause does on metal where it does most, to two digits, or those of its interval; share: this of that."""
    metal = np.arange(model.table.size, model.linear.nuisance.shape[0])
    effect = amplitude * model.linear.effects[metal, k]
    most = np.flatnonzero(np.abs(effect) > 0.99 * np.abs(effect).max())
    at = most[np.argmax(model.metal_frequencies[most])]
    value, unit = 100.0 * float(effect[at].real), "% of the modulus"
    if abs(effect[at].imag) > abs(effect[at].real):
        value, unit = float(np.degrees(effect[at].imag)), "deg of phase"
    half = max(share * abs(value), 10.0 ** np.floor(np.log10(abs(value))))
    size = f"{round_to_interval(value, half)} {unit}"
    every = most.size == effect.size > 1
    return f"{size} at {'every frequency' if every else f'{model.metal_frequencies[at]:g} Hz'}"


def _amplitude(candidate: Candidate) -> float:
    return candidate.values[0] / float(candidate.typical[0])


def _sized(candidate: Candidate, typical: float) -> tuple[str, str, str]:
    """A cause of so many typical sizes in words, that size, and the cause in few words where there are fewer."""
    cause, first = candidate.cause, candidate.cause.parameters[0]
    value, unit = shown(typical * first.typical, first.unit)
    size = f"{three_digits(value)} {typed(unit)}"
    if cause.plain is None:
        return f"{article(cause.name.replace('_', ' '))} of {size}", size, ""
    short, rest = cause.plain
    return f"{short} {rest.format(size)}", size, short
