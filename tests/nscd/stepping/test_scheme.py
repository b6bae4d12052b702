"""Two-step schemes on the implicit Euler step: order, the steady oscillation, and the naive twin."""

from __future__ import annotations

import numpy as np
import pytest
from theory.marches import FREQUENCY, OMEGA, followed, march

from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.nscd.stepping.scheme import Scheme


@pytest.mark.parametrize("angle", [0.0, 1e-6, 0.0628, 0.5, 1.2])
def test_rate_of_the_fitted_scheme_is_exact(angle):
    """i omega dt for the fitted frequency, zero for a constant, one per step for a ramp of omega -> 0."""
    scheme = Scheme.named("fitted", angle)
    assert scheme.rate(angle) == pytest.approx(1j * angle, rel=1e-14, abs=1e-15)
    assert scheme.rate(0.0) == 0.0
    if angle == 0.0:
        assert (scheme.a, scheme.b) == (1.5, 0.5)
    assert Scheme.named("euler", angle) == Scheme(1.0, 0.0)


@pytest.mark.parametrize("angle", [0.0628, 0.3])
def test_the_fitted_scheme_is_stable(angle):
    """Growth factors z of y' = s y, roots of (1 - 1/z)(a - b/z) = s dt: none above one for decaying s."""
    scheme = Scheme.named("fitted", angle)
    for s in -np.geomspace(1e-3, 1e6, 40)[:, None] * np.exp(1j * np.linspace(-1.55, 1.55, 41)):
        for value in s:
            roots = np.roots([scheme.a - value, -(scheme.a + scheme.b), scheme.b])
            assert np.abs(roots).max() < 1.0 + 1e-7


@pytest.mark.parametrize("method", ["condensed", "reduced"])
@pytest.mark.parametrize("steps", [20, 100])
def test_steady_oscillation_is_that_of_the_law(beam_system, quick_law, steps, method):
    """|E*| to 1e-9 and the phase to 1e-7 deg, inertia included, where implicit Euler errs by 1 % and 1 deg."""
    dt, errors = 1 / FREQUENCY / steps, []
    exact = driving_force(beam_system, quick_law.discrete_modulus(OMEGA, 0.0), OMEGA)
    time = dt * np.arange(1, 6 * steps + 1)
    driven = np.concatenate([np.zeros(10), 1e-6 * np.sin(OMEGA * time)])
    for name in ("euler", "fitted"):
        run = march(beam_system, quick_law, dt, name, method)
        force = followed(run, driven)
        found = harmonic_response(time, force[10:], driven[10:], FREQUENCY, cycles=2)
        ratio = found.force_amplitude / found.displacement_amplitude * np.exp(1j * found.phase) / exact
        errors.append((abs(abs(ratio) - 1), abs(np.degrees(np.angle(ratio)))))
    assert errors[0][0] > 5e-3 and errors[0][1] > 0.5
    assert errors[1][0] < 1e-9 and errors[1][1] < 1e-7


def test_fitted_steps_against_the_scheme_written_out(beam_system, quick_law):
    """Every rate is [a (y+ - y) - b (y - y-)]/dt: law, kinematics and motion on the full arrays, to rounding."""
    dt, law = 2e-4, quick_law
    scheme = Scheme.named("fitted", OMEGA * dt)
    run = march(beam_system, law, dt, "fitted")
    for n in range(8):
        force = run.move_to(1e-6 * np.sin(0.3 * (n + 1)))
        if n < 2:
            before, now = run.earlier, run.now
            continue
        last, before, now = before, now, run.now
        y = {name: (last.values[name], before.values[name], now.values[name]) for name in now.values}
        rate = {k: (scheme.a * (c - b) - scheme.b * (b - a)) / dt for k, (a, b, c) in y.items()}
        sigma, velocity = now.values["sigma"], now.values["velocity"]
        opening = -rate["sigma"] / law.spring - sigma / law.dashpot + rate["memory"].sum(axis=0)
        scale = np.abs(beam_system.operator @ velocity).max()
        np.testing.assert_allclose(beam_system.operator @ velocity, opening, rtol=0, atol=1e-9 * scale)
        np.testing.assert_allclose(
            rate["displacement"], velocity, rtol=0, atol=1e-12 * np.abs(velocity).max()
        )
        drive = np.zeros_like(velocity)
        drive[beam_system.driven] = force
        pull = beam_system.load + beam_system.operator.T @ (beam_system.weight * sigma) + drive
        np.testing.assert_allclose(beam_system.mass * rate["velocity"], pull, rtol=0, atol=1e-9 * abs(force))
