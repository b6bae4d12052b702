"""Readings exchanged within an isotherm: both tests are named, nothing else is, and nothing is put right silently."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_suspects import FREQUENCIES, altered, campaign, delayed, out, row_of

from asphalt_nscd.diagnosis.screening import exchanged, suspects, within_isotherm

KINDS = {"phase": (1,), "modulus": (0,), "both": (0, 1)}


def with_exchange(observed, rows, what):
    """The same with the phases, the moduli or both of two rows exchanged."""
    parts = np.array([observed.logarithm.real, observed.logarithm.imag])
    for column in KINDS[what]:
        parts[column, rows] = parts[column, rows[::-1]]
    return replace(observed, modulus=np.exp(parts[0] + 1j * parts[1]))


def places(observed, temperature=21.0):
    """Rows of 0.5 and 5 Hz of one specimen."""
    return [row_of(observed, 1, temperature, frequency) for frequency in (0.5, 5.0)]


@pytest.mark.parametrize("temperature", [4.0, 21.0])
@pytest.mark.parametrize("what", KINDS)
def test_exchange_is_named_by_both_tests_and_nothing_else_is_set_aside(what, temperature):
    observed = campaign()
    rows = places(observed, temperature)
    wrong = with_exchange(observed, rows, what)
    loo = within_isotherm.leave_one_out(wrong)
    assert [(sorted(one.rows), one.columns) for one in loo.exchanged] == [(rows, KINDS[what])]
    found = suspects.find(wrong, loo)
    assert [one.row for one in found] == rows and not any(one.used for one in found)
    assert found[0].reasons == found[1].reasons and len(found[0].reasons) == 1
    assert not suspects.broken_isotherms(wrong, loo)


@pytest.mark.parametrize("delay", [-1e-3, 1e-3])
def test_exchange_is_found_beside_a_delay(delay):
    observed = campaign()
    rows = places(observed)
    wrong = with_exchange(delayed(observed, delay), rows, "phase")
    loo = within_isotherm.leave_one_out(wrong)
    assert loo.delay == pytest.approx(delay, rel=0.1)
    assert [sorted(one.rows) for one in loo.exchanged] == [rows]
    assert (loo.chance[rows] > 0.05).all()


def test_each_isotherm_may_have_one():
    observed = campaign()
    wrong = with_exchange(observed, cold := places(observed, 4.0), "modulus")
    wrong = with_exchange(wrong, warm := places(observed, 21.0), "phase")
    assert out(wrong) == sorted(cold + warm)


@pytest.mark.parametrize(("side", "sign"), [("higher", 1.0), ("lower", -1.0)])
def test_phases_lie_on_the_side_of_their_mean_and_exchanged_ones_on_none(side, sign):
    observed = campaign().subset(np.arange(6))
    wrong = with_exchange(observed, [0, 5], "phase")
    loo = within_isotherm.leave_one_out(wrong)
    loo.exchanged = (exchanged.Exchange((0, 5), (1,), 9.0),)
    loo.required[:] = observed.logarithm.imag
    loo.required_error[:] = 1e-9
    loo.required[1:5] -= sign * np.radians([-3.0, -3.0, 10.0, 10.0])
    said = suspects.one_sided(wrong, loo)
    assert said.startswith(f"2 of 4 phases are {side} than |E*| requires")
    assert said.endswith(f"On average all phases are 3.5 deg {side} than that.")


@pytest.mark.parametrize("scatter", [(0.003, 0.1), (0.01, 0.3)])
@pytest.mark.parametrize("seed", range(4))
def test_table_without_one_has_none(seed, scatter):
    assert not within_isotherm.leave_one_out(campaign(seed, scatter)).exchanged


@pytest.mark.parametrize(
    "change", [{"modulus": 0.3}, {"phase_deg": 6.0}, {"modulus": 0.3, "phase_deg": -5.0}]
)
@pytest.mark.parametrize("frequency", FREQUENCIES)
def test_one_wrong_reading_is_no_exchange(frequency, change):
    observed = campaign()
    wrong = altered(observed, row_of(observed, 1, 21.0, frequency), **change)
    assert not within_isotherm.leave_one_out(wrong).exchanged


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("two", [(0.5, 1.0), (1.0, 5.0), (5.0, 10.0)])
def test_two_wrong_tests_are_no_exchange_of_others(two, seed):
    """Raised alike they make a step, which two others in each other's place would nearly make."""
    observed = campaign(seed, scatter=(0.008, 0.2))
    rows = [row_of(observed, 1, 4.0, f) for f in two]
    wrong = altered(observed, rows, np.log(1.3), 4.0)
    assert not within_isotherm.leave_one_out(wrong).exchanged
    assert not set(out(wrong)) - set(rows)


@pytest.mark.parametrize("size", [2.0, 5.0])
@pytest.mark.parametrize("seed", range(3))
def test_in_an_isotherm_without_order_nothing_is_exchanged(seed, size):
    observed = campaign(seed)
    hot = observed.temperature == 37.0
    disorder = size * np.random.default_rng(seed).standard_normal(observed.size)
    assert not within_isotherm.leave_one_out(altered(observed, hot, phase_deg=disorder[hot])).exchanged


@pytest.mark.parametrize("columns", exchanged.COLUMNS)
def test_gain_is_that_of_the_evidence_computed_anew(columns):
    random = np.random.default_rng(1)
    k, m = 5, 3
    root = random.normal(size=(m, 2 * k, 2 * k))
    precision = root @ root.transpose(0, 2, 1) / k
    readings = random.normal(size=(k, 2))
    offset = random.normal(size=(k, 2))  # taken off before, as a delay is
    weights = random.normal(size=m)

    def evidence(readings):
        values = (readings - offset).T.ravel()
        return weights - 0.5 * np.einsum("i,mij,j->m", values, precision, values)

    pull = np.einsum("mij,j->mi", precision, (readings - offset).T.ravel())
    given = evidence(readings)
    gain = exchanged.gains(precision[None], pull[None], given[None], readings[None])[0]
    first, second = exchanged.pairs(k)
    for pair, (one, other) in enumerate(zip(first, second, strict=True)):
        moved = readings.copy()
        for column in columns:
            moved[[one, other], column] = moved[[other, one], column]
        expected = np.logaddexp.reduce(evidence(moved)) - np.logaddexp.reduce(given)
        assert gain[exchanged.COLUMNS.index(columns), pair] == pytest.approx(expected, abs=1e-9)


def test_an_exchange_pays_for_all_that_were_tried_and_for_values_that_fit_badly_after_it():
    """Of 6 + 3 pairs three kinds each, four more; three beyond wrong values, and twice what is less than 3 %."""
    assert exchanged.least_gain(np.array([4, 3])) == pytest.approx(4.0 + np.log(27.0))
    assert exchanged.least_beyond(0.5) == 3.0 and exchanged.least_beyond(0.003) == pytest.approx(
        3.0 + np.log(100.0)
    )
