"""Fits of viscoelastic laws to complex moduli.

All fits minimise the complex residual ln(E_measured / E_law): its real part is the relative error
of the norm, its imaginary part the error of the phase in radians, so both count alike at every
temperature and frequency.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import OptimizeResult, least_squares

from asphalt_nscd.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.spectrum import TwoS2P1D

SEED = 20200117  # of the random starts; any value, fixed so that a fit can be repeated
STARTS = 24

Law = TypeVar("Law")
Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Fit(Generic[Law]):
    """A fitted law.

    std_error: standard error of each parameter, by field name and in its unit, all points taken as
    independent (a scatter common to a whole specimen is not); None where the points do not outnumber
    the parameters or do not determine them all. rms_log_residual: root mean square of
    |ln(E_measured / E_law)| over the points.
    """

    law: Law
    std_error: dict[str, float] | None
    rms_log_residual: float


def fit_burgers(omega: ArrayLike, modulus: ArrayLike) -> Fit[Burgers]:
    """Burgers law of one temperature from E* [Pa] at angular frequencies omega [rad/s] (vectors)."""
    omega, modulus = _require_points(omega, modulus)
    if np.unique(omega).size < 2:
        raise InputError("a Burgers law needs at least two frequencies; measure more at this temperature.")
    # Scales in which every parameter is of order one: the largest norm and the middle frequency.
    stress, rate = np.abs(modulus).max(), np.sqrt(omega.min() * omega.max())
    scale = np.log([stress, stress / rate, stress, stress / rate])

    def build(x: Vector) -> Burgers:
        return Burgers(*np.exp(x + scale).tolist())

    def residual(x: Vector) -> Vector:
        return _log_residual(modulus, build(x).complex_modulus(omega))

    # e^14 is a stiffness no measured phase can tell from rigid: beyond it the parameter is unseen.
    bounds = np.full(4, -14.0), np.full(4, 14.0)
    solution = _best_of_starts(residual, bounds, starts=(np.full(4, -3.0), np.full(4, 5.0)))
    law = build(solution.x)
    std_log = _standard_errors(solution)
    std_error = None
    if std_log is not None:
        names = [field.name for field in fields(Burgers)]
        std_error = {name: getattr(law, name) * float(s) for name, s in zip(names, std_log, strict=True)}
    return Fit(law, std_error, _rms(solution, modulus.size))


def fit_spectrum(
    omega: ArrayLike, temperature: ArrayLike, modulus: ArrayLike, reference_temperature: float
) -> Fit[TwoS2P1D]:
    """2S2P1D law with WLF shift (nine parameters, jointly) from E* [Pa] of all temperatures.

    omega [rad/s], temperature [degC], modulus [Pa]: vectors of one length. No standard errors are
    given: the static modulus often runs to its lower bound, where they have no meaning.
    """
    omega, modulus = _require_points(omega, modulus)
    temperature = np.asarray(temperature, dtype=float)
    if np.unique(temperature).size < 3:
        raise InputError("a WLF shift needs at least three temperatures; measure more of them.")
    if 2 * modulus.size < 9:
        raise InputError(f"{modulus.size} points cannot determine nine parameters; measure at least five.")
    rate, largest = float(np.sqrt(omega.min() * omega.max())), float(np.abs(modulus).max())
    # The shift is singular at C2 below the coldest test; 5 K keeps the steps of the fit off it.
    least_c2 = max(0.0, float(reference_temperature - temperature.min())) + 5.0

    def build(x: Vector) -> TwoS2P1D:
        h = _between_0_and_1(x[3])
        return TwoS2P1D(
            static_modulus=largest * float(np.exp(x[0])),
            glassy_modulus=largest * float(np.exp(x[1])),
            k=h * _between_0_and_1(x[2]),
            h=h,
            delta=float(np.exp(x[4])),
            tau=float(np.exp(x[5])) / rate,
            beta=float(np.exp(x[6])),
            wlf_c1=float(np.exp(x[7])),
            wlf_c2=least_c2 + float(np.exp(x[8])),
            reference_temperature=float(reference_temperature),
        )

    def residual(x: Vector) -> Vector:
        return _log_residual(modulus, build(x).complex_modulus(omega, temperature))

    #                  static glassy  k/h     h  delta    tau  beta    C1    C2
    low = np.array([-14.0, -0.5, -5.0, -5.0, -5.0, -15.0, -3.0, 0.0, -5.0])
    high = np.array([-0.1, 3.0, 5.0, 5.0, 6.0, 15.0, 15.0, 5.0, 7.0])
    starts = (
        np.array([-8.0, 0.0, -1.5, -0.5, 0.0, -3.0, 2.0, 2.0, 3.0]),
        np.array([-4.0, 1.0, 0.0, 2.0, 1.5, 8.0, 8.0, 3.5, 5.5]),
    )
    solution = _best_of_starts(residual, (low, high), starts)
    return Fit(build(solution.x), None, _rms(solution, modulus.size))


def _require_points(omega: ArrayLike, modulus: ArrayLike) -> tuple[Vector, NDArray[np.complex128]]:
    omega, modulus = np.asarray(omega, dtype=float), np.asarray(modulus, dtype=complex)
    if omega.shape != modulus.shape or omega.ndim != 1 or omega.size == 0:
        raise InputError(
            "no points to fit, or frequencies and moduli differ in number; give one modulus each."
        )
    if not (np.all(np.isfinite(omega)) and np.all(omega > 0)):
        raise InputError("a frequency to fit is not positive; give positive frequencies.")
    if not (np.all(np.isfinite(modulus)) and np.all(np.abs(modulus) > 0)):
        raise InputError("a modulus to fit is zero or not finite; remove or mend it.")
    return omega, modulus


def _log_residual(measured: NDArray[np.complex128], law: NDArray[np.complex128]) -> Vector:
    ratio = np.log(measured / law)
    return np.concatenate([ratio.real, ratio.imag])


def _best_of_starts(
    residual: Callable[[Vector], Vector], bounds: tuple[Vector, Vector], starts: tuple[Vector, Vector]
) -> OptimizeResult:
    """Least squares from random starts between two corners; the lowest cost wins."""
    random = np.random.default_rng(SEED)
    solutions = (
        least_squares(
            residual,
            random.uniform(*starts),
            bounds=bounds,
            x_scale="jac",
            xtol=1e-12,
            ftol=1e-12,
            gtol=1e-12,
        )
        for _ in range(STARTS)
    )
    return min(solutions, key=lambda solution: solution.cost)


def _standard_errors(solution: OptimizeResult) -> Vector | None:
    """Standard errors of the fitted x from the Jacobian at the solution."""
    jacobian = solution.jac
    freedom = jacobian.shape[0] - jacobian.shape[1]
    singular = np.linalg.svd(jacobian, compute_uv=False)
    # A parameter at its bound moves the residual by e^-14 = 1e-6 at most: the data do not see it.
    if freedom < 1 or singular[-1] < 1e-5 * singular[0]:
        return None
    variance = 2.0 * solution.cost / freedom
    return np.sqrt(variance * np.diag(np.linalg.inv(jacobian.T @ jacobian)))


def _rms(solution: OptimizeResult, points: int) -> float:
    return float(np.sqrt(2.0 * solution.cost / points))


def _between_0_and_1(x: float) -> float:
    return float(1.0 / (1.0 + np.exp(-x)))
