"""Grains that touch beside their films: one contact against Hertz and Mindlin; a network against what it must obey."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy import sparse

from asphalt_nscd.bending.cycles import CyclicTest, run_cycles
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.skeleton import Grip, Skeleton
from asphalt_nscd.rheology.as_run import Programme
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.specimen.prism import pulled_system
from theory.specimens import jittered_beam

PRELOAD, FRICTION = 2.0, 0.4  # N
RADIUS, PLANE, SLIDING = 3e-3, 31e9, 8.0 / 9.0
NO_FILM = BondLaw(1.0, np.inf, np.empty(0), np.empty(0))
POWER = 0.3  # of the films, over frequency


def contact(driven: int) -> tuple[BondedSystem, Skeleton]:
    """A grain that moves along z (0) and x (1), pressed on a plate; no mass and next to no film."""
    ones = np.ones(2)
    operator = sparse.csr_matrix(np.eye(3, 2))
    system = BondedSystem(
        operator, 1e-3 * np.ones(3), 1e-9 * ones, 0.0 * ones, driven, np.zeros(1), np.full(1, np.inf), 0.0
    )
    overlap = (PRELOAD / (4.0 / 3.0 * PLANE * np.sqrt(RADIUS))) ** (2.0 / 3.0)
    return system, Skeleton(
        np.zeros(1, int), np.array([RADIUS]), np.array([overlap]), PLANE, SLIDING, FRICTION
    )


def test_hertz(row):
    """Pressed to twice the preload and back, and pulled until it nearly opens."""
    for force, haversine in ((0.5 * PRELOAD, True), (0.95 * PRELOAD, False)):
        system, skeleton = contact(0)
        test = run_cycles(
            system, NO_FILM, skeleton, 1.0, force, Programme(haversine, cycles=1, read=1, samples=60)
        )
        own = (0.75 * (PRELOAD + test.force) / (PLANE * np.sqrt(RADIUS))) ** (2.0 / 3.0)
        moved = own - skeleton.overlap[0]
        off = np.abs(test.displacement - moved).max() / np.abs(moved).max()
        row(
            f"Hertz, {'pressed' if haversine else 'pulled'} by {force:g} N, error",
            0.0,
            off,
            1e-4,
            "Hertz 1882",
        )


def test_mindlin(row):
    """Sheared to 0.8 of the limit and back: Cattaneo and Mindlin on the way out, Masing's rule on the way back."""
    system, skeleton = contact(1)
    limit = FRICTION * PRELOAD
    programme = Programme(haversine=False, cycles=2, read=1, samples=200)
    test = run_cycles(system, NO_FILM, skeleton, 1.0, 0.8 * limit, programme)
    stiffness = skeleton.stiffness(skeleton.overlap)[1]
    most = 1.5 * limit / stiffness

    def out(share: np.ndarray) -> np.ndarray:
        return most * (1.0 - (1.0 - share) ** (2.0 / 3.0))

    share = test.force / limit
    first, back = slice(0, 51), slice(50, 151)
    source = "Mindlin & Deresiewicz 1953"
    for name, part, expected in (
        ("loading", first, out(share[first])),
        ("unloading", back, out(np.array(0.8)) - 2.0 * out(0.5 * (0.8 - share[back]))),
    ):
        off = np.abs(test.displacement[part] - expected).max() / out(np.array(0.8))
        row(f"sheared contact, {name}, error over its largest displacement", 0.0, off, 0.01, source)
    loss = 1.0 - 0.2 ** (5.0 / 3.0) - 5.0 / 6.0 * 0.8 * (1.0 + 0.2 ** (2.0 / 3.0))
    row(
        "sheared contact, loss of a cycle (J)",
        7.2 * limit**2 / stiffness * loss,
        test.taken,
        0.02,
        "Johnson 1985, Eq. 7.58",
    )


def test_unloaded(row):
    """Sheared, unloaded and sheared back: what it held beyond its new stiffness is lost, and no force is left."""
    _, skeleton = contact(1)
    loaded = skeleton.stiffness(skeleton.overlap)[1]
    shear, opening = 1e-3 * FRICTION * PRELOAD / loaded, 2.0 / 3.0 * skeleton.overlap[0]
    grip, reaction = Grip.rest(skeleton), np.zeros(3)
    for place in ([0.0, shear, 0.0], [opening, shear, 0.0], [opening, 0.0, 0.0]):
        reaction, grip = grip.moved(skeleton, np.array(place))
    unloaded = skeleton.stiffness(skeleton.overlap - opening)[1]
    source = "Thornton & Randall 1988"
    row("unloaded contact, loss (J)", 0.5 * (loaded - unloaded) * shear**2, grip.slipped, 1e-9, source)
    row("unloaded contact, force left over its largest", 0.0, reaction[1] / (loaded * shear), 1e-9, source)


@cache
def network(pressure: float, amplitude: float, softness: float = 1.0, samples: int = 32) -> CyclicTest:
    """A pulled prism of spheres; every other bond between grains has a contact beside its film."""
    prism = jittered_beam(seed=4, shape=(4, 4, 8), area="facets")
    bonds, n, of = prism.network, prism.radius.size, prism.geometry
    form = np.repeat(bonds.form, 3)
    system = pulled_system(prism, form / softness)
    touching = np.flatnonzero((bonds.first < n) & (bonds.second < n))[::2]
    one, two = prism.radius[bonds.first[touching]], prism.radius[bonds.second[touching]]
    volume = of.width * of.thickness * of.h
    skeleton = Skeleton.preloaded(touching, one * two / (one + two), bonds.length[touching], volume, pressure)
    chain, _ = kelvin_chain(lambda omega: 1e9 * (1j * omega / 6.3) ** POWER, 0.3, 30.0)
    law = BondLaw(
        chain.spring, chain.dashpot, np.array(chain.kelvin_springs), np.array(chain.kelvin_dashpots)
    )
    programme = Programme(haversine=False, cycles=4, read=2, drift=True, samples=samples)
    size = 1e9 / softness * of.width * of.thickness
    return run_cycles(system, law, skeleton, 1.0, amplitude * size, programme)


def phase(test: CyclicTest) -> float:
    """Beyond that of the network with its contacts stuck [deg]."""
    return float(np.degrees(np.angle(test.stiffness / test.stuck)))


def test_network(row):
    """Energy, the scaling of Hertz and Mindlin in a network, and the time step."""
    test = network(10e3, 100e-6)
    assert phase(test) > 0.3
    row("network, energy taken over work of a cycle", 1.0, test.taken / test.work, 0.01, "energy")
    # eight times the pressure and twice the films: four times the displacements, twice the stiffness
    for factor in (8.0, 64.0):
        stiffer = factor ** (1.0 / 3.0)
        scaled = network(factor * 10e3, factor ** (2.0 / 3.0) * 100e-6, 1.0 / stiffer)
        name = f"network, {factor:g} times the pressure"
        source = "dimensions of Hertz contacts"
        row(f"{name}, stiffness", stiffer, abs(scaled.stiffness / test.stiffness), 0.01, source)
        row(f"{name}, phase of its contacts", phase(test), phase(scaled), 0.01, source)
    fine = network(10e3, 100e-6, samples=64)
    row("network, phase of its contacts, half the step", phase(fine), phase(test), 0.05, "refinement")


def test_stuck(row):
    """Pressed hard and hardly moved, the network is linear: its contacts are springs."""
    test = network(500e3, 1e-6)
    row("hardly moved network over its contacts stuck", 1.0, abs(test.stiffness / test.stuck), 0.01, "linear")
    assert phase(test) == pytest.approx(0.0, abs=0.1)
