"""The scheme against theory: dilute and dense suspensions, bounds, causality; and no drawn recipe has a cliff."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.contact import contact_stiffness, rings
from asphalt_nscd.forecasting.forecast import INPUTS, OF_THE_MODEL, forecast, refilled
from asphalt_nscd.forecasting.recipe import Grading, recipe_of
from asphalt_nscd.forecasting.scheme import SIZES, Settings, _filled, binder_volume, modulus_of_mix, volumes

VOLUMES = Settings(contacts=0.0, pressure=0.0)
BINDER = np.geomspace(1e4, 1e9, 11) * np.exp(0.8j)
SIEVES = np.array([0.063, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0])
# Largest sieves [mm], powers of size, filler [%], binder [%], air [%] between which recipes are drawn.
DRAWN = {
    "dense": ((8, 16), (0.35, 0.6), (4, 9), (4, 7), (2, 10)),
    "open": ((8, 16), (0.9, 1.5), (2, 5), (4, 6), (15, 24)),
    "sand": ((2, 4), (0.3, 0.5), (5, 12), (6, 10), (3, 15)),
}


def drawn_recipes(content, count):
    """So many recipes, dense, open and sand by turns."""
    rng = np.random.default_rng(1)
    for number in range(count):
        tops, *bounds = list(DRAWN.values())[number % 3]
        top = rng.choice(tops)
        power, filler, binder, air = (float(rng.uniform(*bound)) for bound in bounds)
        size = SIEVES[SIEVES <= top]
        passing = filler + (100 - filler) * ((size / top) ** power - (0.063 / top) ** power) / (
            1 - (0.063 / top) ** power
        )
        grading = dict(zip(size.tolist(), passing.round(6).tolist(), strict=True))
        own = {"grading": grading, "binder_percent_by_mass": binder, "air_voids_percent": air}
        yield recipe_of(content | own), content | own


def bounds_of(asked, binder):
    """Least and largest E, K and G [Pa] of grains, binder and air for E of the binder: Voigt, Hashin and Shtrikman.

    That of Reuss, and the lower one of Hashin and Shtrikman, are zero with air, and hold of the mix without it.
    """
    liquid, stone = binder_volume(asked), asked.aggregate
    share = np.array([1 - liquid - asked.voids, liquid, asked.voids])[:, None]
    k, g = 2.5e9 + 0 * binder, 3 * 2.5e9 * binder / (9 * 2.5e9 - binder)
    bulk, shear = (
        np.stack([of + 0 * binder, own, 0 * binder]) for of, own in ((stone.bulk, k), (stone.shear, g))
    )

    def shtrikman(most):
        around = most[1] * (9 * most[0] + 8 * most[1]) / (6 * (most[0] + 2 * most[1]))
        return (
            1 / (share / (bulk + 4 / 3 * most[1])).sum(0) - 4 / 3 * most[1],
            1 / (share / (shear + around)).sum(0) - around,
        )

    def young(bulk, shear):
        return 9 * bulk * shear / (3 * bulk + shear)

    highest = young(*shtrikman((stone.bulk, stone.shear)))
    lowest = young(*shtrikman((k, g))) if asked.voids == 0.0 else 0.0 * binder
    solids = 1 - liquid
    reuss = 1 / (solids / stone.modulus + liquid / binder) if asked.voids == 0.0 else 0.0 * binder
    voigt = share[0] * stone.modulus + share[1] * binder
    return {"voigt": voigt, "reuss": reuss, "highest": highest, "lowest": lowest}


def naive_moduli(recipe, binder, settings):
    """K and G without the dry skeleton, and E* with it (n,) [Pa], step by step as the text of `scheme` says."""
    stone, air_all = recipe.aggregate, recipe.voids
    k_stone = stone.modulus / 3 / (1 - 2 * stone.poisson)
    g_stone, plane = stone.modulus / 2 / (1 + stone.poisson), stone.modulus / 2 / (1 - stone.poisson**2)
    by_mass = (
        recipe.binder_share / recipe.binder_density,
        (1 - recipe.binder_share) / recipe.aggregate_density,
    )
    liquid = (1 - air_all) * by_mass[0] / sum(by_mass)
    solids = 1 - air_all - liquid
    filler = float(np.interp(np.log(63e-6), np.log(recipe.grading.sieve), recipe.grading.passing))

    def finer(size):
        """Grains and air finer than a size; filler evenly over the logarithm of size from 1 um, air among the rest."""
        if size <= 63e-6:
            return solids * filler * np.log(size / 1e-6) / np.log(63.0), 0.0
        share = np.interp(np.log(size), np.log(recipe.grading.sieve), recipe.grading.passing)
        return solids * share, air_all * (share - filler) / (1 - filler)

    def slopes(compliance, g, air):
        k = 1 / compliance
        around = g * (9 * k + 8 * g) / (6 * (k + 2 * g))
        dk = (1 - air) * (k_stone - k) * (3 * k + 4 * g) / (3 * k_stone + 4 * g) - air * k * (
            3 * k + 4 * g
        ) / (4 * g)
        dg = (1 - air) * (g_stone - g) * (g + around) / (g_stone + around) - air * g * (g + around) / around
        return np.array([-dk / k**2, dg])

    def put_in(k, g, air, amount, steps=12):
        y, h = np.array([1 / k, g]), amount / steps
        for _ in range(steps):
            one = slopes(*y, air)
            two = slopes(*(y + h / 2 * one), air)
            three = slopes(*(y + h / 2 * two), air)
            y = y + h / 6 * (one + 2 * two + 2 * three + slopes(*(y + h * three), air))
        return 1 / y[0], y[1]

    k = settings.binder_bulk + 0 * binder
    g = 3 * k * binder / (9 * k - binder)
    known = [(SIZES[0], k, g)]
    for low, high in zip(SIZES[:-1], SIZES[1:]):
        (before, air_before), (after, air_after) = finer(low), finer(high)
        if high <= 63e-6:
            packed = 1 - recipe.rigden_voids
            room = [1 - of / (liquid + of) / packed for of in (before, after)]
            k, g = put_in(k, g, 0.0, packed * np.log(room[0] / room[1]))
        elif after > before:
            more, air = after - before, air_after - air_before
            total = liquid + after + air_after
            k, g = put_in(k, g, air / (more + air), -np.log(1 - (more + air) / total))
            size = np.sqrt(low * high)
            radius = size / 2
            gaps = [
                settings.gap + at**2 * radius / 4 for at in rings()
            ]  # of spheres whose R is half their radius
            at = np.log([one[0] for one in known])
            bulks, shears = (np.array([one[n] for one in known]).T for n in (1, 2))
            medium = []
            for h, moduli in zip(gaps, (shears, bulks + 4 / 3 * shears)):
                parts = [
                    [np.interp(np.log(h), at, part) for part in np.log(of).view(float).reshape(-1, 2).T]
                    for of in moduli
                ]
                medium.append(np.array([np.exp(real + 1j * imaginary) for real, imaginary in parts]))
            stiff = contact_stiffness(medium[0] / plane, medium[1] / plane, settings.gap * 2 / radius)
            touching = min(1.0, np.log(size / 63e-6) / np.log(90 / 63))
            n = settings.contacts * touching * more / total * liquid / (liquid + air_all)
            spring = stiff * plane * radius / 2
            k, g = (
                k + n * spring / (6 * np.pi * radius) * (1 - k / k_stone) ** 2,
                g + n * spring / (10 * np.pi * radius) * (1 - g / g_stone) ** 2,
            )
        known.append((high, k, g))
    filled, coarse = (k, g), solids * (1 - filler)
    force = 4 * np.pi * settings.pressure / (coarse * 4)  # on a contact of spheres of radius 1
    normal = 2 * plane * np.cbrt(3 * force * 0.5 / (4 * plane))
    tangential = normal * 2 * (1 - stone.poisson) / (2 - stone.poisson)
    n = coarse * settings.contacts / np.pi
    k = k + n * normal / 6 * (1 - k / k_stone) ** 2
    g = g + n * (normal + 1.5 * tangential) / 10 * (1 - g / g_stone) ** 2
    return *filled, 9 * k * g / (3 * k + g)


@pytest.mark.parametrize(
    ("voids", "settings"),
    [
        (0.06, Settings()),
        (0.0, Settings(contacts=3.0, gap=1e-6, pressure=0.0)),
        (0.2, Settings(contacts=0.5, pressure=1e6, binder_bulk=5e9)),
    ],
)
def test_the_scheme_is_what_its_text_says(recipe, voids, settings):
    binder = np.array([1e3, 1e6, 1e8, 1e9]) * np.exp(0.7j)
    asked = replace(recipe, voids=voids)
    k, g, young = naive_moduli(asked, binder, settings)
    np.testing.assert_allclose(_filled(asked, binder, settings), (k, g), rtol=2e-3)
    np.testing.assert_allclose(modulus_of_mix(asked, binder, settings), young, rtol=2e-3)


def test_grains_in_a_soft_binder_are_a_suspension(recipe):
    """(1 - phi)^(-5/2) of rigid grains in what keeps its volume; filler's by Krieger and Dougherty."""
    few = replace(recipe, voids=0.0)
    grains = volumes(few)[0]
    filler = grains[SIZES <= 63e-6][-1]
    packed = 1 - few.rigden_voids
    mastic = (1 - filler / (filler + binder_volume(few)) / packed) ** (-2.5 * packed)
    rest = 1 - filler - binder_volume(few)
    found = modulus_of_mix(few, np.array([1e3]), VOLUMES)[0].real / 1e3
    assert found == pytest.approx(mastic * (1 - rest) ** -2.5, rel=5e-3)


