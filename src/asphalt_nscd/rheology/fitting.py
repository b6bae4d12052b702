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

Law = TypeVar("Law")
Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Fit(Generic[Law]):
    """A fitted law.

    Parameters
    ----------
    law : Law
        With the fitted parameters.
    std_error : dict of str to float, or None
        Standard error of each parameter, by field name and in its unit, all points taken as independent (a
        scatter common to a whole specimen is not). None where the points do not outnumber the parameters or
        do not determine them all.
    rms_log_residual : float
        Root mean square of |ln(E_measured / E_law)| over the points.
    freedom : int
        Residuals (two for each point) less the parameters that the points determine.
    unseen : tuple of str
        Parameters that the points do not determine. Those at a bound of the fit or without effect have no
        standard error, and those of the others hold them fixed.
    from_prior : tuple of str
        Those of the unseen that have the value, and nearly the standard error, of a prior.
    covariance : ndarray (p, p), optional
        Of the logarithms of `parameters`, zero where there is no standard error.
    response : ndarray (p, 2n), optional
        Change of these logarithms with ln|E*| and the phase of the points.
    of_prior : ndarray (p, p), optional
        What the prior leaves open of these logarithms.
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

    def under(self, points: NDArray) -> Fit[Law]:
        """The same fit to points of another covariance than it assumed.

        Parameters
        ----------
        points : ndarray (2n, 2n)
            Covariance of ln|E*|, then of the phase, of the points.

        Returns
        -------
        Fit
            With other standard errors; the law stays.
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
        """Confidence interval of a parameter that has a standard error: Student's t on its logarithm.

        Parameters
        ----------
        name : str
            Of the parameter.
        level : float
            Probability that the interval holds it.

        Returns
        -------
        tuple of float
            Lower and upper end, in the unit of the parameter.
        """
        value, error = parameters(self.law)[name], (self.std_error or {})[name]
        # on the logarithm, in which the law was fitted: the lower end stays above zero
        factor = float(np.exp(stdtrit(self.freedom, 0.5 + 0.5 * level) * error / value))
        return value / factor, value * factor


def fit_burgers(omega: ArrayLike, modulus: ArrayLike) -> Fit[Burgers]:
    """Fit a Burgers law of one temperature.

    Parameters
    ----------
    omega : array_like (n,)
        Angular frequencies [rad/s].
    modulus : array_like of complex (n,)
        E* [Pa].

    Returns
    -------
    Fit of Burgers
        The law and its standard errors.

    Raises
    ------
    InputError
        For fewer than two frequencies, and what `require_points` refuses.

    Examples
    --------
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
    """Frequencies and moduli as vectors, refused where they cannot be fitted.

    Parameters
    ----------
    omega : array_like
        Angular frequencies [rad/s].
    modulus : array_like
        E* [Pa], one for each.

    Returns
    -------
    ndarray (n,)
        omega.
    ndarray of complex (n,)
        E*.

    Raises
    ------
    InputError
        For no points, numbers that differ, or values that are zero, negative or not finite.
    """
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
    """ln(E_measured / E_law), both parts after each other.

    Parameters
    ----------
    measured : ndarray of complex (n,)
        E* [Pa].
    law : ndarray of complex (n,)
        E* [Pa].

    Returns
    -------
    ndarray
        (2n,) Relative errors of the norm, then errors of the phase [rad].
    """
    ratio = np.log(measured / law)
    return np.concatenate([ratio.real, ratio.imag])


def best_of_starts(
    residual: Callable[[Vector], Vector], bounds: tuple[Vector, Vector], starts: tuple[Vector, Vector]
) -> OptimizeResult:
    """Least squares from random starts between two corners; the lowest cost wins.

    Parameters
    ----------
    residual : callable
        From parameters (p,) to residuals (r,).
    bounds : tuple of ndarray (p,)
        Lowest and highest parameters of the fit.
    starts : tuple of ndarray (p,)
        Two corners between which STARTS points are drawn uniformly, from SEED.

    Returns
    -------
    OptimizeResult
        As `scipy.optimize.least_squares` gives it, with its Jacobian.
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
    """Covariance of fitted coordinates, from the Jacobian.

    Parameters
    ----------
    solution : OptimizeResult
        Of `scipy.optimize.least_squares`.
    seen : ndarray of bool (p,), optional
        The part of x that is asked for, with the rest held; all of x if None.
    variance : float, optional
        Of the residuals, where it is known; else it is estimated.

    Returns
    -------
    ndarray (p, p) or None
        None where the points do not outnumber the unknowns or do not determine them all.
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
    """Root mean square over the points of the complex residual's norm.

    Parameters
    ----------
    solution : OptimizeResult
        Least squares of `log_residual`: two residuals for each point.
    points : int
        How many were fitted.

    Returns
    -------
    float
        Root mean square of |ln(E_measured / E_law)|.
    """
    return float(np.sqrt(2.0 * solution.cost / points))
