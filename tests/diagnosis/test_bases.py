"""The flexible law: what its prior allows, and how its shift is told."""

import numpy as np
import pytest

from asphalt_nscd.diagnosis.model.bases import LN10, FlexibleSpectrum
from asphalt_nscd.diagnosis.record.rungs import _shift_constants

TIMES = np.geomspace(1e-6, 1e6, 12)


@pytest.mark.parametrize("reach", [(0.0, 0.0), (25.0, 15.0), (160.0, 5.0), (5.0, 160.0)])
def test_however_far_the_tests_reach_the_prior_is_finite_and_the_shift_regular(reach):
    base = FlexibleSpectrum(TIMES, 15.0, *reach, 0.2)
    x = np.zeros(base.parameters)
    x[-2] = base.log_odds(7e-3)
    assert np.isfinite(base.prior(x)[0]).all()
    temperature = np.linspace(7.0 - reach[0], 23.0 + reach[1], 50)  # 8 K beyond, as far as a bias is sought
    for bent in (-30.0, 0.0, 30.0):
        x[-2] = bent
        assert np.all(np.diff(base.log_shift(x, temperature)[0]) < 0.0)


class Fitted:
    """A fit with given slope, log-odds of the curvature, and their covariance."""

    def __init__(self, slope, log_odds, covariance):
        self.law = np.array([0.0, np.log(slope), log_odds, 0.0])
        self.covariance = np.zeros((4, 4))
        self.covariance[1:3, 1:3] = covariance


def test_shift_constants_and_their_errors_are_those_of_drawn_parameters():
    base = FlexibleSpectrum(TIMES, 15.0, 25.0, 15.0, 0.2)
    covariance = np.array([[4e-4, -3e-4], [-3e-4, 9e-4]])
    told = _shift_constants(base, Fitted(0.12, base.log_odds(0.008), covariance), 1.0)
    assert told["wlf_C1"]["value"] == pytest.approx(15.0) and told["wlf_C2"]["value"] == pytest.approx(125.0)
    drawn = np.random.default_rng(1).multivariate_normal(
        [np.log(0.12), base.log_odds(0.008)], covariance, 40_000
    )
    curvature = np.array([base.curvature(y)[0] for y in drawn[:, 1]])
    assert told["wlf_C2"]["std_error"] == pytest.approx(np.std(1.0 / curvature), rel=0.05)
    assert told["wlf_C1"]["std_error"] == pytest.approx(np.std(np.exp(drawn[:, 0]) / curvature), rel=0.05)


@pytest.mark.parametrize(
    ("curvature", "names"), [(2e-4, {"shift_slope"}), (-5e-3, {"shift_slope", "shift_curvature"})]
)
def test_a_shift_that_is_no_wlf_is_told_by_slope_and_curvature(curvature, names):
    base = FlexibleSpectrum(TIMES, 15.0, 25.0, 15.0, 0.2)
    told = _shift_constants(base, Fitted(0.12, base.log_odds(curvature), 1e-3 * np.eye(2)), 1.0)
    assert set(told) == names and told["shift_slope"]["value"] == pytest.approx(0.12)
    if "shift_curvature" in told:
        assert told["shift_curvature"]["value"] == pytest.approx(curvature)


def test_slope_and_curvature_are_those_of_wlf():
    base = FlexibleSpectrum(TIMES, 15.0, 25.0, 15.0, 0.2)
    x = np.zeros(base.parameters)
    x[-3:-1] = np.log(18.0 / 120.0), base.log_odds(1.0 / 120.0)
    assert base.log_shift(x, np.array([30.0]))[0] == pytest.approx(-LN10 * 18.0 * 15.0 / (120.0 + 15.0))


def test_the_departure_of_a_shift_is_a_cube_of_the_distance_to_the_middle():
    base = FlexibleSpectrum(TIMES, 15.0, 25.0, 15.0, 0.2)
    x, temperature = np.zeros(base.parameters), np.array([-10.0, 15.0, 40.0, 65.0])
    x[-3:-1] = np.log(0.12), base.log_odds(0.008)
    straight = base.log_shift(x, temperature)[0]
    x[-1] = 0.3
    assert base.log_shift(x, temperature)[0] - straight == pytest.approx([-0.3, 0.0, 0.3, 2.4])