def test_a_little_filler_is_einsteins(recipe):
    few = replace(
        recipe, voids=0.0, grading=Grading(np.array([1e-6, 63e-6]), np.array([0.0, 1.0])), binder_share=0.98
    )
    share = 1 - binder_volume(few)
    assert share < 0.01
    found = modulus_of_mix(few, np.array([1e3]), VOLUMES)[0].real / 1e3
    assert found == pytest.approx(1 + 2.5 * share, rel=5e-4)


def test_air_in_a_mix_of_one_material_is_the_differential_scheme_of_voids(recipe):
    """All of the grains' modulus: E falls by (1 - air)^2, nearly (McLaughlin 1977, Poisson's ratio 0.2)."""
    stone = recipe.aggregate
    settings = replace(VOLUMES, binder_bulk=stone.bulk)
    found = modulus_of_mix(recipe, np.array([stone.modulus]), settings)[0].real
    assert found == pytest.approx(stone.modulus * (1 - recipe.voids) ** 2, rel=2e-3)
    assert modulus_of_mix(
        replace(recipe, voids=0.0), np.array([stone.modulus]), replace(settings, contacts=1.0)
    )[0].real == pytest.approx(stone.modulus, rel=1e-9)


def test_the_dry_skeleton_is_waltons_and_falls_with_air(recipe):
    """Walton (1987) for spheres that stick, at the grains' fraction and four contacts, where the binder is nothing."""
    nu, shear, p = recipe.aggregate.poisson, recipe.aggregate.shear, 10e3
    grains = volumes(recipe)[0]
    solid = grains[-1] - grains[SIZES <= 63e-6][-1]
    bulk = np.cbrt((solid * 4 * shear / (1 - nu)) ** 2 * p / (18 * np.pi**2))
    own = 3 * (5 - 4 * nu) / (5 * (2 - nu)) * bulk
    found = modulus_of_mix(recipe, np.array([1e-9]), Settings(contacts=4.0, gap=1e3))[0].real
    assert found == pytest.approx(9 * bulk * own / (3 * bulk + own), rel=0.02)
    assert modulus_of_mix(replace(recipe, voids=0.12), np.array([1e-9]))[0].real < found


