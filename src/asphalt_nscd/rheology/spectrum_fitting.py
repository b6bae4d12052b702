"""Fit of one continuous law to all temperatures at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import OptimizeResult
from scipy.special import expit

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.fitting import (
    Fit,
    best_of_starts,
    covariance_of,
    log_residual,
    require_points,
    rms_of,
)
from asphalt_nscd.rheology.shift import SHIFTS
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum, parameter_names, parameters

LEAST_TEMPERATURES = {"wlf": 3, "arrhenius": 2}

# Each parameter in the coordinate of the fit: its bounds, and the range of the random starts.
# Moduli over the largest norm, tau times the middle frequency, c2 above its least value and the
# activation energy over 1e5 J/mol are logarithms, as are delta, beta and c1; h and k/h are log-odds.
RANGES = {
    "static_modulus": (-14.0, -0.1, -8.0, -4.0),
    "glassy_modulus": (-0.5, 3.0, 0.0, 1.0),
    "k": (-5.0, 5.0, -1.5, 0.0),
    "h": (-5.0, 5.0, -0.5, 2.0),
    "delta": (-5.0, 6.0, 0.0, 1.5),
    "tau": (-15.0, 15.0, -3.0, 8.0),
    "beta": (-3.0, 15.0, 2.0, 8.0),
    "c1": (0.0, 8.0, 2.0, 3.5),
    "c2": (-5.0, 10.0, 3.0, 5.5),
    "activation_energy": (-5.0, 3.0, 0.0, 1.5),
}
NO_EFFECT = 1e-5  # of a parameter on the residuals, relative to that of the strongest one


def fit_spectrum(
    omega: ArrayLike, temperature: ArrayLike, modulus: ArrayLike, reference_temperature: float,
    law: str = "2s2p1d", shift: str = "wlf",
) -> Fit[Spectrum]:  # fmt: skip
    """A law of LAWS with a shift of SHIFTS, all parameters jointly, from E* [Pa] of all temperatures.

    omega [rad/s], temperature [degC], modulus [Pa]: vectors of one length. Standard errors go by
    the names of `spectrum.parameters`.
    """
    omega, modulus = require_points(omega, modulus)
    temperature = np.asarray(temperature, dtype=float)
    least = LEAST_TEMPERATURES[shift]
    if np.unique(temperature).size < least:
        raise InputError(
            f"a shift of kind {shift!r} needs at least {least} temperatures; measure more of them."
        )
    own, of_shift = parameter_names(LAWS[law]), parameter_names(SHIFTS[shift])
    names = own + of_shift
    if 2 * modulus.size < len(names):
        raise InputError(
            f"{modulus.size} points cannot determine {len(names)} parameters; "
            f"measure at least {(len(names) + 1) // 2}."
        )
    rate, largest = float(np.sqrt(omega.min() * omega.max())), float(np.abs(modulus).max())
    # The shift is singular at c2 below the coldest test; 5 K keeps the steps of the fit off it.
    least_c2 = max(0.0, float(reference_temperature - temperature.min())) + 5.0
    scales = {
        "static_modulus": largest, "glassy_modulus": largest, "tau": 1.0 / rate, "activation_energy": 1e5,
    }  # fmt: skip

    def build(x: NDArray) -> Spectrum:
        given = dict(zip(names, x.tolist(), strict=True))
        values = {name: scales.get(name, 1.0) * float(np.exp(value)) for name, value in given.items()}
        values["h"] = float(expit(given["h"]))
        values["k"] = values["h"] * float(expit(given["k"]))
        if "c2" in values:
            values["c2"] += least_c2
        shifted = SHIFTS[shift](
            **{name: values[name] for name in of_shift}, reference_temperature=float(reference_temperature)
        )
        return LAWS[law](**{name: values[name] for name in own}, shift=shifted)

    def residual(x: NDArray) -> NDArray:
        with np.errstate(over="ignore", invalid="ignore"):  # wild trial shifts; such steps are refused
            return log_residual(modulus, build(x).complex_modulus(omega, temperature))

    low, high, first, last = np.array([RANGES[name] for name in names]).T
    solution = best_of_starts(residual, (low, high), (first, last))
    seen = _seen(solution, low, high)
    if "c2" in names and not seen[names.index("c2")]:
        seen[names.index("c1")] = False  # of a straight shift only C1/C2 is determined
    return Fit(
        build(solution.x),
        _standard_errors(solution, seen, build, names),
        rms_of(solution, modulus.size),
        freedom=2 * modulus.size - int(seen.sum()),
        unseen=tuple(name for name, visible in zip(names, seen, strict=True) if not visible),
    )


def _seen(solution: OptimizeResult, low: NDArray, high: NDArray) -> NDArray[np.bool_]:
    """Which parameters are off their bounds and move the residuals."""
    effect = np.linalg.norm(solution.jac, axis=0)
    margin = 1e-2  # the steps of the fit end a little inside the bounds
    inside = (solution.x > low + margin) & (solution.x < high - margin)
    return inside & (effect > NO_EFFECT * effect.max())


def _standard_errors(
    solution: OptimizeResult, seen: NDArray, build: Callable[[NDArray], Spectrum], names: list[str]
) -> dict[str, float] | None:
    """Those of the parameters themselves, carried over from the coordinates to first order."""
    covariance = covariance_of(solution, seen)
    if covariance is None:
        return None
    step = 1e-5

    def values(x: NDArray) -> NDArray:
        found = parameters(build(x))
        return np.array([found[name] for name in names])

    slope = np.column_stack(
        [
            (values(solution.x + move) - values(solution.x - move)) / (2.0 * step)
            for move in step * np.eye(len(names))[seen]
        ]
    )
    variance = np.einsum("pi,ij,pj->p", slope, covariance, slope)
    return {
        name: float(np.sqrt(value))
        for name, value, visible in zip(names, variance, seen, strict=True)
        if visible
    }
