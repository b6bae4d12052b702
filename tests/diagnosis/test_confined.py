"""Faults of one specimen's channel, of one isotherm and of one sweep's temperature are told with place and size."""

from typing import get_type_hints

import msgspec
import numpy as np
import pytest
from test_diagnose import EFFECTS, LAW, table

from asphalt_nscd.diagnosis.content import Content
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.search.confined import DELAY, ISOTHERM, OFFSET, SWEEP, Odd
from asphalt_nscd.diagnosis.search.diagnose import diagnose

FEW = 500  # draws: what is tested here does not hang on the third digit of a chance


def offset(rows, degrees):
    return lambda e, s, t, w: e * np.exp(1j * np.radians(degrees) * rows(s, t))


def delayed(e, s, t, w):
    return e * np.exp(2e-4j * w * (s == 2))


def warmer(e, s, t, w):
    return LAW.complex_modulus(w, t + np.where((s == 1) & (t == 15), 4.0, 0.0))


def slipping(e, s, t, w):
    """Gauges on the warmest isotherm: the slower, the less |E*| and phase, which no causal law allows."""
    slow = np.where(t == 30, np.log(2 * np.pi * 40 / w) / np.log(40 / 3), 0.0)
    return e * np.exp(-slow * (0.3 + 1j * np.radians(6.0)))


FAULTS = {
    (OFFSET, "b", None): (-1.5, offset(lambda s, t: s == 1, -1.5)),
    (DELAY, "c", None): (2e-4, delayed),
    (ISOTHERM, None, 10.0): (1.5, offset(lambda s, t: t == 10, 1.5)),
    (SWEEP, "b", 15.0): (4.0, warmer),
}


@pytest.mark.slow
@pytest.mark.parametrize("place", FAULTS, ids=lambda place: place[0])
def test_a_hidden_fault_is_told_alone_with_its_place_and_size(place):
    size, effect = FAULTS[place]
    climbed = diagnose(table(3, effect), draws=FEW).ladder
    (one,) = climbed.odd
    assert (one.kind, one.specimen, one.isotherm) == place
    assert abs(one.size - size) < 2.5 * one.std_error and one.std_error < 0.2 * abs(size)
    assert one.probability > 0.5 and climbed.torn == [] and climbed.rungs == []


@pytest.fixture(scope="module")
def smallest():
    """Limits of a table without a fault, by place."""
    ladder = diagnose(table(3), draws=FEW).ladder
    return {
        (one.kind, one.specimen, one.isotherm): ladder.estimates_spread * one.size for one in ladder.smallest
    }


HIDDEN = {
    (OFFSET, "b", None): lambda size: offset(lambda s, t: s == 1, size),
    (DELAY, "c", None): lambda size: lambda e, s, t, w: e * np.exp(1j * size * w * (s == 2)),
    (ISOTHERM, None, 10.0): lambda size: offset(lambda s, t: t == 10, size),
    (SWEEP, "b", 15.0): lambda size: (
        lambda e, s, t, w: LAW.complex_modulus(w, t + np.where((s == 1) & (t == 15), size, 0.0))
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("place", HIDDEN, ids=lambda place: place[0])
def test_a_fault_is_told_at_three_limits_and_not_at_a_third(smallest, place):
    effect, limit = HIDDEN[place], smallest[place]
    (one,) = diagnose(table(3, effect(3.0 * limit)), draws=FEW).ladder.odd
    assert (one.kind, one.specimen, one.isotherm) == place
    assert diagnose(table(3, effect(limit / 3.0)), draws=FEW).ladder.odd == []


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
def test_beside_a_common_offset_no_isotherm_has_one_of_its_own():
    """What is left of an offset without one size is the machine's, not one isotherm's."""
    both = offset(lambda s, t: 1.5 + np.select([t == -10, t == 30], [-1.5, 1.5], 0.0), 1.0)
    climbed = diagnose(table(3, both), draws=FEW).ladder
    assert "phase_offset" in [rung.candidate.cause.name for rung in climbed.rungs]
    assert all(one.kind != ISOTHERM for one in climbed.odd)


TOLD = {
    "odd_phases": Odd(OFFSET, "3", None, 1.2, 0.1, 0.9),
    "odd_temperatures": Odd(SWEEP, "3", 20.0, -2.1, 0.31, 0.8),
    "contradictory_isotherms": Odd(ISOTHERM, None, 20.0, -1.23, 0.1, 0.8),
}


@pytest.mark.parametrize("key", TOLD)
def test_a_fault_is_written_as_the_schema_says_in_widened_intervals(key):
    one = TOLD[key]
    content = one.content(1.5, 25.0)
    msgspec.convert([content], get_type_hints(Content, include_extras=True)[key])
    half = 1.5 * 1.96 * one.std_error
    assert content["interval_95"] == pytest.approx([one.size - half, one.size + half])
    assert content["probability"] == one.probability


def test_a_fault_is_told_with_its_interval_and_what_to_check():
    offset, delay = (
        one.content(1.0, 25.0) for one in (TOLD["odd_phases"], Odd(DELAY, "3", None, -2e-4, 2e-5, 0.9))
    )
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


def test_what_is_told_beside_the_last_fit_takes_the_place_of_what_the_levels_say():
    told = [
        TOLD[key].content(1.0, 25.0) for key in ("odd_phases", "odd_temperatures", "contradictory_isotherms")
    ]
    phases = [{"specimen": name, "temperature_C": 5.0, "phase_deg": 4.0} for name in ("3", "4")]
    temperatures = [{"specimen": "3", "temperature_C": t, "kelvin": -3.0} for t in (20.0, 30.0)]
    assert levels.merge_confined(phases, temperatures, told) == (
        [told[0], phases[1]],
        [told[1], temperatures[1]],
    )
    assert levels.merge_confined(phases, temperatures, []) == (phases, temperatures)
