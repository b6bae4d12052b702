import re

import numpy as np
import pytest
import yaml

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.recipe import INCHES, NUMBERED, read_recipe, recipe_of
from asphalt_nscd.forecasting.scheme import require_free_binder
from asphalt_nscd.forecasting.solid import Solid
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.table_import.shear import read_sweeps


def test_a_recipe_in_si_units(content):
    read = recipe_of(content, "folder/mine.yaml")
    assert (read.name, read.source, read.file) == ("a hot mix", "not stated", "folder/mine.yaml")
    numbers = (read.binder_share, read.voids, read.aggregate_density, read.binder_density, read.rigden_voids)
    assert numbers == pytest.approx((0.054, 0.06, 2670, 1040, 0.35))
    assert read.aggregate == Solid(60e9, 0.2) and read.measured is None and not read.shifted
    assert read.aggregate_fraction == pytest.approx(94.6 / 2670 / (94.6 / 2670 + 5.4 / 1040))
    np.testing.assert_allclose(read.grading.sieve, [63e-6, 2e-3, 4e-3, 6e-3, 10e-3])
    np.testing.assert_allclose(read.grading.passing, [0.0877, 0.41238, 0.56062, 0.72324, 1.0])
    between = read.grading.passing_at(np.array([1e-6, np.sqrt(2e-3 * 4e-3), 0.02]))
    np.testing.assert_allclose(between, [0.0877, (0.41238 + 0.56062) / 2, 1.0])
    np.testing.assert_allclose(2 * np.pi * read.frequency, content["angular_frequencies_rad_s"])
    assert (read.temperature == 15.0).all() and read.frequency.size == 5
    law = TwoS2P1D(0.1, 1e9, k=0.22, h=0.63, delta=2.2, tau=0.001945, beta=50.0, shift=read.binder.shift)
    omega = np.array(content["angular_frequencies_rad_s"])
    np.testing.assert_allclose(read.binder_modulus(), law.complex_modulus(omega, 15.0))
    for key in ("density_kg_m3", "aggregate", "angular_frequencies_rad_s", "name"):
        del content[key]
    usual = recipe_of(
        content | {"binder": {"grade": "64-22"}, "rigden_voids_percent": 30}, "folder/mine.yaml"
    )
    assert (usual.name, usual.aggregate_density, usual.binder_density) == ("mine", 2670, 1030)
    assert usual.aggregate == Solid(60e9, 0.2) and usual.rigden_voids == pytest.approx(0.3)
    grid = np.meshgrid([-10, 0, 10, 15, 20, 30, 40], [0.1, 0.3, 1, 3, 10, 25], indexing="ij")
    np.testing.assert_array_equal([usual.temperature, usual.frequency], [one.ravel() for one in grid])


def test_a_solid_has_the_moduli_of_its_lame_constants():
    solid, (lame, shear) = Solid(60e9, 0.25), (24e9, 24e9)
    assert (solid.shear, solid.bulk) == pytest.approx((shear, lame + 2 / 3 * shear))
    assert solid.plane == pytest.approx(2 * shear * (lame + shear) / (lame + 2 * shear))


def test_the_shipped_recipe_is_read():
    assert read_recipe("data/forecast/recipe.yaml").frequency.size == 20


