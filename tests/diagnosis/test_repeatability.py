"""Coefficients of variation between and within specimens, against those that were drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.repeatability import coefficients

BETWEEN, WITHIN = (0.06, np.radians(0.8)), (0.02, np.radians(0.3))


def table(specimens, temperatures=(0.0, 20.0), frequencies=(1.0, 3.0, 10.0, 30.0)):
    """Specimens that differ by BETWEEN on each isotherm, tests that scatter by WITHIN."""
    random = np.random.default_rng(7)
    grid = np.array([(s, t, f) for t in temperatures for s in range(specimens) for f in frequencies])
    level = np.repeat(
        random.standard_normal((grid.shape[0] // len(frequencies), 2)), len(frequencies), axis=0
    )
    apart = level * BETWEEN + random.standard_normal((grid.shape[0], 2)) * WITHIN
    modulus = 5e9 * grid[:, 2] ** 0.2 * np.exp(-0.05 * grid[:, 1] + 0.3j + apart @ [1.0, 1j])
    ones = np.ones(grid.shape[0])
    names = tuple(f"S{k}" for k in range(specimens))
    return Observations(grid[:, 0].astype(int), names, grid[:, 1], grid[:, 2], modulus, ones, 0.0 * ones)


def test_both_are_those_that_were_drawn():
    found = coefficients(table(400))
    for way, drawn in (("between", np.hypot(BETWEEN, WITHIN)), ("within", WITHIN)):
        for one in (found[way], *(row[way] for row in found["by_isotherm"])):
            assert one["E_percent"] == pytest.approx(100.0 * drawn[0], rel=0.1)
            assert one["phase_deg"] == pytest.approx(np.degrees(drawn[1]), rel=0.1)
    assert [row["temperature_C"] for row in found["by_isotherm"]] == [0.0, 20.0]


def test_between_two_specimens_is_half_the_square_of_their_difference():
    observed = table(2, (0.0,), (1.0,))
    found = coefficients(observed)
    apart = np.diff(observed.logarithm)[0]
    assert found["between"]["E_percent"] == pytest.approx(100.0 * abs(apart.real) / np.sqrt(2.0))
    assert found["between"]["phase_deg"] == pytest.approx(np.degrees(abs(apart.imag)) / np.sqrt(2.0))
    assert found["within"] is None  # one test of each: level and scatter are one


def test_without_a_repeated_condition_there_is_none():
    assert coefficients(table(1)) is None


def test_tests_that_are_held_back_do_not_widen_what_their_repeats_are_judged_by():
    """A delay tilts the phases of a specimen: beside it a repeat without one would pass for an agreement."""
    sound = table(4)
    kept = sound.specimen < 3
    late = np.where(kept, 1.0, np.exp(1j * sound.omega * 5e-4))
    found = coefficients(replace(sound, modulus=sound.modulus * late), kept)
    assert found["within"] == coefficients(sound.subset(kept))["within"]
    assert found["between"]["phase_deg"] > 1.2 * coefficients(sound.subset(kept))["between"]["phase_deg"]
    # An isotherm of which one specimen is left says nothing.
    kept = (sound.specimen == 0) | (sound.isotherm == 0.0)
    cold, warm = (row["within"] for row in coefficients(sound, kept)["by_isotherm"])
    assert warm is None and cold == coefficients(sound)["by_isotherm"][0]["within"]
