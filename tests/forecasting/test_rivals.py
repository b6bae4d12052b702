from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.forecasting.levels import levels_of
from asphalt_nscd.forecasting.recipe import Grading, recipe_of
from asphalt_nscd.forecasting.rivals import hirsch, mori_tanaka, self_consistent, witczak
from asphalt_nscd.measurements.units import PSI


def test_dilute_grains_stiffen_a_flowing_matrix_as_einstein_says(content):
    """1 + 2.5 phi for rigid spheres in an incompressible matrix."""
    content["binder_percent_by_mass"], content["air_voids_percent"] = 20, 0
    recipe = recipe_of(content)
    recipe = replace(recipe, binder=replace(recipe.binder, glassy_modulus=1e3))
    diluted = replace(
        recipe, binder_share=0.98, grading=Grading(np.array([2.1e-3, 10e-3]), np.array([1e-9, 1.0]))
    )
    (level,) = levels_of(diluted)[-1:]
    for rival in (mori_tanaka, self_consistent):
        amplified = (rival(diluted) / diluted.binder_modulus()).real
        assert amplified == pytest.approx(1 + 2.5 * level.fraction, rel=2e-3)


def test_hirsch_at_a_point_worked_by_hand(recipe):
    stone, binder = 0.946 / 2670, 0.054 / 1040
    air = 0.06
    vma = 100 * ((1 - air) * binder / (stone + binder) + air)
    vfa = 100 * (vma - 6) / vma
    g = abs(recipe.binder_modulus()[2]) / 3 / 6894.757
    x = vfa * 3 * g / vma
    pc = (20 + x) ** 0.58 / (650 + x**0.58)
    psi = pc * (4.2e6 * (1 - vma / 100) + 3 * g * vfa * vma / 10000) + (1 - pc) / (
        (1 - vma / 100) / 4.2e6 + vma / (3 * vfa * g)
    )
    found = hirsch(recipe)[2]
    assert abs(found) == pytest.approx(psi * PSI, rel=1e-6)
    assert np.degrees(np.angle(found)) == pytest.approx(-21 * np.log10(pc) ** 2 - 55 * np.log10(pc), rel=1e-6)


def test_regressions_lose_stiffness_with_air(recipe):
    airy = replace(recipe, voids=0.09)
    for rival in (hirsch, witczak, mori_tanaka):
        assert (abs(rival(airy)) < abs(rival(recipe))).all()
