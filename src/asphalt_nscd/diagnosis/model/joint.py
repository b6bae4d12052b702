"""Law of the mix, specimen scales and causes fitted together: Gauss-Newton on ln E* with priors.

An effect fitted to the residuals of a fitted law is biased, for the law has already swallowed part of
it; so every candidate is refitted jointly. All residuals are whitened by the replicate scatter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv

from asphalt_nscd.diagnosis.causes._cause import Cause, Parameter, Place
from asphalt_nscd.diagnosis.model.bases import Base, FlexibleSpectrum
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
ITERATIONS = 60
MOST_DAMPED = 1e9  # a step damped more than this moves nothing
CONVERGED = 1e-6  # change of the objective, in units of the replicate scatter squared
SILENT = 1e-12  # of a parameter's precision: a typical step of it moves no test by a millionth of its scatter
NEAR = 0.01  # the same where a fit is only to predict what was left out of it


@dataclass(frozen=True)
class Candidate:
    """A cause with its values, in their units, at a place: a specimen, an isotherm [degC], or None for all tests."""

    cause: Cause
    place: Place
    values: tuple[float, ...]

    @property
    def key(self) -> tuple[str, Place]:
        """Name and place, which tell candidates apart."""
        return self.cause.name, self.place

    @property
    def typical(self) -> Vector:
        """Usual size (p,) of each parameter, in its unit."""
        return np.array([parameter.typical for parameter in self.cause.parameters])

    @property
    def shaped(self) -> bool:
        """Whether it has shapes of its own: its size then is above zero, and uncertain by a factor."""
        return len(self.values) > 1

    @property
    def pinned(self) -> list[tuple[Parameter, float]]:
        """Parameters that stand at a bound of their range, with their values; an absent cause has none."""
        return [
            (parameter, value)
            for parameter, value in zip(self.cause.parameters, self.values, strict=True)
            if value and np.isclose(value, [parameter.low, parameter.high], rtol=1e-6, atol=0.0).any()
        ]

    def replace_values(self, values: Vector) -> Candidate:
        """The same candidate with other parameters (p,) in their units."""
        return replace(self, values=tuple(float(v) for v in values))


@dataclass(frozen=True)
class Fitted:
    """A joint fit.

    `law` are the parameters of the base; `scales` (S,) ln of the specimens' scales; `objective` the squares of whitened
    residuals and priors; `modelled` (n,) ln E*; `residual` (2n,) and `jacobian` (2n, p) are whitened; `precision`
    (p, p). `gradient` (p,) of half the objective, downwards, is zero at the best fit.
    """

    law: Vector
    scales: Vector
    active: tuple[Candidate, ...]
    objective: float
    modelled: Complex
    residual: Vector
    jacobian: NDArray
    precision: NDArray
    gradient: Vector

    @property
    def covariance(self) -> NDArray:
        """Covariance (q, q) of the parameters."""
        return np.linalg.inv(self.precision)

    def place_of(self, key: tuple[str, Place]) -> int:
        """Column of the Jacobian at which the parameters of a cause in the fit begin."""
        number = [one.key for one in self.active].index(key)
        return self.law.size + self.scales.size + sum(len(one.values) for one in self.active[:number])

    def fixed(self, places: int | Sequence[int]) -> Fitted:
        """The same with the parameters at some columns of the Jacobian fixed where they stand, without derivatives."""
        return replace(
            self,
            jacobian=np.delete(self.jacobian, places, axis=1),
            precision=np.delete(np.delete(self.precision, places, axis=0), places, axis=1),
            gradient=np.delete(self.gradient, places),
        )


class Joint:
    """The joint model of one table: law of the mix, causes and scatter of the tests."""

    def __init__(self, observed: Observations, base: Base, noise: Noise) -> None:
        self.observed, self.base, self.noise = observed, base, noise
        self.membership = np.eye(len(observed.names))[observed.specimen]
        # Candidates are tried at one law: it is computed once for all that leave the temperatures alone.
        self._last: tuple[Vector, tuple[Complex, Complex]] | None = None  # at the temperatures stated

    @property
    def spectrum(self) -> FlexibleSpectrum:
        """The law common to all temperatures, where the base is one."""
        assert isinstance(self.base, FlexibleSpectrum)
        return self.base

    def apparent(
        self, law: Vector, active: tuple[Candidate, ...], scales: Vector | None = None
    ) -> tuple[Complex, Complex]:
        """Apparent E* (n,) with causes [Pa], and its derivatives (n, p + S) by law (p,) and ln of scales (S,)."""
        observed = self.observed
        modulus, slope = self._unscaled(law, active)
        # The scale belongs to the specimen: what the head adds, a mass say, is not scaled with it.
        factor = 1.0 if scales is None else np.exp(scales)[observed.specimen]
        slope = np.column_stack([slope, self.membership * modulus[:, None]])
        modulus, slope = factor * modulus, np.reshape(factor, (-1, 1)) * slope
        # As a signal passes them: the channel delays what the head has added too.
        for candidate in sorted(active, key=lambda c: c.cause.stage):
            rows = candidate.cause.rows(observed, candidate.place)
            values = np.array(candidate.values)
            after = candidate.cause.apparent(modulus, values, observed)
            step = 1e-6 * modulus
            # causes are analytic in the modulus, so one complex derivative carries those of all parameters
            # before it
            gain = (candidate.cause.apparent(modulus + step, values, observed) - after) / step
            modulus = np.where(rows, after, modulus)
            slope = np.where(rows, gain, 1.0)[:, None] * slope
        return modulus, slope

    def _unscaled(self, law: Vector, active: tuple[Candidate, ...]) -> tuple[Complex, Complex]:
        """E* of the mix and its derivatives, at the temperatures that the causes leave."""
        observed = self.observed
        temperature, moved = observed.temperature, False
        for candidate in active:
            rise = candidate.cause.temperature_rise(np.array(candidate.values), observed)
            if np.any(rise):
                moved = True
                rows = candidate.cause.rows(observed, candidate.place)
                temperature = temperature + np.where(rows, rise, 0.0)
        if moved:
            return self.base.modulus(law, observed.omega, temperature)
        if self._last is None or not np.array_equal(self._last[0], law):
            self._last = law, self.base.modulus(law, observed.omega, temperature)
        return self._last[1]

    def _shown(self, law: Vector, active: tuple[Candidate, ...], scales: Vector) -> Complex:
        """Apparent E* (n,) without derivatives."""
        modulus = np.exp(scales)[self.observed.specimen] * self._unscaled(law, active)[0]
        for candidate in sorted(active, key=lambda c: c.cause.stage):
            rows = candidate.cause.rows(self.observed, candidate.place)
            after = candidate.cause.apparent(modulus, np.array(candidate.values), self.observed)
            modulus = np.where(rows, after, modulus)
        return modulus

    def direction(
        self, law: Vector, scales: Vector, active: tuple[Candidate, ...], index: int, parameter: int
    ) -> Complex:
        """Derivative (n,) of ln E* by one parameter of the cause at `index`, in typical units."""
        typical = active[index].typical
        low_high = []
        # central differences, which err by the square of the step
        for sign in (-1.0, 1.0):
            values = np.array(active[index].values)
            values[parameter] += sign * 1e-3 * typical[parameter]
            moved = active[:index] + (active[index].replace_values(values),) + active[index + 1 :]
            low_high.append(self._shown(law, moved, scales))
        return np.asarray(np.log(low_high[1] / low_high[0]) / 2e-3, complex)

    def linearise(self, law: Vector, scales: Vector, active: tuple[Candidate, ...]) -> Fitted:
        """Objective and derivatives where the parameters stand: `law`, `scales` (S,) in ln, causes with values."""
        modulus, slope = self.apparent(law, active, scales)
        modelled = np.log(np.abs(modulus)) + 1j * np.angle(modulus)
        causes = [
            self.direction(law, scales, active, k, j)
            for k, candidate in enumerate(active)
            for j in range(len(candidate.values))
        ]
        left = self.observed.logarithm - modelled
        # one whitening for all columns
        whitened = self.noise.whiten(np.column_stack([slope / modulus[:, None], *causes, left]))
        jacobian, residual = np.ascontiguousarray(whitened[:, :-1]), whitened[:, -1].copy()
        prior, prior_slope = self.base.prior(law)
        p, s, total = law.size, scales.size, jacobian.shape[1]
        precision = jacobian.T @ jacobian
        precision[:p, :p] += prior_slope.T @ prior_slope
        # Without a prior the scales and the level of the law would say the same.
        precision[range(p, p + s), range(p, p + s)] += self.noise.scale**-2
        first = p + s
        for candidate in active:  # the shapes of a cause are held weakly where they start
            for j in range(1, len(candidate.values)):
                precision[first + j, first + j] += 1.0
            first += len(candidate.values)
        assert first == total
        # What neither a test nor a prior speaks of, a bias of an isotherm that is left out, stays where it is.
        silent = np.flatnonzero(np.diag(precision) < SILENT)
        precision[silent, silent] = 1.0
        objective = residual @ residual + prior @ prior + (scales @ scales) / self.noise.scale**2
        gradient = jacobian.T @ residual
        gradient[:p] -= prior_slope.T @ prior
        gradient[p : p + s] -= scales / self.noise.scale**2
        return Fitted(
            law, scales, active, float(objective), modelled, residual, jacobian, precision, gradient
        )

    def predict(self, fitted: Fitted) -> Complex:
        """ln E* (n,) of these observations from a fit to others of the same specimens."""
        modulus = self.apparent(fitted.law, fitted.active, fitted.scales)[0]
        return np.log(np.abs(modulus)) + 1j * np.angle(modulus)

    def refit_without(self, rows: NDArray[np.int64], fitted: Fitted) -> Fitted:
        """Repeat the fit without some rows; a cause that reaches no other row is absent from it."""
        kept = np.setdiff1d(np.arange(self.observed.size), rows)
        part = Joint(self.observed.subset(kept), self.base, self.noise.subset(kept))
        active = tuple(c for c in fitted.active if c.cause.rows(part.observed, c.place).any())
        return part.fit(fitted.law, fitted.scales, active, NEAR)

    def fit(
        self, law: Vector, scales: Vector, active: tuple[Candidate, ...] = (), converged: float = CONVERGED
    ) -> Fitted:
        """Fit by Levenberg-Marquardt from where the parameters stand; bounds of causes are respected.

        A step to where the model overflows counts as one that gains nothing. `scales` (S,) are ln of the specimens'
        scales; `converged` is the change of the objective that ends the fit.
        """
        now = self.linearise(law, scales, active)
        damping = 1e-3
        for _ in range(ITERATIONS):
            gained, trial = -np.inf, now
            while gained < 0.0 and damping < MOST_DAMPED:
                step = _damped_step(now, damping)
                if step is not None:
                    # fits without causes start far from their end, where a whole step may leave all sense
                    limited = np.clip(step, -3.0, 3.0) if active == () else step
                    trial = self._moved(now, limited)
                    gained = now.objective - trial.objective
                if not np.isfinite(gained):
                    gained = -np.inf
                if gained < 0.0:
                    damping *= 8.0
            if gained < 0.0:
                break
            now, damping = trial, max(damping / 5.0, 1e-9)
            # a small gain under heavy damping says that the step was short, not that the fit is at its best
            if gained < converged and (damping < 1e-2 or converged > CONVERGED):
                break
        return now

    def _moved(self, fitted: Fitted, step: Vector) -> Fitted:
        p, s = fitted.law.size, fitted.scales.size
        # Logarithms and log-odds: beyond a factor of e^2 the linearised model says nothing.
        law = fitted.law + np.clip(step[:p], -2.0, 2.0)
        first, active = p + s, []
        for candidate in fitted.active:
            size = len(candidate.values)
            values = np.array(candidate.values) + step[first : first + size] * candidate.typical
            low = [parameter.low for parameter in candidate.cause.parameters]
            high = [parameter.high for parameter in candidate.cause.parameters]
            # Clipped: a cause that wants more stands at its bound, and `doubts` tells so.
            active.append(candidate.replace_values(np.clip(values, low, high)))
            first += size
        return self.linearise(law, fitted.scales + step[p : p + s], tuple(active))


def _damped_step(now: Fitted, damping: float) -> Vector | None:
    """None where the precision is no positive definite matrix of finite numbers."""
    # Marquardt's scaling: the damping means the same whatever the units of the parameters
    damped = now.precision + damping * np.diag(np.diag(now.precision) + 1e-9)
    if not (np.isfinite(damped).all() and np.isfinite(now.gradient).all()):
        return None
    # A factor that fails says that the precision is not positive definite: more damping makes it so.
    _, step, failed = dposv(damped, now.gradient)
    return None if failed else step
