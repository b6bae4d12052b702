"""Three ways to one complex modulus: condensed, reduced, frequency domain."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.nscd.bonds.implicit_operator import factors
from asphalt_nscd.nscd.bonds.statics import static_factor
from asphalt_nscd.nscd.stepping import harmonic
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper

FREQUENCY, OMEGA = 40.0, 80 * np.pi
AMPLITUDE, REST = 1e-7, 100  # m; steps under gravity alone


def of_the_scheme(system, law, dt) -> complex:
    """Frequency domain, with the modulus and the acceleration that implicit Euler gives at this step."""
    rate = (1 - np.exp(-1j * OMEGA * dt)) / dt
    return driving_force(system, law.discrete_modulus(OMEGA, dt), OMEGA, rate**2)


def stepped(system, law, dt, method, cycles) -> complex:
    """Force per displacement [N/m] in the last two cycles."""
    time = dt * np.arange(1, round(cycles / FREQUENCY / dt) + 1)
    driven = np.concatenate([np.zeros(REST), AMPLITUDE * np.sin(OMEGA * time)])
    if method == "reduced":
        force = ReducedStepper(ReducedModel(system, ritz_basis(system, 12)), law, dt, 1e-6).run(driven)[0]
    else:
        stepper = CondensedStepper(system, law, dt, CondensedState.rest_state(system, law))
        force = np.array([stepper.advance(v) for v in np.diff(driven, prepend=0.0) / dt])
    found = harmonic_response(time, force[REST:], driven[REST:], FREQUENCY, cycles=2)
    return found.force_amplitude / found.displacement_amplitude * np.exp(1j * found.phase)


def deviations(found: complex, expected: complex) -> tuple[float, float]:
    """(relative error of the norm, error of the phase in degrees)."""
    return abs(abs(found / expected) - 1), abs(np.degrees(np.angle(found / expected)))


@pytest.mark.parametrize("most", [1, harmonic.MOST_ITERATIONS])
def test_frequency_domain_by_static_factors_or_by_those_of_the_frequency(beam_system, monkeypatch, most):
    """Few iterations do below resonance; where they do not, the whole matrix is factorised: one answer, to 1e-11."""
    factorised = []
    monkeypatch.setattr(harmonic, "factors", lambda matrix: factorised.append(matrix) or factors(matrix))
    monkeypatch.setattr(harmonic, "MOST_ITERATIONS", most)
    modulus, omega = (2.0 + 0.7j) * 1e9, 600.0
    free, driven = beam_system.free, beam_system.driven
    dense = modulus * beam_system.stiffness().toarray() - omega**2 * np.diag(beam_system.mass)
    motion = np.linalg.solve(dense[np.ix_(free, free)], -dense[free, driven])
    expected = dense[driven, driven] + dense[driven, free] @ motion
    static = static_factor(beam_system, beam_system.weight)
    assert driving_force(beam_system, modulus, omega, static=static) == pytest.approx(expected, rel=1e-11)
    assert len(factorised) == (most == 1)
