"""The bond law: a spring, a dashpot and Kelvin-Voigt elements in series (Burgers: one element).

Steppers know no more of a law than `AnyLaw` and `LawStep` say: its affine law of a step, and a memory that they keep
for it. A law with another memory is one class of each.

All bonds share one rheology, or each component of each bond has its own (`BondLaws`). Their geometry
g [m] (Eqs. 30-33) is divided out: the reaction is R = g sigma [N], and sigma [N/m], a stress times the length of
the bond, obeys for each component

    sigma = -Em dm,   sigma = -eta_m dm',   sigma = -Ek dk - eta_k dk',   U = dm' + dm'' + dk'

with U the opening velocity. Implicit Euler over dt turns this into the affine law of the paper
(Eqs. 22-26 with consistent signs)

    U+ = b - S sigma+,   S = 1/(dt Em) + 1/eta_m + sum 1/(eta_k + dt Ek)
    b = sigma-/(dt Em) - sum Ek dk-/(eta_k + dt Ek)
    dk+ = (eta_k dk- - dt sigma+)/(eta_k + dt Ek)
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

# <,> over the bonds [m]: a stress and an opening to an energy
Form = Callable[[np.ndarray, np.ndarray], float]
Stresses = tuple[np.ndarray, np.ndarray]  # of bonds: sigma (...,) [N/m] and the memory (m, ...) of their law


class AnyLaw(ABC):
    """What steppers ask of a law of bonds."""

    @property
    @abstractmethod
    def memory(self) -> int:
        """Number m of internal variables beside sigma, of each component of a bond."""

    @abstractmethod
    def step(self, dt: float) -> LawStep:
        """The affine law U+ = b - S sigma+ of a step of implicit Euler of `dt` [s]."""

    @abstractmethod
    def discrete_modulus(self, omega: float, dt: float) -> complex | np.ndarray:
        """Complex modulus [Pa] of the scheme itself at `omega` [rad/s]; dt = 0 gives the exact law.

        One of all bonds, or (3 b,). The scheme replaces i omega by (1 - exp(-i omega dt))/dt.
        """

    @abstractmethod
    def stored(self, strain: Form, one: Stresses, other: Stresses) -> float:
        """Bilinear form [J] of all springs; half of it, with the same stresses twice, is what they store."""

    @abstractmethod
    def dissipated(self, strain: Form, sigma: np.ndarray, memory: np.ndarray, rate: np.ndarray) -> float:
        """What all dashpots take [W] at a step's end; `rate` (m, ...) is that of the `memory`."""


