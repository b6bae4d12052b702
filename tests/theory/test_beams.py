"""Networks of bonds against structural mechanics: chains, beams, two-point bending, devices of the rig."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from asphalt_nscd.measurements.twopoint import Geometry, form_factor, mass_factor
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import opening_operator
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.harmonic import actuator_stiffness, driving_force
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.scheme import Scheme
from theory.marches import OMEGA, beam, followed, march, stiffness
from theory.rows import order
from theory.specimens import QUICK_LAW, chain, elastic, jittered_beam, laminated_beam

SPECIMEN = Geometry(b=25e-3, B=56e-3, e=25e-3, h=250e-3, mass=0.6, mobile_mass=0.235)  # the paper's
PRISM = Geometry(b=40e-3, B=40e-3, e=25e-3, h=250e-3, mass=0.6, mobile_mass=0.235)
RIGID_IN_SHEAR = 1e4  # tangential over normal stiffness: Euler-Bernoulli's beam knows no shear
MODULUS = 1e10  # Pa


def test_rigid_motion(row):
    """All bodies turn and drift as one: bonds between them stay shut, and no reaction does any net work."""
    specimen = jittered_beam()
    network, rng = specimen.network, np.random.default_rng(3)
    position = np.concatenate([specimen.position, [[0.0, 0.0, specimen.geometry.h]]])
    operator = opening_operator(network.first, network.second, network.frame, network.point, position)
    drift, spin = rng.normal(size=(2, 3))
    velocity = np.hstack([drift + np.cross(spin, position), np.tile(spin, (len(position), 1))])
    between = np.repeat(np.maximum(network.first, network.second) < len(position), 3)  # not to the ground
    opening = operator[between] @ velocity.ravel()
    forces = (operator[between].T @ rng.normal(size=opening.size)).reshape(-1, 6)
    force = forces[:, :3].sum(axis=0)
    torque = (forces[:, 3:] + np.cross(position, forces[:, :3])).sum(axis=0)
    source = "rigid-body kinematics; actio = reactio"
    row("rigid motion of a bonded beam, largest opening", 0.0, np.abs(opening).max(), 1e-13, source)
    row("reactions of a bonded beam, sum of forces", 0.0, np.abs(force).max(), 1e-12, source)
    row("reactions of a bonded beam, sum of torques", 0.0, np.abs(torque).max(), 1e-12, source)


def test_chain_of_bonds(row):
    """n equal masses on equal springs, the last to the wall: force at the driven end by transfer matrices."""
    system, omega, n = chain(6, 2e-3, 0.3), 4e3, 6
    stiffness, inertia = 2e-3 * MODULUS, -0.3 * omega**2
    seen = stiffness  # of the wall's spring, then a mass and a spring in series with it, n - 1 times
    for _ in range(n - 1):
        seen = 1.0 / (1.0 / stiffness + 1.0 / (seen + inertia))
    expected = seen + inertia
    found = driving_force(system, MODULUS, omega).real
    row("chain of six masses and bonds, dynamic stiffness", expected, found, 1e-12, "transfer matrices")


def test_hanging_chain(row):
    """Hung up in a Maxwell law it creeps: the lowest body sinks by the sum over the bonds below which it hangs."""
    n, weight, load = 4, 2e-3, 3.0
    system, law = chain(n, weight, 1e-9, load), BondLaw(MODULUS, 1e9, np.array([]), np.array([]))
    state, dt, steps = CondensedState.at_rest(system, law), 1e-4, 400
    # next to no inertia, so that the chain creeps and does not swing
    system = replace(system, driven=n - 1, mass=np.append(np.full(n - 1, 1e-9), 1.0))
    stepper = CondensedStepper(system, law, dt, state)
    for _ in range(steps):
        stepper.advance(0.0)
    pulled = load * (n - 1) * n / 2  # the free ends' bonds carry one, two, ... loads
    expected, found = pulled / weight * (1.0 / MODULUS + steps * dt / 1e9), state.displacement[0]
    row("chain of bodies hung on Maxwell bonds, creep", expected, found, 1e-6, "J(t) = 1/E + t/eta")


def test_held_chain(row):
    """Between two supports, each body loaded alike: the head bears its own load and half of the others."""
    n, load, law = 6, 3.0, elastic(MODULUS)
    system = chain(n, 2e-3, 1e-9, load)
    stepper = CondensedStepper(system, law, 1e-2, CondensedState.at_rest(system, law))
    expected, force = -load * (n + 1) / 2, [stepper.advance(0.0) for _ in range(3)][-1]
    row("chain between two supports, force of the head (N)", expected, force, 1e-9, "symmetry")


@pytest.mark.slow
def test_oscillator(row):
    """A mass on an elastic bond, let go: amplitude and phase after four periods; second order and first."""
    errors: dict[str, list[float]] = {"euler": [], "fitted": []}
    omega, source = np.sqrt(2e-3 * MODULUS / 0.2), "m u'' + k u = 0"
    for name, found in errors.items():
        for steps in (400, 800):
            dt = 2 * np.pi / omega / steps
            system, scheme = chain(2, 2e-3, 0.2), Scheme.named(name, 0.0)
            law, state = elastic(MODULUS), CondensedState.at_rest(chain(2, 2e-3, 0.2), elastic(MODULUS))
            # the bond to the driven body is all but cut: the other bond and the mass swing free of it
            system = replace(system, weight=np.array([1e-30, 1.0, 1.0, 2e-3, 1.0, 1.0]))
            state.velocity[1] = 1.0
            march = March(CondensedStepper(system, law, dt / scheme.a, state), scheme, law, dt)
            for _ in range(4 * steps):
                march.move_to(0.0)
            found.append(abs(state.velocity[1] - 1.0))
    row("oscillator, order in dt of implicit Euler", 1.0, order(errors["euler"]), 0.1, source)
    row("oscillator, order in dt of the two-step scheme", 2.0, order(errors["fitted"]), 0.1, source)


def test_timoshenko(row):
    """Cantilever under a tip load: sum over the cuts exactly, the continuous beam in second order."""
    shear, source = 0.02, "Timoshenko: F L^3/(3 E I) + F L/(k G A)"
    inertia, area, length = PRISM.e * PRISM.B**3 / 12, PRISM.e * PRISM.B, PRISM.h
    exact = 1.0 / (length**3 / (3 * MODULUS * inertia) + length / (shear * MODULUS * area))
    beams = [laminated_beam(PRISM, slices, shear) for slices in (10, 20, 40)]
    found = np.array([driving_force(one, MODULUS, 0.0).real for one in beams])
    arm = length - (np.arange(10) + 0.5) * length / 10
    cut = length / 10 / (MODULUS * inertia), length / 10 / (shear * MODULUS * area)
    discrete = 1.0 / ((cut[0] * arm**2).sum() + 10 * cut[1])
    row("beam of bonds in ten cuts, stiffness", discrete, found[0], 1e-9, "virtual work over the cuts")
    row("beam of bonds in forty cuts, stiffness", exact, found[-1], 1e-3, source)
    row("beam of bonds, order in the length of a slice", 2.0, order(found - exact), 0.05, source)


def test_euler_bernoulli(row):
    found = driving_force(laminated_beam(PRISM, 80, RIGID_IN_SHEAR), MODULUS, 0.0).real
    expected = 3 * MODULUS * PRISM.e * PRISM.B**3 / 12 / PRISM.h**3
    row("slender beam of bonds, stiffness", expected, found, 2e-4, "Euler-Bernoulli: 3 E I/L^3")


def test_trapezoid(row):
    """Eq. (3): E = gamma F/z, the head free to rotate."""
    beam = laminated_beam(SPECIMEN, 200, RIGID_IN_SHEAR)
    found = form_factor(SPECIMEN) * driving_force(beam, MODULUS, 0.0).real
    row("trapezoid in two-point bending, form factor", MODULUS, found, 1e-4, "Eq. (3), EN 12697-26")


def _deflection(height: float) -> float:
    """Of the trapezoid under a unit tip load, Euler-Bernoulli, times E e/12; double integral of the curvature."""
    h, B, taper = SPECIMEN.h, SPECIMEN.B, (SPECIMEN.b - SPECIMEN.B) / SPECIMEN.h
    return quad(lambda z: (height - z) * (h - z) / (B + taper * z) ** 3, 0.0, height)[0]


def test_moving_mass(row):
    """Below resonance the beam's inertia is that of its static shape (Rayleigh): Eq. (1) rounds it to 0.135 M."""
    tip, h = _deflection(SPECIMEN.h), SPECIMEN.h
    width = lambda z: SPECIMEN.B + (SPECIMEN.b - SPECIMEN.B) * z / h  # noqa: E731
    shape = quad(lambda z: width(z) * (_deflection(z) / tip) ** 2, 0.0, h)[0] / quad(width, 0.0, h)[0]
    beam, omega = laminated_beam(SPECIMEN, 200, RIGID_IN_SHEAR), 60.0
    drop = driving_force(beam, MODULUS, 0.0).real - driving_force(beam, MODULUS, omega).real
    found = drop / omega**2
    expected, source = shape * SPECIMEN.mass + SPECIMEN.mobile_mass, "Rayleigh's quotient of the static shape"
    row("trapezoid in two-point bending, mass at the head (kg)", expected, found, 1e-3, source)
    row("the same by Eq. (1) (kg)", mass_factor(SPECIMEN), found, 0.03, "mu = 0.135 M + m, EN 12697-26")


