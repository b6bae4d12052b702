"""Tension-compression of a cylinder between end plates: EN 12697-26 annex D, AASHTO T 342 and T 378.

The lower plate rests, the upper one is driven along the axis; displacement is that of the plate over the whole height.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.files.csvinput import Limits
from asphalt_nscd.measurements.shape import Shape

SIDES = 24  # of the prism of equal section that stands for the cylinder, so that all its faces are planes
USUAL_STRAIN = 50e-6  # half of the 100e-6 from peak to peak that T 378 aims at


@dataclass(frozen=True)
class Cylinder(Shape):
    """Cylinder in tension-compression: diameter `d` and height `h` in m, masses in kg.

    `mobile_mass` is that of the upper plate and what moves with it.

    >>> ampt = Cylinder(d=0.1, h=0.15, mass=2.8, mobile_mass=0.5)
    >>> round(ampt.form_factor(), 2), round(ampt.mass_factor(), 3), f"{ampt.usual_amplitude():.2g} m"
    (19.1, 1.433, '7.5e-06 m')
    """

    d: float
    h: float
    mass: float
    mobile_mass: float

    test: ClassVar[str] = "tension-compression"
    axis: ClassVar[int] = 2
    limits: ClassVar[dict[str, Limits]] = {
        "d_mm": Limits(10, 300, "give the diameter in mm"),
        "h_mm": Limits(20, 1000, "give the height in mm"),
        "mass_kg": Limits(1e-3, 50, "give the mass of the specimen in kg"),
        "mobile_mass_kg": Limits(0, 50, "give the mass of the upper plate in kg"),
    }

    @property
    def width(self) -> float:
        """Diameter [m]."""
        return self.d

    @property
    def thickness(self) -> float:
        """Diameter [m]."""
        return self.d

    def faces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Head, foot, and SIDES planes around the axis; the section is pi d^2/4."""
        angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
        around = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(SIDES)])
        apothem = self.d / 2.0 * np.sqrt(np.pi / (SIDES * np.tan(np.pi / SIDES)))
        normal = np.concatenate([[[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], around])
        return normal, np.concatenate([[self.h, 0.0], np.full(SIDES, apothem)])

    def gyration(self) -> NDArray[np.float64]:
        """Squared radii of gyration (3,) [m2] of a thin disc."""
        return self.d**2 * np.array([1.0 / 16.0, 1.0 / 16.0, 1.0 / 8.0])

    def form_factor(self) -> float:
        """h / A [1/m]: strain z/h, stress F/A."""
        return self.h / (np.pi * self.d**2 / 4.0)

    def mass_factor(self) -> float:
        """A third of the bar, whose velocity grows evenly from foot to head (Rayleigh), and the mobile mass [kg]."""
        return self.mass / 3.0 + self.mobile_mass

    def counted_share(self, poisson: float) -> float:
        """One: a bar in tension has no shear, and that plates hold its ends is not counted (docs/geometries.md)."""
        return 1.0

    def line(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Elastic line x / h at heights `x` (n,) [m]: one at the upper plate."""
        return x / self.h

    def usual_amplitude(self) -> float:
        """Amplitude of the upper plate [m] for USUAL_STRAIN."""
        return USUAL_STRAIN * self.h


AMPT = Cylinder(d=0.1, h=0.15, mass=2.83, mobile_mass=0.0)
"""Specimen of AASHTO T 378 and EN 12697-26 annex D, 2400 kg/m3."""