RHEOMETER = "temperature_C,frequency_Hz,G_MPa,phase_deg"
LABORATORY = (
    "Temperature (°F),Angular frequency (rad/s),Complex modulus G* [kPa],Phase angle (°),Viscosity (Pa·s)"
)
GRADING = {10: 100, 6: 72, 4: 56, 2: 41, 0.063: 8.8}
NAN, INF = float("nan"), float("inf")
BAD = [
    ("air_voids_percent", 60, "air_voids_percent is 60, but must be at most"),
    ("air_voids_percent", -3, "air_voids_percent is -3, but must be at least"),
    ("air_voids_percent", 0.06, "air_voids_percent: 0.06 % is less than any mix has; give per cent"),
    ("air_voids_percent", "6 %", "air_voids_percent is '6 %', but must be a number"),
    ("air_voids_percent", NAN, "air_voids_percent: nan is no finite number"),
    ("air_voids_percent", None, "air_voids_percent is None, but must be a number"),
    ("binder_percent_by_mass", 0.054, "more than grains can"),
    ("binder_percent_by_mass", 54, "binder_percent_by_mass is 54, but must be at most"),
    ("binder_percent_by_mass", NAN, "binder_percent_by_mass: nan is no finite number"),
    ("binder", 35, "binder is 35, but must be a mapping"),
    ("binder", {"table": "absent.csv"}, "absent.csv: no such file"),
    ("binder", {"grade": "PG 65-22"}, "binder.grade: no usual viscosity of 'PG 65-22' is known"),
    ("binder", {"grade": "64-22", "A": 10.98}, "unknown key 'A' in binder; allowed are grade"),
    ("binder", {"A": 10.98}, "key 'VTS' is missing from binder"),
    ("binder", {"penetration_dmm": 20, "softening_point_C": 25}, "binder.softening_point_C: 25 .* above 30"),
    # The rheometer's G* counts: 0.35 made a mix of soft binder 4 % softer, and Hirsch's 6 %.
    (
        "binder",
        {"table": "absent.csv", "poisson": 0.35},
        "unknown key 'poisson' in binder; allowed are table",
    ),
    ("density_kg_m3", {"aggregate": 2.67, "binder": 1.04}, "density_kg_m3.* but must be at least"),
    ("density_kg_m3", {"aggregate": 2670}, "key 'binder' is missing from density_kg_m3"),
    ("aggregate", {"E_GPa": 0.06, "poisson": 0.2}, "aggregate.E_GPa is 0.06, but must be at least"),
    ("aggregate", {"E_GPa": 60000, "poisson": 0.2}, "aggregate.E_GPa is 60000, but must be at most"),
    ("aggregate", {"E_GPa": NAN, "poisson": 0.2}, "aggregate.E_GPa: nan is no finite number"),
    ("grading", {10: 100, 4: 60, 2: 70, 0.063: 5}, "grading: less passes 4 mm than 2 mm"),
    ("grading", {10: 90, 4: 60, 0.063: 5}, "grading: 90 % passes the largest sieve"),
    ("grading", {10: 1.0, 4: 0.6, 2: 0.4, 0.063: 0.05}, "grading: 1 % passes .* give per cent"),
    ("grading", {10: 110, 4: 60, 0.063: 5}, "grading.10 is 110, but must be at most"),
    ("grading", {10: 100, 4: NAN, 0.063: 5}, "grading.4: nan is no finite number"),
    ("grading", {10: 100, NAN: 50, 0.063: 5}, "grading: a sieve is no number"),
    ("grading", {10: 100, "10.0": 90, 2: 41, 0.063: 8}, "grading: a sieve is given twice"),
    ("grading", {"10 mm": 100, "filler": 8, "2 mm": 41}, "grading: a sieve is no number"),
    ("grading", {k / 1000: v for k, v in GRADING.items()}, "grading: sieves go from .* give them in mm"),
    ("grading", {k * 1000: v for k, v in GRADING.items()}, "grading: sieves go from .* give them in mm"),
    ("grading", {10: 100, 2: 41, 0: 0}, "grading: sieves go from 0 to 10 mm"),
    ("grading", [[10, 100], [2, 41]], "grading is .*, but must be a mapping"),
    ("grading", None, "grading is None, but must be a mapping"),
    ("grading", {10: 100, 2: 100, 0.063: 100}, "grading: the filler is 87 % of filler and binder"),
    (
        "grading",
        {10: 100, 6: 72, 4: 56, 2: 41},
        "grading: 41 % passes the finest sieve, 2 mm; add finer ones",
    ),
    ("temperatures_C", [40], "temperatures_C: 40 degC, but the binder's law has no shift"),
    ("temperatures_C", 20, "temperatures_C is 20, but must be a list"),
    ("temperatures_C", [293], "temperatures_C.0. is 293, but must be at most"),
    ("frequencies_Hz", [1, 10], "frequencies_Hz and angular_frequencies_rad_s; give one"),
    ("angular_frequencies_rad_s", [0, 1], "angular_frequencies_rad_s.0. is 0, but must be at least"),
    ("angular_frequencies_rad_s", [1e300], "angular_frequencies_rad_s.0. is 1e.300, but must be at most"),
    ("angular_frequencies_rad_s", [INF], "angular_frequencies_rad_s.0: inf is no finite number"),
    ("colour", "black", "unknown key 'colour' in the recipe; allowed are name"),
    (
        "binder_percent",
        5,
        "unknown key 'binder_percent' in the recipe; did you mean 'binder_percent_by_mass'",
    ),
    ("binder_percent_by_mass", "4,8", "binder_percent_by_mass is '4,8', but must be a number .*; write 4.8"),
    ("grading", {10: 100, 0.063: 8}, "grading is .* but must be a mapping of at least 3"),
    ("grading", {"3/4": 100, 19: 95, "No. 200": 5}, "grading: a sieve is given twice"),
    ("binder", {"grade": "50/70"}, "of a grade of EN 12591 give penetration_dmm and softening_point_C"),
]
BAD_BINDERS = [
    ("E0_MPa", 1e6, "not below the aggregate's 60 GPa; give E0_MPa in MPa"),
    ("E0_MPa", 1, "binder.E0_MPa is 1, but must be at least"),
    ("E00_MPa", 2000, "binder: needs .* correct it"),
    ("k", 0.7, "binder: needs 0 < k <= h < 1"),
    ("k", 1.2, "binder.k is 1.2, but must be less than 1"),
    ("tau_s", NAN, "binder.tau_s: nan is no finite number"),
    (
        "shift",
        {"wlf_C1": 20, "wlf_C2_K": 20},
        "temperatures_C: WLF shift: it is not defined 20 K below 15 degC",
    ),
    ("gamma", 3, "unknown key 'gamma' in binder"),
    ("shift", {"wlf_C1": 20}, "key 'wlf_C2_K' is missing from binder.shift"),
    (
        "shift",
        {"activation_energy_J_mol": 150},
        "binder.shift.activation_energy_J_mol is 150, but must be at least",
    ),
]


