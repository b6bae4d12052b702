"""A smooth law through a table of moduli, for effects that move tests along it: warmth and wrong frequencies.

The method shares nothing with the diagnosis: three closed forms of `laws` (Huet-Sayegh, Havriliak-Negami
skewed to either side) with the WLF shift, each fitted by scipy to ln|E*| and phase of all tests under a
robust loss, so that a broken isotherm or an outlying test does not bend it. The best of the three is kept.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .laws import CENTRES, Law

SHAPES = ("huet_sayegh", "havriliak_negami", "havriliak_negami_mirrored")
SOFT = (0.10, np.radians(2.0))  # misfit of ln|E*| and phase [rad] beyond which a test loses weight
CENTRE_SHIFT = {"c1": 16.0, "c2": 130.0}  # decades, K: the middle of what `laws` draws
FREEDOM = 0.7  # of the ln of each parameter around its centre, in standard deviations of the fit
TIME_FREEDOM = 3.0  # decades


def fit_law(table: pd.DataFrame) -> Law:
    """The law of the best shape; table: temperature_C, frequency_Hz, E_MPa, phase_deg."""
    omega = 2.0 * np.pi * table["frequency_Hz"].to_numpy(float)
    temperature = table["temperature_C"].to_numpy(float)
    measured = np.log(1e6 * table["E_MPa"].to_numpy(float)), np.radians(table["phase_deg"].to_numpy(float))
    fits = [_fit(shape, omega, temperature, measured) for shape in SHAPES]
    return min(fits, key=lambda fit: fit[0])[1]


def _fit(shape: str, omega: NDArray, temperature: NDArray, measured: tuple) -> tuple[float, Law]:
    centre = CENTRES[shape]

    def law(x: NDArray) -> Law:
        own = {
            name: float(
                value + TIME_FREEDOM * step if name == "log10_tau" else value * np.exp(FREEDOM * step)
            )
            for (name, value), step in zip(centre.items(), x[:-2], strict=True)
        }
        shift = {
            name: float(value * np.exp(FREEDOM * step))
            for (name, value), step in zip(CENTRE_SHIFT.items(), x[-2:], strict=True)
        }
        return Law(shape, own, "wlf", shift)

    def misfit(x: NDArray) -> NDArray:
        modelled = law(x).modulus(omega, temperature)
        tests = np.log(np.abs(modelled)) - measured[0], np.angle(modelled) - measured[1]
        return np.concatenate([part / size for part, size in zip(tests, SOFT, strict=True)] + [0.3 * x])

    found = least_squares(misfit, np.zeros(len(centre) + 2), loss="soft_l1", bounds=(-4.0, 4.0))
    return float(found.cost), law(found.x)


def shift_rate(law: Law, temperature: float) -> float:
    """Rate of ln a_T at temperature [degC], 1/K: below zero, since warmth is speed."""
    step = 0.01
    return float((law.log_shift(temperature + step) - law.log_shift(temperature - step)) / (2.0 * step))
