"""What is not known of the sizes of a discrepancy widens the standard error of a cause (Kackar and Harville 1984)."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from test_discrepancy import small

from asphalt_nscd.diagnosis.model import likelihood


def test_the_variance_added_is_slope_times_covariance_times_slope():
    """Slope of the amplitude and curvature of the objective along ln v, both by differences."""
    model, cause = small(np.random.default_rng(5))
    found = likelihood.estimate(model, cause)
    wide = likelihood.widen_error(model, cause, found)
    log_v = np.log(found.variances)

    def slope(at):
        return approx_fprime(at, lambda x: likelihood._point(model, cause, x).objective, 1e-5)

    step = 1e-3 * np.eye(log_v.size)
    curvature = np.array([slope(log_v + e) - slope(log_v - e) for e in step]) / 2e-3
    value, vector = np.linalg.eigh(0.25 * (curvature + curvature.T))
    along = approx_fprime(log_v, lambda x: likelihood._point(model, cause, x).amplitude, 1e-6)
    covariance = vector / (np.maximum(value, 0.0) + likelihood.UNKNOWN**-2) @ vector.T
    added = along @ covariance @ along
    assert added > 0.02 * found.std_error**2
    assert wide.std_error**2 - found.std_error**2 == pytest.approx(added, rel=0.02)
    assert wide.amplitude == found.amplitude
