"""Prediction of isotherms and frequencies left out of the fit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.joint import Fitted, Joint


def predictions(joint: Joint, fitted: Fitted, label: NDArray) -> NDArray[np.complex128]:
    """ln E* (n,) of each row from a fit without the rows that share its label, e.g. its frequency."""
    predicted = np.empty(joint.observed.size, complex)
    for value in np.unique(label):
        rows = np.flatnonzero(label == value)
        predicted[rows] = joint.predict(joint.without(rows, fitted))[rows]
    return predicted
