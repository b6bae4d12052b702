"""A recipe, and packings that need no pouring: spheres about a lattice, the outermost inside the box."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.forecasting.forecast import Networks
from asphalt_nscd.forecasting.packing import LARGEST, LevelPacking
from asphalt_nscd.forecasting.recipe import recipe_of

CONTENT = {
    "name": "a hot mix",
    "binder": {
        "E00_MPa": 1e-7,
        "E0_MPa": 1000,
        "delta": 2.2,
        "k": 0.22,
        "h": 0.63,
        "beta": 50,
        "tau_s": 0.001945,
    },
    "binder_percent_by_mass": 5.4,
    "air_voids_percent": 6,
    "density_kg_m3": {"aggregate": 2670, "binder": 1040},
    "aggregate": {"E_GPa": 60, "poisson": 0.2},
    "grading": {10: 100, 6: 72.324, 4: 56.062, 2: 41.238, 0.063: 8.77},
    "angular_frequencies_rad_s": [5e-4, 1.7e-2, 0.55, 18.0, 300.0],
}


@pytest.fixture
def content():
    return {name: dict(value) if isinstance(value, dict) else value for name, value in CONTENT.items()}


@pytest.fixture(scope="session")
def recipe():
    return recipe_of(CONTENT)


@pytest.fixture(scope="session")
def packing():
    """Touching spheres of one size on a cubic lattice, 9 x 9 x 9."""
    radius = LARGEST / 2.0
    at = radius + LARGEST * np.stack(np.meshgrid(*3 * [np.arange(9)], indexing="ij"), axis=-1).reshape(-1, 3)
    jitter = 1e-3 * LARGEST * np.random.default_rng(1).standard_normal(at.shape)
    box = np.full(3, 9.0 * LARGEST)
    return LevelPacking(at + jitter, np.full(len(at), radius), box, 1, np.pi / 6.0, 6.0)


@pytest.fixture(scope="session")
def networks(packing):
    """Of this packing at every level; each map is solved once for all tests."""
    return Networks(lambda level, seed: packing)
