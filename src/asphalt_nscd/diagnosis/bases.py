"""Laws of the mix against which causes are judged: parameters with priors, moduli with derivatives.

A rig effect may not soak up the misfit of a parametric law, so the base is flexible: many Maxwell
elements on reduced time, their logarithmic strengths smoothed, with a WLF shift and a small smooth
departure from it. Burgers at each temperature, the paper's law, has the same interface.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
LN10 = np.log(10.0)


class Base(Protocol):
    """A law of the mix with p parameters (all real, of order one)."""

    def modulus(self, x: Vector, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        """E* (n,) [Pa] and its derivative (n, p) with respect to the parameters."""

    def prior(self, x: Vector) -> tuple[Vector, NDArray]:
        """Residuals (k,) of the prior in standard deviations, and their derivative (k, p)."""


@dataclass(frozen=True)
class FlexibleSpectrum:
    """Maxwell elements on WLF-reduced time.

    times (m,): relaxation times [s] at the reference temperature [degC], ascending; roughness: standard
    deviation of the second differences of ln(strength); least_c2 [K]: the shift is singular at C2 below
    the coldest test; span [K]: scale of the departure from WLF; static_modulus [Pa]: known from
    elsewhere, or None; ends_straight: the tests come near it. Parameters: ln strength (m), ln static
    modulus, ln C1, ln(C2 - least_c2), departure.
    """

    times: Vector
    reference_temperature: float
    least_c2: float
    span: float
    roughness: float
    static_modulus: float | None = None
    ends_straight: bool = False

    # Slower than the tests, a bump acts as a larger static modulus. Where that is known and near, there is none.
    SLOWEST = 5  # elements
    STRAIGHT = 0.02  # standard deviation of their second differences
    DEPARTURE = 0.1  # standard deviation of ln(a_T) off WLF one span away from the reference

    @property
    def parameters(self) -> int:
        return self.times.size + 4

    def log_shift(self, x: Vector, temperature: Vector) -> tuple[Vector, NDArray]:
        """ln a_T (n,) and its derivative (n, 3) with respect to the last three parameters."""
        c1, c2 = np.exp(x[-3]), self.least_c2 + np.exp(x[-2])
        above = temperature - self.reference_temperature
        wlf = -LN10 * c1 * above / (c2 + above)
        cubic = (above / self.span) ** 3
        slopes = np.column_stack([wlf, -wlf / (c2 + above) * (c2 - self.least_c2), cubic])
        return wlf + x[-1] * cubic, slopes

    def modulus(self, x: Vector, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        m = self.times.size
        shift, shift_slopes = self.log_shift(x, temperature)
        z = 1j * (omega * np.exp(shift))[:, None] * self.times
        strength = np.exp(x[:m])
        terms = z / (1.0 + z) * strength
        known = self.static_modulus is not None
        static = self.static_modulus if known else float(np.exp(x[m]))
        along = (terms / (1.0 + z)).sum(axis=1)  # derivative with respect to ln(reduced frequency)
        slope = np.empty((omega.size, self.parameters), complex)
        slope[:, :m] = terms
        slope[:, m] = 0.0 if known else static
        slope[:, m + 1 :] = along[:, None] * shift_slopes
        return static + terms.sum(axis=1), slope

    def prior(self, x: Vector) -> tuple[Vector, NDArray]:
        m = self.times.size
        rows = np.zeros((m + 2, self.parameters))
        rows[: m - 2, :m] = np.diff(np.eye(m), 2, axis=0) / self.roughness
        if self.ends_straight:
            rows[m - 2 - self.SLOWEST : m - 2, :m] *= max(self.roughness / self.STRAIGHT, 1.0)
        offset = np.zeros(m + 2)
        # Broad: the static modulus anywhere from 1e-5 to 0.1 of the glassy one; WLF constants of bitumens.
        level = float(np.log(np.exp(x[:m]).sum()))
        rows[m - 2, m], offset[m - 2] = 1.0 / 3.0, (level - 6.0) / 3.0
        rows[m - 1, -3], offset[m - 1] = 1.0, np.log(12.0)
        rows[m, -2], offset[m] = 1.0, np.log(100.0)
        rows[m + 1, -1] = 1.0 / self.DEPARTURE
        return rows @ x - offset, rows


@dataclass(frozen=True)
class BurgersAtEach:
    """A Burgers law for each temperature, the paper's base. Parameters: ln(Em, eta_m, Ek, eta_k) of each."""

    isotherms: Vector  # degC

    @property
    def parameters(self) -> int:
        return 4 * self.isotherms.size

    def modulus(self, x: Vector, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        at = np.abs(temperature[:, None] - self.isotherms).argmin(axis=1)
        em, eta_m, ek, eta_k = np.exp(x.reshape(-1, 4))[at].T
        i_omega = 1j * omega
        maxwell, flow, kelvin = 1.0 / em, 1.0 / (i_omega * eta_m), 1.0 / (ek + i_omega * eta_k)
        modulus = 1.0 / (maxwell + flow + kelvin)
        slopes = np.column_stack([maxwell, flow, kelvin**2 * ek, kelvin**2 * i_omega * eta_k])
        slope = np.zeros((omega.size, self.parameters), complex)
        rows = np.arange(omega.size)
        for k in range(4):
            slope[rows, 4 * at + k] = modulus**2 * slopes[:, k]
        return modulus, slope

    def prior(self, x: Vector) -> tuple[Vector, NDArray]:
        # Keeps a parameter that the data do not see where it is.
        return np.zeros(x.size), 1e-3 * np.eye(x.size)
