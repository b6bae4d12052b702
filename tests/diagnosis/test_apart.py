"""The specimen that stands out: its size where it is known, and how far those lie that are drawn from the priors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.criteria import LABORATORY
from asphalt_nscd.diagnosis.observed.apart import STANDS_OUT, furthest
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.scatter import SPECIMEN_PHASE, SPECIMEN_SCALE
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

FREQUENCIES, TEMPERATURES = np.array([0.1, 0.5, 1.0, 5.0, 10.0, 25.0]), np.array([4.0, 14.0, 24.0, 34.0])
LAW = TwoS2P1D(86e6, 26e9, k=0.22, h=0.65, delta=2.5, tau=0.8, beta=43.0, shift=WLF(12.0, 120.0, 21.0))
SIZE = {name: usual.size for name, usual in LABORATORY.items()}


def campaign(specimens=3, warmer=0.0, level=0.0, random=None):
    """Specimen 1 is so many K warmer than stated and its ln|E*| off by a level; `random` draws a usual laboratory."""
    grid = np.meshgrid(np.arange(specimens), TEMPERATURES, FREQUENCIES, indexing="ij")
    specimen, temperature, frequency = (values.ravel() for values in grid)
    odd = specimen == 1
    at, ln_time, factor = temperature + warmer * odd, 0.0 * frequency, level * odd + 0j
    if random is not None:
        sweep = specimen * TEMPERATURES.size + np.searchsorted(TEMPERATURES, temperature)

        def drawn(size, of):
            return random.normal(0.0, size, of.max() + 1)[of]

        at = at + drawn(SIZE["specimen temperature"], sweep)
        ln_time = drawn(SIZE["specimen times"], specimen)
        factor = factor + drawn(SPECIMEN_SCALE, specimen) + 1j * drawn(SPECIMEN_PHASE, specimen)
        factor += drawn(SIZE["mounting, modulus"], sweep) + 1j * drawn(SIZE["mounting, phase"], sweep)
    modulus = LAW.complex_modulus(2.0 * np.pi * frequency * np.exp(ln_time), at) * np.exp(factor)
    ones = np.ones(specimen.size)
    return Observations(
        specimen, tuple("ABCDEF"[:specimens]), temperature, frequency, modulus, ones, 0.0 * ones
    )


@pytest.mark.parametrize("warmer", [2.0, -2.0])
def test_a_specimen_at_another_temperature_is_told_with_its_kelvin(warmer):
    found = furthest(campaign(warmer=warmer))
    assert found["specimen"] == "B" and found["kelvin"] == pytest.approx(warmer, rel=0.05)
    assert found["kelvin_over_usual"] > STANDS_OUT


def test_a_test_that_is_missing_takes_nothing_else_along():
    observed = campaign(warmer=2.0)
    found = furthest(observed.subset(np.arange(observed.size) != 9))
    assert found["specimen"] == "B" and found["kelvin"] == pytest.approx(2.0, rel=0.05)


def test_a_level_is_told_as_a_level():
    found = furthest(campaign(4, level=0.3))
    assert found["specimen"] == "B" and found["E_percent"] == pytest.approx(100.0 * np.expm1(0.3))
    assert found["kelvin_over_usual"] < 0.5 and found["E_over_usual"] > STANDS_OUT


def test_specimens_of_a_usual_laboratory_differ_by_one_usual_difference():
    """Root mean square, over drawn tables of two: both ways are one difference."""
    random = np.random.default_rng(7)
    found = [furthest(campaign(2, random=random)) for _ in range(300)]
    for key in ("E_over_usual", "kelvin_over_usual"):
        assert np.sqrt(np.mean([one[key] ** 2 for one in found])) == pytest.approx(1.0, abs=0.12)
    assert np.mean([max(one["E_over_usual"], one["kelvin_over_usual"]) > STANDS_OUT for one in found]) < 0.02


def test_the_size_that_is_told_in_19_of_20_tables():
    random = np.random.default_rng(8)
    told = furthest(campaign())["kelvin_told"]
    found = [furthest(campaign(warmer=told, random=random)) for _ in range(200)]
    share = np.mean([max(one["E_over_usual"], one["kelvin_over_usual"]) > STANDS_OUT for one in found])
    assert share > 0.93


def test_without_others_or_a_course_nobody_stands_out():
    observed = campaign(2)
    assert furthest(campaign(1)) is None
    assert furthest(observed.subset(observed.temperature == 4.0)) is None
    assert furthest(replace(observed, modulus=np.full(observed.size, 7e10 + 0j))) is None
    # No common condition: neither is compared.
    apart = (observed.temperature < 20.0) == (observed.specimen == 0)
    assert furthest(observed.subset(apart)) is None
