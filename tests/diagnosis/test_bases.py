"""The flexible law: what its prior allows, and how its shift is told."""

import numpy as np
import pytest

from asphalt_nscd.diagnosis.bases import LN10, FlexibleSpectrum
from asphalt_nscd.diagnosis.rungs import _shift_constants

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
