"""Orders to the laboratory that need no computed gain: what a table lacks, whatever else it says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from asphalt_nscd.diagnosis.criteria import LEAST_ISOTHERMS
from asphalt_nscd.diagnosis.next_tests.sweeps import BEYOND, COLDEST, METAL, NEW, WARMEST, Costs, temperatures
from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.words import counted, joined, numbers, specimen_named
from asphalt_nscd.measurements.campaign import OFF_TARGET

Orders = list[dict[str, Any]]
CLEAR = 3.0  # standard errors of an excess phase
STRAINS = 25, 75  # 1e-6
HALF = ", at half the strain"
MANY = 4  # frequencies from which only the ends are told


def gauges(done: Observations, costs: Costs) -> Orders:
    """Order tests again after a check, of specimens beyond a quality limit that half of all tests or more exceed."""
    above = quality.exceeded(done)
    orders: Orders = []
    for name, limit in quality.LIMITS.items():
        rows = np.array([one.row for one in above if one.column == name], np.int64)
        if 2 * rows.size < done.size:
            continue
        share = np.bincount(done.specimen[rows], minlength=len(done.names)) / np.bincount(done.specimen)
        names = [done.names[k] for k in np.flatnonzero(share >= 0.5)]
        room = float(np.mean(costs.room))
        # Nearest to the room, so that no conditioning is paid for.
        at = float(min(done.isotherms, key=lambda t: abs(t - room)))
        why = (
            f"{rows.size} of {done.size} tests exceed the limit of {limit.label}. If the new ones stay below it, the "
            "mounting was at fault: repeat the other temperatures too. If not, it is the machine or the specimens."
        )
        act = f"check {limit.check}, mount {named(names)} anew and test again"
        purpose = f"to see whether {limit.label} gets better"
        orders.append(_order(act, names, [at], done, costs, (purpose, [why])))
    return orders


def metal(done: Observations, costs: Costs, one_sided: str) -> Orders:
    """Order a test of metal: phases lie on one side (`one_sided`, in words) of what |E*| requires, without a cause."""
    # Both ends: at one frequency an offset and a delay are the same.
    ends = [float(done.frequencies[0]), float(done.frequencies[-1])]
    hours = costs.hours(METAL, float(np.mean(costs.room)), ends)
    why = (
        f"{one_sided} Metal has no phase of its own: what it shows is the machine's. If it shows none, the "
        "cause is in the mix or in the mounting."
    )
    purpose = "to see whether the machine adds to the phase"
    return [content(f"test {METAL}", (purpose, [why]), hours, ([METAL], [], ends))]


def strains(done: Observations, costs: Costs, excesses: Sequence[Mapping[str, Any]]) -> Orders:
    """Order one specimen at two strains by both modes, where cyclic compression has an excess phase.

    `excesses` as in diagnosis.json, less what is established, which is their `taken_off_deg`. Beams oscillate about
    zero already, so that nothing is left to tell apart by mode.
    """
    clear = [one for one in excesses if one["excess_deg"] > CLEAR * one["standard_error_deg"]]
    if done.test_type != "tension-compression" or not clear:
        return []
    largest = max(clear, key=lambda one: one["excess_deg"])
    at, frequencies, specimen = largest["temperature_C"], done.frequencies.tolist(), done.names[0]
    act = (
        f"test {specimen_named(specimen)} at {at:g} degC and {numbers(STRAINS)} microstrain, by "
        "a haversine and by tension-compression, raw signals kept"
    )
    less = ", when corrected" * bool(largest.get("taken_off_deg"))
    why = (
        f"The phase lies {largest['excess_deg']:.1f} deg above what |E*| requires{less}. A reading of drift vanishes "
        "in tension-compression and does not change with strain. Grains that slip and films that soften stay there; "
        "the excess of films grows as the strain, that of grains less and less."
    )
    hours = 4.0 * costs.hours(specimen, at, frequencies)  # two strains by two modes
    words = "to see whether reading, grains or films cause the excess phase", [why]
    return [content(act, words, hours, ([specimen], [at], frequencies))]


def off_target(done: Observations, costs: Costs, found: Sequence[Mapping[str, Any]]) -> Orders:
    """Order tests again of specimens measured off their target at one isotherm: a slip there makes false biases."""
    orders: Orders = []
    for t in sorted({one["temperature_C"] for one in found}):
        here = [one for one in found if one["temperature_C"] == t]
        names = [one["specimen"] for one in here]
        most = max(abs(one["measured_C"] - t) for one in here)
        many = len(here) > 1
        they, their = ("they were", "their") if many else ("it was", "its")
        purpose = f"because {they} measured {'up to ' * many}{most:.2g} K off {their} target"
        why = (
            f"AASHTO T 378 allows {OFF_TARGET:g} K. Look into the record first. If the temperature there is a slip, "
            "correct it and run this again. If not, use the new tests."
        )
        orders.append(_order(f"test {named(names)} again", names, [t], done, costs, (purpose, [why])))
    return orders


def second_specimen(done: Observations, costs: Costs) -> Orders:
    """Order a new specimen at the same conditions, where one alone was tested."""
    if len(done.names) > 1:
        return []
    why = "Two specimens show the scatter from test to test. Without it nothing here is certain."
    at, words = done.isotherms.tolist(), ("to measure the scatter", [why])
    return [_order(f"test {NEW}", [NEW], at, done, costs, words)]


def order_temperatures(done: Observations, costs: Costs) -> Orders:
    """Order as many temperatures as certainty lacks: beyond those tested, then between them."""
    tested = done.isotherms
    beyond = [t for t in (tested[-1] + BEYOND, tested[0] - BEYOND) if COLDEST <= t <= WARMEST]
    between = [t for t in temperatures(done) if tested[0] < t < tested[-1] and t not in tested]
    new = [float(round(t)) for t in (*beyond, *between)][: max(LEAST_ISOTHERMS - tested.size, 0)]
    if not new:
        return []
    beyond_limits = np.array([one.row for one in quality.exceeded(done)], np.int64)
    poor = np.bincount(done.specimen[beyond_limits], minlength=len(done.names))
    names = [done.names[k] for k in sorted(np.argsort(poor, kind="stable")[:2])]
    were = f"{counted(tested.size, 'temperature')} {'was' if tested.size == 1 else 'were'} tested"
    why = f"{were}. A fault can be proved from {LEAST_ISOTHERMS} on."
    purpose = f"because fewer than {LEAST_ISOTHERMS} temperatures cannot prove a fault"
    return [_order(f"test {named(names)}", names, sorted(new), done, costs, (purpose, [why]))]


def _order(
    act: str, names: list[str], at: list[float], done: Observations, costs: Costs, why: tuple[str, list[str]]
) -> dict[str, Any]:
    """An order at these temperatures and all frequencies; why: its purpose in a few words, and the reasons in full."""
    frequencies = done.frequencies.tolist()
    hours = sum(costs.hours("", t, frequencies) for name in names for t in at)
    hours += costs.new_specimen * (NEW in names)
    words = f"{act} at {numbers(at)} degC"
    return content(words, why, hours, (names, at, frequencies))


def content(
    act: str,
    why: tuple[str, list[str]],
    hours: float,
    tests: tuple[list[str], list[float], list[float]],
    half: bool = False,
) -> dict[str, Any]:
    """An order as diagnosis.json has it, of no computed gain; `half` of the usual strain or all of it.

    `why` holds its purpose in a few words and the reasons in full; `hours` in h; `tests` are the names of the
    specimens, temperatures [degC] and frequencies [Hz].
    """
    names, at, frequencies = tests
    return {
        "text": f"{round(hours, 2):.1f} h: {act}, {band(frequencies)}{HALF * half}.",
        "act": act,
        "purpose": why[0],
        "why": why[1],
        "hours": round(hours, 2),
        "nats": 0.0,
        "specimens": names,
        "temperature_C": at[0] if len(at) == 1 else None,
        "frequencies_Hz": frequencies,
        "half_strain": half,
    }


def named(specimens: Sequence[str]) -> str:
    """Names of specimens in words: `specimens A and B`, `specimen A and a new specimen`."""
    own = [name for name in specimens if name not in (METAL, NEW)]
    others = [name for name in specimens if name in (METAL, NEW)]
    if len(own) > 1 and specimen_named(own[0]) != own[0]:
        return joined([f"specimens {joined(own)}", *others])
    return joined([*map(specimen_named, own), *others])


def band(frequencies: Sequence[float]) -> str:
    """Frequencies [Hz], ascending, in words: `1 and 10 Hz`, `0.1 to 25 Hz (6 frequencies)`."""
    if len(frequencies) < MANY:
        return f"{numbers(frequencies)} Hz"
    return f"{frequencies[0]:g} to {frequencies[-1]:g} Hz ({len(frequencies)} frequencies)"
