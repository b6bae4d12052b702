"""Which half of a sweep is wrong is asked of the other specimens; that something is wrong is not."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from test_suspects import LAW, altered, out, row_of

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import contested, suspects

FREQUENCIES = np.array([3.0, 10.0, 25.0, 40.0])
TEMPERATURES = np.array([4.0, 21.0, 37.0])


def campaign(specimens=3, isotherms=TEMPERATURES, frequencies=FREQUENCIES):
    specimen, temperature, frequency = (
        values.ravel() for values in np.meshgrid(np.arange(specimens), isotherms, frequencies, indexing="ij")
    )
    random = np.random.default_rng(4)
    noise = random.normal(0.0, 0.005, (2, specimen.size))
    level = (1.0 + 0.2j) * np.array([0.5, -0.5, 0.0, 0.2])[specimen]
    modulus = LAW.complex_modulus(2.0 * np.pi * frequency, temperature)
    modulus = modulus * np.exp(level + noise[0] + 0.5j * noise[1])
    ones = np.ones(specimen.size)
    names = ("A", "B", "C", "D")[:specimens]
    return Observations(specimen, names, temperature, frequency, modulus, ones, 0.0 * ones)


def rows_of(observed, *frequencies):
    """Of specimen B at 21 degC."""
    return [row_of(observed, 1, 21.0, f) for f in frequencies]


def mask(observed, rows):
    return np.isin(np.arange(observed.size), rows)


@pytest.mark.parametrize("scatter", [0.0, 0.03])
def test_distance_is_how_far_off_its_level_a_test_is_in_usual_departures(scatter):
    """Off the middle of the others, less what its specimen is off elsewhere; 1.4826 medians, or 1 % and 0.3 deg."""
    observed = campaign()
    noise = np.random.default_rng(3).normal(0.0, scatter, (2, observed.size))
    observed = altered(observed, np.arange(observed.size), noise[0], np.degrees(noise[1]))
    values = np.stack([observed.logarithm.real, observed.logarithm.imag], axis=1).reshape(3, 3, 4, 2)
    apart = np.stack([values[k] - np.median(np.delete(values, k, axis=0), axis=0) for k in range(3)])
    level = [[np.median(np.delete(apart[k], t, axis=0), axis=(0, 1)) for t in range(3)] for k in range(3)]
    off = np.abs(apart - np.array(level)[:, :, None]).reshape(-1, 2)
    usual = np.maximum(1.4826 * np.median(off, axis=0), [0.01, np.radians(0.3)])
    assert bool(usual[0] > 0.01) is (scatter > 0.0)
    assert contested._level_distance(observed) == pytest.approx((off / usual).max(axis=1))


@pytest.mark.parametrize("specimens", [2, 3, 4])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("sizes", [(0.26, 4.0), (0.26, 0.0), (0.0, 15.0)], ids=["both", "modulus", "phase"])
def test_of_two_halves_the_one_off_the_level_of_its_specimen_is_left_out(specimens, sign, sizes):
    observed = campaign(specimens)
    wrong, right = rows_of(observed, 10.0, 25.0), rows_of(observed, 3.0, 40.0)
    observed = altered(observed, wrong, *(sign * size for size in sizes))
    for accused in (right, right[:1], [*right, wrong[0]], [right[0], wrong[0]], wrong):
        now, turned = contested.put_right(observed, mask(observed, accused))
        assert np.flatnonzero(now).tolist() == wrong
        assert np.flatnonzero(turned).tolist() == ([] if accused is wrong else sorted(wrong + right))


def test_a_sound_test_beside_a_wrong_one_is_put_back_though_they_are_no_half_of_the_sweep():
    observed = campaign(frequencies=np.array([0.1, 0.5, 1.0, 5.0, 10.0, 25.0]))
    wrong, sound = rows_of(observed, 1.0, 5.0), rows_of(observed, 10.0)
    observed = altered(observed, wrong, 0.26, 4.0)
    now, turned = contested.put_right(observed, mask(observed, [wrong[0], *sound]))
    assert np.flatnonzero(now).tolist() == wrong and turned[sound].all()


def test_of_four_a_half_is_contested_though_none_of_it_is_clearly_on_the_level():
    observed = campaign()
    wrong, middle = rows_of(observed, 10.0, 25.0), rows_of(observed, 40.0)
    observed = altered(altered(observed, wrong, 0.26), middle, 0.11)
    distance = contested._level_distance(observed)
    assert 0.38 < distance[middle[0]] / distance[wrong].max() < 0.48
    now, _ = contested.put_right(observed, mask(observed, [wrong[0], *middle]))
    assert np.flatnonzero(now).tolist() == wrong


def test_of_tests_that_causality_accuses_less_distance_is_asked_than_of_others():
    observed = campaign()
    wrong, right = rows_of(observed, 10.0, 25.0), rows_of(observed, 3.0, 40.0)
    for size, expected in ((0.045, wrong), (0.03, right)):
        near = altered(observed, wrong, size)
        apart = contested._level_distance(near)[wrong].max()
        assert 3.0 < apart < contested.FAR and bool(apart > contested.ACCUSED) is (expected is wrong)
        now, _ = contested.put_right(near, mask(near, right))
        assert np.flatnonzero(now).tolist() == expected
    assert not contested.masked(near, mask(near, []), mask(near, wrong)).any()


def test_what_stays_is_not_accused_where_it_is_on_the_level_too_or_most_of_a_sweep_is_off():
    observed = campaign()
    right = mask(observed, rows_of(observed, 3.0, 40.0))
    three = rows_of(observed, 3.0, 10.0, 25.0)
    for table, accused in (
        (observed, right),
        (altered(observed, three, 0.26), mask(observed, rows_of(observed, 40.0))),
        (altered(observed, rows_of(observed, *FREQUENCIES), 0.26), right),
    ):
        now, turned = contested.put_right(table, accused)
        assert (now == accused).all() and not turned.any()


def test_scatter_turns_nothing():
    observed = campaign(4)
    for sweep in np.arange(observed.size).reshape(-1, FREQUENCIES.size):
        for pair in combinations(sweep, 2):
            accused = mask(observed, pair)
            now, turned = contested.put_right(observed, accused)
            assert (now == accused).all() and not turned.any()


@pytest.mark.parametrize("alone", [{"specimens": 1}, {"isotherms": TEMPERATURES[1:2]}])
def test_without_other_specimens_or_isotherms_nothing_is_turned(alone):
    observed = campaign(**alone)
    row = int(np.flatnonzero(observed.frequency == 10.0)[-1])
    accused = mask(observed, [row + 1])
    now, turned = contested.put_right(altered(observed, [row], 0.26), accused)
    assert (now == accused).all() and not turned.any()


def test_a_pair_of_wrong_readings_in_four_is_left_out_and_the_reason_says_who_tells():
    observed = campaign()
    wrong = rows_of(observed, 10.0, 25.0)
    observed = altered(observed, wrong, np.log(1.3), 4.0)
    assert out(observed) == wrong
    for one in suspects.find(observed):
        assert one.reasons == (suspects.HALVES,) or one.used


@pytest.mark.parametrize("specimens", [3, 4])
def test_two_wrong_readings_of_which_causality_accuses_none_are_told_by_the_other_specimens(specimens):
    observed, none = campaign(specimens), mask(campaign(specimens), [])
    wrong = rows_of(observed, 10.0, 25.0)
    observed = altered(observed, wrong, np.log(1.3), 4.0)
    for doubted in (wrong, wrong[:1]):
        found = contested.masked(observed, none, mask(observed, doubted))
        assert np.flatnonzero(found).tolist() == wrong
    others = rows_of(observed, 3.0, 40.0)
    assert not contested.masked(observed, none, none).any()
    assert not contested.masked(observed, none, mask(observed, others)).any()
    assert not contested.masked(observed, mask(observed, others[:1]), mask(observed, wrong)).any()


def test_of_two_specimens_or_where_a_sweep_departs_smoothly_none_is_told():
    two = campaign(2)
    wrong = rows_of(two, 10.0, 25.0)
    assert not contested.masked(altered(two, wrong, np.log(1.3)), mask(two, []), mask(two, wrong)).any()
    observed = campaign()
    for frequencies, size in (
        (FREQUENCIES, np.array([0.3, 0.2, 0.13, 0.05])),
        (FREQUENCIES[:3], 0.26),
        ([10.0], 0.26),
    ):
        rows = rows_of(observed, *frequencies)
        assert not contested.masked(
            altered(observed, rows, size), mask(observed, []), mask(observed, rows)
        ).any()


def test_a_wrong_sweep_accuses_no_sound_one():
    """Against three specimens of which one is far off, a sound one seems off by half as much."""
    observed = campaign()
    wrong = rows_of(observed, 10.0, 25.0)
    observed = altered(observed, wrong, 0.6, 8.0)
    found = contested.masked(observed, mask(observed, []), mask(observed, np.arange(observed.size)))
    assert np.flatnonzero(found).tolist() == wrong
