"""Units of moduli and temperatures, by their definitions."""

import pytest

from asphalt_nscd.measurements.units import MEGAPASCAL, celsius_of_fahrenheit

POUND, INCH = 0.45359237 * 9.80665, 0.0254  # N, m


def test_one_of_each_unit_in_megapascals():
    pascals = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1.0 / 0.001**2, "MN/m2": 1e6}
    pascals |= {"kgf/cm2": 9.80665 / 0.01**2, "psi": POUND / INCH**2, "ksi": 1000.0 * POUND / INCH**2}
    assert {name: 1e-6 * value for name, value in pascals.items()} == pytest.approx(MEGAPASCAL, rel=1e-12)


def test_ice_melts_and_water_boils():
    assert [celsius_of_fahrenheit(t) for t in (-40.0, 32.0, 212.0)] == [-40.0, 0.0, 100.0]
