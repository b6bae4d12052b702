"""The bond law: a spring, a dashpot and Kelvin-Voigt elements in series (Burgers: one element).

All bonds share one rheology. Their geometry g [m] (Eqs. 30-33) is divided out: the reaction is
R = g sigma, and sigma [Pa] obeys for each component

    sigma = -Em dm,   sigma = -eta_m dm',   sigma = -Ek dk - eta_k dk',   U = dm' + dm'' + dk'

with U the opening velocity. Implicit Euler over dt turns this into the affine law of the paper
(Eqs. 22-26 with consistent signs)

    U+ = b - S sigma+,   S = 1/(dt Em) + 1/eta_m + sum 1/(eta_k + dt Ek)
    b = sigma-/(dt Em) - sum Ek dk-/(eta_k + dt Ek)
    dk+ = (eta_k dk- - dt sigma+)/(eta_k + dt Ek)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class BondLaw:
    """Moduli [Pa] and viscosities [Pa s] of the chain; kelvin arrays have one entry per element.

    An infinite spring or dashpot is one that the chain does not have.
    """

    spring: float
    dashpot: float
    kelvin_springs: np.ndarray
    kelvin_dashpots: np.ndarray

    def step(self, dt: float) -> LawStep:
        """Coefficients of the affine law for the step dt [s]."""
        springs, dashpots = np.asarray(self.kelvin_springs, float), np.asarray(self.kelvin_dashpots, float)
        damped = dashpots + dt * springs
        return LawStep(
            dt=dt,
            compliance=1.0 / (dt * self.spring) + 1.0 / self.dashpot + float((1.0 / damped).sum()),
            memory=1.0 / (dt * self.spring),
            recall=springs / damped,
            keep=dashpots / damped,
            gain=dt / damped,
        )

    def discrete_modulus(self, omega: float, dt: float) -> complex:
        """Complex modulus [Pa] of the implicit Euler scheme itself, for steady oscillation.

        The scheme replaces i omega by (1 - exp(-i omega dt))/dt; dt = 0 gives the exact law.
        """
        rate = (1.0 - np.exp(-1j * omega * dt)) / dt if dt > 0.0 else 1j * omega
        kelvin = (1.0 / (self.kelvin_springs + rate * self.kelvin_dashpots)).sum()
        return complex(1.0 / (1.0 / self.spring + 1.0 / self.dashpot / rate + kelvin))


@dataclass(frozen=True)
class LawStep:
    """Affine law over one step: U+ = b - compliance sigma+."""

    dt: float
    compliance: float  # S, 1/(Pa s)
    memory: float  # factor of sigma- in b
    recall: np.ndarray  # factors of dk- in b, with minus
    keep: np.ndarray  # factors of dk- in dk+
    gain: np.ndarray  # factors of sigma+ in dk+, with minus

    def explicit_part(self, sigma: np.ndarray, kelvin: np.ndarray) -> np.ndarray:
        """b [m/s] from sigma (...,) [Pa] and kelvin displacements (k, ...) [m]."""
        return self.memory * sigma - np.tensordot(self.recall, kelvin, axes=1)

    def update(self, explicit: np.ndarray, velocity: np.ndarray, kelvin: np.ndarray) -> tuple:
        """(sigma+, dk+) from the opening velocity U+ (...,) [m/s]."""
        sigma = (explicit - velocity) / self.compliance
        shape = (-1,) + (1,) * sigma.ndim
        return sigma, self.keep.reshape(shape) * kelvin - self.gain.reshape(shape) * sigma
