"""How far smooth data can lie from the Burgers law that was fitted to them.

Data are smooth where they are the response of any retardation spectrum that is nowhere negative,

    1/E* = J0 + sum_k J_k / (1 + i omega lambda_k) + 1/(i omega eta),    J_k >= 0,

which holds every linear viscoelastic law in use. Law over data, u = E*_law / E*, is linear in the J_k. So are, to first
order about u = 1, the errors of norm and phase and the conditions that the law is the fit of least squares: bounds of
the error are linear programs in integers, which carry the signs of the errors. Each program is solved again with what
the first order left out at the last solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, LinearConstraint, milp

from asphalt_nscd.rheology.burgers import Burgers

Vector = NDArray[np.float64]
# How far the level of the simulation may lie from that of its law: error at the coldest, Table 4.
LEVEL = 0.0056
SLACK = 0.02  # of the printed errors: their rounding
ROUNDS = 3  # of the linearisation
DECADES = np.arange(-2.0, 2.01, 0.25)  # retardation times about the middle frequency
LARGEST = 0.5  # of any error of one point: above all of them, and small, for a larger one slackens the relaxed program
STEP = 1e-5  # of the logarithm of a parameter: central differences err by its square, 1e-10, and by rounding, 1e-11


@dataclass(frozen=True)
class Printed:
    """A law of one temperature, and its mean relative errors of norm and phase against unknown data.

    `omega` (n,) in rad/s is that of the data; `error` is of |E*|; `weight` is that of the phase in the fit, relative to
    that of ln|E*|.
    """

    law: Burgers
    omega: Vector
    error: float
    phase_error: float
    weight: float = 1.0

    @property
    def modulus(self) -> NDArray[np.complex128]:
        """E* (n,) [Pa] of the law."""
        return self.law.complex_modulus(self.omega)


def log_slopes(law: Burgers, omega: Vector) -> NDArray[np.float64]:
    """Derivatives (2n, 4) of ln|E*|, then of the phase [rad], by ln of the parameters, at `omega` (n,) [rad/s]."""
    values = np.array([law.modulus_m, law.viscosity_m, law.modulus_k, law.viscosity_k])
    columns = []
    for k in range(4):
        factor = np.where(np.arange(4) == k, np.exp(STEP), 1.0)
        above, below = (Burgers(*(values * f).tolist()) for f in (factor, 1.0 / factor))
        slope = np.log(above.complex_modulus(omega) / below.complex_modulus(omega)) / (2.0 * STEP)
        columns.append(np.concatenate([slope.real, slope.imag]))
    return np.column_stack(columns)


def phase_error(printed: Printed, largest: bool) -> float:
    """Largest or smallest mean relative error of the phase of smooth data that meet the law.

    They have the law as their fit, and its error of the norm; NaN where there are no such data.
    """
    return _solved(printed, "largest" if largest else "smallest")


def least_scatter(printed: Printed) -> float:
    """How far from smooth data must lie that have the law as their fit, and both its errors.

    Largest distance of a point in ln E*, so of ln|E*| as of the phase [rad].
    """
    return _solved(printed, "scatter")


def _solved(printed: Printed, wanted: str) -> float:
    law, angle = printed.modulus, np.angle(printed.modulus)
    n = law.size
    times = 10.0**DECADES / np.sqrt(printed.omega.min() * printed.omega.max())
    i_omega = 1j * printed.omega[:, None]
    basis = np.hstack([1.0 / (1.0 + i_omega * times), np.ones((n, 1)), 1.0 / i_omega]) * law[:, None]
    # To size one, for the solver's tolerances are absolute.
    basis /= np.abs(basis).mean(axis=0)
    program = _Program(basis.shape[1], n)
    beyond, of_data, value = np.zeros(2 * n), angle, np.nan  # second order of ln u, phases of the data
    for _ in range(ROUNDS):
        x = program.solve(basis, beyond, of_data, printed, wanted)
        if x is None:
            return np.nan
        ratio = basis @ x[: basis.shape[1]]
        logarithm = np.log(ratio)
        scattered = logarithm.imag - x[program.scatter][n:]  # phase of the law less that of the data
        of_data = np.maximum(angle - scattered, 0.1 * angle)
        beyond = np.concatenate([logarithm.real - (ratio.real - 1.0), logarithm.imag - ratio.imag])
        value = float(x[-1]) if wanted == "scatter" else float(np.abs(scattered / (angle - scattered)).mean())
    return value


class _Program:
    """Linear program in integers.

    Unknowns: J_k (k,), errors of norm and phase split by their sign (4n,), the signs (2n,), scatter (2n,), the level,
    and the largest scatter.
    """

    def __init__(self, times: int, n: int) -> None:
        self.times, self.n = times, n
        ends = np.cumsum([times, 2 * n, 2 * n, 2 * n, 2 * n, 1, 1])
        self.size = int(ends[-1])
        self.above, self.below, self.signs, self.scatter = (slice(*ends[k : k + 2]) for k in range(4))
        self.level = self.size - 2

    def solve(
        self, basis: NDArray[np.complex128], beyond: Vector, of_data: Vector, printed: Printed, wanted: str
    ) -> Vector | None:
        n, one = self.n, np.eye(2 * self.n)
        # ln u = basis J - 1 + beyond - scatter; norm first, then phase
        logarithm = np.zeros((2 * n, self.size))
        logarithm[:, : self.times] = np.concatenate([basis.real, basis.imag])
        logarithm[:, self.scatter] = -one
        offset = np.concatenate([np.ones(n), np.zeros(n)]) - beyond
        errors = logarithm.copy()
        errors[:n, self.level] = 1.0
        errors[:, self.above] -= one
        errors[:, self.below] += one
        weights = np.repeat([1.0, printed.weight], n)[:, None]
        # Normal equations: the law is the fit where its slopes stand at right angles to the errors.
        fitted = (log_slopes(printed.law, printed.omega) * weights).T
        # By the sign one of the two parts is zero: both could else grow, and the mean error with them.
        upper, lower = np.zeros((2, 2 * n, self.size))
        upper[:, self.above], upper[:, self.signs] = one, -LARGEST * one
        lower[:, self.below], lower[:, self.signs] = one, LARGEST * one
        largest = np.zeros((4 * n, self.size))
        largest[:, self.scatter], largest[:, -1] = np.concatenate([one, -one]), -1.0
        norm, phase = np.zeros((2, self.size))
        share = np.concatenate([np.full(n, 1.0 / n), 1.0 / (n * of_data)])
        for part in (self.above, self.below):
            norm[part][:n], phase[part][n:] = share[:n], share[n:]
        rows = [
            (errors, offset, offset),
            (fitted @ logarithm, fitted @ offset, fitted @ offset),
            (upper, -np.inf, 0.0),
            (lower, -np.inf, LARGEST),
            (largest, -np.inf, 0.0),
            (norm[None], (1.0 - SLACK) * printed.error, (1.0 + SLACK) * printed.error),
        ]
        low, high = np.zeros(self.size), np.full(self.size, np.inf)
        low[self.scatter], low[self.level], high[self.level], high[self.signs] = -np.inf, -LEVEL, LEVEL, 1.0
        if wanted == "scatter":
            aim = np.eye(self.size)[-1]
            bounds = (1.0 - SLACK) * printed.phase_error, (1.0 + SLACK) * printed.phase_error
            rows.append((phase[None], *bounds))
        else:
            aim = phase if wanted == "smallest" else -phase
            # Bounds are of smooth data, which have no scatter.
            high[-1] = 0.0
        whole = np.zeros(self.size)
        whole[self.signs] = 1
        constraints = [LinearConstraint(*row) for row in rows]
        return milp(aim, constraints=constraints, integrality=whole, bounds=Bounds(low, high)).x
