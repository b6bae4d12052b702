"""Laws of the mix against which causes are judged: parameters with priors, moduli with derivatives.

A rig effect may not soak up the misfit of a parametric law, so the base is flexible: many Maxwell
elements on reduced time, their logarithmic strengths smoothed, with a WLF shift of any curvature, a bend where
binders turn to glass and a small smooth departure. Burgers at each temperature, the paper's law, has the same
interface.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, logit

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
LN10 = np.log(10.0)
CLEAR = 10.0  # K beyond the tests that a shift is not singular in, further than a bias is sought


class Base(Protocol):
    """A law of the mix with p parameters (all real, of order one)."""

    def modulus(self, x: Vector, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        """E* (n,) of the law [Pa] and its derivative (n, p) by x (p,); `omega` in rad/s, `temperature` in degC."""

    def prior(self, x: Vector) -> tuple[Vector, NDArray]:
        """How far the law is from what mixes are: residuals (k,) in standard deviations, and derivative (k, p)."""


@dataclass(frozen=True)
class FlexibleSpectrum:
    """Maxwell elements (m) on WLF-reduced time; tests reach `below` and `above` the reference [degC] in K.

    Parameters x: ln strength (m), ln static modulus, bends, ln slope, log-odds of the curvature, departure. By slope
    C1/C2 and curvature 1/C2 a shift straight in T is nothing special; in C1 and C2 it lies at infinity, and an isotherm
    was said to be off instead. `times` (m,) ascend, in s; `roughness` is the standard deviation of second differences
    of ln strength; `ends_straight` says whether the tests come near the `static_modulus` [Pa].
    """

    times: Vector
    reference_temperature: float
    below: float
    above: float
    roughness: float
    static_modulus: float | None = None
    ends_straight: bool = False

    # Slower than the tests, a bump acts as a larger static modulus. Where that is known and near, there is none.
    SLOWEST = 5  # elements
    STRAIGHT = 0.02  # standard deviation of their second differences
    SLOPE = 0.12, 1.0  # decades/K at the reference: mean, standard deviation of its logarithm
    CURVATURE = 7e-3, 5e-3  # 1/K: mean, standard deviation; bitumens about 0.01, Arrhenius 0.0035
    # Standard deviation of ln(a_T) off WLF this far from the reference [K], where the paper's tests end; it grows
    # with the cube. With 0.1 quadratic shifts are taken for a bias there, 0.3 hides one at the ends.
    DEPARTURE = 0.2, 25.0
    # Below the temperature at which a binder turns to glass its shift is Arrhenius' (SHRP-A-369: WLF of 19 and 92 K
    # above, 261 kJ/mol below): the second derivative of ln(a_T) falls by some 0.01 /K2 there. It lies between these
    # temperatures [degC]; the standard deviation [1/K2] is for each.
    GLASS = (10.0, 0.0, -10.0)
    BEND = 3e-3

    @property
    def parameters(self) -> int:
        """Number p of parameters: strengths, static modulus and shift."""
        return self.times.size + 4 + len(self.GLASS)

    @property
    def _curvatures(self) -> tuple[float, float]:
        """Least, and how much the largest is above it [1/K]."""
        # WLF is singular where 1 + curvature (T - T_ref) = 0, which these bounds keep CLEAR of the tests.
        least = -1.0 / (self.above + CLEAR)
        return least, 1.0 / (self.below + CLEAR) - least

    def log_odds(self, curvature: float) -> float:
        """Log-odds of a curvature 1/C2 in 1/K, or of the nearest that is well within the bounds."""
        least, width = self._curvatures
        # Well inside: at a bound the derivative by the log-odds vanishes, and no fit would leave.
        return float(logit(np.clip((curvature - least) / width, 0.1, 0.9)))

    def curvature(self, log_odds: float) -> tuple[float, float]:
        """Curvature 1/C2 [1/K] of its log-odds, and its derivative."""
        (least, width), share = self._curvatures, float(expit(log_odds))
        return least + width * share, width * share * (1.0 - share)

    def log_shift(self, x: Vector, temperature: Vector) -> tuple[Vector, NDArray]:
        """ln a_T (n,) at temperatures (n,) in degC, and its derivative (n, 6) by the parameters of the shift."""
        curvature, change = self.curvature(x[-2])
        away = temperature - self.reference_temperature
        bent = away / (1.0 + curvature * away)
        # The slope is a logarithm: no mix grows stiffer as it warms.
        wlf = -LN10 * np.exp(x[-3]) * bent
        # odd in the distance, so that it bends both ends apart and leaves slope and curvature to the WLF
        # shift
        cubic = (away / self.DEPARTURE[1]) ** 3
        glass = -0.5 * self.BEND * np.minimum(temperature[:, None] - self.GLASS, 0.0) ** 2
        bends = x[self.times.size + 1 : -3]
        slopes = np.column_stack([glass, wlf, -wlf * bent * change, cubic])
        return wlf + glass @ bends + x[-1] * cubic, slopes

    def modulus(self, x: Vector, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        """E* (n,) of the law [Pa] and its derivative (n, p); `omega` (n,) in rad/s, `temperature` (n,) in degC."""
        m = self.times.size
        shift, shift_slopes = self.log_shift(x, temperature)
        z = 1j * (omega * np.exp(shift))[:, None] * self.times
        # Strengths are logarithms: whatever they are, modulus and phase obey Kramers and Kronig.
        strength = np.exp(x[:m])
        terms = z / (1.0 + z) * strength
        known = self.static_modulus is not None
        static = self.static_modulus if known else float(np.exp(x[m]))
        along = (terms / (1.0 + z)).sum(axis=1)  # derivative with respect to ln(reduced frequency)
        slope = np.empty((omega.size, self.parameters), complex)
        slope[:, :m] = terms
        # A static modulus that is known keeps its column, empty, so that parameters keep their places.
        slope[:, m] = 0.0 if known else static
        slope[:, m + 1 :] = along[:, None] * shift_slopes
        return static + terms.sum(axis=1), slope

    def prior(self, x: Vector) -> tuple[Vector, NDArray]:
        """How far the law is from what mixes are: residuals (k,) in standard deviations, and derivative (k, p)."""
        m, bends = self.times.size, len(self.GLASS)
        rows = np.zeros((m + 2 + bends, self.parameters))
        # second differences: a power law, whose spectrum is straight, costs nothing
        rows[: m - 2, :m] = np.diff(np.eye(m), 2, axis=0) / self.roughness
        if self.ends_straight:
            rows[m - 2 - self.SLOWEST : m - 2, :m] *= max(self.roughness / self.STRAIGHT, 1.0)
        offset = np.zeros(m + 2 + bends)
        # Broad: the static modulus anywhere from 1e-5 to 0.1 of the glassy one.
        level = float(np.log(np.exp(x[:m]).sum()))
        rows[m - 2, m], offset[m - 2] = 1.0 / 3.0, (level - 6.0) / 3.0
        rows[m - 1, -3], offset[m - 1] = 1.0 / self.SLOPE[1], np.log(self.SLOPE[0]) / self.SLOPE[1]
        usual = self.log_odds(self.CURVATURE[0])
        rows[m, -2] = self.curvature(usual)[1] / self.CURVATURE[1]
        offset[m] = rows[m, -2] * usual
        rows[m + 1, -1] = 1.0 / self.DEPARTURE[0]
        rows[m + 2 :, m + 1 : -3] = np.eye(bends)
        return rows @ x - offset, rows


@dataclass(frozen=True)
class BurgersAtEach:
    """A Burgers law for each isotherm [degC], the paper's base; parameters: ln(Em, eta_m, Ek, eta_k) of each."""

    isotherms: Vector

    @property
    def parameters(self) -> int:
        """Number p of parameters: four for each isotherm."""
        return 4 * self.isotherms.size

    def modulus(self, x: Vector, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        """E* (n,) of the law [Pa] and its derivative (n, p); `omega` (n,) in rad/s, `temperature` (n,) in degC."""
        # A test off its target still has the law of its isotherm: a Burgers law knows no other temperature.
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
        """How far the law is from what mixes are: residuals (k,) in standard deviations, and derivative (k, p)."""
        # Keeps a parameter that the data do not see where it is.
        return np.zeros(x.size), 1e-3 * np.eye(x.size)
