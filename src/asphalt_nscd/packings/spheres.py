"""Spheres as a file gives them: numbers in the unit that the file states, or in none."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.specimen.given_spheres import require_spheres

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
GUESSED = ("m", "mm")
RADII = (1e-4, 5e-2)  # m: of aggregate from 0.2 to 100 mm; no number is one of them in m and in mm
SURE = (1e-3, 2e-2)  # m: of what a mix holds most; lengths that give such radii in cm may be meant so
MOST = 10_000_000


@dataclass(frozen=True)
class Spheres:
    """Spheres as a file gives them, with notes on how it was read.

    `position` (n, 3) and `radius` (n,) in `unit`, which is None where the file does not say it.
    """

    path: Path
    position: NDArray[np.float64]
    radius: NDArray[np.float64]
    unit: str | None = None
    notes: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        # in metres it is no matter how far: a packing is moved to the origin
        require_spheres(self.path, self.position, self.radius, np.inf)
        if self.radius.size > MOST:
            raise InputError(f"{self.path}: {self.radius.size} spheres; give at most {MOST}.")

    def convert_to_metres(self, stated: str | None) -> tuple[Spheres, str]:
        """The same spheres in m, and a sentence on the unit.

        `stated` is the unit that the user gives; if None it is that of the file, or the one that fits radii of
        aggregate.
        """
        if stated is not None and stated not in UNITS:
            raise InputError(f"unit {stated!r} is not known; give one of {', '.join(UNITS)}.")
        if stated is not None and self.unit is not None and stated != self.unit:
            raise InputError(f"{self.path}: its columns are in {self.unit}; leave out --unit {stated}.")
        unit = stated or self.unit
        low, high = float(self.radius.min()), float(self.radius.max())
        if unit is None:
            fits = [u for u in GUESSED if RADII[0] <= low * UNITS[u] and high * UNITS[u] <= RADII[1]]
            if not fits:
                raise InputError(
                    f"{self.path}: radii from {low:g} to {high:g} are those of aggregate neither in m nor in mm; "
                    f"state the unit with --unit (packing_unit in a study), one of {', '.join(UNITS)}."
                )
            unit = fits[0]
            if unit == "mm" and SURE[0] <= low * UNITS["cm"] and high * UNITS["cm"] <= SURE[1]:
                raise InputError(
                    f"{self.path}: radii from {low:g} to {high:g} are those of sand in mm and of gravel in cm; state "
                    "the unit with --unit (packing_unit in a study), mm or cm."
                )
            said = f"lengths taken as {unit}, because radii from {low:g} to {high:g} are those of aggregate in {unit}"
        else:
            said = f"lengths in {unit}, as {'stated' if stated else 'the file says'}"
            if not RADII[0] <= low * UNITS[unit] <= high * UNITS[unit] <= RADII[1]:
                raise InputError(
                    f"{self.path}: radii from {low:g} to {high:g} {unit} are not those of aggregate, 0.1 to 50 mm; "
                    "check the unit, or scale the packing."
                )
        scale = UNITS[unit]
        return Spheres(self.path, scale * self.position, scale * self.radius, "m", self.notes), said
