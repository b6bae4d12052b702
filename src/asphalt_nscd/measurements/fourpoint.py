"""Four-point bending of a prism: EN 12697-26 annex B, AASHTO T 321.

The prism lies along z and is clamped in four sections, at the ends and at thirds of its span. The outer clamps rest,
the inner ones are driven together across the span; all of them turn. Displacement is that of the inner clamps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.files.csvinput import Limits
from asphalt_nscd.measurements.shape import DRIVEN, FREE, HELD, Plate, Shape

INNER = 1.0 / 3.0, 2.0 / 3.0  # of the span: where the inner clamps stand
SHARE_OF_MASS = 697.0 / 1050.0  # mean of the squared static line, 1 at the inner clamps (Rayleigh)
USUAL_STRAIN = 50e-6  # of the outermost fibre between the inner clamps, as EN 12697-26 asks


@dataclass(frozen=True)
class Beam(Shape):
    """Prism in four-point bending: `h` is the span between the outer clamps [m].

    `depth` is the extent along the drive, `breadth` the other one [m]; `mass` is that of the specimen, `mobile_mass`
    that of the inner clamps and what moves with them [kg].

    >>> beam = Beam(h=0.357, depth=0.05, breadth=0.063, mass=2.7, mobile_mass=0.5)
    >>> round(beam.form_factor()), round(beam.mass_factor(), 3), f"{beam.usual_amplitude():.2g} m"
    (1070, 2.292, '2.4e-05 m')
    """

    h: float
    depth: float
    breadth: float
    mass: float
    mobile_mass: float

    test: ClassVar[str] = "four-point bending"
    axis: ClassVar[int] = 0
    down: ClassVar[int] = 0
    limits: ClassVar[dict[str, Limits]] = {
        "L_mm": Limits(20, 1000, "give the span between the outer clamps in mm"),
        "H_mm": Limits(2, 200, "give the depth along the drive in mm"),
        "B_mm": Limits(2, 200, "give the breadth across the drive in mm"),
        "mass_kg": Limits(1e-3, 50, "give the mass of the specimen in kg"),
        "mobile_mass_kg": Limits(0, 50, "give the mass of the inner clamps in kg"),
    }

    @property
    def width(self) -> float:
        """Depth [m]."""
        return self.depth

    @property
    def thickness(self) -> float:
        """Breadth [m]."""
        return self.breadth

    @property
    def plates(self) -> tuple[Plate, ...]:
        """The inner clamps, which share the mobile mass and move as one along x; the outer ones, without mass."""
        driven = (DRIVEN, FREE, FREE, FREE, FREE, FREE)
        return (
            Plate(INNER[0] * self.h, driven, 0.5),
            Plate(INNER[1] * self.h, driven, 0.5),
            Plate(0.0, (HELD, HELD, HELD, FREE, FREE, HELD), 0.0),
            # Free along the beam at one end: held at both it would be stretched as it bends.
            Plate(self.h, (HELD, HELD, FREE, FREE, FREE, HELD), 0.0),
        )

    def faces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The ends, then the four sides."""
        normal = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], float)
        half = np.array([self.depth, self.depth, self.breadth, self.breadth]) / 2.0
        return normal, np.concatenate([[self.h, 0.0], half])

    def gyration(self) -> NDArray[np.float64]:
        """Squared radii of gyration (3,) [m2] of a thin rectangle, depth x breadth."""
        x2, y2 = self.depth**2, self.breadth**2
        return np.array([y2, x2, x2 + y2]) / 12.0

    def form_factor(self) -> float:
        """5 L^3 / (27 B H^3) [1/m]: F/2 on each inner clamp deflects it by 5 F L^3 / (324 E I)."""
        return 5.0 * self.h**3 / (27.0 * self.breadth * self.depth**3)

    def mass_factor(self) -> float:
        """The part of the beam's mass that its static line moves, and the mobile mass [kg]."""
        return SHARE_OF_MASS * self.mass + self.mobile_mass

    def counted_share(self, poisson: float) -> float:
        """Share of bending in the static displacement; the rest is shear, of F/2 over L/3 from outer to inner clamps.

        k of the shear is that of `twopoint.bending_share`.
        """
        shear = (12.0 + 11.0 * poisson) / 30.0 * self.h / (self.breadth * self.depth)
        return float(self.form_factor() / (self.form_factor() + shear))

    def line(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Elastic line (n,) of a beam on two supports under two forces, 1 at the inner clamps; `x` (n,) rising [m]."""
        s = np.minimum(x, self.h - x) / self.h
        outer = s * (2.0 / 3.0 - s**2)
        inner = (3.0 * s * (1.0 - s) - 1.0 / 9.0) / 3.0
        return 27.0 / 5.0 * np.where(s < INNER[0], outer, inner)

    def usual_amplitude(self) -> float:
        """Amplitude of the inner clamps [m] that strains the outermost fibre by USUAL_STRAIN."""
        # M = F L/6 between the inner clamps: strain F L H/(12 E I) over deflection 5 F L^3/(324 E I) is 5.4 H/L^2.
        return USUAL_STRAIN * self.h**2 / (5.4 * self.depth)


T321 = Beam(h=0.357, depth=0.05, breadth=0.063, mass=2.7, mobile_mass=0.0)
"""Specimen of AASHTO T 321 between its outer clamps, 2400 kg/m3."""
