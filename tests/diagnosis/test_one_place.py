"""Faults of one place compete with all other causes and are told with place and size."""

from dataclasses import replace
from typing import get_type_hints

import msgspec
import numpy as np
import pytest
from test_diagnose import EFFECTS, LAW
from test_diagnose import table as whole

from asphalt_nscd.diagnosis.causes import EVERY
from asphalt_nscd.diagnosis.causes._cause import Setting, Sweep
from asphalt_nscd.diagnosis.content.whole import Content
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.diagnosis.search.told import Odd, odd_frequency

FEW = 500  # draws: what is tested here does not hang on the third digit of a chance
CAUSES = {cause.name: cause for cause in EVERY}
OFFSET, DELAY, ISOTHERM = "offset of one specimen", "delay of one specimen", "offset of one isotherm"
SWEEP, LEVEL, PHASE = (
    f"{what} of one specimen on one isotherm" for what in ("temperature", "level", "offset")
)


def table(seed, *effect):
    """Of four isotherms and frequencies, whose diagnosis takes half the time."""
    every = whole(seed, *effect)
    some = np.isin(every.isotherm, (-10, 10, 15, 30)) & np.isin(every.frequency, (3, 10, 25, 40))
    return replace(every.subset(some), whole=None)


def offset(rows, degrees):
    return lambda e, s, t, w: e * np.exp(1j * np.radians(degrees) * rows(s, t))


def here(s, t):
    return (s == 1) & (t == 15)


FAULTS = {
    (OFFSET, "b"): (-1.5, lambda size: offset(lambda s, t: s == 1, size)),
    (DELAY, "c"): (2e-4, lambda size: lambda e, s, t, w: e * np.exp(1j * size * w * (s == 2))),
    (ISOTHERM, 10.0): (1.5, lambda size: offset(lambda s, t: t == 10, size)),
    (SWEEP, Sweep("b", 15.0)): (
        4.0,
        lambda size: lambda e, s, t, w: LAW.complex_modulus(w, t + np.where(here(s, t), size, 0.0)),
    ),
    (LEVEL, Sweep("b", 15.0)): (0.3, lambda size: lambda e, s, t, w: e * np.exp(size * here(s, t))),
    (PHASE, Sweep("b", 15.0)): (-5.0, lambda size: offset(here, size)),
    ("offset at one frequency", Setting(40.0)): (
        4.0,
        lambda size: lambda e, s, t, w: e * np.exp(1j * np.radians(size) * np.isclose(w, 2.0 * np.pi * 40.0)),
    ),
}


def slipping(e, s, t, w):
    """Gauges on the warmest isotherm: the slower, the less |E*| and phase, which no causal law allows."""
    slow = np.where(t == 30, np.log(2 * np.pi * 40 / w) / np.log(40 / 3), 0.0)
    return e * np.exp(-slow * (0.3 + 1j * np.radians(6.0)))


@pytest.mark.slow
@pytest.mark.parametrize("key", FAULTS, ids=lambda key: key[0])
def test_a_hidden_fault_is_told_alone_with_its_place_and_size(key):
    size, effect = FAULTS[key]
    climbed = diagnose(table(3, effect(size)), draws=FEW).ladder
    (one,) = climbed.odd
    assert one.candidate.key == key
    assert abs(one.size - size) < 2.5 * one.std_error and one.std_error < 0.2 * abs(size)
    assert one.probability > 0.5 and climbed.torn == [] and climbed.rungs == []
    assert (climbed.at_highest is None) == (not isinstance(key[1], Setting))


@pytest.mark.slow
@pytest.mark.parametrize(
    "cause", [None, ("guide_friction", None), ("loose_clamp", "b"), ("temperature_bias", 15.0)]
)
def test_an_empty_table_and_one_with_a_cause_hold_no_fault_of_one_place(cause):
    observed = table(4) if cause is None else table(3, EFFECTS[cause][1])
    climbed = diagnose(observed, draws=FEW).ladder
    assert [rung.candidate.key for rung in climbed.rungs] == ([] if cause is None else [cause])
    assert climbed.odd == [] and climbed.torn == []


