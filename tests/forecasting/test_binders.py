"""Binders as people know them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.binders import (
    GRADES,
    ViscosityShift,
    _setpoints,
    crossover_of,
    read_binder,
    shear_modulus,
)

OMEGA = 2 * np.pi * np.array([0.1, 10.0])


def test_a_binder_that_crosses_over_is_half_way_between_glass_and_flow():
    at = shear_modulus(np.array([3.0]), 3.0)
    assert np.degrees(np.angle(at)) == pytest.approx(45.0)
    assert np.abs(at) == pytest.approx(1e9 * 10**-1.8)  # the rheological index is the decades below the glass
    assert shear_modulus(np.array([1e-20]), 3.0) == pytest.approx(1e9 / 3.0 * 1e-20 * 1j, rel=0.02)


@pytest.mark.parametrize("viscosity", [1e2, 1e5, 7e9])
def test_a_binder_has_the_viscosity_of_its_grade(viscosity):
    at = shear_modulus(np.array([10.0]), crossover_of(viscosity))
    found = np.abs(at) / 10.0 * (1.0 / np.sin(np.angle(at))) ** 4.8628
    assert found == pytest.approx(viscosity, rel=1e-6)


@pytest.mark.parametrize("temperature", [-60.0, 120.0])
@pytest.mark.parametrize("grade", GRADES)
def test_every_grade_has_a_modulus_at_all_temperatures_of_a_recipe(grade, temperature):
    for line in GRADES[grade].values():
        shift = ViscosityShift(*line)
        at = shear_modulus(np.array([10.0]), shift.crossover(np.array([temperature])))
        found = np.log(np.abs(at) / 10.0) - 4.8628 * np.log(np.sin(np.angle(at)))
        assert found == pytest.approx(np.log(shift.viscosity(temperature)), abs=1e-6)


def test_a_and_vts_of_no_binder_are_refused():
    with pytest.raises(InputError, match="a viscosity of inf Pa s, more than any; correct A and VTS"):
        ViscosityShift(20.0, -1.0).crossover(np.array([15.0]))


def test_a_grade_is_its_usual_a_and_vts():
    """A point of data/mixes50: PG 58-28 at -10 degC has 6.64e9 Pa s."""
    shift = ViscosityShift(*GRADES[58][-28])
    assert shift.viscosity(-10.0) == pytest.approx(6.64e9, rel=0.01)
    grade, known = read_binder({"grade": "PG 58-28"}, "r"), read_binder({"A": 11.010, "VTS": -3.701}, "r")
    assert grade.law.complex_modulus(OMEGA, 20.0) == pytest.approx(known.law.complex_modulus(OMEGA, 20.0))
    crossing = shift.crossover(
        np.array([[20.0, -5.0], [20.0, 40.0]])
    )  # Young's modulus is three times the shear's
    found = grade.law.complex_modulus(crossing, np.array([[20.0, -5.0], [20.0, 40.0]]))
    np.testing.assert_allclose(found, 3e9 * 10**-1.8 * np.exp(0.25j * np.pi) * np.ones((2, 2)), rtol=1e-9)
    assert (
        read_binder({"grade": "pg58 - 28"}, "r").law == grade.law
        and grade.law.shift.reference_temperature == 15.0
    )


def test_all_grades_obey_one_rule_to_their_last_digit():
    """300 Pa s at the high temperature, and one point that all pairs of one low temperature share.

    A digit of A or VTS that is off by ten moves the first by a third, the second as far.
    """
    for high, lows in GRADES.items():
        assert [*lows] == list(range(max(lows), min(lows) - 1, -6)) and max(lows) in (-10, -34)
        for pair in lows.values():
            assert ViscosityShift(*pair).viscosity(high) == pytest.approx(300.0, rel=0.05), (high, pair)
    for low in {low for lows in GRADES.values() for low in lows}:
        a, vts = np.array([lows[low] for lows in GRADES.values() if low in lows]).T
        slope, shared = np.polyfit(-vts, a, 1)  # a = shared + slope (-vts): all lines meet at log T = slope
        assert np.abs(a - shared + slope * vts).max() < 2e-3, low


def test_grades_have_the_viscosities_of_measured_mixes():
    """A and VTS through the viscosities of data/mixes50, in most rows the default of the grade."""
    recipes = pd.read_csv("data/mixes50/recipes.csv").set_index("mix")
    moduli = pd.read_csv("data/mixes50/modulus.csv")
    confirmed = set()
    for mix, points in moduli.groupby("mix"):
        grade = recipes.loc[mix, ["PG_high_C", "PG_low_C"]].astype(int)
        temperature = np.log10(1.8 * (points["temperature_C"] + 273.15))
        vts, a = np.polyfit(temperature, np.log10(np.log10(1e3 * points["binder_viscosity_Pa_s"])), 1)
        known = GRADES.get(grade.iloc[0], {}).get(grade.iloc[1], (0.0, 0.0))
        if abs(known[1] - vts) < 1.5e-3 and abs(known[0] - a) < 4e-3:
            confirmed.add(tuple(grade))
    assert confirmed == {(58, -22), (58, -28), (64, -16), (64, -22), (64, -28), (70, -28), (76, -22)}


def test_stiffer_grades_are_stiffer_where_they_are_named_for():
    """At 40 degC by the high temperature, at -10 degC by the low one."""
    hot = [
        abs(read_binder({"grade": f"{high}-22"}, "r").law.complex_modulus(OMEGA, 40.0)[0])
        for high in (52, 58, 64, 70)
    ]
    cold = [
        abs(read_binder({"grade": f"64{low}"}, "r").law.complex_modulus(OMEGA, -10.0)[0])
        for low in (-34, -28, -22, -16)
    ]
    assert (np.diff(hot) > 0).all() and (np.diff(cold) > 0).all()


@pytest.mark.parametrize(
    ("letter", "told"), [("", False), ("S", False), ("H", True), ("V", True), ("E", True)]
)
def test_a_grade_with_a_letter_of_traffic(letter, told):
    """AASHTO M 332: S is the plain grade; of the others the usual viscosity is that of the plain one, and told so."""
    read = read_binder({"grade": f"PG 64{letter}-22"}, "r")
    assert (read.law.shift.a, read.law.shift.vts) == GRADES[64][-22]
    assert (f"PG 64{letter}-22 is taken for PG 64-22" in read.caution) == told


def test_penetration_and_softening_point_by_hand():
    """50 dmm at 25 degC: 10^(10.5012 - 2.2601 log 50 + 0.00389 log^2 50) poises; 13 000 at the softening point."""
    law = read_binder({"penetration_dmm": 50, "softening_point_C": 50}, "r").law
    log = np.log10(50)
    assert law.shift.viscosity(25.0) == pytest.approx(
        0.1 * 10 ** (10.5012 - 2.2601 * log + 0.00389 * log**2), rel=1e-6
    )
    assert law.shift.viscosity(50.0) == pytest.approx(1300.0, rel=1e-6)


def test_recycled_asphalt_stiffens_by_the_share_of_its_binder(content):
    """20 % with 5 % of binder in a mix of 5.4 %: logarithms of the moduli mix 18.5 : 81.5."""
    from asphalt_nscd.forecasting.recipe import recipe_of

    content |= {"binder": {"grade": "58-28"}, "temperatures_C": [20], "frequencies_Hz": [10]}
    del content["angular_frequencies_rad_s"]
    old = {"percent_by_mass": 20, "binder_percent_by_mass": 5, "binder": {"grade": "82-16"}}
    new, mixed = recipe_of(content).binder_modulus(), recipe_of(content | {"rap": old}).binder_modulus()
    hard = recipe_of(content | {"binder": {"grade": "82-16"}}).binder_modulus()
    assert recipe_of(content | {"rap": old}).binder.shift == recipe_of(content).binder.shift
    with pytest.raises(InputError, match="rap: brings 5.5 % of binder into a mix of 5.4 %"):
        recipe_of(content | {"rap": old | {"percent_by_mass": 55, "binder_percent_by_mass": 10}})
    recipe_of(content | {"rap": old | {"percent_by_mass": 54, "binder_percent_by_mass": 10}})
    assert np.log(mixed / new) == pytest.approx(np.log(hard / new) * 0.2 * 5 / 5.4)


def test_readings_about_one_temperature_are_one_that_was_set():
    """A thermostat scatters by tenths of a kelvin; a ramp in steps of a kelvin has many temperatures."""
    assert _setpoints(np.array([9.97, 10.0, 10.04, 10.3])) == 1
    assert _setpoints(np.array([9.9, 10.1, 19.8, 20.2, 40.0])) == 3
    assert _setpoints(np.arange(10.0, 21.0)) == 6


def test_a_colder_binder_is_asked_at_a_higher_reduced_frequency():
    shift = ViscosityShift(*GRADES[64][-22], reference_temperature=20.0)
    cold, same, warm = shift.factor(np.array([0.0, 20.0, 40.0]))
    assert same == pytest.approx(1.0) and cold > 10.0 and warm < 0.1
    at = shift.crossover(np.array([20.0, 0.0]))
    assert cold * at[1] == pytest.approx(at[0])  # it crosses over there as at the reference
