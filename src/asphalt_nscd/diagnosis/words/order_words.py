"""What an order to the laboratory says: the tests, their hours, and what they would do for open questions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from jinja2 import Template
from scipy.special import ndtr

from asphalt_nscd.diagnosis.causes._cause import Place
from asphalt_nscd.diagnosis.causes.temperature_bias import TemperatureBias
from asphalt_nscd.diagnosis.criteria import USUAL_THRESHOLD
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.next_tests.choice import Order
from asphalt_nscd.diagnosis.next_tests.fixed_orders import named
from asphalt_nscd.diagnosis.next_tests.further_tests import Departure
from asphalt_nscd.diagnosis.next_tests.information import Question
from asphalt_nscd.diagnosis.next_tests.sweeps import METAL
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.words import sentences
from asphalt_nscd.diagnosis.words.sentences import article, numbers
from asphalt_nscd.files.templates import items, template
from asphalt_nscd.files.words import joined

REASONS = 3  # sentences at most
NOTICEABLE = 15.0  # percent of cases
CLEARER = 0.3  # standard errors by which tests must make a cause clearer, to say so
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
    def copied(self) -> bool:
        """Whether it is about a test that is a copy of another, or has one."""
        return self.departure is not None and self.departure.copied

    @property
    def place(self) -> Place:
        """Where the cause sits that it is about."""
        return None if self.candidate is None else self.candidate.place


@dataclass(frozen=True)
class Context:
    """What an order stands in: others come before it, a check of gauges is among them, somebody typed the tests in."""

    later: bool = False
    checked: bool = False
    typed: bool = True


def reasons(order: Order, questions: Sequence[Open], context: Context) -> list[str]:
    """What the tests would do for the questions that they help most, in sentences."""
    helped = [(questions[k], *strengths) for k, strengths in order.helps.items()]
    text = _template().render(
        order=order,
        context=context,
        helped=helped,
        tested=[one for one, *_ in helped if one.covers(order)],
        reached=reached([one for one in helped if one[0].kind == "reach"]),
    )
    return items(text)[:REASONS]


@cache
def _template() -> Template:
    filters = vars(sentences) | {"spelled_places": spelled_places, "chances": chances}
    return template("diagnosis/words/orders.j2", filters, {"CLEARER": CLEARER, "CLEAR": CLEAR})


def purpose(order: Order, questions: Sequence[Open]) -> str:
    """What an order is for, in a few words: "to ..." or "because ..."; empty if it helps none of these questions."""
    helped = [questions[k] for k in order.helps]
    repeated = [one for one in helped if one.kind == "repeat"]
    if any(one.copied for one in repeated):
        return "because one of two equal sweeps is a copy"
    again = sorted({one.departure.frequency for one in repeated if one.departure and one.departure.frequency})
    for kind, words in (
        ("repeat", f"because the old result at {numbers(again)} Hz contradicts the other frequencies"),
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
            return words.format(about=one.short or one.about, other=other, places=spelled_places(alike))
    return ""


def reached(helped: Sequence[tuple[Open, float, float]]) -> list[tuple[Any, ...]]:
    """Causes that the tests bring within reach: what, where, and the chances [%] to find them now and then."""
    causes: dict[str, list[tuple[Place, float, float]]] = {}
    for one, *strengths in helped:
        before, after = (
            100.0 * float(ndtr(np.sqrt(max(strength - one.hidden, 0.0)) - USUAL_THRESHOLD))
            for strength in strengths
        )
        if after - before >= NOTICEABLE:
            causes.setdefault(one.about, []).append((one.place, before, after))
    return [(about, *map(list, zip(*found, strict=True))) for about, found in causes.items()]


def spelled_places(places: Sequence[Place]) -> str:
    """` at 4, 20 or 50 degC`, ` of specimen A or B`; nothing for a cause of all tests."""
    temperatures = sorted(place for place in places if isinstance(place, float))
    if temperatures:
        return f" at {numbers(temperatures, 'or')} degC"
    names = [place for place in places if isinstance(place, str)]
    return f" of {joined(names, 'or')}" if names else ""


def chances(values: Sequence[float]) -> str:
    """Chances in whole percent, the least and the most."""
    least, most = f"{min(values):.0f}", f"{max(values):.0f}"
    return f"{least} %" if least == most else f"{least} to {most} %"


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
