"""An error of all tests at the highest frequency: too few samples in a cycle, or a frequency noted wrongly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_doubts import SCATTER, late, table, turned

from asphalt_nscd.diagnosis.search.diagnose import diagnose

pytestmark = pytest.mark.slow


def at_top(value: complex):
    """What is added to ln E* of all tests at 25 Hz, the highest frequency of `table`."""
    return lambda omega, temperature: value * np.isclose(omega, 2.0 * np.pi * 25.0)


def found(observed):
    return diagnose(observed, SCATTER, draws=200).ladder


def within(value, size):
    return abs(value - size[0]) < 3.0 * size[1] and size[1] < 0.3 * max(abs(value), 0.03)


@pytest.mark.parametrize("modulus,degrees", [(0.0, 5.0), (0.10, 0.0), (-0.08, -4.0)])
def test_what_the_highest_frequency_alone_is_off_by_is_told_and_gets_no_name(modulus, degrees):
    ladder = found(table(at_top(modulus + 1j * np.radians(degrees))))
    off = ladder.at_highest
    assert off.frequency == 25.0 and not ladder.rungs
    assert within(modulus, off.modulus) and within(np.radians(degrees), off.phase)


@pytest.mark.parametrize("effect,name", [(late, "channel_delay"), (turned, "phase_offset")])
def test_an_error_that_grows_towards_it_keeps_its_name(effect, name):
    ladder = found(table(effect))
    assert [rung.candidate.cause.name for rung in ladder.rungs] == [name]
    assert ladder.at_highest is None and not ladder.withdrawn


def test_a_clean_table_has_none():
    assert found(table()).at_highest is None


def test_a_name_that_it_displaces_is_withdrawn():
    """A delay of one sample at 25 Hz takes most of the error, and the tests at 10 Hz deny it."""
    ladder = found(table(at_top(1j * np.radians(7.0))))
    assert {rung.candidate.cause.name for rung in ladder.withdrawn} <= {"channel_delay", "moving_mass"}
    assert not ladder.rungs and ladder.at_highest is not None


def test_of_two_frequencies_neither_is_the_wrong_one():
    observed = table(at_top(0.1))
    two = observed.subset(np.flatnonzero(observed.frequency >= 10.0))
    assert found(two).at_highest is None
    three = observed.subset(np.flatnonzero(observed.frequency >= 5.0))
    assert found(three).at_highest.frequency == 25.0


def test_it_is_written_in_percent_and_degrees():
    ladder = found(table(at_top(0.1 + 1j * np.radians(2.0))))
    one, twice = ladder.at_highest.content(1.0), ladder.at_highest.content(2.0)
    low, high = one["modulus_interval_95"]
    assert low < 100.0 * 0.1 < high and one["phase_deg"] == pytest.approx(2.0, abs=0.6)
    assert np.diff(twice["phase_interval_95"]) == pytest.approx(2.0 * np.diff(one["phase_interval_95"]))
    observed = replace(table(), frequency=np.full(table().size, 25.0))
    assert ladder.at_highest.rows(observed).all()
