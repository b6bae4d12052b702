"""A recipe."""

from __future__ import annotations

import pytest

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
