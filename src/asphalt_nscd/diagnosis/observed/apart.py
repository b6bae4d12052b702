"""The specimen that stands out: how far its tests lie from the mean of the others, against what laboratories have.

Nobody is accused by that: air voids, dimensions and temperature of a whole specimen look much alike. It says which
specimen makes the scatter, where that is more than usual by the priors of `criteria.LABORATORY`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.criteria import LABORATORY, Z_95
from asphalt_nscd.diagnosis.observed.observations import Complex, Observations
from asphalt_nscd.diagnosis.observed.scatter import SPECIMEN_PHASE, SPECIMEN_SCALE

STANDS_OUT = 3.0  # usual differences between a specimen and the others, from which it is told
ONE_TEST = 0.01, float(np.radians(0.3))  # scatter of ln|E*| and of the phase


def furthest(observed: Observations) -> dict[str, Any] | None:
    """`furthest` of diagnosis.json: the specimen furthest from the others; None where nothing compares them.

    Two isotherms and two frequencies at least say what a kelvin does.
    """
    if min(observed.isotherms.size, observed.frequencies.size, np.unique(observed.specimen).size) < 2:
        return None
    found = [one for k in np.unique(observed.specimen) if (one := _compared(observed, int(k))) is not None]
    return max(found, key=lambda one: max(one["E_over_usual"], one["kelvin_over_usual"]), default=None)


def _compared(observed: Observations, k: int) -> dict[str, Any] | None:
    """Mean difference of ln|E*| of specimen k from the others, and the temperature that would explain it [K]."""
    own, others = (_means(observed, rows) for rows in (observed.specimen == k, observed.specimen != k))
    per_kelvin = np.gradient(others, observed.isotherms, axis=1)
    per_time = np.gradient(others, np.log(observed.frequencies), axis=0)
    known = np.isfinite(own + per_kelvin + per_time)
    if known.any(axis=0).sum() < 2 or not per_kelvin[known].real.any():
        return None
    sweep = np.eye(observed.isotherms.size)[np.nonzero(known)[1]]
    left, kelvin, time = (_stacked(x[known]) for x in (own - others, per_kelvin, per_time))
    level = np.repeat([1.0, 0.0], known.sum())
    usual = {name: one.size for name, one in LABORATORY.items()}
    roots = [
        usual["specimen temperature"] * _stacked(per_kelvin[known][:, None] * sweep),
        usual["mounting, modulus"] * _stacked(sweep + 0j),
        usual["mounting, phase"] * _stacked(1j * sweep),
        np.column_stack([SPECIMEN_SCALE * level, SPECIMEN_PHASE * (1.0 - level)]),
        np.diag(np.repeat(ONE_TEST, known.sum())),
    ]
    others_too = 1.0 + 1.0 / (np.unique(observed.specimen).size - 1.0)
    covariance = others_too * sum(root @ root.T for root in roots)
    times = others_too * usual["specimen times"] ** 2
    weight = np.linalg.solve(covariance, kelvin)
    warmer, variance = weight @ left / (weight @ kelvin), 1.0 / (weight @ kelvin)
    mean = level / level.sum()
    # Longer relaxation times are as many kelvin as |E*| says.
    variance += times * ((mean @ np.abs(time)) / (mean @ np.abs(kelvin))) ** 2
    of_mean = mean @ covariance @ mean + times * (mean @ time) ** 2
    told = STANDS_OUT + Z_95
    return {
        "specimen": observed.names[k],
        "E_percent": 100.0 * float(np.expm1(mean @ left)),
        "kelvin": float(warmer),
        "E_over_usual": float(abs(mean @ left) / np.sqrt(of_mean)),
        "kelvin_over_usual": float(abs(warmer) / np.sqrt(variance)),
        "E_percent_told": 100.0 * float(np.expm1(told * np.sqrt(of_mean))),
        "kelvin_told": float(told * np.sqrt(variance)),
    }


def _stacked(values: NDArray) -> NDArray[np.float64]:
    """Real part above the imaginary one."""
    return np.concatenate([values.real, values.imag])


def _means(observed: Observations, rows: NDArray[np.bool_]) -> Complex:
    """Mean ln E* of some tests by frequency and isotherm, NaN where there are none."""
    at = (
        np.searchsorted(observed.frequencies, observed.frequency[rows]),
        np.searchsorted(observed.isotherms, observed.isotherm[rows]),
    )
    total = np.zeros((observed.frequencies.size, observed.isotherms.size), complex)
    count = np.zeros(total.shape)
    np.add.at(total, at, observed.logarithm[rows])
    np.add.at(count, at, 1.0)
    return np.where(count > 0.0, total / np.maximum(count, 1.0), np.nan)
