"""Modulus against phase: what a material can do is let pass, what only a rig does is told."""

from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening.causality import contradictions

FREQUENCIES = np.array([1.0, 3.0, 10.0, 25.0])
NOISE = SimpleNamespace(sigma=(0.01, np.radians(0.3)))


def told(departure):
    """Contradictions at 20 degC where ln E* of three specimens departs from a power law by departure(f)."""
    f, specimen = np.tile(FREQUENCIES, 3), np.repeat([0, 1, 2], FREQUENCIES.size)
    law = 22.0 + 0.3 * np.log(f) + 0.15j * np.pi
    one = np.ones(f.size)
    observed = Observations(
        specimen, ("A", "B", "C"), 20.0 * one, f, np.exp(law + departure(f)), one, 0.0 * one
    )
    return contradictions(observed, SimpleNamespace(modelled=law), NOISE)


def relaxing(f, relative=0.1, time=1.0 / (2 * np.pi * 5.0)):
    return np.log(1.0 + relative * 1j * 2 * np.pi * f * time / (1.0 + 1j * 2 * np.pi * f * time))


def test_the_level_of_a_specimen_that_is_alone_at_a_frequency_is_no_slope():
    """Two of three are missing at the highest frequency, as where they were set aside; the third is 40 % stiffer."""
    specimen = np.repeat([0, 1, 2], FREQUENCIES.size)
    f = np.tile(FREQUENCIES, 3)
    there = (specimen == 2) | (f < FREQUENCIES[-1])
    law = (22.0 + 0.3 * np.log(f) + 0.15j * np.pi)[there]
    one = np.ones(there.sum())
    level = np.where(specimen == 2, np.log(1.4), 0.0)[there]
    observed = Observations(
        specimen[there], ("A", "B", "C"), 20.0 * one, f[there], np.exp(law + level), one, 0.0 * one
    )
    assert contradictions(observed, SimpleNamespace(modelled=law), NOISE) == []


@pytest.mark.parametrize(
    "departure",
    [
        lambda f: 0j * f,
        lambda f: 0.1 + 0j * f,
        lambda f: 0.1 * np.log(f) + 0.05j * np.pi,
        relaxing,
    ],
    ids=["none", "stiffer", "steeper", "a second process"],
)
def test_what_a_linear_material_can_do_is_no_contradiction(departure):
    assert told(departure) == []


def test_a_gain_at_one_frequency_is_told_with_the_phase_its_slope_asks_for():
    worst = told(lambda f: np.where(f == 25.0, 0.15, 0.0) + 0j)[0]
    assert (worst.temperature, worst.low, worst.high) == (20.0, 10.0, 25.0)
    assert np.degrees(worst.measured) == pytest.approx(27.0)
    assert np.degrees(worst.asked) == pytest.approx(27.0 + 90.0 * 0.15 / np.log(2.5))


def test_a_phase_without_its_slope_is_told():
    assert len(told(lambda f: np.radians(3.0) * 1j + 0.0 * f)) == 3
    assert told(lambda f: np.radians(0.2) * 1j + 0.0 * f) == []
