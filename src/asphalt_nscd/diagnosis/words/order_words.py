"""What an order to the laboratory says: the tests, their hours, and what they would do for open questions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from asphalt_nscd.diagnosis.causes._cause import Place
from asphalt_nscd.diagnosis.causes.temperature_bias import TemperatureBias
from asphalt_nscd.diagnosis.criteria import USUAL_THRESHOLD
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.next_tests.fixed_orders import named
from asphalt_nscd.diagnosis.next_tests.further_tests import Departure
from asphalt_nscd.diagnosis.next_tests.information import Question
from asphalt_nscd.diagnosis.next_tests.sweeps import METAL, Sweep
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.words.sentences import article, capital
from asphalt_nscd.files.words import joined

REASONS = 3
COPY = "One of two equal sweeps is a copy of the other: use the new tests in place of the old."
NOTICEABLE = 15.0  # percent of cases
CLEARER = 0.3  # standard errors
CLEAR = 2.0 * float(np.log(1000.0))  # strength from which two causes are told apart: 1000 to 1


@dataclass(frozen=True)
class Open:
    """An open question, and how a reader is told what the tests would do for it.

    `kind`: kept, metal, apart, repeat, level, linear or reach; `about` and `other`: what it is about and held against,
    in words; `short`: fewer words for `about`. `alike`: `candidate` and `rival` fitted the tests equally well.
    `hidden`: strength that the tests done have less than the linear model says, because the law follows a large effect
    further than a small one.
    """

    kind: str
    question: Question
    about: str
    other: str = ""
    candidate: Candidate | None = None
    rival: Candidate | None = None
    departure: Departure | None = None
    alike: bool = False
    hidden: float = 0.0
    short: str = ""

    def covers(self, order: Order) -> bool:
        """Whether an order tests the departure that a question is about: its specimen, isotherm and frequency."""
        one, sweep = self.departure, order.sweep
        return (
            one is not None
            and (one.specimen is None or one.specimen in order.specimens)
            and (one.isotherm is None or one.isotherm == sweep.temperature)
            and (one.frequency is None or one.frequency in sweep.frequencies)
        )

    @property
    def place(self) -> Place:
        """Where the cause sits that it is about."""
        return None if self.candidate is None else self.candidate.place


@dataclass
class Order:
    """One order to the laboratory: hours, gain [nats], and the strength before and after of each question helped."""

    sweep: Sweep
    specimens: list[str]
    hours: float
    nats: float
    helps: dict[int, tuple[float, float]]


@dataclass(frozen=True)
class Context:
    """What an order stands in: others come before it, a check of gauges is among them, somebody typed the tests in."""

    later: bool = False
    checked: bool = False
    typed: bool = True


def reasons(order: Order, questions: Sequence[Open], context: Context) -> list[str]:
    """What the tests would do for the questions that they help most, in sentences."""
    helped = [(questions[k], *strengths) for k, strengths in order.helps.items()]
    tested = [one for one, *_ in helped if one.covers(order)]
    here = f"{order.sweep.temperature:g} degC"
    repeated = [one for one in tested if one.kind == "repeat"]
    again = sorted(one.about for one in repeated if not _copied(one))
    found = [COPY] * any(map(_copied, repeated))
    if again:
        several = len(again) > 1
        # The order itself has named them.
        whole = len(again) == len(order.specimens) * len(order.sweep.frequencies)
        old = f"test{'s' * several}" if whole else f"reading{'s' * several} of {joined(again)}"
        look = "Look for a typing error in the record first: the" if context.typed else "The"
        found.append(
            f"{look} old {old} contradict{'s' * (not several)} the other frequencies at {here}."
            + " Check gauges and mounting before." * context.checked
            + " If the new test agrees with the other frequencies, use the new test."
        )
    found += [
        f"{capital(one.about)}. If the new {one.other}, the machine, the temperature, the dimensions or the mounting "
        "was at fault: use the new tests."
        for one in tested
        if one.kind == "level"
    ]
    found += [
        f"What stays unexplained at {here} ({one.other}) should fall to about half if the mix is not linear. If the "
        "machine is at fault, it should stay or grow."
        for one in tested
        if one.kind == "linear" and order.sweep.half_strain
    ]
    found += [_reason(*one) for one in helped if one[0].kind in ("kept", "metal", "apart")]
    found += _reachable_causes([one for one in helped if one[0].kind == "reach"], context)
    return [reason for reason in found if reason][:REASONS]


def purpose(order: Order, questions: Sequence[Open]) -> str:
    """What an order is for, in a few words ("to ..."), without its first reason's numbers."""
    helped = [questions[k] for k in order.helps]
    repeated = [one for one in helped if one.kind == "repeat"]
    if any(map(_copied, repeated)):
        return "because one of two equal sweeps is a copy"
    again = [one.departure.frequency for one in repeated if one.departure]
    for kind, words in (
        ("repeat", f"because the old result at {_frequencies(again)} contradicts the other frequencies"),
        ("level", "to see whether the odd result repeats itself"),
        ("linear", f"to see whether the mix is linear at {order.sweep.temperature:g} degC"),
        ("metal", "to confirm the {about}: metal must then show {other}, and 0 deg if there is none"),
        ("kept", "to confirm the {about}"),
        ("apart", "to confirm the {about}: {other} would look much the same"),
        ("reach", "to see whether there is {about}{places}"),
    ):
        for one in helped:
            if one.kind != kind or (kind == "linear" and not (order.sweep.half_strain and one.covers(order))):
                continue
            at = [c.place for c in (one.candidate, one.rival) if c and c.cause.name == TemperatureBias.name]
            if kind == "apart" and len(at) == 2:
                return f"to decide whether the temperature was wrong at {at[0]:g} or at {at[1]:g} degC"
            if kind == "reach" and at:
                return f"to see an error of {one.other} in the temperature of any isotherm"
            alike = [other.place for other in helped if (other.kind, other.about) == (kind, one.about)]
            other = article(one.other) if kind == "apart" else one.other
            return words.format(about=one.short or one.about, other=other, places=_places(alike))
    return ""


