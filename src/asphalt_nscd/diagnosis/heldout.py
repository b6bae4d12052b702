"""Prediction of isotherms and frequencies left out of the fit.

Candidates are compared by the linearised fit: with hat matrix H of the whitened fit, the residual of
a group predicted without it is (1 - H_gg)^-1 r_g, and (1 - H_gg)^-1 its predictive covariance. What
was gained is reported from fits repeated without the group.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.joint import Fitted, Joint
from asphalt_nscd.diagnosis.observations import Observations


def groups(observed: Observations) -> list[NDArray[np.int64]]:
    """Rows of each isotherm and of each frequency."""
    rows = [np.flatnonzero(observed.temperature == t) for t in observed.isotherms]
    return rows + [np.flatnonzero(observed.frequency == f) for f in observed.frequencies]


def log_density(joint: Joint, fitted: Fitted) -> float:
    """Sum over left-out groups of the logarithm of their predictive density, up to a constant."""
    n = joint.observed.size
    jacobian = fitted.jacobian
    half = np.linalg.solve(np.linalg.cholesky(fitted.precision), jacobian.T)
    total = 0.0
    for rows in groups(joint.observed):
        both = np.concatenate([rows, rows + n])
        left = np.eye(both.size) - half[:, both].T @ half[:, both]
        r = fitted.residual[both]
        total += 0.5 * np.linalg.slogdet(left)[1] - 0.5 * r @ np.linalg.solve(left, r)
    return float(total)


def predictions(joint: Joint, fitted: Fitted, label: NDArray) -> NDArray[np.complex128]:
    """ln E* (n,) of each row from a fit without the rows that share its label, e.g. its frequency."""
    predicted = np.empty(joint.observed.size, complex)
    for value in np.unique(label):
        rows = np.flatnonzero(label == value)
        predicted[rows] = joint.predict(joint.without(rows, fitted))[rows]
    return predicted
