"""The tails are those of scipy.stats, to the last bit, and nothing in the diagnosis imports that."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from scipy import stats

from asphalt_nscd.diagnosis import tails

VALUES = np.array([0.0, 1e-3, 0.5, 1.0, 3.7, 20.0, 400.0])
FREEDOM = np.array([1.0, 2.5, 7.0, 300.0, 1e6])[:, None]


def test_tails_are_those_of_scipy_stats():
    both = np.concatenate([-VALUES, VALUES])
    assert np.array_equal(tails.normal(both), stats.norm.sf(both))
    assert np.array_equal(tails.student(both, FREEDOM), stats.t.sf(both, FREEDOM))
    assert np.array_equal(tails.chi_squared(VALUES, FREEDOM), stats.chi2.sf(VALUES, FREEDOM))
    assert np.array_equal(tails.fisher(VALUES, 2.0, FREEDOM), stats.f.sf(VALUES, 2.0, FREEDOM))
    levels = np.array([1e-9, 0.01, 0.5, 0.999])
    assert np.array_equal(tails.normal_beyond(levels), stats.norm.isf(levels))


def test_a_diagnosis_starts_without_scipy_stats():
    script = "import sys, asphalt_nscd.api.diagnosis; print('scipy.stats' in sys.modules, 'numba' in sys.modules)"
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout
    assert said == "False False\n"
