"""Bonds that are films between spheres: limits that theory knows."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.forecast.film import Films, Solid, film_stiffness

GRAIN = Solid(60e9, 0.2)
BITUMEN = 2.5e9  # bulk modulus, Pa


def pairs(gap: float = 0.05, ratio: float = 1.0, share: float = 0.8) -> Films:
    """One film of spheres of 1 mm and `ratio` mm; gap and facet relative to the smaller and its section."""
    small = 1e-3 * min(ratio or 1.0, 1.0)
    return Films(*np.array([[1e-3], [1e-3 * ratio], [gap * small], [share * np.pi * small**2]]))


@pytest.mark.parametrize("ratio", [1.0, 0.3, 0.0])
@pytest.mark.parametrize("gap", [0.003, 0.3, 3.0])
def test_one_material_is_the_homogeneous_bond(gap, ratio):
    films = pairs(gap, ratio)
    length = films.first_radius + films.second_radius + films.gap
    for stiffness in film_stiffness(films, GRAIN, np.array(60e9), GRAIN.bulk):
        np.testing.assert_allclose(stiffness, 60e9 * films.area / length, rtol=1e-12)


@pytest.mark.parametrize("ratio", [1.0, 0.3, 0.0])
def test_soft_thin_film_is_lubricated(ratio):
    """Brenner 1961: 6 pi mu a^2 / h; pairs whose common pressure is added have 6/5 of their Young's modulus."""
    films = pairs(1e-4, ratio)
    a = 1e-3 * (ratio / (1.0 + ratio) if ratio else 1.0)
    normal, _ = film_stiffness(films, Solid(60e15, 0.2), np.array(3.0), 1e20)
    assert normal[0] == pytest.approx(1.2 * 6.0 * np.pi * a**2 / films.gap[0], rel=0.02)


def test_soft_film_is_proportional_to_its_modulus():
    weak = film_stiffness(pairs(), Solid(60e15, 0.2), np.array([1.0, 1e3]), 1e15)
    for stiffness in weak:
        np.testing.assert_allclose(stiffness[1] / stiffness[0], 1e3, rtol=1e-6)


def test_thin_compressible_film_is_a_layer():
    """Where the film cannot flow out, its bulk modulus carries the load."""
    films = pairs(1e-4)
    confined = [film_stiffness(films, Solid(60e15, 0.2), np.array(1e6), bulk)[0][0] for bulk in (1e6, 2e6)]
    assert 1.3 < confined[1] / confined[0] < 2.0


def test_stiffness_grows_with_the_modulus_and_falls_with_the_gap():
    gaps = np.geomspace(0.003, 0.3, 9)
    films = Films(np.full(9, 1e-3), np.full(9, 5e-4), gaps * 5e-4, np.full(9, 6e-7))
    modulus = 60e9 * np.geomspace(1e-5, 0.05, 15)
    for stiffness in film_stiffness(films, GRAIN, modulus, BITUMEN):
        assert stiffness.shape == (15, 9)
        assert (np.diff(stiffness, axis=0) > 0.0).all() and (np.diff(stiffness, axis=1) < 0.0).all()


def test_order_of_the_spheres_does_not_matter():
    films = pairs(0.02, 0.2)
    turned = Films(films.second_radius, films.first_radius, films.gap, films.area)
    for one, other in zip(*(film_stiffness(of, GRAIN, np.array(6e7), BITUMEN) for of in (films, turned))):
        np.testing.assert_allclose(one, other, rtol=1e-13)


def test_complex_modulus():
    """Correspondence: a real modulus written as a complex one; a lossy film lags less than its binder."""
    real = film_stiffness(pairs(), GRAIN, np.array(6e7), BITUMEN)
    same = film_stiffness(pairs(), GRAIN, np.array(6e7 + 0j), BITUMEN)
    lossy = film_stiffness(pairs(), GRAIN, np.array(6e7 * np.exp(0.8j)), BITUMEN)
    for a, b, c in zip(real, same, lossy):
        np.testing.assert_allclose(a, b, rtol=1e-12)
        assert (0.1 < np.angle(c)).all() and (np.angle(c) < 0.8).all()


def test_grains_that_touch_have_no_film():
    with pytest.raises(ValueError, match="a film needs a gap"):
        pairs(0.0)
