"""Bonds of films stepped in time, against the frequency domain of the same network."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from theory.specimens import jittered_beam

from asphalt_nscd.forecasting.stepping import fit_bonds, harmonic_stiffness, step_test
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.specimen.system import bending_system

MATRIX = TwoS2P1D(1e6, 8e9, k=0.2, h=0.6, delta=2.0, tau=2e-3, beta=100.0, shift=WLF(20.0, 150.0, 15.0))
GRAIN = 60e9


@pytest.fixture(scope="module")
def beam():
    """Facets, without weight, and no bond breaks."""
    specimen = jittered_beam(area="facets")
    system = bending_system(specimen, 0.35, np.inf, 0.7)
    return specimen, replace(system, load=np.zeros_like(system.load))


def films(specimen, system, temperature, sheared=0.5):
    """Films in series with grains, by the gap of each; sheared they are softer."""
    share = np.clip(specimen.network.gap / specimen.network.length, 0.03, 1.0)
    share = np.column_stack([share, sheared * share + 0.5 * (1 - sheared), 0.8 * share]).ravel()

    def stiffness(omega):
        modulus = MATRIX.complex_modulus(omega, temperature)[:, None]
        return system.weight / (share / modulus + (1 - share) / GRAIN)

    return stiffness


@pytest.mark.parametrize(("temperature", "frequency"), [(0.0, 20.0), (30.0, 2.0)])
def test_stepping_is_the_frequency_domain(beam, temperature, frequency):
    """Chains, classes, steps and transients together: 0.2 % and 0.05 deg; bonds differ by more in both."""
    stiffness, omega = films(*beam, temperature), 2 * np.pi * frequency
    own = stiffness(np.array([omega]))[0]
    assert np.ptp(np.log(np.abs(own / beam[1].weight))) > 0.2 and np.ptp(np.degrees(np.angle(own))) > 1.5
    bonds = fit_bonds(beam[1], stiffness, omega / 5, 5 * omega)
    assert bonds.rms_error < bonds.largest_error < 0.05 and len(bonds.laws.table) > 20
    stepped = step_test(bonds, frequency, 1e-7)
    ratio = stepped.stiffness / harmonic_stiffness(beam[1], stiffness, omega)
    assert abs(abs(ratio) - 1) < 2e-3 and abs(np.degrees(np.angle(ratio))) < 0.05
    assert stepped.broken == [] and abs(stepped.energies.error) < 1e-10 * stepped.energies.actuator


def test_bonds_of_one_law_are_one_class(beam):
    """Stiffnesses of one shape: one chain, whose error alone is left, and sizes that are those of the bonds."""
    omega = 2 * np.pi * 10

    def stiffness(at):
        return beam[1].weight * MATRIX.complex_modulus(at, 15.0)[:, None]

    bonds = fit_bonds(beam[1], stiffness, omega / 5, 5 * omega)
    assert len(bonds.laws.table) == 1 and bonds.largest_error < 5e-4
    found = bonds.system.weight * bonds.laws.discrete_modulus(omega, 0.0)
    np.testing.assert_allclose(found, stiffness(np.array([omega]))[0], rtol=5e-4)


def test_more_classes_are_nearer(beam):
    """Errors of classes fall as their number grows; few are far off."""
    stiffness, omega = films(*beam, 15.0), 2 * np.pi * 10
    errors = [
        fit_bonds(beam[1], stiffness, omega / 5, 5 * omega, classes).rms_error for classes in (2, 8, 32)
    ]
    assert errors[0] > 3 * errors[1] > 9 * errors[2]


def test_frequency_domain_of_equal_films(beam):
    """All bonds alike: the stiffness of one network times one complex number."""
    one, two = (
        harmonic_stiffness(beam[1], lambda at, m=m: np.tile(m * beam[1].weight, (at.size, 1)), 1e-3)
        for m in (1e9, (0.6 + 0.8j) * 1e9)
    )
    assert two / one == pytest.approx(0.6 + 0.8j, rel=1e-9)
