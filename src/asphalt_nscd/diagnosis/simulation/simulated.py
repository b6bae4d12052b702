"""The numerical specimen in a diagnosis: its bending test in reduced form, a few dozen unknowns.

All bonds share one law, so the specimen is two small matrices: K, which the modulus E* multiplies,
and M. The steady response to the driven head solves (E* K - omega^2 M) u = F.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load, save
from asphalt_nscd.measurements.geometry import shape_of
from asphalt_nscd.measurements.shape import Shape

KIND = "reduced specimen"
SHIPPED = "specimen.h5"


@dataclass(frozen=True)
class NumericalSpecimen:
    """A specimen in reduced form: stiffness K (k, k) [m], mass M (k, k) [kg]; coordinate 0 is the driven head."""

    stiffness: NDArray[np.float64]
    mass: NDArray[np.float64]
    geometry: Shape
    name: str

    def apparent_modulus(self, omega: ArrayLike, modulus: ArrayLike) -> NDArray[np.complex128]:
        """E* (n,) [Pa] by Eqs. (1)-(2) of the simulated test, at omega [rad/s] and E* of the bonds [Pa]."""
        omega, modulus = np.asarray(omega, float), np.asarray(modulus, complex)
        dynamic = modulus[:, None, None] * self.stiffness - (omega**2)[:, None, None] * self.mass
        motion = np.linalg.solve(dynamic[:, 1:, 1:], -dynamic[:, 1:, :1])
        force = dynamic[:, 0, 0] + (dynamic[:, :1, 1:] @ motion)[:, 0, 0]
        # As a machine reduces it: Eq. (1) adds the inertia that it counts, whatever the specimen's own motion is.
        return np.asarray(
            self.geometry.form_factor() * (force + self.geometry.mass_factor() * omega**2), complex
        )

    def law_alone(self) -> NumericalSpecimen:
        """One that moves only where Eq. (1) counts it: it shows the law of its bonds and adds nothing."""
        stiffness, mass = 1.0 / self.geometry.form_factor(), self.geometry.mass_factor()
        return replace(self, stiffness=np.array([[stiffness]]), mass=np.array([[mass]]), name="none")

    def ratio(self) -> float:
        """c: static modulus of the specimen over that of its law; one with facets, at full size."""
        return float(self.apparent_modulus([1e-3], [1e9 + 0j])[0].real / 1e9)


def reduce_model(model_file: str | Path, output: str | Path) -> None:
    """Keep of a condensed model (HDF5 file of `condense`) what a diagnosis needs; write it to another HDF5 file."""
    from asphalt_nscd.bending.model import read_model
    from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel

    model = read_model(model_file)
    reduced = ReducedModel(model.system, model.basis)
    arrays = {"stiffness": reduced.stiffness, "mass": reduced.mass}
    save(output, KIND, arrays, {"name": model.name, **model.geometry.attributes()})


def read_specimen(path: str | Path | None = None) -> NumericalSpecimen:
    """Read an HDF5 file of `reduce_model`; None for the specimen shipped with the package."""
    if path is None:
        with as_file(files("asphalt_nscd.diagnosis.simulation") / SHIPPED) as shipped:
            return read_specimen(shipped)
    try:
        record = load(path, KIND)
    except InputError:
        raise InputError(
            f"{path}: not a numerical specimen; give a file made by `reduced-specimen`."
        ) from None
    shape = shape_of(record.attributes)
    return NumericalSpecimen(
        record.arrays["stiffness"], record.arrays["mass"], shape, record.attributes["name"]
    )
