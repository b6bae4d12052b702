"""The scheme against theory: dilute and dense suspensions, bounds, causality; and no drawn recipe has a cliff."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.forecast import forecast, refilled
from asphalt_nscd.forecasting.recipe import Grading, recipe_of
from asphalt_nscd.forecasting.scheme import SIZES, Settings, binder_volume, modulus_of_mix, volumes

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


def test_contacts_of_grains_without_a_medium_are_digbys(recipe):
    """What contacts add to one thin layer of sizes: G = f n k / (10 pi r) with k of the contact alone."""
    from asphalt_nscd.forecasting.contact import RINGS, contact_stiffness

    one = Grading(SIZES[24:26], np.array([0.0, 1.0]))
    alone = replace(recipe, grading=one, voids=0.0, binder_share=0.5)
    soft = np.array([1e3 + 0j])
    added = modulus_of_mix(alone, soft, Settings(contacts=2e-3, gap=1e-9, pressure=0.0)) - modulus_of_mix(
        alone, soft, VOLUMES
    )
    plane, share = alone.aggregate.plane, float(volumes(alone)[0][-1])
    there = [np.full((1, RINGS), value / plane, complex) for value in (soft[0] / 3, 2.5e9)]
    radius = 0.5 * float(np.sqrt(SIZES[24] * SIZES[25]))
    k = contact_stiffness(there[0], there[1], 1e-9 / (radius / 2))[0] * plane * radius / 2
    shear = share * 2e-3 * k / (10 * np.pi * radius)
    assert added[0].real == pytest.approx(3 * shear.real, rel=0.02)


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


def test_what_is_moved(recipe):
    made = forecast(recipe)
    for name, sign in {
        "voids": -1,
        "binder": -1,
        "rigden": 1,
        "stiffness": 1,
        "aggregate": 1,
    }.items():
        assert (sign * made.moved[name].real > 0.0).all(), name
    for name, sign in {"contacts": 1, "gap": -1, "pressure": -1}.items():
        assert (sign * made.moved[name].real > 0.0).all(), name
    grading = refilled(recipe.grading, 0.01)
    assert grading.passing_at(63e-6) == pytest.approx(recipe.grading.passing_at(63e-6) + 0.01)
    assert grading.passing_at(10e-3) == 1.0