def test_bounds_and_order_hold(content):
    """Of drawn recipes, with air and without; a stiffer binder makes a stiffer mix, contacts and skeleton add to it."""
    binder = np.geomspace(1e4, 3e9, 12)
    for with_air, _ in drawn_recipes(content, 24):
        for asked in (with_air, replace(with_air, voids=0.0)):
            found, bound = modulus_of_mix(asked, binder + 0j).real, bounds_of(asked, binder)
            assert (found < bound["voigt"]).all() and (found < bound["highest"]).all()
            assert (found > bound["reuss"]).all() and (found > bound["lowest"]).all()
            assert (np.diff(found) > 0.0).all()
            assert (found > modulus_of_mix(asked, binder + 0j, VOLUMES).real).all()


def test_the_mix_is_a_causal_function_of_its_binder(content):
    """Of a power law of the binder: phase and slope of ln|E*| obey Kramers and Kronig, which a complex map does."""
    log = np.linspace(np.log(1e3), np.log(1e9), 61)
    for asked, _ in drawn_recipes(content, 9):
        found = np.log(modulus_of_mix(asked, np.exp(log + 0.5j)))
        real = np.log(modulus_of_mix(asked, np.exp(log) + 0j)).real
        # ln F is analytic in ln x: F(ln x + i a) is that of a polynomial through real points
        fit = np.polynomial.Chebyshev.fit(log, real, 18)
        assert np.abs(found - fit(log + 0.5j))[10:51].max() < 0.02
        assert (found.imag > 0.0).all() and (found.imag <= 0.5 + 1e-9).all()


