"""What every laboratory adds: sized from the table, and no fault."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_diagnose import LAW, table

from asphalt_nscd.diagnosis import laboratory, scatter, start
from asphalt_nscd.diagnosis.diagnose import diagnose

NOISE = 0.01, np.radians(0.3), 0.03


def warmed(kelvin, seed=3):
    """A table whose isotherms, or specimens' isotherms, are off by kelvin (4, 6), not told."""
    temperatures = np.array([-10.0, 0, 10, 15, 20, 30])

    def effect(modulus, specimen, temperature, omega):
        at = np.searchsorted(temperatures, temperature)
        return LAW.complex_modulus(omega, temperature + np.broadcast_to(kelvin, (4, 6))[specimen, at])

    return table(seed, effect)


def fitted(observed):
    return start.fit_spectrum(observed, scatter.stated(observed, *NOISE))


def test_a_column_is_what_one_kelvin_or_one_mounting_does():
    observed = table(0)
    joint, fit = fitted(observed)
    roots = laboratory._roots(joint, fit, joint.noise.block)
    first = observed.isotherm == observed.isotherms[1]
    warmer = np.where(first, 0.5, 0.0)
    change = np.log(
        joint.base.modulus(fit.law, observed.omega, observed.temperature + warmer)[0]
        / joint.base.modulus(fit.law, observed.omega, observed.temperature - warmer)[0]
    )
    of_isotherms = laboratory._of_isotherm(joint, fit) / laboratory.OF_ISOTHERM
    column = of_isotherms[:, 1]
    assert np.allclose(column, change, atol=3e-3 * np.abs(change).max()) and not column[~first].any()
    of_mountings = roots["specimen temperature"]
    assert of_mountings.shape == (observed.size, 24)
    assert np.allclose(of_mountings.sum(axis=1), of_isotherms.sum(axis=1))
    assert np.allclose(roots["mounting, phase"], 1j * roots["mounting, modulus"])


@pytest.mark.parametrize("kind", ["specimen temperature", "mounting, modulus"])
def test_sizes_follow_the_table(kind):
    random = np.random.default_rng(5)
    drawn = random.standard_normal((4, 6))
    still = table(3)
    block = still.specimen, np.searchsorted(still.isotherms, still.isotherm)
    moved = (
        warmed(1.0 * drawn)
        if kind == "specimen temperature"
        else replace(still, modulus=still.modulus * np.exp(0.04 * drawn[block]))
    )
    small, large = (laboratory.estimate(*fitted(observed)).sizes[kind] for observed in (still, moved))
    usual = laboratory.LABORATORY[kind].size
    assert small < usual and large > 1.8 * usual


def test_isotherms_within_the_tolerance_of_the_standard_are_no_fault():
    """Each seems far off by the scatter of the tests alone."""
    found = diagnose(warmed(np.array([0.3, -0.4, 0.2, -0.3, 0.4, -0.2])), draws=500)
    assert not found.ladder.rungs and found.verdict == "explained"


def test_an_isotherm_far_outside_is_one():
    found = diagnose(warmed(np.array([0.0, 0.0, 3.0, 0.0, 0.0, 0.0])), draws=500)
    (rung,) = found.ladder.rungs
    assert rung.candidate.key == ("temperature_bias", 10.0) and rung.probability > 0.95
    low, high = (
        rung.candidate.values[0] + side * 1.96 * found.ladder.std_errors(rung.candidate)[0]
        for side in (-1, 1)
    )
    assert low < 3.0 < high