def refusal(content, folder) -> str:
    """One sentence that names the file, of a recipe written to one."""
    path = folder / "recipe.yaml"
    path.write_text(yaml.safe_dump(content))
    with pytest.raises(InputError) as caught:
        require_free_binder(read_recipe(path))
    said = str(caught.value)
    assert "\n" not in said and said.startswith(str(folder))
    return said


@pytest.mark.parametrize(("where", "value", "said"), BAD)
def test_a_bad_recipe_is_refused_in_one_sentence(content, tmp_path, where, value, said):
    assert re.search(said, refusal(content | {where: value}, tmp_path))


@pytest.mark.parametrize(("key", "value", "said"), BAD_BINDERS)
def test_a_bad_binder_is_refused(content, tmp_path, key, value, said):
    content["binder"][key] = value
    assert re.search(said, refusal(content, tmp_path))


def test_sieves_of_astm_e11_by_name():
    """From 4.75 mm down each is a fourth root of two finer than the one before, or several are; 1 in is 25.4 mm."""
    steps = {
        "4": 0,
        "6": 2,
        "8": 4,
        "10": 5,
        "12": 6,
        "16": 8,
        "20": 10,
        "30": 12,
        "40": 14,
        "50": 16,
        "60": 17,
    }
    steps |= {"80": 19, "100": 20, "140": 22, "200": 24, "230": 25}
    assert {name: 4.75 / 2 ** (step / 4) for name, step in steps.items()} == pytest.approx(NUMBERED, rel=0.02)
    inches = {
        "3": 3,
        "2 1/2": 2.5,
        "2": 2,
        "1 1/2": 1.5,
        "1": 1,
        "3/4": 0.75,
        "1/2": 0.5,
        "3/8": 0.375,
        "1/4": 0.25,
    }
    assert {name: 25.4 * size for name, size in inches.items()} == pytest.approx(INCHES, rel=0.02)


def test_sieves_by_their_names_are_those_in_millimetres(content):
    """A whole number without a mark of inches is in mm."""
    named = {'1-1/2"': 100, "1 in.": 99, "3/4": 95, "3": 60, "#4": 70, "No. 8": 32, "no 30": 16, "No.200": 5}
    millimetres = {37.5: 100, 25: 99, 19: 95, 4.75: 70, 3: 60, 2.36: 32, 0.6: 16, 0.075: 5}
    read, known = (recipe_of(content | {"grading": sieves}).grading for sieves in (named, millimetres))
    assert read.sieve == pytest.approx(known.sieve) and (read.passing == known.passing).all()


def test_bounds_of_a_recipe_are_in_it(content):
    """The least air, the coarsest and finest sieve, the least glass above which stone is softer."""
    for change in (
        {"air_voids_percent": 0.15},
        {"grading": {100: 100, 1: 40, 0.15: 9}},
        {"grading": {0.5: 100, 0.2: 40, 0.063: 9}, "binder_percent_by_mass": 12},
        {"grading": {4: 100, 1: 40, 0.2: 0}},
        {"aggregate": {"E_GPa": 10, "poisson": 0.2}, "binder": content["binder"] | {"E0_MPa": 9999}},
    ):
        recipe_of(content | change)
    for change in (
        {"air_voids_percent": 0.14},
        {"grading": {101: 100, 1: 40, 0.15: 9}},
        {"grading": {0.49: 100, 0.2: 40, 0.063: 9}, "binder_percent_by_mass": 12},
        {"grading": {4: 100, 1: 40, 0.2: 9}},
        {"aggregate": {"E_GPa": 10, "poisson": 0.2}, "binder": content["binder"] | {"E0_MPa": 10000}},
        {"binder_percent_by_mass": 1.1},
    ):
        with pytest.raises(InputError):
            recipe_of(content | change)


