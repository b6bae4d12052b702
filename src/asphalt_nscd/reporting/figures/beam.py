"""The elastic line of the specimen in beam theory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.measurements.twopoint import Geometry


def deflection(geometry: Geometry, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Elastic line of the trapezoidal cantilever under a force at its free head, 1 at the head.

    x: heights above the foot [m], from 0 to h, rising. w'' ~ (h - x) / width(x)^3, the bending
    theory behind the form factor of Eq. (3), integrated by the trapezoidal rule.
    """
    width = geometry.B - (geometry.B - geometry.b) * x / geometry.h
    curvature = (geometry.h - x) / width**3
    step = np.diff(x)
    slope = np.concatenate([[0.0], np.cumsum(0.5 * step * (curvature[1:] + curvature[:-1]))])
    line = np.concatenate([[0.0], np.cumsum(0.5 * step * (slope[1:] + slope[:-1]))])
    return line / line[-1]
