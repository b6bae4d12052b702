"""Wrong values that bend their neighbours or hide each other; the algebra against dense matrices."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp
from test_suspects import FREQUENCIES, altered, campaign, out, row_of

from asphalt_nscd.diagnosis.screening import suspects, within_isotherm, wrong_values


@pytest.mark.parametrize("factor", [10.0, 0.1, 0.145])
@pytest.mark.parametrize("frequency", FREQUENCIES)
@pytest.mark.parametrize("temperature", [4.0, 37.0])
def test_a_slip_condemns_itself_alone(factor, frequency, temperature):
    observed = campaign()
    row = row_of(observed, 1, temperature, frequency)
    slipped = altered(observed, [row], modulus=np.log(factor))
    assert out(slipped) == [row]
    reasons = [reason for one in suspects.find(slipped) for reason in one.reasons]
    assert all(0.0 <= phase <= 90.0 for phase in map(_expected, reasons) if phase is not None)


@pytest.mark.parametrize("factor", [10.0, 0.1])
@pytest.mark.parametrize("frequency", [0.1, 1.0, 25.0])
def test_a_slip_of_ten_is_left_out_of_a_sweep_of_three(frequency, factor):
    """Of three tests none is judged by causality, and three replicates alone take none out."""
    whole = campaign()
    three = whole.subset(np.isin(whole.frequency, [0.1, 1.0, 25.0]))
    row = row_of(three, 1, 4.0, frequency)
    assert out(three) == []
    slipped = altered(three, [row], modulus=np.log(factor))
    assert out(slipped) == [row]
    (found,) = [one for one in suspects.find(slipped) if one.row == row]
    expected = float(found.reasons[0].partition("expected about ")[2].split()[0])
    assert expected == pytest.approx(abs(three.modulus[row]) / 1e6, rel=0.3)
    sweep = (slipped.specimen == 1) & (slipped.temperature == 4.0)
    # Two of three: the one that is right is not taken for the wrong one.
    assert out(altered(three, np.flatnonzero(sweep)[:2], modulus=np.log(factor))) == []
    if frequency != 1.0:
        two = slipped.subset(~sweep | np.isin(slipped.frequency, [frequency, 1.0]))
        assert out(two) == [row_of(two, 1, 4.0, frequency)]
        alone = two.subset(two.specimen == 1)
        assert wrong_values.expected_of_tens(alone) == {}


def _expected(reason):
    """The phase [deg] that a sentence expects."""
    _, found, rest = reason.partition(" deg, expected ")
    return float(rest.split()[0]) if found else None


def test_no_impossible_phase_is_expected():
    """Even where a test is judged by neighbours that make no curve."""
    observed = campaign()
    loo = within_isotherm.leave_one_out(observed)
    for phase in (-7.4, 255.2):
        told = suspects._causal_reason(
            observed, replace(loo, expected=loo.expected * 0 + np.radians(phase)), 3, 1
        )
        assert "expected" not in told and "does not fit" in told


def test_two_wrong_tests_of_one_sweep_no_longer_hide_each_other():
    observed = campaign()
    rows = [row_of(observed, 1, 21.0, f) for f in (1.0, 10.0)]
    assert out(altered(observed, rows, modulus=0.2, phase_deg=4.0)) == sorted(rows)


def test_odds_are_those_of_dense_matrices():
    random = np.random.default_rng(3)
    tests, mixtures = 5, 3
    roots = random.standard_normal((mixtures, 2 * tests, 2 * tests))
    covariance = roots @ roots.transpose(0, 2, 1) + 0.1 * np.eye(2 * tests)
    values = random.standard_normal(2 * tests)
    values[[2, 7]] += 60.0
    precision = np.linalg.inv(covariance)
    pull = precision @ values
    weights = np.log([0.5, 0.3, 0.2])

    def evidence(kept):
        own = covariance[:, kept][:, :, kept]
        square = np.einsum("i,mij,j->m", values[kept], np.linalg.inv(own), values[kept])
        whole = -0.5 * (square + np.linalg.slogdet(own)[1] + kept.size * np.log(2.0 * np.pi))
        return logsumexp(weights + whole)

    every = np.arange(2 * tests)
    weighed = weights + 0.5 * np.linalg.slogdet(precision)[1] - 0.5 * pull @ values
    ((odds, found),) = wrong_values.likeliest(precision[None], pull[None], weighed[None], 2)
    assert found.tolist() == [2, 7]
    density = -sum(np.log(np.sqrt(2.0 * np.pi) * width) for width in wrong_values.WIDE)
    before = wrong_values.RARE + wrong_values.WITH_IT  # modulus and phase of one test
    assert odds == pytest.approx(evidence(np.setdiff1d(every, found)) + density - evidence(every) + before)


def test_a_value_taken_for_wrong_pays_for_the_width_that_it_then_has():
    """Of one test and one spectrum: a Gaussian of precision 4 or 9 about the law, against one of the width WIDE."""
    precision, pull = np.diag([4.0, 9.0])[None, None], np.array([[[6.0, 3.0]]])
    each = 0.5 * np.array([36.0 / 4.0, 9.0 / 9.0]) - 0.5 * np.log([4.0, 9.0]) - np.log(wrong_values.WIDE)
    ((odds, values),) = wrong_values.likeliest(precision, pull, np.zeros((1, 1)), room=1)
    assert odds == pytest.approx(each.max() + wrong_values.RARE) and values.tolist() == [0]
