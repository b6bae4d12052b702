"""Bonds that are films between spheres: limits that theory knows."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.forecasting.film import (
    Films,
    Matrix,
    Solid,
    bulk_modulus,
    deviatoric_stiffness,
    film_stiffness,
)

GRAIN = Solid(60e9, 0.2)
RIGID = Solid(60e15, 0.2)
FRACTION = 0.5


def pairs(gap: float = 0.05, ratio: float = 1.0, share: float = 0.8) -> Films:
    """One film of spheres of 1 mm and `ratio` mm; gap and facet relative to the smaller and its section."""
    small = 1e-3 * min(ratio or 1.0, 1.0)
    return Films(*np.array([[1e-3], [1e-3 * ratio], [gap * small], [share * np.pi * small**2]]))


def bitumen(modulus) -> Matrix:
    return Matrix(np.asarray(modulus), 2.5e9)


@pytest.mark.parametrize("ratio", [1.0, 0.3, 0.0])
@pytest.mark.parametrize("gap", [0.003, 0.3, 3.0])
def test_one_material_is_the_homogeneous_bond(gap, ratio):
    films, same = pairs(gap, ratio), Matrix(np.array(60e9), GRAIN.bulk)
    for stiffness in film_stiffness(films, GRAIN, same, FRACTION):
        np.testing.assert_allclose(stiffness, 60e9 * films.area / films.length, rtol=1e-12)
    for stiffness in deviatoric_stiffness(films, GRAIN, same):
        np.testing.assert_allclose(stiffness, 2.0 * GRAIN.shear * films.area / films.length, rtol=1e-12)


def test_soft_film_is_proportional_to_its_modulus():
    for stiffness in film_stiffness(pairs(), RIGID, Matrix(np.array([1.0, 1e3]), 1e15), FRACTION):
        np.testing.assert_allclose(stiffness[1] / stiffness[0], 1e3, rtol=1e-6)


def test_thin_compressible_film_is_a_layer():
    """Where the film cannot flow out, its bulk modulus carries the load."""
    films = pairs(1e-4)
    confined = [
        deviatoric_stiffness(films, RIGID, Matrix(np.array(1e6), bulk))[0][0] for bulk in (1e6, 2e6, 1e15)
    ]
    assert 1.3 < confined[1] / confined[0] < 2.0 and confined[2] > 20.0 * confined[1]


def test_thin_film_is_as_stiff_as_its_grains_allow():
    """Elastic grains limit a film ever thinner: less than a fifth of the rigid film's stiffness."""
    thin = pairs(1e-5)
    soft, hard = (deviatoric_stiffness(thin, grain, bitumen(6e5))[0][0] for grain in (GRAIN, RIGID))
    assert soft < 0.2 * hard


def test_stiffness_grows_with_the_modulus_and_falls_with_the_gap():
    gaps = np.geomspace(0.003, 0.3, 9)
    films = Films(np.full(9, 1e-3), np.full(9, 5e-4), gaps * 5e-4, np.full(9, 6e-7))
    modulus = 60e9 * np.geomspace(1e-5, 0.05, 15)
    for stiffness in film_stiffness(films, GRAIN, bitumen(modulus), FRACTION):
        assert stiffness.shape == (15, 9)
        assert (np.diff(stiffness, axis=0) > 0.0).all() and (np.diff(stiffness, axis=1) < 0.0).all()


def test_order_of_the_spheres_does_not_matter():
    films = pairs(0.02, 0.2)
    turned = Films(films.second_radius, films.first_radius, films.gap, films.area)
    for one, other in zip(*(film_stiffness(of, GRAIN, bitumen(6e7), FRACTION) for of in (films, turned))):
        np.testing.assert_allclose(one, other, rtol=1e-13)


def test_complex_modulus():
    """Correspondence: a real modulus written as a complex one; a lossy film lags less than its binder."""
    real = film_stiffness(pairs(), GRAIN, bitumen(6e7), FRACTION)
    same = film_stiffness(pairs(), GRAIN, bitumen(6e7 + 0j), FRACTION)
    lossy = film_stiffness(pairs(), GRAIN, bitumen(6e7 * np.exp(0.8j)), FRACTION)
    for a, b, c in zip(real, same, lossy):
        np.testing.assert_allclose(a, b, rtol=1e-12)
        assert (0.1 < np.angle(c)).all() and (np.angle(c) < 0.8).all()


def test_more_rings_change_little():
    films = [pairs(gap, ratio) for gap in (0.003, 0.3) for ratio in (1.0, 0.1)]
    one = [deviatoric_stiffness(film, GRAIN, bitumen(6e5))[0][0] for film in films]
    fine = [deviatoric_stiffness(film, GRAIN, bitumen(6e5), rings=200)[0][0] for film in films]
    np.testing.assert_allclose(one, fine, rtol=0.01)


def test_bulk_modulus_without_and_with_nothing_but_grains():
    matrix = bitumen([6e6, 6e8])
    np.testing.assert_allclose(bulk_modulus(GRAIN, matrix, 0.0), 2.5e9)
    np.testing.assert_allclose(bulk_modulus(GRAIN, matrix, 1.0), GRAIN.bulk)


def test_grains_that_touch_have_no_film():
    with pytest.raises(ValueError, match="a film needs a gap"):
        pairs(0.0)