def test_rig_devices(row):
    """Spring and mass at the head, clamp to the actuator: stiffnesses in parallel and in series."""
    steps, source = 100, "1/(C + 1/(H + k - m omega^2))"
    sine = 1e-6 * np.sin(2 * np.pi / steps * np.arange(1, 4 * steps + 1))
    for name, devices in (
        ("guide spring", HeadDevices(0.0, 1e5)),
        ("moving mass", HeadDevices(0.0, 0.0, 0.0, 2.0)),
        ("clamp", HeadDevices(2e-6)),
        ("clamp and guide spring", HeadDevices(2e-6, 1e5)),
    ):
        head = driving_force(beam(), QUICK_LAW.discrete_modulus(OMEGA, 0.0), OMEGA)
        clamp, spring, _, mass = devices.of_head
        exact = 1 / (clamp + 1 / (head + spring - mass * OMEGA**2))
        run = march(beam(), QUICK_LAW, 2 * np.pi / OMEGA / steps, "fitted", devices=devices)
        found = stiffness(followed(run, sine), steps, 1e-6)
        row(f"rig with a {name}, apparent |F/z|", abs(exact), abs(found), 1e-5, source)
        other = actuator_stiffness(head, devices, OMEGA)
        phase, apart = np.angle(exact), "the same, frequency domain"
        row(f"rig with a {name}, phase (rad)", phase, np.angle(other), 1e-12, apart)
