"""Measurements of which printed laws are the fit and printed errors the residual, drawn about one smooth law.

At each temperature four conditions make a Burgers law the fit of least squares in ln E*, and two say what it misses.
Ten numbers (norm and phase at five frequencies) leave four free: drawn about a smooth law for all temperatures, then
moved to the nearest point that meets all six. The law is the one nearest to such data, found by turns; the scatter of
the draws is the distance that remains.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import null_space
from scipy.optimize import minimize

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.rivals import rivals
from studies.paper.smooth_bounds import Printed, log_slopes

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
TURNS = 6
TRIES = 20  # of a draw that leads nowhere
CLOSE = 1e-6  # to a printed error, absolute
GAIN = 1e4  # brings squares of ln E* to order one


def nearest(printed: Printed, wanted: Complex) -> Complex | None:
    """ln E* (n,) nearest to `wanted` that has the law as its fit and the two printed errors; None if not found."""
    law = np.log(printed.modulus)
    n, angle = law.size, law.imag
    free = null_space(log_slopes(printed.law, printed.omega).T)  # of errors that leave the fit where it is
    away = wanted - law
    start = free.T @ np.concatenate([away.real, away.imag])

    def parts(x: Vector) -> tuple[Vector, Vector, Vector]:
        error = free @ x
        with np.errstate(over="ignore"):  # a wild trial
            return error, np.expm1(-error[:n]), error[n:] / (angle + error[n:])

    def missed(x: Vector, corner: float = 0.0) -> Vector:
        _, norm, phase = parts(x)
        means = np.hypot(norm, corner).mean(), np.hypot(phase, corner).mean()
        return np.array(means) - (printed.error, printed.phase_error)

    def slopes(x: Vector, corner: float = 0.0) -> NDArray[np.float64]:
        error, norm, phase = parts(x)
        by_norm = -_sign(norm, corner) * (1.0 + norm) / n
        by_phase = _sign(phase, corner) * angle / (angle + error[n:]) ** 2 / n
        return np.stack([by_norm @ free[:n], by_phase @ free[n:]])

    def moved(x: Vector, corner: float) -> Vector:
        """From x to the printed errors; corner: how far the |error| of each test is rounded off at zero."""
        found = minimize(
            lambda x: 0.5 * GAIN * ((x - start) ** 2).sum(),
            x,
            jac=lambda x: GAIN * (x - start),
            constraints={"type": "eq", "fun": missed, "jac": slopes, "args": (corner,)},
            method="SLSQP",
            options={"maxiter": 100, "ftol": 1e-10},
        )
        return np.asarray(found.x)

    # The search may stop where an error changes its sign: then it begins anew from a path without these corners.
    x = moved(start, 0.0)
    if np.abs(missed(x)).max() > CLOSE:
        x = moved(moved(start, printed.error), 0.0)
    error = free @ x
    # A phase at or below zero is no material's.
    if np.abs(missed(x)).max() > CLOSE or (angle + error[n:]).min() <= 0.0:
        return None
    return np.asarray(law + error[:n] + 1j * error[n:])


def _sign(error: Vector, corner: float) -> Vector:
    """Slope of |error| with its corner at zero rounded off."""
    return np.asarray(error / np.hypot(error, corner) if corner else np.sign(error))


def nearest_law(
    printed: Sequence[Printed], temperature: Vector, smooth: Complex, reference: float
) -> tuple[Complex, float]:
    """ln E* (t, n) of a 2S2P1D law near data that meet all that is printed, and the distance that remains.

    `temperature` (t,) and `reference` (of the shift) in degC; `smooth` (t, n) is ln E* of the law to start from. The
    distance is the root mean square of one part of ln E*.
    """
    omega = np.tile(printed[0].omega, len(printed))
    each = np.repeat(temperature, printed[0].omega.size)
    law, best, x = smooth, (smooth, np.inf), None
    for _ in range(TURNS):
        met = [nearest(one, row) for one, row in zip(printed, law, strict=True)]
        data = np.array([row if new is None else new for row, new in zip(law, met, strict=True)])
        rival = next(rivals(omega, each, np.exp(data).ravel(), reference))
        x = rival.fit(omega, each, np.exp(data).ravel(), x)
        law = np.log(rival.modulus(x, omega, each)).reshape(data.shape)
        distance = float(np.sqrt((np.abs(data - law) ** 2).mean() / 2.0))
        if all(new is not None for new in met) and distance < best[1]:
            best = law, distance
    return best


def draws(printed: Sequence[Printed], law: Complex, scatter: float, number: int, seed: int) -> Complex:
    """Draw data that meet all that is printed, scattered about a law: ln E* (number, t, n).

    `law` (t, n) is ln E* of the smooth law; `scatter` is the standard deviation of each part of ln E*. Raises
    InputError where no data meet the printed laws and errors.
    """
    found = np.empty((number, *law.shape), complex)
    for k in range(number):
        random = np.random.default_rng([seed, k])  # a stream of its own: the same draw among two or ten
        for row, (one, about) in enumerate(zip(printed, law, strict=True)):
            for _ in range(TRIES):
                noise = random.standard_normal((2, about.size))
                new = nearest(one, about + scatter * (noise[0] + 1j * noise[1]))
                if new is not None:
                    found[k, row] = new
                    break
            else:
                raise InputError("no data meet the printed laws and errors; check both tables.")
    return found
