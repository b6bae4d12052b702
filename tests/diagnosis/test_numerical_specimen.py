"""The numerical specimen in reduced form, against a spring and a mass worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.diagnosis.simulation.simulated import NumericalSpecimen
from asphalt_nscd.measurements.twopoint import Geometry, form_factor, mass_factor

GEOMETRY = Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235)


def test_the_head_feels_what_hangs_on_it_and_the_reduction_adds_its_own_inertia():
    """The head's own spring and mass, and a mass on a spring: force over displacement of the driven head."""
    stiffness = np.array([[5e-5, -2e-5], [-2e-5, 3e-5]])
    specimen = NumericalSpecimen(stiffness, np.diag([0.02, 0.3]), GEOMETRY, "two")
    omega, star = 2.0 * np.pi * np.array([1.0, 40.0]), np.array([2e9 + 1e9j, 9e9 + 3e8j])
    coupled = (2e-5 * star) ** 2 / (3e-5 * star - 0.3 * omega**2)
    force = 5e-5 * star - 0.02 * omega**2 - coupled
    expected = form_factor(GEOMETRY) * (force + mass_factor(GEOMETRY) * omega**2)
    assert specimen.apparent_modulus(omega, star) == pytest.approx(expected)
    assert specimen.ratio() == pytest.approx(form_factor(GEOMETRY) * (5e-5 - 4e-10 / 3e-5), rel=1e-6)


def test_without_a_motion_of_its_own_it_shows_the_law_of_its_bonds():
    specimen = NumericalSpecimen(np.eye(2), np.eye(2), GEOMETRY, "two").law_alone()
    omega, star = 2.0 * np.pi * np.array([1.0, 100.0]), np.array([2e9 + 1e9j, 2e8 + 9e7j])
    assert specimen.apparent_modulus(omega, star) == pytest.approx(star, rel=1e-12)