def test_a_shift_that_turns_to_arrhenius_where_the_binder_is_glass_is_followed():
    """SHRP-A-369: C1 = 19, C2 = 92 K about the defining temperature, 261 kJ/mol below it."""
    base, glass = FlexibleSpectrum(TIMES, 15.0, 35.0, 25.0, 0.2), -5.0
    temperature = np.array([-20.0, -10.0, 0.0, 10.0, 15.0, 20.0, 30.0, 40.0])
    above, cold = np.maximum(temperature - glass, 0.0), np.minimum(temperature, glass) + 273.15
    true = -LN10 * 19.0 * above / (92.0 + above) + 261e3 / 8.314 * (1.0 / cold - 1.0 / (glass + 273.15))
    x = np.zeros(base.parameters)
    x[-3:-1] = np.log(0.12), base.log_odds(7e-3)
    for _ in range(10):  # the likeliest with 0.03 of ln time for the error of each, a tenth of a kelvin
        shift, slope = base.log_shift(x, temperature)
        left, rows = base.prior(x)
        miss = true - shift - (true - shift).mean()
        tests = (slope - slope.mean(axis=0)) / 0.03
        whole, off = np.vstack([tests, rows[:, -6:]]), np.concatenate([miss / 0.03, -left])
        x[-6:] += np.linalg.lstsq(whole, off, rcond=None)[0]
    assert np.abs(miss).max() < 0.04  # 0.13 without bends
    assert np.abs(base.prior(x)[0][-3:]).max() < 2.5  # standard deviations of the bends


def test_a_bend_acts_below_its_temperature_as_a_square():
    base = FlexibleSpectrum(TIMES, 15.0, 35.0, 25.0, 0.2)
    x, temperature = np.zeros(base.parameters), base.GLASS[1] + np.array([-20.0, -10.0, 0.0, 30.0])
    x[-3:-1] = np.log(0.12), base.log_odds(0.008)
    straight = base.log_shift(x, temperature)[0]
    x[base.times.size + 2] = 1.0
    bend = base.log_shift(x, temperature)[0] - straight
    assert bend == pytest.approx(-0.5 * base.BEND * np.array([400.0, 100.0, 0.0, 0.0]))


@pytest.mark.parametrize(
    ("roughness", "near", "last"), [(0.2, True, 0.02), (0.2, False, 0.2), (0.01, True, 0.01)]
)
def test_the_prior_is_how_far_a_law_is_from_usual_mixes(roughness, near, last):
    """Standard deviations: straight spectrum, static modulus of 1/400, 0.12 decades/K, C2 of 140 K, WLF, no bend."""
    base = FlexibleSpectrum(TIMES, 15.0, 25.0, 15.0, roughness, ends_straight=near)
    x = np.random.default_rng(6).normal(0.0, 1.0, base.parameters)
    strengths, static, bends, (slope, odds, departure) = x[:12], x[12], x[13:16], x[16:]
    least, most = -1.0 / 25.0, 1.0 / 35.0  # curvatures that are singular 10 K beyond the tests
    share = (7e-3 - least) / (most - least)
    per_odds = (most - least) * share * (1.0 - share)
    usual = np.log(share / (1.0 - share))
    expected = [
        *np.diff(strengths, 2) / np.repeat([roughness, last], 5),
        (static - np.log(np.exp(strengths).sum()) + 6.0) / 3.0,
        slope - np.log(0.12),
        (odds - usual) * per_odds / 5e-3,
        departure / 0.2,
        *bends,
    ]
    found, rows = base.prior(x)
    assert found == pytest.approx(expected)
    of_shift = np.zeros((6, 6))  # its rows begin with the slope's, its columns with the bends
    of_shift[[0, 1, 2], [3, 4, 5]] = 1.0, per_odds / 5e-3, 5.0
    of_shift[3:, :3] = np.eye(3)
    assert rows[11:, -6:] == pytest.approx(of_shift) and not rows[:11, -6:].any()


def test_a_curvature_is_begun_well_within_its_bounds():
    base = FlexibleSpectrum(TIMES, 15.0, 25.0, 15.0, 0.2)
    width = 1.0 / 35.0 + 1.0 / 25.0
    for curvature, share in ((-1.0, 0.1), (1.0, 0.9), (0.5 * width - 0.04, 0.5)):
        assert base.log_odds(curvature) == pytest.approx(np.log(share / (1.0 - share)), abs=1e-9)
