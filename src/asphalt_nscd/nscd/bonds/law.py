"""The bond law: a spring, a dashpot and Kelvin-Voigt elements in series (Burgers: one element).

All bonds share one rheology, or each component of each bond has its own (`BondLaws`). Their geometry
g [m] (Eqs. 30-33) is divided out: the reaction is R = g sigma, and sigma [Pa] obeys for each component

    sigma = -Em dm,   sigma = -eta_m dm',   sigma = -Ek dk - eta_k dk',   U = dm' + dm'' + dk'

with U the opening velocity. Implicit Euler over dt turns this into the affine law of the paper
(Eqs. 22-26 with consistent signs)

    U+ = b - S sigma+,   S = 1/(dt Em) + 1/eta_m + sum 1/(eta_k + dt Ek)
    b = sigma-/(dt Em) - sum Ek dk-/(eta_k + dt Ek)
    dk+ = (eta_k dk- - dt sigma+)/(eta_k + dt Ek)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True)
class BondLaw:
    """One law for all bonds: a chain, its geometry divided out.

    An infinite spring or dashpot is one that the chain does not have. `spring` Em in Pa, `dashpot` eta_m in Pa s; of
    each Kelvin element (e,), `kelvin_springs` Ek in Pa and `kelvin_dashpots` eta_k in Pa s.
    """

    spring: float
    dashpot: float
    kelvin_springs: np.ndarray
    kelvin_dashpots: np.ndarray

    def step(self, dt: float) -> LawStep:
        """Coefficients of the affine law U+ = b - S sigma+ of a step of length `dt` [s]."""
        springs, dashpots = np.asarray(self.kelvin_springs, float), np.asarray(self.kelvin_dashpots, float)
        damped = dashpots + dt * springs
        # of spring and dashpot the reciprocals alone: infinite ones, which the chain does not have, drop out
        return LawStep(
            dt=dt,
            compliance=1.0 / (dt * self.spring) + 1.0 / self.dashpot + float((1.0 / damped).sum()),
            spring_memory=1.0 / (dt * self.spring),
            kelvin_recall=springs / damped,
            kelvin_decay=dashpots / damped,
            kelvin_gain=dt / damped,
        )

    def discrete_modulus(self, omega: float, dt: float) -> complex:
        """Complex modulus [Pa] of the implicit Euler scheme itself, for steady oscillation at `omega` [rad/s].

        The scheme replaces i omega by (1 - exp(-i omega dt))/dt, `dt` in s; dt = 0 gives the exact law.
        """
        rate = (1.0 - np.exp(-1j * omega * dt)) / dt if dt > 0.0 else 1j * omega
        kelvin = (1.0 / (self.kelvin_springs + rate * self.kelvin_dashpots)).sum()
        return complex(1.0 / (1.0 / self.spring + 1.0 / self.dashpot / rate + kelvin))


@dataclass(frozen=True)
class BondLaws:
    """A law for each component of each bond: its place `kind` (3 b,) in a `table` of those that differ.

    A film, for example, is squeezed by another law than it is sheared by. Coefficients are those of `BondLaw` for each
    component; a law with fewer Kelvin elements than another has zeros for the rest. It takes full steps, for the
    reduced model rests on one law for all bonds.
    """

    table: tuple[BondLaw, ...]
    kind: np.ndarray

    @classmethod
    def of_bonds(
        cls, table: Sequence[BondLaw], normal: np.ndarray, tangential: np.ndarray | None = None
    ) -> BondLaws:
        """Laws from places (b,) in `table`; the tangential law is the normal one if `tangential` is None."""
        tangential = normal if tangential is None else tangential
        return cls(tuple(table), np.column_stack([normal, tangential, tangential]).ravel())

    @cached_property
    def spring(self) -> np.ndarray:
        """(3 b,) Pa."""
        return np.array([law.spring for law in self.table])[self.kind]

    @cached_property
    def dashpot(self) -> np.ndarray:
        """(3 b,) Pa s."""
        return np.array([law.dashpot for law in self.table])[self.kind]

    @cached_property
    def kelvin_springs(self) -> np.ndarray:
        """(k, 3 b) Pa."""
        return self._element_values([law.kelvin_springs for law in self.table])

    @cached_property
    def kelvin_dashpots(self) -> np.ndarray:
        """(k, 3 b) Pa s."""
        return self._element_values([law.kelvin_dashpots for law in self.table])

    def step(self, dt: float) -> LawStep:
        """Coefficients of U+ = b - S sigma+ of a step `dt` [s], as arrays (3 b,) where bonds differ."""
        steps = [law.step(dt) for law in self.table]
        return LawStep(
            dt=dt,
            compliance=np.array([step.compliance for step in steps])[self.kind],
            spring_memory=np.array([step.spring_memory for step in steps])[self.kind],
            kelvin_recall=self._element_values([step.kelvin_recall for step in steps]),
            kelvin_decay=self._element_values([step.kelvin_decay for step in steps]),
            kelvin_gain=self._element_values([step.kelvin_gain for step in steps]),
        )

    def discrete_modulus(self, omega: float, dt: float) -> np.ndarray:
        """Complex modulus (3 b,) [Pa] of each component at `omega` [rad/s], as of a `BondLaw`."""
        return np.array([law.discrete_modulus(omega, dt) for law in self.table])[self.kind]

    def _element_values(self, values: Sequence[np.ndarray]) -> np.ndarray:
        """(k, 3 b) from one number for each Kelvin element of each law."""
        most = max(len(of_law) for of_law in values)
        # an element of zeros neither recalls nor grows: laws of any length go through one product
        return np.array([np.pad(of_law, (0, most - len(of_law))) for of_law in values]).T[:, self.kind]


AnyLaw = BondLaw | BondLaws


@dataclass(frozen=True)
class LawStep:
    """Affine law over one step: U+ = b - compliance sigma+; one for all, or a number for each of (3 b,).

    Any law must be so, with one compliance for all steps, for matrices are factorised with it once. One that changes
    with rate or load is beyond every stepper here.
    """

    dt: float
    compliance: float | np.ndarray  # S, 1/(Pa s)
    spring_memory: float | np.ndarray  # factor of sigma- in b
    kelvin_recall: np.ndarray  # (k,) or (k, 3 b) factors of dk- in b, with minus
    kelvin_decay: np.ndarray  # factors of dk- in dk+
    kelvin_gain: np.ndarray  # factors of sigma+ in dk+, with minus

    def explicit_part(self, sigma: np.ndarray, kelvin: np.ndarray) -> np.ndarray:
        """What the law remembers at the start of a step: b [m/s] of U+ = b - S sigma+, shape (...,).

        `sigma` (...,) in Pa and the displacements `kelvin` (k, ...) of the Kelvin elements in m, both at the start.
        """
        return np.asarray(
            self.spring_memory * sigma - (_expand(self.kelvin_recall, kelvin) * kelvin).sum(axis=0)
        )

    def update(self, explicit: np.ndarray, velocity: np.ndarray, kelvin: np.ndarray) -> tuple:
        """State at the end of a step, sigma+ = (b - U+) / S (...,) [Pa] and dk+ (k, ...) [m].

        `explicit` (...,) is b of `explicit_part` and `velocity` (...,) the opening velocity U+, both in m/s; `kelvin`
        (k, ...) are the displacements of the Kelvin elements at the start [m].
        """
        sigma = (explicit - velocity) / self.compliance
        return sigma, self.stretched(kelvin, sigma)

    def stretched(self, kelvin: np.ndarray, sigma: np.ndarray) -> np.ndarray:
        """Kelvin displacements dk+ = (eta_k dk- - dt sigma+) / (eta_k + dt Ek) (k, ...) [m] at a step's end.

        `sigma` (...,) is the stress at the end [Pa]; a positive one shortens, as sigma = -Em dm has it.
        """
        return np.asarray(
            _expand(self.kelvin_decay, kelvin) * kelvin - _expand(self.kelvin_gain, kelvin) * sigma
        )


def _expand(factor: np.ndarray, kelvin: np.ndarray) -> np.ndarray:
    """Factors (k,) or (k, 3 b) in a shape that multiplies kelvin (k, ...)."""
    return factor.reshape(factor.shape + (1,) * (kelvin.ndim - factor.ndim))
