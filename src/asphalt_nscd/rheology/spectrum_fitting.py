"""Fit of one continuous law to all temperatures at once, to tests alone or to tests and a prior."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import OptimizeResult, least_squares

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.fitting import STARTS, Fit, covariance_of, log_residual, require_points
from asphalt_nscd.rheology.priors import Prior
from asphalt_nscd.rheology.shift import SHIFTS
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum, parameter_names, parameters
from asphalt_nscd.rheology.spectrum_coordinates import Coordinates

Vector = NDArray[np.float64]
# Tests show how far isotherms are apart: one distance for each constant of the shift, C1 and C2 or the energy.
LEAST_TEMPERATURES = {"wlf": 3, "arrhenius": 2}
NO_EFFECT = 1e-5  # of a parameter on the residuals, relative to that of the strongest one
LEAST_STARTS = 4
AGREE = 1e-4  # relative difference of the objectives of two starts that found the same optimum
ROUGH, PRECISE = 1e-8, 1e-12  # tolerances of a trial and of the fit
COARSE = 0.05  # scatter at which the starts with a prior begin
SCATTER = 0.01, 2.0  # of a test beside a prior, relative and in rad; how many residuals this guess is worth
SETTLED, ROUNDS = 1e-4, 30  # relative change of the scatter that ends its search, and rounds at most


@dataclass(frozen=True)
class Form:
    """Which law is fitted, one of `LAWS`, with which shift, one of `SHIFTS`."""

    law: str = "2s2p1d"
    shift: str = "wlf"


def fit_spectrum(
    omega: ArrayLike,
    temperature: ArrayLike,
    modulus: ArrayLike,
    reference_temperature: float,
    form: Form = Form(),
    *,  # noqa: B008  frozen
    prior: Prior | None = None,
    weights: tuple[ArrayLike, ArrayLike] | None = None,
) -> Fit[Spectrum]:
    """Fit one law to the tests at all temperatures, all parameters jointly; without `prior` only the tests count.

    `omega` [rad/s], `temperature` [degC] and `modulus` E* [Pa] are (n,), `reference_temperature` is in degC. `weights`
    are standard deviations of ln|E*| and of the phase [rad], each (n,) or one for all; residuals larger than they allow
    widen the standard errors in proportion. Without them both count alike, and the scatter is that of the residuals.
    """
    omega, modulus = require_points(omega, modulus)
    law, shift = form.law, form.shift
    temperature = np.asarray(temperature, dtype=float)
    least = LEAST_TEMPERATURES[shift]
    if np.unique(temperature).size < least:
        raise InputError(
            f"a shift of kind {shift!r} needs at least {least} temperatures; measure more of them."
        )
    needed = len(parameter_names(LAWS[law]) + parameter_names(SHIFTS[shift]))
    if prior is None and 2 * modulus.size < needed:
        raise InputError(
            f"{modulus.size} points cannot determine {needed} parameters; "
            f"measure at least {(needed + 1) // 2}."
        )
    largest = float(np.abs(modulus).max())
    reach = 0.0 if prior is None else prior.largest("glassy_modulus")
    at = Coordinates(law, shift, omega, temperature, largest, reference_temperature, reach)
    deviations = _deviations(weights, modulus.size)
    return _Problem(at, omega, temperature, modulus, deviations, prior).fit(known=weights is not None)


def _deviations(weights: tuple[ArrayLike, ArrayLike] | None, points: int) -> Vector:
    """Standard deviation of each residual (2n,); ones without weights."""
    if weights is None:
        return np.ones(2 * points)
    parts = [np.broadcast_to(np.asarray(part, dtype=float), points) for part in weights]
    deviations = np.concatenate(parts)
    if not np.all(np.isfinite(deviations) & (deviations > 0.0)):
        raise InputError("a standard deviation of a test is not positive; give positive ones.")
    return deviations


class _Problem:
    """Residuals of the tests in their deviations, over a common scatter, and of the prior, with derivatives."""

    def __init__(
        self,
        coordinates: Coordinates,
        omega: Vector,
        temperature: Vector,
        modulus: NDArray[np.complex128],
        deviations: Vector,
        prior: Prior | None,
    ) -> None:
        self.coordinates, self.omega, self.temperature, self.modulus = (
            coordinates,
            omega,
            temperature,
            modulus,
        )
        self.deviations, self.prior = deviations, prior
        self.scatter = 1.0

    def residual(self, x: Vector) -> Vector:
        """Residuals (r,) at coordinates `x` (p,): of ln|E*|, of the phase, and of the prior if there is one."""
        with np.errstate(over="ignore", invalid="ignore"):  # wild trial shifts; such steps are refused
            law = self.coordinates.build(x)
            tests = log_residual(self.modulus, law.complex_modulus(self.omega, self.temperature))
        tests /= self.deviations * self.scatter
        if self.prior is None:
            return tests
        return np.concatenate(
            [tests, self.prior.standardised(parameters(law), self.coordinates.reference)[0]]
        )

    def jacobian(self, x: Vector) -> NDArray[np.float64]:
        """Derivatives (r, p) of `residual` by the coordinates."""
        law, coordinates = self.coordinates.build(x), self.coordinates.log_slopes(x)
        slopes = law.log_slopes(self.omega, self.temperature)
        tests = -np.concatenate([slopes.real, slopes.imag]) / (self.deviations * self.scatter)[:, None]
        if self.prior is None:
            return tests @ coordinates
        return (
            np.vstack([tests, self.prior.standardised(parameters(law), self.coordinates.reference)[1]])
            @ coordinates
        )

    def solve(self, start: Vector, tolerance: float = ROUGH) -> OptimizeResult:
        """Least squares from one start (p,)."""
        # The coordinates are of order one. Scaled by the Jacobian instead, ten times the steps in a flat valley.
        return least_squares(
            self.residual,
            start,
            self.jacobian,
            bounds=(self.coordinates.low, self.coordinates.high),
            xtol=tolerance,
            ftol=tolerance,
            gtol=tolerance,
        )

    def starts(self) -> list[Vector]:
        """Usual laws at the tau that suits the tests best, then random ones; the best of each kind first."""

        def cost(x: Vector) -> float:
            residual = self.residual(x)
            value = float(residual @ residual)
            return value if np.isfinite(value) else np.inf

        # Usual laws first: from random starts alone fits took most of a diagnosis, and one ended at 259 GPa.
        usual = [min(group, key=cost) for group in self.coordinates.usual_starts()]
        return sorted(usual, key=cost)[:2] + sorted(self.coordinates.random_starts(STARTS), key=cost)

    def best(self, starts: list[Vector]) -> OptimizeResult:
        """The lowest optimum of several starts; once enough were tried, two that agree on it end the search."""
        found: list[OptimizeResult] = []
        for start in starts:
            found.append(self.solve(start))
            found.sort(key=lambda solution: solution.cost)
            # ROUGH^2 ends the search too where a law fits its own numbers, whose objectives are rounding.
            if len(found) >= LEAST_STARTS and found[1].cost <= (1.0 + AGREE) * found[0].cost + ROUGH**2:
                break
        return found[0]

    def settle(self, solution: OptimizeResult, known: bool) -> OptimizeResult:
        """Solve again with the scatter of the last residuals until it no longer changes; `known` as in `scatter_of`.

        A larger scatter weakens the tests, and so strengthens the prior.
        """
        for _ in range(ROUNDS):
            before, self.scatter = self.scatter, self.scatter_of(solution, known)
            if abs(self.scatter / before - 1.0) < SETTLED:
                self.scatter = before  # that of the solution
                break
            solution = self.solve(solution.x)
        return solution

    def scatter_of(self, solution: OptimizeResult, known: bool) -> float:
        """Scatter of the tests over their deviations; one at least where it is `known` that these are it."""
        size = 2 * self.modulus.size
        squares = float(solution.fun[:size] @ solution.fun[:size]) * self.scatter**2
        freedom = max(self.freedom(solution), 1.0)
        if known:
            return max(1.0, float(np.sqrt(squares / freedom)))
        # a short table is followed almost exactly; a scatter of its residuals alone would drown the prior
        guess, worth = SCATTER
        return float(np.sqrt((squares + worth * guess**2) / (freedom + worth)))

    def freedom(self, solution: OptimizeResult) -> float:
        """Residuals of the tests less what the parameters take from them; a prior leaves them less to take."""
        size = 2 * self.modulus.size
        seen = self.seen(solution)
        # The hat matrix by singular vectors: J^T J would square the condition of a flat valley.
        left = np.linalg.svd(solution.jac[:, seen], full_matrices=False)[0][:size]
        return size - float(np.sum(left**2))

    def seen(self, solution: OptimizeResult) -> NDArray[np.bool_]:
        """Which parameters (p,) are off their bounds and move a residual, if only that of the prior."""
        effect = np.linalg.norm(solution.jac, axis=0)
        seen = self.coordinates.inside(solution.x) & (effect > NO_EFFECT * effect.max())
        if "c2" in self.coordinates.names and not seen[self.coordinates.names.index("c2")]:
            seen[self.coordinates.names.index("c1")] = False  # of a straight shift only C1/C2 is determined
        return seen

    def fit(self, known: bool) -> Fit[Spectrum]:
        """Fit from all starts; `known`: whether the deviations are the scatter of the tests, or only its ratios."""
        if self.prior is None:
            return self.result(self.solve(self.best(self.starts()).x, PRECISE), known)
        self.scatter = 1.0 if known else COARSE
        starts = self.starts()
        # how much the prior counts depends on the scatter: starts are compared at one that a fit has shown
        first = self.settle(self.solve(starts[0]), known)
        last = self.settle(self.best([first.x, *starts]), known)
        return self.result(self.solve(last.x, PRECISE), known)

    def result(self, solution: OptimizeResult, known: bool) -> Fit[Spectrum]:
        """The fit at a solution: law, standard errors, and which parameters the tests leave open."""
        at, seen, law = self.coordinates, self.seen(solution), self.coordinates.build(solution.x)
        values, freedom = parameters(law), self.freedom(solution)
        variance = None
        if self.prior is not None:
            # Beside a prior the residuals are in units of the settled scatter already.
            variance = 1.0
        elif known:
            variance = self.scatter_of(solution, known) ** 2
        covariance = covariance_of(solution, seen, variance)
        unseen = {name for name, visible in zip(at.names, seen, strict=True) if not visible}
        std_error: dict[str, float] | None = None
        from_prior: tuple[str, ...] = ()
        response = of_prior = None
        if covariance is not None:
            slopes, size = at.log_slopes(solution.x)[:, seen], 2 * self.modulus.size
            jacobian = solution.jac[:, seen]
            gain = slopes @ np.linalg.inv(jacobian.T @ jacobian)
            response = -gain @ jacobian[:size].T / (self.deviations * self.scatter)
            of_prior = gain @ jacobian[size:].T @ jacobian[size:] @ gain.T
            covariance = slopes @ covariance @ slopes.T  # of the logarithms of all parameters
            errors = np.sqrt(np.diag(covariance)) * np.array(list(values.values()))
            std_error = {
                name: float(error) for name, error in zip(at.names, errors, strict=True) if name not in unseen
            }
            if self.prior is not None:
                from_prior = self.prior.undetermined_names(values, covariance, at.reference)
        ratio = log_residual(self.modulus, law.complex_modulus(self.omega, self.temperature))
        return Fit(
            law,
            std_error,
            float(np.sqrt(ratio @ ratio / self.modulus.size)),
            round(freedom),
            unseen=tuple(name for name in at.names if name in unseen or name in from_prior),
            from_prior=from_prior,
            covariance=covariance,
            response=response,
            of_prior=of_prior,
        )
