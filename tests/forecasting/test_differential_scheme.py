"""The scheme against theory: dilute and dense suspensions, bounds, causality; and no recipe has a cliff."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.forecast import forecast, with_filler
from asphalt_nscd.forecasting.recipe import Grading, recipe_of
from asphalt_nscd.forecasting.scheme import SIZES, Settings, binder_volume, modulus_of_mix, volumes

VOLUMES = Settings(contacts=0.0, pressure=0.0)
BINDER = np.geomspace(1e4, 1e9, 11) * np.exp(0.8j)
GRADINGS = {
    "dense": {10: 100, 6: 72.3, 4: 56.1, 2: 41.2, 0.063: 8.8},
    "open": {16: 100, 11.2: 90, 8: 25, 4: 12, 2: 10, 0.5: 6, 0.063: 3},
    "sand": {2: 100, 1: 85, 0.5: 60, 0.25: 35, 0.125: 18, 0.063: 10},
    "coarse": {25: 100, 19: 92, 9.5: 60, 4.75: 42, 2.36: 30, 0.6: 15, 0.15: 6, 0.063: 4},
}
MIXES = {"dense": (5.4, 6.0), "open": (4.5, 20.0), "sand": (8.0, 10.0), "coarse": (4.2, 4.0)}


def mix(content, name, **changed):
    binder, air = MIXES[name]
    own = {"grading": GRADINGS[name], "binder_percent_by_mass": binder, "air_voids_percent": air}
    return recipe_of(content | own | changed)


def test_grains_in_a_soft_binder_are_a_suspension(recipe):
    """(1 - phi)^(-5/2) of rigid grains in what keeps its volume; filler counts with its voids."""
    few = replace(recipe, voids=0.0)
    grains = volumes(few)[0]
    filler = grains[SIZES <= 63e-6][-1]
    held = filler / (1 - few.rigden_voids) / (filler + binder_volume(few))
    rest = 1 - filler - binder_volume(few)
    found = modulus_of_mix(few, np.array([1e3]), VOLUMES)[0].real / 1e3
    assert found == pytest.approx(((1 - held) * (1 - rest)) ** -2.5, rel=5e-3)


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
    added = modulus_of_mix(alone, soft, Settings(contacts=2e-3, pressure=0.0)) - modulus_of_mix(
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


@pytest.mark.parametrize("name", MIXES)
def test_bounds_and_order_hold(content, name):
    """Voigt and Reuss; stiffer binders make stiffer mixes, and contacts and skeleton add to volumes."""
    asked = mix(content, name)
    binder = np.abs(BINDER)
    found = modulus_of_mix(asked, binder + 0j).real
    liquid = binder_volume(asked)
    assert (found < (1 - liquid - asked.voids) * asked.aggregate.modulus + liquid * binder).all()
    assert (found > binder * (1 - asked.voids) ** 3).all() and (np.diff(found) > 0.0).all()
    assert (found > modulus_of_mix(asked, binder + 0j, VOLUMES).real).all()


@pytest.mark.parametrize("name", MIXES)
def test_the_mix_is_a_causal_function_of_its_binder(content, name):
    """Of a power law of the binder: phase and slope of ln|E*| obey Kramers and Kronig, which a complex map does."""
    asked = mix(content, name)
    log = np.linspace(np.log(1e3), np.log(1e9), 61)
    found = np.log(modulus_of_mix(asked, np.exp(log + 0.5j)))
    real = np.log(modulus_of_mix(asked, np.exp(log) + 0j)).real
    # ln F is analytic in ln x: F(ln x + i a) is that of a polynomial through real points
    fit = np.polynomial.Chebyshev.fit(log, real, 18)
    inner = slice(10, 51)
    assert np.abs(found - fit(log + 0.5j))[inner].max() < 0.02
    assert (found.imag > 0.0).all() and (found.imag <= 0.5 + 1e-9).all()


@pytest.mark.parametrize("name", MIXES)
def test_a_little_of_any_input_changes_little(content, name):
    """Less than 6 % and 1.5 degrees for 0.1 % of binder or air, or 1 % on any sieve but that of filler: 12 %."""
    asked = mix(content, name)
    before = np.log(modulus_of_mix(asked, BINDER))
    changed = [mix(content, name, binder_percent_by_mass=MIXES[name][0] + step) for step in (0.1, -0.1)]
    changed += [mix(content, name, air_voids_percent=MIXES[name][1] + step) for step in (0.1, -0.1)]
    for sieve in list(GRADINGS[name])[1:-1]:
        changed.append(mix(content, name, grading=GRADINGS[name] | {sieve: GRADINGS[name][sieve] + 1.0}))
    filler = mix(content, name, grading=GRADINGS[name] | {0.063: GRADINGS[name][0.063] + 1.0})
    assert np.abs(np.log(modulus_of_mix(filler, BINDER)) - before).max() < 0.12
    for other in changed:
        moved = np.log(modulus_of_mix(other, BINDER)) - before
        assert np.abs(moved.real).max() < 0.06 and np.degrees(np.abs(moved.imag)).max() < 1.5


def test_finer_sizes_change_little(recipe, monkeypatch):
    from asphalt_nscd.forecasting import scheme

    before = np.log(modulus_of_mix(recipe, BINDER))
    finer = np.concatenate([np.geomspace(1e-6, 63e-6, 15), 63e-6 * 10.0 ** (np.arange(1, 91) / 28.0)])
    monkeypatch.setattr(scheme, "SIZES", finer)
    moved = np.log(modulus_of_mix(recipe, BINDER)) - before
    assert np.abs(moved.real).max() < 0.1 and np.degrees(np.abs(moved.imag)).max() < 0.6


def test_a_mastic_whose_filler_holds_all_binder_is_refused(content):
    with pytest.raises(InputError, match="the filler is .* hold all binder; correct grading"):
        forecast(mix(content, "sand", binder_percent_by_mass=2.0))


@pytest.mark.parametrize(
    "changed",
    [
        {"air_voids_percent": 0.2},
        {"air_voids_percent": 0},
        {"grading": {10: 100, 4: 50, 1: 0}},
        {"grading": {0.5: 100, 0.25: 90, 0.063: 40}, "binder_percent_by_mass": 18},
    ],
)
def test_unusual_mixes_get_an_answer(content, changed):
    """Hardly any air, none, no filler, a mastic."""
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
    grading = with_filler(recipe.grading, 0.01)
    assert grading.passing_at(63e-6) == pytest.approx(recipe.grading.passing_at(63e-6) + 0.01)
    assert grading.passing_at(10e-3) == 1.0
