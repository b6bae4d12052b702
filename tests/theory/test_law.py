"""The bond law alone against the analytic Burgers law and Kelvin chain."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.bonds.law import BondLaw, BondLaws
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.rheology.burgers import Burgers
from theory.rows import order
from theory.specimens import system_of

BURGERS = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)  # Table 3, 15 degC
LAW = BondLaw(24.3e9, 3.71e9, np.array([48.4e9]), np.array([0.773e9]))
CHAIN = BondLaw(24.3e9, 3.71e9, np.array([48.4e9, 90e9]), np.array([0.773e9, 0.18e9]))
FREQUENCY = 10.0
STEPS = (5e-4, 2.5e-4, 1.25e-4)  # s
EULER = "implicit Euler"
BURGERS_LAW = "Findley, Lai & Onaran 1976, ch. 5; Eqs. (15)-(29)"


def creep(law: BondLaw, time: float, dt: float) -> float:
    """Opening [m] under a tension of 1 Pa for `time` [s], stepped from rest; exactly, creep compliance times 1 Pa."""
    step = law.step(dt)
    sigma, kelvin, opening = np.zeros(1), np.zeros((law.kelvin_springs.size, 1)), 0.0
    for _ in range(round(time / dt)):
        explicit = step.explicit_part(sigma, kelvin)
        velocity = explicit + step.compliance  # U+ = b - S sigma+ at sigma+ = -1
        opening += dt * velocity[0]
        sigma, kelvin = step.update(explicit, velocity, kelvin)
    return opening


def follow(law: BondLaw, opening: np.ndarray, dt: float) -> np.ndarray:
    """Stress sigma (n,) [Pa], below zero in tension, at a prescribed history of the opening, from rest.

    `opening` (n,) in m is at the end of each step `dt` [s], zero before the first.
    """
    step = law.step(dt)
    sigma, kelvin = np.zeros(1), np.zeros((law.kelvin_springs.size, 1))
    history = np.empty(opening.size)
    for n, velocity in enumerate(np.diff(opening, prepend=0.0) / dt):
        sigma, kelvin = step.update(step.explicit_part(sigma, kelvin), velocity, kelvin)
        history[n] = sigma[0]
    return history


def steady_modulus(law: BondLaw, steps: int, cycles: int = 40) -> complex:
    """Modulus -sigma/u [Pa] of the steady oscillation at FREQUENCY, with `steps` in a cycle, from the last cycle.

    It should be `discrete_modulus` of the same step.
    """
    # 40 cycles are 4 s, and the slow relaxation of the law takes 0.24 s: its transient is gone
    angle = 2 * np.pi * np.arange(1, cycles * steps + 1) / steps
    sigma = follow(law, np.sin(angle), 1 / (FREQUENCY * steps))
    last = slice(-steps, None)
    return complex(-2j * (sigma[last] * np.exp(-1j * angle[last])).mean())


def chain_creep(time: float) -> float:
    """Creep compliance [1/Pa] of CHAIN at `time` [s], element by element."""
    delayed = sum(
        -np.expm1(-time * e / n) / e for e, n in zip(CHAIN.kelvin_springs, CHAIN.kelvin_dashpots, strict=True)
    )
    return 1 / CHAIN.spring + time / CHAIN.dashpot + delayed


def test_creep(row):
    for name, law, exact in (
        ("Burgers", LAW, float(BURGERS.creep_compliance(0.02))),
        ("Kelvin chain", CHAIN, chain_creep(0.02)),
    ):
        found = np.array([creep(law, 0.02, dt) for dt in STEPS])
        row(f"{name} creep, opening after 20 ms", exact, found[-1], 2e-3, BURGERS_LAW)
        row(f"{name} creep, order in dt", 1.0, order(found - exact), 0.05, EULER)


def test_relaxation(row):
    exact = float(BURGERS.relaxation_modulus(0.02))
    found = np.array([-follow(LAW, np.ones(round(0.02 / dt)), dt)[-1] for dt in STEPS])
    row("Burgers relaxation, stress after 20 ms", exact, found[-1], 5e-3, BURGERS_LAW)
    row("Burgers relaxation, order in dt", 1.0, order(found - exact), 0.05, EULER)


def test_oscillation(row):
    omega = 2 * np.pi * FREQUENCY
    exact = complex(BURGERS.complex_modulus(omega))
    found = np.array([steady_modulus(LAW, n) for n in (100, 200, 400)])
    name, of_the_scheme = "Burgers oscillation", "i omega -> (1 - exp(-i omega dt))/dt"
    scheme = LAW.discrete_modulus(omega, 1 / (400 * FREQUENCY))
    of_scheme, phase = float(np.angle(scheme)), float(np.angle(found[-1]))
    row(f"{name}, |E*| at 400 steps a cycle", abs(exact), abs(found[-1]), 5e-3, "Eqs. (27)-(29)")
    row(f"{name}, order in dt", 1.0, order([abs(value) for value in found - exact]), 0.05, EULER)
    row(f"{name}, |E*| of the scheme", abs(scheme), abs(found[-1]), 1e-8, of_the_scheme)
    row(f"{name}, phase of the scheme (rad)", of_scheme, phase, 1e-8, "the same")


def test_two_bonds_in_series(row):
    """A Burgers bond's normal and a chain's tangent, in series under 3 N: each creeps by its own law."""
    time, operator = 0.02, np.zeros((6, 3))
    # Body 2 on body 1 along the normal, body 1 on the wall along a tangent.
    operator[0], operator[4] = [0, -1, 1], [0, 1, 0]
    mass, load = np.array([1.0, 1e-9, 1e-9]), np.array([0.0, 0.0, 3.0])
    system = system_of(operator, np.repeat([2e-3, 5e-3], 3), mass, driven=0, load=load)
    law = BondLaws.of_bonds((LAW, CHAIN), np.array([0, 0]), np.array([0, 1]))
    found = np.zeros(len(STEPS))
    for k, dt in enumerate(STEPS):
        stepper = CondensedStepper(system, law, dt, CondensedState.at_rest(system, law))
        for _ in range(round(time / dt)):
            stepper.advance(0.0)
        found[k] = stepper.state.displacement[2]
    exact = 3.0 * (float(BURGERS.creep_compliance(time)) / 2e-3 + chain_creep(time) / 5e-3)
    name = "bonds of two laws in series"
    row(f"{name}, opening after 20 ms", exact, found[-1], 2e-3, "sum of both creep compliances")
    row(f"{name}, order in dt", 1.0, order(found - exact), 0.05, EULER)
