"""Time schemes built on the implicit Euler step of the core.

A two-step scheme takes for the rate of every variable y of motion and law

    y' = [a (y+ - y) - b (y - y-)] / dt = (y+ - y*) / (dt/a),   y* = y + (b/a)(y - y-)

which is an implicit Euler step of length dt/a from the extrapolated state y*. The bond law stays
the affine law U+ = b - S sigma+ with S at dt/a, contacts, yield and devices stay as they are, and the
matrix stays constant. a = 1, b = 0 is implicit Euler itself, a = 3/2, b = 1/2 is BDF2 (second order,
L-stable). The fitted scheme is BDF2 made exact for 1, cos(omega t) and sin(omega t): with z = exp(i omega dt)

    (1 - 1/z)(a - b/z) = i omega dt   =>   b = x / sin(2 x), a = b (1 + 2 cos(2 x)),   x = omega dt/2

so that the steady oscillation of a linear system has no error of the time step at all. It tends to
BDF2 as omega dt -> 0. (Trigonometric fitting: Gautschi 1961, Numer. Math. 3, 381-397.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

VARIABLES = ("displacement", "velocity", "sigma", "memory")


@dataclass(frozen=True)
class Scheme:
    """Dimensionless coefficients of the rate, y' = [a (y+ - y) - b (y - y-)] / dt."""

    a: float = 1.0
    b: float = 0.0

    @classmethod
    def named(cls, name: str, angle: float) -> Scheme:
        """The scheme "euler", or "fitted", which is fitted to `angle` omega dt [rad], below pi/2, 0 giving BDF2."""
        if name == "euler":
            return cls()
        # x / sin(2 x) by sinc, which has no 0/0 at an angle of zero, where this is BDF2
        b = 0.5 / float(np.sinc(angle / np.pi))
        return cls(b * (1.0 + 2.0 * float(np.cos(angle))), b)

    def rate(self, angle: float) -> complex:
        """i omega dt as the scheme sees it, for an oscillation of `angle` omega dt [rad]."""
        back = np.exp(-1j * angle)
        return complex((1.0 - back) * (self.a - self.b * back))


@dataclass
class History:
    """The variables of a state, by the names in VARIABLES, and the actuator's place [m] at one instant."""

    values: dict[str, np.ndarray]
    actuator: float

    @classmethod
    def of(cls, state: Any, actuator: float) -> History:
        """A copy of the present of a state, with the actuator's place [m]."""
        # copies, for the compiled kernel changes the arrays of a state in place
        return cls({name: getattr(state, name).copy() for name in VARIABLES}, actuator)

    def put(self, state: Any) -> None:
        """Make it the present of a state."""
        for name, value in self.values.items():
            setattr(state, name, value.copy())

    def widened(self, state: Any) -> History:
        """Itself, or wider, with zeros for the coordinates that a state has got since."""
        if self.values["sigma"].size == state.sigma.size:
            return self
        more = state.sigma.size - self.values["sigma"].size
        padded = {n: np.pad(v, [(0, 0)] * (v.ndim - 1) + [(0, more)]) for n, v in self.values.items()}
        return History(padded, self.actuator)

    def extrapolate(self, earlier: History, share: float) -> History:
        """Extrapolated: this plus `share` times the change since `earlier`."""
        values = {n: v + share * (v - earlier.values[n]) for n, v in self.values.items()}
        return History(values, self.actuator + share * (self.actuator - earlier.actuator))
