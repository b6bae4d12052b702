"""Two-point bending of a trapezoidal cantilever: Eqs. (1)-(5) of the paper, in SI units.

Complex amplitudes go with exp(+i omega t). The force leads the displacement by `phase`.
Sources: Quezada & Chazallon (2020); EN 12697-26 (whose factor 1e-6 on the mass term belongs to
the units N, mm, g, MPa and has no place in SI).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.csvinput import Limits
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.kinds import BENDING
from asphalt_nscd.measurements.kinds import PAPER_AMPLITUDE as PAPER_AMPLITUDE
from asphalt_nscd.measurements.shape import Shape

HEAD_SHARE_OF_MASS = 0.135  # part of the specimen's mass that moves with the head, Eq. (1)
# Of a prism: Rayleigh's quotient with the static deflection. With 0.135 a prism of 1.8 kg would be 54 MPa off at 40 Hz.
SHARE_OF_PRISM = 33.0 / 140.0


@dataclass(frozen=True)
class Geometry(Shape):
    """Trapezoidal specimen, Fig. 1a: lengths in m, masses in kg.

    `b` and `B` are the widths of head and foot, `e` the thickness, `h` the height; `mobile_mass` is that of the
    equipment that moves with the head.
    """

    b: float
    B: float
    e: float
    h: float
    mass: float
    mobile_mass: float

    test: ClassVar[str] = BENDING
    axis: ClassVar[int] = 0
    # Wide enough for any two-point bending rig, narrow enough to catch metres under a name in mm.
    limits: ClassVar[dict[str, Limits]] = {
        "b_mm": Limits(2, 200, "give the width of the head in mm"),
        "B_mm": Limits(2, 300, "give the width of the foot in mm"),
        "e_mm": Limits(2, 200, "give the thickness in mm"),
        "h_mm": Limits(20, 1000, "give the height in mm"),
        "mass_kg": Limits(1e-3, 20, "give the mass of the specimen in kg"),
        "mobile_mass_kg": Limits(0, 20, "give the mass of the mobile equipment in kg"),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.b > self.B:
            raise InputError(
                f"geometry: the head b = {self.b:g} m is wider than the foot B = {self.B:g} m; "
                "exchange b and B."
            )

    @property
    def width(self) -> float:
        """Width of the foot [m]."""
        return self.B

    @property
    def thickness(self) -> float:
        """Thickness e [m]."""
        return self.e

    def faces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Head, foot, the two inclined faces and the two others."""
        slope = (self.B - self.b) / (2.0 * self.h)
        side = np.array([1.0, 0.0, slope]) / np.hypot(1.0, slope)
        normal = np.array([[0, 0, 1], [0, 0, -1], side, side * [-1, 1, 1], [0, 1, 0], [0, -1, 0]])
        half = self.B / 2.0 * side[0]
        return normal, np.array([self.h, 0.0, half, half, self.e / 2.0, self.e / 2.0])

    def gyration(self) -> NDArray[np.float64]:
        """Squared radii of gyration (3,) [m2] of a thin rectangle b x e."""
        b2, e2 = self.b**2, self.e**2
        return np.array([e2, b2, b2 + e2]) / 12.0

    def form_factor(self) -> float:
        """gamma [1/m], Eq. (3)."""
        return form_factor(self)

    def mass_factor(self) -> float:
        """mu [kg] of Eq. (1)."""
        return mass_factor(self)

    def counted_share(self, poisson: float) -> float:
        """Share of the static displacement of the head that is bending, without shear."""
        return bending_share(self, poisson)

    def line(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Elastic line (n,) of the cantilever under a force at its free head, where it is one.

        w'' ~ (h - x) / width(x)^3, the bending theory behind Eq. (3), is integrated by the trapezoidal rule over
        heights `x` (n,) [m], which rise from 0 to h.
        """
        curvature = (self.h - x) / (self.B - (self.B - self.b) * x / self.h) ** 3
        step = np.diff(x)
        slope = np.concatenate([[0.0], np.cumsum(0.5 * step * (curvature[1:] + curvature[:-1]))])
        line = np.concatenate([[0.0], np.cumsum(0.5 * step * (slope[1:] + slope[:-1]))])
        return line / line[-1]

    def usual_amplitude(self) -> float:
        """Amplitude of the head [m] for the strain of the paper's 63 um in its specimen: as h^2 / B."""
        return PAPER_AMPLITUDE * (self.h**2 / self.B) / (PAPER.h**2 / PAPER.B)


PAPER = Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235)
"""Specimen of the paper, section 2.1."""