def test_a_little_of_any_input_changes_little(content):
    """Less than 6 % and 1.5 degrees for 0.1 % of binder or air, or 1 % on any sieve, of drawn recipes."""
    for asked, own in drawn_recipes(content, 18):
        before, grading = np.log(modulus_of_mix(asked, BINDER)), own["grading"]
        changed = [
            {key: own[key] + step}
            for key in ("binder_percent_by_mass", "air_voids_percent")
            for step in (0.1, -0.1)
        ]
        for sieve, step in product(list(grading)[:-1], (1.0, -1.0)):
            other = grading | {sieve: grading[sieve] + step}
            if (np.diff(list(other.values())) >= 0.0).all():
                changed.append({"grading": other})
        for other in changed:
            moved = np.log(modulus_of_mix(recipe_of(own | other), BINDER)) - before
            assert np.abs(moved.real).max() < 0.06 and np.degrees(np.abs(moved.imag)).max() < 1.5, (
                other,
                own,
            )


def test_finer_sizes_change_little(recipe, monkeypatch):
    from asphalt_nscd.forecasting import scheme

    before = np.log(modulus_of_mix(recipe, BINDER))
    finer = np.concatenate([np.geomspace(1e-6, 63e-6, 15), 63e-6 * 10.0 ** (np.arange(1, 91) / 28.0)])
    monkeypatch.setattr(scheme, "SIZES", finer)
    moved = np.log(modulus_of_mix(recipe, BINDER)) - before
    assert np.abs(moved.real).max() < 0.1 and np.degrees(np.abs(moved.imag)).max() < 0.6


def test_a_mastic_whose_filler_holds_all_binder_is_refused(content):
    sand = {2: 100, 1: 85, 0.5: 60, 0.25: 35, 0.125: 18, 0.063: 10}
    with pytest.raises(InputError, match="the filler is .* hold all binder; correct grading"):
        forecast(recipe_of(content | {"grading": sand, "binder_percent_by_mass": 2.0}))


@pytest.mark.parametrize(
    "changed",
    [
        {"air_voids_percent": 0.2},
        {"air_voids_percent": 0},
        {"grading": {10: 100, 4: 50, 1: 0}},
        {"grading": {0.5: 100, 0.25: 90, 0.063: 40}, "binder_percent_by_mass": 18},
        {"grading": {0.5: 100, 0.25: 100, 0.063: 100}, "binder_percent_by_mass": 19, "air_voids_percent": 0},
    ],
)
def test_unusual_mixes_get_an_answer(content, changed):
    """Hardly any air, none, no filler, a mortar, a mastic."""
    made = forecast(recipe_of(content | changed))
    assert (np.abs(made.modulus) > 1e6).all() and (np.diff(np.abs(made.modulus)) > 0.0).all()


def test_what_each_input_and_number_of_the_model_moves(content):
    """Against recipes that say so themselves."""
    made = forecast(recipe_of(content))
    more = {
        "voids": {"air_voids_percent": 6.5},
        "binder": {"binder_percent_by_mass": 5.6},
        "rigden": {"rigden_voids_percent": 40},
        "stiffness": {"angular_frequencies_rad_s": [2 * w for w in content["angular_frequencies_rad_s"]]},
        "aggregate": {"aggregate": {"E_GPa": 75, "poisson": 0.2}},
    }
    other = {name: forecast(recipe_of(content | change)).modulus for name, change in more.items()}
    filled = replace(made.recipe, grading=refilled(made.recipe.grading, 0.01))
    other["filler"] = forecast(filled).modulus
    settings = {
        "contacts": Settings(contacts=2.1),
        "gap": Settings(gap=30e-9),
        "pressure": Settings(pressure=1e4 / 3),
    }
    other |= {name: forecast(made.recipe, one).modulus for name, one in settings.items()}
    assert set(other) == set(made.moved) == {*INPUTS, *OF_THE_MODEL}
    for name, modulus in other.items():
        np.testing.assert_allclose(made.moved[name], np.log(modulus / made.modulus), atol=1e-12, err_msg=name)


def test_filler_takes_the_place_of_all_that_is_coarser():
    """8 % of filler become 10 %: what is coarser keeps its proportions, and what is finer its own."""
    before = Grading(1e-3 * np.array([0.02, 0.2, 2.0, 10.0]), np.array([0.04, 0.2, 0.4, 1.0]))
    filler = before.passing_at(63e-6)
    after = refilled(before, 0.02)
    np.testing.assert_allclose(1e3 * after.sieve, [0.02, 0.063, 0.2, 2.0, 10.0])
    rest = (np.array([0.2, 0.4, 1.0]) - filler) / (1 - filler)
    told = [0.04 * (filler + 0.02) / filler, filler + 0.02, *(filler + 0.02 + rest * (0.98 - filler))]
    np.testing.assert_allclose(after.passing, told)
    mastic = Grading(1e-3 * np.array([0.001, 0.063]), np.array([0.0, 1.0]))
    np.testing.assert_allclose(refilled(mastic, 0.02).passing, [0.0, 1.0])
