from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.forecasting.forecast import Networks, Settings, forecast, modulus_of
from asphalt_nscd.forecasting.levels import levels_of
from asphalt_nscd.forecasting.network import SKIN, Physics, bond_stiffness, contents_of, films_of, level_map
from asphalt_nscd.forecasting.packing import LARGEST
from asphalt_nscd.forecasting.recipe import recipe_of
from asphalt_nscd.forecasting.rivals import mori_tanaka
from asphalt_nscd.forecasting.static_map import RATIOS, fit_map
from asphalt_nscd.forecasting.written import law_of_mix, points, summary
from asphalt_nscd.nscd.bonds.statics import Statics, static_motion
from asphalt_nscd.specimen.prism import pulled_system, stretched

BULK = 2.5e9


@pytest.fixture(scope="module")
def contents(packing):
    return contents_of(packing)


@pytest.fixture(scope="module")
def mortar(recipe):
    """As coarse as mortar, with fewer grains than the lattice holds where they touch."""
    return replace(levels_of(recipe)[1], fraction=0.45)


def hashin_shtrikman(recipe, level, modulus):
    """Lower and upper bound of E [Pa] of stiff grains in a matrix of E = modulus and the bulk modulus used."""
    stone = recipe.aggregate
    bulk = BULK + modulus / stone.modulus * (stone.bulk - BULK)
    shear = 3 * bulk * modulus / (9 * bulk - modulus)
    bounds = []
    for (k1, g1, c1), (k2, g2, c2) in (
        ((bulk, shear, 1 - level.fraction), (stone.bulk, stone.shear, level.fraction)),
        ((stone.bulk, stone.shear, level.fraction), (bulk, shear, 1 - level.fraction)),
    ):
        k = k1 + c2 / (1 / (k2 - k1) + 3 * c1 / (3 * k1 + 4 * g1))
        g = g1 + c2 / (1 / (g2 - g1) + 6 * c1 * (k1 + 2 * g1) / (5 * g1 * (3 * k1 + 4 * g1)))
        bounds.append(9 * k * g / (3 * k + g))
    return bounds


def test_grains_of_two_sizes_fill_what_a_count_of_points_says(packing):
    small = np.arange(packing.radius.size) % 2 == 0
    radius = np.where(small, 0.6, 1.0) * packing.radius
    found = contents_of(replace(packing, radius=radius))
    shape = found.prism.geometry
    point = SKIN * LARGEST + np.random.default_rng(5).random((10000, 3)) * [shape.h, shape.e, shape.b]
    inside = (np.linalg.norm(point[:, None] - packing.position, axis=2) < radius).any(axis=1)
    assert found.solid_fraction == pytest.approx(inside.mean(), abs=0.01)
    assert 0.25 < found.solid_fraction < 0.35


@pytest.mark.parametrize("physics", [Physics(), Physics(film=6e-6), Physics(squeezed=False)])
def test_one_material_is_itself(recipe, contents, mortar, physics):
    found = level_map(contents, mortar, recipe.aggregate, BULK, physics)
    assert found(1.0) == pytest.approx(1.0, abs=0.04)


def test_bounds_hold_at_every_modulus(recipe, contents, mortar):
    found = level_map(contents, mortar, recipe.aggregate, BULK, Physics(film=6e-6))
    for ratio in RATIOS[:-1]:
        low, high = hashin_shtrikman(recipe, mortar, ratio * recipe.aggregate.modulus)
        assert 0.9 * low < found(ratio) * recipe.aggregate.modulus < high


def test_grains_that_touch_keep_the_film(recipe, contents, mortar):
    apart, none = films_of(contents, mortar, Physics())
    close, touching = films_of(contents, mortar, Physics(film=6e-6))
    assert touching.sum() == 7**2 * 6 * 3  # pairs of the 7 x 7 x 7 spheres that are left inside
    assert close.gap[touching] == pytest.approx(6e-6 * 10e-3 / mortar.largest)
    assert close.length == pytest.approx(apart.length)
    assert (none == touching).all()
    assert (close.gap[~touching] == apart.gap[~touching]).all()


def test_soft_matrix_feels_each_part_of_the_physics(recipe, contents, mortar):
    def soft(**physics):
        return level_map(contents, mortar, recipe.aggregate, BULK, Physics(**physics))(1e-6).real

    touching = soft(film=6e-6)
    assert touching > 1.5 * soft()
    assert soft(film=6e-6, squeezed=False) < touching
    assert soft(film=6e-6, loosening=0.01) < touching
    assert soft(film=6e-6, void_share=0.1) < touching
    assert soft(film=6e-6, skeleton_pressure=1e4) > touching


def test_dry_skeleton_is_hertz_on_a_cubic_lattice(recipe, contents, mortar):
    # Along a lattice direction E = k / d, k = 2 E' a, a^3 = 3 F R / (4 E'), each contact under F = 3 p V / sum(d).
    stone, pressure, d = recipe.aggregate, 1e4, 10e-3
    plane = stone.modulus / (2 * (1 - stone.poisson**2))
    prism = contents.prism
    volume = prism.geometry.b * prism.geometry.e * prism.geometry.h
    force = 3 * pressure * volume / (882 * d)
    stiffness = 2 * plane * (0.75 * force * d / 4 / plane) ** (1 / 3)
    found = level_map(contents, mortar, stone, BULK, Physics(film=6e-6, skeleton_pressure=pressure))
    section = prism.geometry.b * prism.geometry.e
    assert found.constant * stone.modulus == pytest.approx(49 * stiffness * d / section, rel=0.08)