def form_factor(geometry: Geometry) -> float:
    """Form factor gamma [1/m], Eq. (3).

    With x = 1 - b/B, Eq. (3) reads gamma = 12 h^3 / (e B^3) (-ln(1-x) - x - x^2/2) / x^3. The quotient tends
    to 1/3 as b -> B (a prismatic cantilever: 4 h^3 / (e B^3)); near that limit it is summed as the series 1/3
    + x/4 + x^2/5 + ..., because the closed form cancels.

    >>> round(form_factor(PAPER), 1)  # the paper prints 25.1 1/mm
    25095.8
    """
    x = 1.0 - geometry.b / geometry.B
    # The closed form holds 13 digits at 0.05, and nine at 0.001.
    if x < 0.05:
        shape = sum(x**n / (n + 3) for n in range(14))  # 0.05^14 is below rounding
    else:
        shape = (-np.log1p(-x) - x - 0.5 * x**2) / x**3
    return float(12.0 * geometry.h**3 / (geometry.e * geometry.B**3) * shape)


def bending_share(geometry: Geometry, poisson: float) -> float:
    """Share (0 to 1) of a Timoshenko beam's static deflection that is bending, all that Eq. (3) counts.

    Eqs. (1)-(3) find E of a beam times this share. Shear: integral of F / (k G A) over the height, G = E / (2 (1 +
    nu)), k = 10 (1 + nu) / (12 + 11 nu) of a rectangle (Cowper 1966); nu is `poisson`.

    >>> round(bending_share(PAPER, 0.35), 3)
    0.968
    """
    x = 1.0 - geometry.b / geometry.B
    mean = 1.0 if x == 0.0 else -np.log1p(-x) / x  # of B / width over the height
    shear = (12.0 + 11.0 * poisson) / 5.0 * geometry.h / (geometry.e * geometry.B) * mean
    bending = form_factor(geometry)
    return float(bending / (bending + shear))


def mass_factor(geometry: Geometry) -> float:
    """Mass factor mu = 0.135 M + m [kg]; that of a prism, b = B, is 33/140 M + m.

    >>> round(mass_factor(PAPER), 3)
    0.316
    """
    share = SHARE_OF_PRISM if geometry.b == geometry.B else HEAD_SHARE_OF_MASS
    return share * geometry.mass + geometry.mobile_mass


def complex_modulus(
    geometry: Geometry,
    frequency: ArrayLike,
    force_amplitude: ArrayLike,
    displacement_amplitude: ArrayLike,
    phase: ArrayLike,
) -> NDArray[np.complex128]:
    """Complex modulus E* = E1 + i E2 [Pa] from peak values, Eqs. (1)-(2).

    `frequency` in Hz, amplitudes F0 in N and z0 in m, `phase` Psi in rad: scalars or arrays of one shape.

    >>> modulus = complex_modulus(PAPER, 10.0, force_amplitude=24.0, displacement_amplitude=63e-6, phase=0.3)
    >>> print(f"{modulus / 1e9:.3f} GPa")
    9.165+2.825j GPa
    """
    return geometry.complex_modulus(frequency, force_amplitude, displacement_amplitude, phase)


def head_response(
    geometry: Geometry, frequency: ArrayLike, modulus: ArrayLike, displacement_amplitude: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Force amplitude F0 [N] and phase Psi [rad] at the head: the exact inverse of Eqs. (1)-(2).

    `frequency` in Hz, `modulus` E* in Pa, `displacement_amplitude` z0 in m: scalars or arrays of one shape.

    >>> force, phase = head_response(PAPER, frequency=10.0, modulus=10e9, displacement_amplitude=63e-6)
    >>> print(f"{force:.2f} N, {phase:.1f} rad")
    25.03 N, 0.0 rad
    """
    omega = 2.0 * np.pi * np.asarray(frequency)
    stiffness = np.asarray(modulus) / form_factor(geometry) - mass_factor(geometry) * omega**2
    return np.abs(stiffness) * np.asarray(displacement_amplitude), np.angle(stiffness)


def norm_and_phase(modulus: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Norm [Pa] and phase angle [rad] of E* [Pa], Eqs. (4)-(5).

    Eq. (5) prints arctan(E2/E1); the angle in (-pi, pi] agrees with it where E1 > 0 and does not hide a negative E1.

    >>> norm, phase = norm_and_phase(3e9 + 4e9j)
    >>> print(f"{norm / 1e9:.0f} GPa, {phase:.4f} rad")
    5 GPa, 0.9273 rad
    """
    modulus = np.asarray(modulus)
    return np.abs(modulus), np.angle(modulus)
