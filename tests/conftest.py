"""Small specimens shared by the tests: beams built from a jittered lattice, not poured."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds import BondedSystem
from asphalt_nscd.nscd.law import BondLaw
from asphalt_nscd.specimen.network import bond_network
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen
from asphalt_nscd.twopoint import Geometry

# Moduli of Table 3 at 15 degC, viscosities lowered until transients die within two cycles at 40 Hz
# (relaxation times below 3 ms), so that a short test reaches its steady state to 1e-9.
QUICK_LAW = BondLaw(24.3e9, 0.06e9, np.array([48.4e9]), np.array([0.077e9]))


def jittered_beam(
    seed: int = 1, shape: tuple[int, int, int] = (3, 2, 9), spacing: float = 4e-3, fill: float = 0.42,
    reach: float = 2e-3,
) -> Specimen:  # fmt: skip
    """A prismatic beam of spheres on a cubic lattice, each moved within its cell.

    fill: largest radius over `spacing` [m]; a sphere stays inside its cell, so that none overlap.
    """
    rng = np.random.default_rng(seed)
    cells = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3)
    radius = spacing * fill * rng.uniform(0.8, 1.0, len(cells))
    slack = 0.98 * (0.5 * spacing - radius)[:, None]
    position = spacing * (cells + 0.5) + slack * rng.uniform(-1.0, 1.0, cells.shape)
    width, thickness, height = spacing * np.array(shape)
    position -= np.array([width / 2, thickness / 2, 0.0])
    network = bond_network(position, radius, height, reach)
    geometry = Geometry(b=width, B=width, e=thickness, h=height, mass=4e-3, mobile_mass=2e-3)
    density = geometry.mass / float((4 / 3 * np.pi * radius**3).sum())
    return Specimen(geometry, position, radius, density, network, 0)


@pytest.fixture(scope="session")
def make_beam() -> Callable[..., Specimen]:
    return jittered_beam


@pytest.fixture(scope="session")
def quick_law() -> BondLaw:
    return QUICK_LAW


@pytest.fixture(scope="session")
def beam() -> Specimen:
    return jittered_beam()


@pytest.fixture(scope="session")
def beam_system(beam: Specimen) -> BondedSystem:
    return bending_system(beam, poisson=0.35, yield_stress=2.7e6, friction=0.7)
