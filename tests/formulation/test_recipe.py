import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.formulation.levels import film_thickness, levels_of
from asphalt_nscd.formulation.recipe import read_recipe, recipe_of


def test_the_shipped_recipe_is_read():
    recipe = read_recipe("data/forecast/recipe.yaml")
    assert recipe.name == "HMA H0"
    assert recipe.frequency.size == 20


@pytest.mark.parametrize(
    ("where", "value", "said"),
    [
        ("air_voids_percent", 60, "air_voids_percent: 60 is greater than the maximum"),
        ("grading", {10: 100, 4: 60, 2: 70, 0.063: 5}, "less passes 4 mm than 2 mm"),
        ("grading", {10: 90, 4: 60, 0.063: 5}, "90 % passes the largest sieve"),
        ("aggregate", {"E_GPa": 0.06, "poisson": 0.2}, "aggregate.E_GPa: 0.06 is less than the minimum"),
        ("binder_percent_by_mass", 0.3, "more than grains can"),
        ("grading", {10: 100, 2: 1, 0.063: 0.5}, "more than a packing reaches"),
        ("temperatures_C", [40], "has no shift"),
        ("binder", {"table": "absent.csv", "poisson": 0.5}, "absent.csv"),
        ("colour", "black", "colour"),
    ],
)
def test_a_bad_recipe_is_refused_in_one_sentence(content, where, value, said):
    with pytest.raises(InputError, match=said):
        levels_of(recipe_of(content | {where: value}))


def test_a_binder_stiffer_than_stone_is_refused(content):
    content["binder"]["E0_MPa"] = 1e6
    with pytest.raises(InputError, match="not below the aggregate's 60 GPa"):
        recipe_of(content)


def test_a_table_of_a_rheometer_gives_the_law_it_was_drawn_from(content, tmp_path):
    content["binder"] |= {"reference_temperature_C": 20, "shift": {"wlf_C1": 20, "wlf_C2_K": 150}}
    law = recipe_of(content).binder
    temperature, frequency = (
        grid.ravel() for grid in np.meshgrid([0, 10, 20, 40, 60], np.geomspace(0.1, 30, 8))
    )
    shear = law.complex_modulus(2 * np.pi * frequency, temperature) / (2 * 1.45)
    rows = zip(temperature, frequency, abs(shear) / 1e6, np.degrees(np.angle(shear)), strict=True)
    lines = [
        "temperature_C,frequency_Hz,G_MPa,phase_deg",
        *(",".join(f"{x:.8g}" for x in row) for row in rows),
    ]
    (tmp_path / "dsr.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "recipe.yaml").write_text("")
    content["binder"] = {"table": "dsr.csv", "poisson": 0.45}
    read = recipe_of(content, tmp_path / "recipe.yaml").binder
    omega = np.array([1e-2, 1.0, 100.0])
    assert read.complex_modulus(omega, 15.0) == pytest.approx(law.complex_modulus(omega, 15.0), rel=0.01)


def test_levels_hold_what_the_recipe_says(recipe):
    # By mass 5.4 % binder: volumes of stone and binder, and shares of filler, sand and stones of the grading.
    stone, binder = 0.946 / 2670, 0.054 / 1040
    filler, sand, stones = (stone * share for share in (0.0877, 0.41238 - 0.0877, 1 - 0.41238))
    expected = [
        filler / (filler + binder),
        sand / (sand + filler + binder),
        stones / (stone + binder),
    ]
    assert [level.fraction for level in levels_of(recipe)] == pytest.approx(expected, rel=1e-9)
    assert [level.touching for level in levels_of(recipe)] == [False, True, True]


def test_film_thickness_is_binder_over_hveems_surface(recipe):
    passing = {
        size: float(recipe.grading.passing_at(size * 1e-3))
        for size in (4.75, 2.36, 1.18, 0.6, 0.3, 0.15, 0.075)
    }
    surface = 0.41 + sum(
        f * p for f, p in zip((0.41, 0.82, 1.64, 2.87, 6.14, 12.29, 32.77), passing.values(), strict=True)
    )  # m2/kg
    assert film_thickness(recipe) == pytest.approx(0.054 / 0.946 / 1040 / surface, rel=1e-9)
    assert 4e-6 < film_thickness(recipe) < 9e-6  # as mix designers know it
