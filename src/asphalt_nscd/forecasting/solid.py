"""The grains' material."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Solid:
    """An isotropic elastic solid: Young's modulus E [Pa] and Poisson's ratio."""

    modulus: float
    poisson: float

    @property
    def shear(self) -> float:
        """G [Pa]."""
        return self.modulus / (2.0 * (1.0 + self.poisson))

    @property
    def bulk(self) -> float:
        """K [Pa]."""
        return self.modulus / (3.0 * (1.0 - 2.0 * self.poisson))

    @property
    def plane(self) -> float:
        """E' = E / (2 (1 - nu^2)) [Pa] of a contact of two of it."""
        return self.modulus / (2.0 * (1.0 - self.poisson**2))