def test_a_sieve_that_yaml_takes_for_a_remark_is_told(tmp_path):
    (tmp_path / "recipe.yaml").write_text("air_voids_percent: 5\ngrading:\n  3/4: 100\n  #4: 60\n")
    with pytest.raises(InputError, match="#4 begins a remark in YAML; write No. 4"):
        read_recipe(tmp_path / "recipe.yaml")


def test_a_temperature_that_the_recipe_does_not_state_is_told(content):
    assert "15 °C stands for it" in recipe_of(content).caveat
    content["binder"]["reference_temperature_C"] = 15
    assert recipe_of(content).caveat == ""


@pytest.mark.parametrize("missing", ["binder", "air_voids_percent", "binder_percent_by_mass", "grading"])
def test_what_is_missing_is_named(content, tmp_path, missing):
    del content[missing]
    assert f"key '{missing}' is missing from the recipe" in refusal(content, tmp_path) or missing == "grading"


@pytest.mark.parametrize("text", ["", "- 1\n", "binder: {E00", "binder:\n\tE0_MPa: 5\n"])
def test_a_file_that_holds_no_recipe_is_refused(tmp_path, text):
    path = tmp_path / "recipe.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match="forecast --help shows a recipe"):
        read_recipe(path)


def rheometer(law, unit=1e-6, degrees=1.0) -> list[str]:
    """Rows of a table at five temperatures and eight frequencies, E = 3 G."""
    temperature, frequency = (
        grid.ravel() for grid in np.meshgrid([0, 10, 20, 40, 60], np.geomspace(0.1, 30, 8))
    )
    shear = law.complex_modulus(2 * np.pi * frequency, temperature) / 3
    phase = np.degrees(np.angle(shear)) * degrees
    rows = zip(temperature, frequency, abs(shear) * unit, phase, strict=True)
    return [",".join(f"{x:.8g}" for x in row) for row in rows]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (lambda law: rheometer(law, unit=1.0), "G_MPa = .* is outside"),
        (lambda law: rheometer(law, degrees=np.pi / 180), "phase is .* at most; give it in degrees"),
        (lambda law: rheometer(law, degrees=-1), "phase_deg = .* is outside 0 to 90"),
        (lambda law: [*rheometer(law), "0,1,nan,30"], "line 42: G_MPa = nan is not finite"),
        (lambda law: [*rheometer(law), "0,1,,30"], "line 42: G_MPa is empty"),
        (lambda law: rheometer(law)[::5], "needs at least 3 temperatures"),
        (lambda law: [row for row in rheometer(law) if row[0] == "0"], "needs at least 3 temperatures"),
        (lambda law: [], "has a header but no rows"),
        (
            lambda law: [
                f"{t},{f},{3 ** ((7 * t + f) % 5)},{(31 * t + 17 * f) % 80}"
                for t in (0, 20, 40)
                for f in (1, 3, 10)
            ],
            "no law of a binder comes nearer",
        ),
    ],
)
def test_a_bad_table_of_a_rheometer_is_refused(content, tmp_path, rows, said):
    content["binder"] |= {"reference_temperature_C": 20, "shift": {"wlf_C1": 20, "wlf_C2_K": 150}}
    law = recipe_of(content).binder
    (tmp_path / "dsr.csv").write_text("\n".join([RHEOMETER, *rows(law)]) + "\n")
    del content["angular_frequencies_rad_s"]
    assert re.search(said, refusal(content | {"binder": {"table": "dsr.csv"}}, tmp_path))