def test_map_of_real_moduli_holds_for_complex_ones():
    def truth(x):
        return 2e-4 + 0.3 * x + 5.0 * x / (1 + x / 3e-4) + 0.7 * x / (1 + x / 0.05)

    found = fit_map(truth(RATIOS))
    x = np.geomspace(1e-6, 0.5, 9) * np.exp(0.4j * np.pi)
    assert found.error < 2e-3
    assert np.log(found(x)) == pytest.approx(np.log(truth(x)), abs=5e-3)


def test_twice_as_many_ratios_leave_a_tenth_of_the_error():
    """Of x^0.6, a Stieltjes function whose poles lie everywhere, as those of a real network do."""
    x = np.geomspace(1e-5, 0.1, 9) * np.exp(0.25j * np.pi)
    dense = np.geomspace(RATIOS[0], RATIOS[-1], 2 * RATIOS.size - 1)
    twelve, more = (np.abs(fit_map(at**0.6, at)(x) / x**0.6 - 1.0).max() for at in (RATIOS, dense))
    assert 1e-3 < twelve < 1e-2 and more < 0.1 * twelve


@pytest.fixture(scope="module")
def found(recipe, networks):
    return forecast(recipe, networks, seeds=(1,))


def test_forecast_has_a_band_that_holds_it(found):
    frame = points(found)
    assert (frame["E_low_MPa"] < frame["E_MPa"]).all()
    assert (frame["E_MPa"] < frame["E_high_MPa"]).all()
    assert frame["E_MPa"].is_monotonic_increasing
    assert set(found.deviation) == {"aggregate", "film_factor", "skeleton_pressure", "voids"}
    assert summary(found)["levels"][1]["grains_touch"] is True


def test_stiffer_stone_and_drier_mixes_are_stiffer(found):
    assert (found.deviation["aggregate"].real >= 0.0).all()
    assert (found.deviation["voids"].real < 0.0).all()
    assert (found.deviation["film_factor"].real < 0.0).all()
    assert (found.deviation["skeleton_pressure"].real < 0.0).all()


def test_forecast_lies_above_the_mean_field_of_apart_grains(found, recipe):
    assert (abs(found.modulus) > abs(mori_tanaka(recipe))).all()


def test_law_of_the_mix_follows_the_forecast(found, tmp_path):
    from asphalt_nscd.api.laws import Law

    law = Law(law_of_mix(found))
    frequency = found.recipe.frequency
    assert np.log(law.complex_modulus(frequency) / found.modulus) == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize("other", [Physics(), Physics(film=6e-6, void_share=0.3)])
def test_factors_left_by_other_films_change_no_map(recipe, contents, mortar, other):
    physics = Physics(film=6e-6, void_share=0.1, skeleton_pressure=1e4)
    prism, stone = contents.prism, recipe.aggregate
    system = pulled_system(prism, np.zeros(3 * prism.network.first.size))
    values = []
    for weight in bond_stiffness(contents, mortar, stone, BULK, physics, RATIOS) / stone.modulus:
        pulled = replace(system, weight=weight)
        values.append(stretched(prism, pulled, static_motion(pulled))[0])
    level_map(contents, mortar, stone, BULK, other)
    found = level_map(contents, mortar, stone, BULK, physics)
    assert found(RATIOS) == pytest.approx(fit_map(np.array(values))(RATIOS), rel=1e-7)


def test_static_motion_that_is_not_found_is_no_motion(contents):
    prism = contents.prism
    system = pulled_system(prism, np.ones(3 * prism.network.first.size))
    with pytest.raises(ArithmeticError, match="not found"):
        Statics(system, 1e-30, 2, 2).motion(system.weight)


@pytest.mark.parametrize("temperatures", [[20], [5, 20], [0, 10, 20]])
def test_a_shifted_binder_gives_a_law_at_few_temperatures(content, networks, temperatures):
    from asphalt_nscd.api.laws import Law

    content["binder"] |= {"reference_temperature_C": 15, "shift": {"wlf_C1": 20, "wlf_C2_K": 150}}
    asked = recipe_of(content | {"temperatures_C": temperatures, "angular_frequencies_rad_s": [10.0]})
    made = forecast(asked, networks, seeds=(1,))
    law = Law(law_of_mix(made))
    found = law.complex_modulus(asked.frequency, asked.temperature)
    assert np.log(found / made.modulus) == pytest.approx(0.0, abs=0.05)


def test_maps_are_solved_once(recipe, packing, monkeypatch):
    from asphalt_nscd.forecasting import forecast as module

    solved = []
    real = module.level_map
    monkeypatch.setattr(module, "level_map", lambda *args: solved.append(args) or real(*args))
    networks = Networks(lambda level, seed: packing)
    levels = networks.chain(recipe, Settings(), 1)
    again = networks.chain(recipe, Settings(skeleton_pressure=1e3), 1)
    assert len(solved) == 4  # three, and the coarsest anew
    binder = recipe.binder_modulus()
    assert (
        abs(modulus_of(again, recipe.aggregate, binder)) < abs(modulus_of(levels, recipe.aggregate, binder))
    ).all()