def _copied(one: Open) -> bool:
    return one.departure is not None and one.departure.copied


def _frequencies(tested: Iterable[float | None]) -> str:
    """`10 and 25 Hz`."""
    return f"{joined([f'{f:g}' for f in sorted({f for f in tested if f is not None})])} Hz"


def _reachable_causes(helped: Sequence[tuple[Open, float, float]], context: Context) -> list[str]:
    """A sentence for each cause that the tests bring within reach, its isotherms or specimens together."""
    causes: dict[str, list[tuple[Place, float, float]]] = {}
    for one, *strengths in helped:
        before, after = (
            100.0 * float(ndtr(np.sqrt(max(strength - one.hidden, 0.0)) - USUAL_THRESHOLD))
            for strength in strengths
        )
        if after - before >= NOTICEABLE:
            causes.setdefault(one.about, []).append((one.place, before, after))
    without = "with only the steps above" if context.later else "without it"
    said = []
    for about, found in causes.items():
        places, now, then = (list(values) for values in zip(*found, strict=True))
        on = "specimen" if isinstance(places[0], str) else "temperature"
        depending = f", depending on the {on}" * (len(places) > 1)
        said.append(
            f"If there is {about}{_places(places)}, this test finds it with a chance of {_chances(then)}; {without} "
            f"the chance is {_chances(now)}{depending}."
        )
    return said


def _places(places: Sequence[Place]) -> str:
    """` at 4, 20 or 50 degC`, ` of specimen A or B`; nothing for a cause of all tests."""
    temperatures = sorted(place for place in places if isinstance(place, float))
    if temperatures:
        return f" at {joined([f'{t:g}' for t in temperatures], 'or')} degC"
    names = [place for place in places if isinstance(place, str)]
    return f" of {joined(names, 'or')}" if names else ""


def _chances(values: Sequence[float]) -> str:
    least, most = f"{min(values):.0f}", f"{max(values):.0f}"
    return f"{least} %" if least == most else f"{least} to {most} %"


def _reason(one: Open, before: float, after: float) -> str:
    """What tests would do for one question; empty where that is little."""
    if one.kind == "kept":
        now, then = np.sqrt(before), np.sqrt(after)
        found = f"The {one.about} should then be found without {one.other} too, by {then:.1f} standard errors"
        return f"{found} (now {now:.1f})." * bool(then - now >= CLEARER)
    if one.kind == "metal":
        return f"Metal shows only what the machine adds. The {one.about} must show there as {one.other}."
    if before >= CLEAR and not one.alike:
        return ""
    doubt = f"would look much the same. These tests speak for the {one.about}, but not beyond doubt."
    looks = f"fits these tests as well as the {one.about}." if one.alike else doubt
    clearer = "decide" if after >= CLEAR else "make it clearer"
    return f"{capital(article(one.other))} {looks} This test should {clearer}."


def act(one: Order, done: Observations) -> str:
    """What an order asks for, in a clause without frequencies; `done` are the tests there are."""
    where = "" if one.sweep.specimen == METAL else f" at {one.sweep.temperature:g} degC"
    return f"test {named(one.specimens)}{' again' * _all_tested(one, done)}{where}"


def _all_tested(one: Order, done: Observations) -> bool:
    """Whether an order asks for tests that were all made."""
    tested = {
        (done.names[k], round(t, 6), round(f, 6))
        for k, t, f in zip(done.specimen, done.isotherm, done.frequency, strict=True)
    }
    wanted = {
        (name, round(one.sweep.temperature, 6), round(f, 6))
        for name in one.specimens
        for f in one.sweep.frequencies
    }
    return not one.sweep.half_strain and wanted <= tested