def test_a_table_of_a_rheometer_gives_the_law_it_was_drawn_from(content, tmp_path):
    """About its middle temperature; and how far the law stays from one that scatters."""
    content["binder"] |= {"reference_temperature_C": 20, "shift": {"wlf_C1": 20, "wlf_C2_K": 150}}
    law, told = recipe_of(content).binder, {}
    for off in (0.0, 0.25):
        rows = [[float(x) for x in row.split(",")] for row in rheometer(law)]
        scattered = [f"{t},{f},{g * np.exp(off * (-1) ** n)},{p}" for n, (t, f, g, p) in enumerate(rows)]
        (tmp_path / "dsr.csv").write_text("\n".join([RHEOMETER, *scattered]) + "\n")
        told[off] = recipe_of(content | {"binder": {"table": "dsr.csv"}}, tmp_path / "r.yaml")
    read, rough = told.values()
    omega = np.array([1e-2, 1.0, 100.0])
    assert read.binder.complex_modulus(omega, 15.0) == pytest.approx(
        law.complex_modulus(omega, 15.0), rel=0.02
    )
    assert (
        read.binder.glassy_modulus == pytest.approx(3e9) and read.binder.shift.reference_temperature == 20.0
    )
    assert read.measured == rough.measured == (0.0, 60.0) and read.caveat == ""
    assert rough.caveat == "The law of the binder misses its table by 25 %."
    outside = read.outside(np.array([-0.6, -0.4, 60.4, 60.6]))
    assert outside.tolist() == [True, False, False, True]
    (tmp_path / "dsr.csv").write_text("\n".join([RHEOMETER, *rheometer(law)]) + "\n")
    rap = {"percent_by_mass": 20, "binder_percent_by_mass": 5, "binder": {"grade": "PG 76E-22"}}
    both = recipe_of(content | {"binder": {"table": "dsr.csv"}, "rap": rap}, tmp_path / "r.yaml")
    assert both.measured == (0.0, 60.0) and both.caveat.startswith("PG 76E-22 is taken for PG 76-22")
    both = recipe_of(
        content | {"binder": {"grade": "64-22"}, "rap": rap | {"binder": {"table": "dsr.csv"}}},
        tmp_path / "r",
    )
    assert both.measured == (0.0, 60.0)
    (tmp_path / "warm.csv").write_text(
        "\n".join([RHEOMETER, *(row for row in rheometer(law) if row[0] != "0")]) + "\n"
    )
    both = recipe_of(
        content | {"binder": {"table": "dsr.csv"}, "rap": rap | {"binder": {"table": "warm.csv"}}},
        tmp_path / "r",
    )
    assert both.measured == (10.0, 60.0)


def test_a_laboratorys_export_is_read_in_its_own_units(content, tmp_path):
    """Degrees Fahrenheit, rad/s and kPa; what it does not reach is told, and not asked unless the recipe asks."""
    content["binder"] |= {"reference_temperature_C": 20, "shift": {"wlf_C1": 20, "wlf_C2_K": 150}}
    law = recipe_of(content).binder
    rows = [[float(x) for x in row.split(",")] for row in rheometer(law)]
    told = [f"{1.8 * t + 32},{2 * np.pi * f},{1e3 * g},{p},{g / f}" for t, f, g, p in rows]
    (tmp_path / "dsr.csv").write_text("\n".join([LABORATORY, *told]) + "\n", encoding="utf-8")
    content |= {"binder": {"table": "dsr.csv"}, "temperatures_C": [-10, 0, 15]}
    read = recipe_of(content, tmp_path / "recipe.yaml", read_sweeps)
    omega = np.array([1e-2, 1.0, 100.0])
    assert read.binder.complex_modulus(omega, 15.0) == pytest.approx(
        law.complex_modulus(omega, 15.0), rel=0.02
    )
    assert read.outside(read.temperature).tolist() == [t == -10 for t in read.temperature]
    del content["temperatures_C"]
    assert recipe_of(content, tmp_path / "recipe.yaml", read_sweeps).temperature.min() == 0.0


def test_a_binder_that_flows_is_read_down_to_a_hundred_pascals(content, tmp_path):
    """A paving grade from 10 to 70 degC: seven decades; told colder, it has the glass of all bitumens."""
    law = recipe_of(content | {"binder": {"grade": "64-22"}}).binder
    rows = ["temperature_C,angular_frequency_rad_s,G_Pa,phase_deg"]
    for t in (10, 22, 34, 46, 58, 70):
        for w in np.geomspace(0.1, 100, 9):
            g = law.complex_modulus(np.array([w]), np.array([t]))[0] / 3
            rows.append(f"{t},{w},{abs(g)},{np.degrees(np.angle(g))}")
    (tmp_path / "dsr.csv").write_text("\n".join(rows) + "\n")
    asked = content | {"binder": {"table": "dsr.csv"}, "temperatures_C": [20]}
    read = recipe_of(asked, tmp_path / "recipe.yaml", read_sweeps)
    omega = np.array([1.0, 10.0])
    for temperature, most in ((15.0, 0.1), (65.0, 0.1), (-5.0, 0.5)):
        off = np.log(
            read.binder.complex_modulus(omega, temperature) / law.complex_modulus(omega, temperature)
        )
        assert np.abs(off).max() < most
    assert read.caveat == ""