@pytest.mark.slow
def test_an_isotherm_whose_gauges_slip_is_torn_and_no_other():
    climbed = diagnose(table(3, slipping), draws=FEW).ladder
    assert climbed.torn == [30.0] and climbed.odd == []


@pytest.mark.slow
def test_of_two_specimens_neither_sweep_is_the_odd_one():
    observed = table(3, FAULTS[LEVEL, Sweep("b", 15.0)][1](0.3))
    two = observed.subset(np.flatnonzero(observed.specimen < 2))
    assert all(one.kind != LEVEL or one.specimen == "b" for one in diagnose(two, draws=FEW).ladder.odd)


def odd(kind, place, size, error):
    return Odd(Candidate(CAUSES[kind], place, (size,)), error, 0.8)


TOLD = {
    "odd_levels": odd(LEVEL, Sweep("3", 20.0), 0.3, 0.02),
    "odd_phases": odd(OFFSET, "3", 1.2, 0.1),
    "odd_temperatures": odd(SWEEP, Sweep("3", 20.0), -2.1, 0.31),
    "contradictory_isotherms": odd(ISOTHERM, 20.0, -1.23, 0.1),
}


@pytest.mark.parametrize("key", TOLD)
def test_a_fault_is_written_as_the_schema_says_in_widened_intervals(key):
    one = TOLD[key]
    content = one.content(1.5, 25.0)
    msgspec.convert([content], get_type_hints(Content, include_extras=True)[key])
    if key == "odd_levels":
        assert content["factor"] == pytest.approx(np.exp(0.3))
        return
    half = 1.5 * 1.96 * one.std_error
    assert content["interval_95"] == pytest.approx([one.size - half, one.size + half])
    assert content["probability"] == one.probability


def test_what_is_found_at_one_frequency_is_told_with_both_parts():
    at = Setting(25.0)
    found = odd_frequency(
        {("level at one frequency", at): (0.1, 0.01), ("offset at one frequency", at): (2.0, 0.3)},
        [odd("level at one frequency", at, 0.1, 0.01)],
    )
    one, twice = found.content(1.0), found.content(2.0)
    assert one["modulus_percent"] == pytest.approx(100.0 * np.expm1(0.1))
    assert one["phase_deg"] == pytest.approx(2.0)
    half = odd_frequency(
        {("level at one frequency", at): (np.log(0.5), 0.01)}, [odd("level at one frequency", at, -0.7, 0.01)]
    ).content(1.0)
    low, high = half["modulus_interval_95"]
    assert half["modulus_percent"] == pytest.approx(-50.0) and -51.1 < low < -50.0 < high < -48.9
    assert np.diff(twice["phase_interval_95"]) == pytest.approx(2.0 * np.diff(one["phase_interval_95"]))
    assert odd_frequency({}, [TOLD["odd_phases"]]) is None


def test_of_the_part_that_was_not_sought_nothing_is_known():
    """An offset at the highest of few frequencies looks like a delay, and may not be among what was estimated."""
    at = Setting(10.0)
    level = odd("level at one frequency", at, 0.1, 0.01)
    low, high = odd_frequency({("level at one frequency", at): (0.1, 0.01)}, [level]).content(1.0)[
        "phase_interval_95"
    ]
    assert low < -20.0 and high > 20.0


def test_a_fault_is_told_with_its_interval_and_what_to_check():
    offset, delay = (one.content(1.0, 25.0) for one in (TOLD["odd_phases"], odd(DELAY, "3", -2e-4, 2e-5)))
    assert levels.sentences([], [offset, delay]) == [
        "specimen 3: phase 1.20 +- 0.20 deg above what its |E*| and the other specimens say, in all its tests: check "
        "its gauges, channels and mounting",
        "specimen 3: displacement recorded 0.200 +- 0.039 ms before the force, 1.8 deg at the highest frequency: check "
        "filters and settings of its channels",
    ]
    (sweep,) = levels.temperature_notes([TOLD["odd_temperatures"].content(1.0, 25.0)])
    assert sweep == (
        "at 20 degC specimen 3 seems 2.10 +- 0.61 K colder than stated: check its conditioning and the record"
    )
