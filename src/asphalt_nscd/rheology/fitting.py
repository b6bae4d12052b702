"""Least-squares fits of viscoelastic laws to complex moduli, and the fit of a Burgers law.

All fits minimise the complex residual ln(E_measured / E_law): its real part is the relative error
of the norm, its imaginary part the error of the phase in radians, so both count alike at every
temperature and frequency.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import OptimizeResult, least_squares
from scipy.special import stdtrit

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.spectrum import parameters

SEED = 20200117  # of the random starts; any value, fixed so that a fit can be repeated
STARTS = 24  # random ones: of a Burgers law one in five ends in another valley

LOOSE = 0.35  # standard error over value, from which the ends of a 95 % interval are a factor of four apart

Law = TypeVar("Law")
Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Fit(Generic[Law]):
    """A fitted law; covariances are those of the logarithms of `parameters` (p,).

    `std_error` takes points as independent (scatter common to a specimen is not); None if they do not suffice.
    `freedom`: two a point less determined parameters. `unseen` are not determined by the points; those at a bound or
    without effect have no error and are held for the others, those in `from_prior` have a prior's value. `covariance`
    (p, p) is zero without an error; `of_prior` (p, p) is its part from the prior; `response` (p, 2n) are
    derivatives of the logarithms by ln|E*| of each point, then by its phase.
    """

    law: Law
    std_error: dict[str, float] | None
    rms_log_residual: float
    freedom: int
    unseen: tuple[str, ...] = ()
    from_prior: tuple[str, ...] = ()
    covariance: NDArray | None = None
    response: NDArray | None = None
    of_prior: NDArray | None = None

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Parameters that the points do not determine: those `unseen`, and those known no better than LOOSE."""
        errors = self.std_error or {}
        return tuple(
            name
            for name, value in parameters(self.law).items()
            if name in self.unseen or errors.get(name, 0.0) > LOOSE * abs(value)
        )

    def restate(self, points: NDArray) -> Fit[Law]:
        """The same law, with the standard errors that follow from another covariance of the points.

        `points` (2n, 2n) has rows of ln|E*|, then of the phase.
        """
        if self.response is None or self.of_prior is None:
            return self
        covariance = self.response @ points @ self.response.T + self.of_prior
        size = np.sqrt(np.diag(covariance))
        std_error = {
            name: value * float(one)
            for (name, value), one in zip(parameters(self.law).items(), size, strict=True)
            if name in (self.std_error or {})
        }
        return replace(self, covariance=covariance, std_error=std_error)

    def interval(self, name: str, level: float = 0.95) -> tuple[float, float]:
        """Confidence interval of a parameter with a standard error, in its unit, by Student's t on its logarithm."""
        value, error = parameters(self.law)[name], (self.std_error or {})[name]
        # on the logarithm, in which the law was fitted: the lower end stays above zero
        factor = float(np.exp(stdtrit(self.freedom, 0.5 + 0.5 * level) * error / value))
        return value / factor, value * factor


def fit_burgers(omega: ArrayLike, modulus: ArrayLike) -> Fit[Burgers]:
    """Fit a Burgers law of one temperature to E* (n,) [Pa] at two or more angular frequencies (n,) [rad/s].

    >>> omega = 2 * np.pi * np.array([3.0, 10.0, 40.0])
    >>> fit = fit_burgers(omega, Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9).complex_modulus(omega))
    >>> print(f"E_m = {fit.law.modulus_m / 1e9:.1f} GPa, eta_m = {fit.law.viscosity_m / 1e9:.2f} GPa s")
    E_m = 24.3 GPa, eta_m = 3.71 GPa s
    """
    omega, modulus = require_points(omega, modulus)
    if np.unique(omega).size < 2:
        raise InputError("a Burgers law needs at least two frequencies; measure more at this temperature.")
    # Scales in which every parameter is of order one: the largest norm and the middle frequency.
    stress, rate = np.abs(modulus).max(), np.sqrt(omega.min() * omega.max())
    scale = np.log([stress, stress / rate, stress, stress / rate])

    def build(x: Vector) -> Burgers:
        return Burgers(*np.exp(x + scale).tolist())

    def residual(x: Vector) -> Vector:
        return log_residual(modulus, build(x).complex_modulus(omega))

    # e^14 is a stiffness no measured phase can tell from rigid: beyond it the parameter is unseen.
    bounds = np.full(4, -14.0), np.full(4, 14.0)
    solution = best_of_starts(residual, bounds, starts=(np.full(4, -3.0), np.full(4, 5.0)))
    law = build(solution.x)
    covariance = covariance_of(solution)
    std_error = None
    if covariance is not None:
        values, std_log = parameters(law), np.sqrt(np.diag(covariance))
        std_error = {name: values[name] * float(s) for name, s in zip(values, std_log, strict=True)}
    return Fit(law, std_error, rms_of(solution, modulus.size), 2 * modulus.size - 4)


def require_points(omega: ArrayLike, modulus: ArrayLike) -> tuple[Vector, NDArray[np.complex128]]:
    """Angular frequencies [rad/s] and E* [Pa] as vectors (n,), refused unless positive, finite and one to one."""
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


def log_residual(measured: NDArray[np.complex128], law: NDArray[np.complex128]) -> Vector:
    """ln(E_measured / E_law) (2n,): relative errors of the norm, then errors of the phase [rad]."""
    ratio = np.log(measured / law)
    return np.concatenate([ratio.real, ratio.imag])


def best_of_starts(
    residual: Callable[[Vector], Vector], bounds: tuple[Vector, Vector], starts: tuple[Vector, Vector]
) -> OptimizeResult:
    """Solve least squares from STARTS random starts, drawn from SEED between two corners; the lowest cost wins.

    `residual` takes parameters (p,) to residuals (r,); `bounds` are the lowest and highest parameters (p,), `starts`
    the corners (p,). The result is that of `scipy.optimize.least_squares`.
    """
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


def covariance_of(
    solution: OptimizeResult, seen: NDArray[np.bool_] | None = None, variance: float | None = None
) -> NDArray | None:
    """Covariance (p, p) of fitted coordinates, from the Jacobian.

    `seen` (p,) marks the part of x that is asked for, with the rest held; all if None. `variance` is that of the
    residuals where it is known, else it is estimated. None where the points do not outnumber or determine all unknowns.
    """
    jacobian = solution.jac if seen is None else solution.jac[:, seen]
    freedom = jacobian.shape[0] - jacobian.shape[1]
    singular = np.linalg.svd(jacobian, compute_uv=False)
    # A parameter at its bound moves the residual by e^-14 = 1e-6 at most: the data do not see it.
    if freedom < 0 or singular[-1] < 1e-5 * singular[0] or (freedom == 0 and variance is None):
        return None
    if variance is None:
        variance = 2.0 * solution.cost / freedom
    return variance * np.linalg.inv(jacobian.T @ jacobian)


def rms_of(solution: OptimizeResult, points: int) -> float:
    """Root mean square of |ln(E_measured / E_law)| over the points of a least-squares fit of `log_residual`."""
    return float(np.sqrt(2.0 * solution.cost / points))
