"""Ways to one answer: condensed, reduced, Gauss-Seidel run to convergence, frequency domain; and their orders."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.stepping.condensed import CondensedState
from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from theory.marches import FREQUENCY, OMEGA, beam, followed, march, stiffness
from theory.rows import order
from theory.specimens import QUICK_LAW, mixed

# of two spheres across, and soft enough for Gauss-Seidel to converge
SOFT = BondLaw(72.9e6, 0.18e6, np.array([145e6]), np.array([0.231e6]))


def stepped(method: str, scheme: str, steps: int, cycles: int = 5) -> complex:
    """Apparent stiffness [N/m] of the weightless beam by time stepping, from the last of its cycles."""
    system = replace(beam(), load=np.zeros(beam().mass.size))
    run = march(system, QUICK_LAW, 2 * np.pi / OMEGA / steps, scheme, method)
    sine = 1e-7 * np.sin(2 * np.pi / steps * np.arange(1, cycles * steps + 1))
    return stiffness(followed(run, sine), steps, 1e-7)


def of_the_law() -> complex:
    """Apparent stiffness [N/m] of the beam by the frequency domain."""
    return driving_force(beam(), QUICK_LAW.discrete_modulus(OMEGA, 0.0), OMEGA)


def test_stepping_against_frequency_domain(row):
    dt = 1 / FREQUENCY / 200
    rate = (1 - np.exp(-1j * OMEGA * dt)) / dt
    exact = driving_force(beam(), QUICK_LAW.discrete_modulus(OMEGA, dt), OMEGA, rate**2)
    phase, source = np.angle(exact), "(E* K - omega^2 M) u = f of the scheme"
    for method in ("condensed", "reduced"):
        found = stepped(method, "euler", 200)
        row(f"{method}, |F/z| of implicit Euler", abs(exact), abs(found), 1e-7, source)
        row(f"{method}, phase of implicit Euler (rad)", phase, np.angle(found), 1e-7, "the same")


def test_fitted_scheme(row):
    exact, source = of_the_law(), "exact law on the same specimen"
    when = "100 steps a cycle, fitted scheme"
    for method in ("condensed", "reduced"):
        found = stepped(method, "fitted", 100)
        angle = np.degrees(np.angle(found / exact))
        row(f"{method}, |E*| at {when}", 1.0, abs(found / exact), 1e-4, source)
        row(f"{method}, phase at {when} (deg)", 0.0, angle, 0.01, source)


def test_order_in_dt(row):
    exact, source = of_the_law(), "against the frequency domain"
    euler = [abs(stepped("reduced", "euler", steps) - exact) for steps in (200, 400)]

    def pulse(steps: int) -> float:
        run = march(beam(), QUICK_LAW, 8e-3 / steps, "fitted", "reduced", omega=0.0)
        # a pulse that begins smoothly: a kink there would cost the second order
        return followed(run, 1e-6 * np.sin(np.pi * np.arange(1, 5 * steps // 8 + 1) / steps) ** 4)[-1]

    reference = pulse(1024)
    fitted = [abs(pulse(steps) - reference) for steps in (64, 128)]
    row("bending, order in dt of implicit Euler", 1.0, order(euler), 0.05, source)
    row("bending by a pulse, order in dt of the two-step scheme", 2.0, order(fitted), 0.3, "BDF2")


@pytest.mark.slow
def test_gauss_seidel(row):
    """Run to convergence it agrees; the error follows the tolerance in first order."""
    system, steps = beam(2, 2, 4), 50
    sine = 1e-6 * np.sin(2 * np.pi / steps * np.arange(1, 21))
    dt = 1 / FREQUENCY / steps
    expected = followed(march(system, SOFT, 2 * np.pi / OMEGA / steps), sine)
    errors = []
    for tolerance in (1e-5, 1e-7, 1e-9):
        stepper = SweepingStepper(system, SOFT, dt, CondensedState.at_rest(system, SOFT), tolerance, 100_000)
        force = np.array([stepper.advance(v) for v in np.diff(sine, prepend=0.0) / dt])
        errors.append(np.abs(force - expected).max() / np.abs(expected).max())
    rate = np.log10(errors[-2] / errors[-1]) / 2
    row("Gauss-Seidel at a tolerance of 1e-9, force", 0.0, errors[-1], 1e-5, "condensed solution")
    row("Gauss-Seidel, order in its tolerance", 1.0, rate, 0.3, "linear convergence")


def test_breaking_alike(row):
    """Beyond yield: the same bonds in the same order, the same forces, by full and reduced stepping."""
    steps, force, broken, source = 100, [], [], "condensed against reduced"
    for method in ("condensed", "reduced"):
        run = march(beam(), QUICK_LAW, 2 * np.pi / OMEGA / steps, method=method)
        sine = 8e-5 * np.sin(2 * np.pi / steps * np.arange(1, steps + 1))
        force.append(followed(run, np.append(np.zeros(10), sine)))
        broken.append(list(run.stepper.state.broken))
    same = sum(a == b for a, b in zip(*broken, strict=False)) if broken[0] else np.nan
    difference = np.abs(force[0] - force[1]).max() / np.abs(force[0]).max()
    row("fracture, bonds that break alike and in order", len(broken[0]), same, 0.0, source)
    row("fracture, difference of the force", 0.0, difference, 1e-6, source)


def test_a_law_for_each_bond(row):
    """Drawn from a table; and one law in every place of the table, through breaks."""
    system, steps = replace(beam(), load=np.zeros(beam().mass.size)), 100
    dt = 2 * np.pi / OMEGA / steps
    law, rate = mixed(system), (1 - np.exp(-1j * OMEGA * dt)) / dt
    modulus, g = law.discrete_modulus(OMEGA, dt), system.operator.toarray()
    dense = (g.T * (system.weight * modulus)) @ g + rate**2 * np.diag(system.mass)
    exact = 1.0 / np.linalg.inv(dense)[system.driven, system.driven]
    sine = np.sin(2 * np.pi / steps * np.arange(1, 12 * steps + 1))
    found = stiffness(followed(march(system, law, dt), 1e-7 * sine), steps, 1e-7)
    force, broken = [], []
    for shared in (QUICK_LAW, mixed(beam(), (QUICK_LAW, QUICK_LAW))):
        run = march(beam(), shared, dt, "fitted")
        force.append(followed(run, 8e-5 * sine[:steps]))
        broken.append(run.stepper.state.broken)
    difference = np.abs(force[0] - force[1]).max() / np.abs(force[0]).max() if broken[0] else np.nan
    same = sum(a == b for a, b in zip(*broken, strict=False))
    by_frequency = abs(driving_force(system, modulus, OMEGA, rate**2) / exact)
    three, one, source = "bonds of three laws", "one law in each bond", "dense equations of the scheme"
    row(f"{three}, |F/z| in the frequency domain", 1.0, by_frequency, 1e-9, "dense equations")
    row(f"{three}, |F/z| of implicit Euler", 1.0, abs(found / exact), 1e-5, source)
    row(f"{three}, phase of implicit Euler (rad)", 0.0, np.angle(found / exact), 1e-5, "the same")
    row(f"{one}, difference of the force", 0.0, difference, 1e-12, "that law shared")
    row(f"{one}, bonds that break alike", len(broken[0]), same, 0.0, "that law shared")