class LawStep(ABC):
    """Affine law over one step: U+ = b - compliance sigma+.

    One compliance for all steps, for matrices are factorised with it once. A law that changes with rate or load is
    beyond every stepper here.
    """

    dt: float
    compliance: float | np.ndarray  # S, 1/(Pa s), of all or of each of (3 b,)

    @abstractmethod
    def explicit_part(self, sigma: np.ndarray, memory: np.ndarray) -> np.ndarray:
        """b (...,) [m/s] of U+ = b - S sigma+, from sigma (...,) [N/m] and memory (m, ...) at the start."""

    @abstractmethod
    def remembered(self, sigma: np.ndarray, velocity: np.ndarray, memory: np.ndarray) -> np.ndarray:
        """Memory (m, ...) at the end, from sigma+ [N/m], U+ [m/s] and the memory at the start.

        The reduced model asks that each variable depends on none of the others: dk+ = decay dk- - gain sigma+ -
        follow U+. Coupled variables are independent in the coordinates of their eigenvectors.
        """

    def update(self, explicit: np.ndarray, velocity: np.ndarray, memory: np.ndarray) -> Stresses:
        """State at the end: sigma+ = (b - U+) / S (...,) [N/m] and memory (m, ...), from b, U+ [m/s] and memory."""
        sigma = (explicit - velocity) / self.compliance
        return sigma, self.remembered(sigma, velocity, memory)

    def coefficients(self, variables: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """(recall (1 + m,) of sigma- and the memory in b; decay, gain, follow (m,)) of one law for all bonds.

        Found by giving the law unit stress, velocity and memory, so that it states them once.
        """
        none, unit = np.zeros(1), np.ones(1)
        still, each = np.zeros((variables, 1)), np.eye(variables)
        alone = self.remembered(np.zeros(variables), np.zeros(variables), each)
        if (alone != alone * each).any():
            raise TypeError("the reduced model asks that no variable of a law depends on another.")
        recall = [self.explicit_part(unit, still), self.explicit_part(np.zeros(variables), each)]
        gain, follow = -self.remembered(unit, none, still), -self.remembered(none, unit, still)
        return np.concatenate(recall), np.diag(alone).copy(), gain[:, 0], follow[:, 0]


class _Chains(AnyLaw):
    """What one chain and chains of many bonds have in common."""

    if TYPE_CHECKING:  # fields of BondLaw; BondLaws computes them

        @property
        def spring(self) -> Any: ...
        @property
        def dashpot(self) -> Any: ...
        @property
        def kelvin_springs(self) -> np.ndarray: ...
        @property
        def kelvin_dashpots(self) -> np.ndarray: ...

    @property
    def memory(self) -> int:
        return len(self.kelvin_springs)

    def stored(self, strain: Form, one: Stresses, other: Stresses) -> float:
        springs = strain(one[0] / self.spring, other[0])
        for modulus, a, b in zip(np.atleast_1d(self.kelvin_springs), one[1], other[1], strict=True):
            springs += strain(modulus * a, b)
        return springs

    def dissipated(self, strain: Form, sigma: np.ndarray, memory: np.ndarray, rate: np.ndarray) -> float:
        power = strain(sigma / self.dashpot, sigma)
        for viscosity, of_element in zip(np.atleast_1d(self.kelvin_dashpots), rate, strict=True):
            power += strain(viscosity * of_element, of_element)
        return power


@dataclass(frozen=True)
class BondLaw(_Chains):
    """One law for all bonds: a chain, its geometry divided out.

    An infinite spring or dashpot is one that the chain does not have. `spring` Em in Pa, `dashpot` eta_m in Pa s; of
    each Kelvin element (e,), `kelvin_springs` Ek in Pa and `kelvin_dashpots` eta_k in Pa s.
    """

    spring: float
    dashpot: float
    kelvin_springs: np.ndarray
    kelvin_dashpots: np.ndarray

    def step(self, dt: float) -> ChainStep:
        """Coefficients of the affine law U+ = b - S sigma+ of a step of length `dt` [s]."""
        springs, dashpots = np.asarray(self.kelvin_springs, float), np.asarray(self.kelvin_dashpots, float)
        damped = dashpots + dt * springs
        # of spring and dashpot the reciprocals alone: infinite ones, which the chain does not have, drop out
        return ChainStep(
            dt=dt,
            compliance=1.0 / (dt * self.spring) + 1.0 / self.dashpot + float((1.0 / damped).sum()),
            spring_memory=1.0 / (dt * self.spring),
            kelvin_recall=springs / damped,
            kelvin_decay=dashpots / damped,
            kelvin_gain=dt / damped,
        )

    def discrete_modulus(self, omega: float, dt: float) -> complex:
        """Complex modulus [Pa] of all bonds, of the scheme itself."""
        rate = (1.0 - np.exp(-1j * omega * dt)) / dt if dt > 0.0 else 1j * omega
        kelvin = (1.0 / (self.kelvin_springs + rate * self.kelvin_dashpots)).sum()
        return complex(1.0 / (1.0 / self.spring + 1.0 / self.dashpot / rate + kelvin))


@dataclass(frozen=True)
class BondLaws(_Chains):
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
        """Laws of bonds by places (b,) in `table`; the tangential law is the normal one if `tangential` is None."""
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

    def step(self, dt: float) -> ChainStep:
        """Coefficients of U+ = b - S sigma+ of a step `dt` [s], as arrays (3 b,) where bonds differ."""
        steps = [law.step(dt) for law in self.table]
        return ChainStep(
            dt=dt,
            compliance=np.array([step.compliance for step in steps])[self.kind],
            spring_memory=np.array([step.spring_memory for step in steps])[self.kind],
            kelvin_recall=self._element_values([step.kelvin_recall for step in steps]),
            kelvin_decay=self._element_values([step.kelvin_decay for step in steps]),
            kelvin_gain=self._element_values([step.kelvin_gain for step in steps]),
        )

    def discrete_modulus(self, omega: float, dt: float) -> np.ndarray:
        """Complex modulus (3 b,) [Pa] of each component, of the scheme itself."""
        return np.array([law.discrete_modulus(omega, dt) for law in self.table])[self.kind]

    def _element_values(self, values: Sequence[np.ndarray]) -> np.ndarray:
        """(k, 3 b) from one number for each Kelvin element of each law."""
        most = max(len(of_law) for of_law in values)
        # an element of zeros neither recalls nor grows: laws of any length go through one product
        return np.array([np.pad(of_law, (0, most - len(of_law))) for of_law in values]).T[:, self.kind]


@dataclass(frozen=True)
class ChainStep(LawStep):
    """The affine law of chains; one for all bonds, or a number for each of (3 b,)."""

    dt: float
    compliance: float | np.ndarray
    spring_memory: float | np.ndarray  # factor of sigma- in b
    kelvin_recall: np.ndarray  # (k,) or (k, 3 b) factors of dk- in b, with minus
    kelvin_decay: np.ndarray  # factors of dk- in dk+
    kelvin_gain: np.ndarray  # factors of sigma+ in dk+, with minus

    def explicit_part(self, sigma: np.ndarray, memory: np.ndarray) -> np.ndarray:
        """b (...,) [m/s]; the memory (k, ...) is the displacements dk of the Kelvin elements [m]."""
        return np.asarray(
            self.spring_memory * sigma - (_expand(self.kelvin_recall, memory) * memory).sum(axis=0)
        )

    def remembered(self, sigma: np.ndarray, velocity: np.ndarray, memory: np.ndarray) -> np.ndarray:
        """dk+ = (eta_k dk- - dt sigma+) / (eta_k + dt Ek) (k, ...) [m]; a positive stress shortens."""
        return np.asarray(
            _expand(self.kelvin_decay, memory) * memory - _expand(self.kelvin_gain, memory) * sigma
        )


def _expand(factor: np.ndarray, memory: np.ndarray) -> np.ndarray:
    """Factors (k,) or (k, 3 b) in a shape that multiplies a memory (k, ...)."""
    return factor.reshape(factor.shape + (1,) * (memory.ndim - factor.ndim))
