"""A specimen condensed for tests (condensing.py): all of it. Most tests need an excerpt alone (excerpt.py)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU

from asphalt_nscd.bending.layers import Layers
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, load
from asphalt_nscd.files.words import counted
from asphalt_nscd.measurements.geometry import shape_of
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.statics import static_factor
from asphalt_nscd.nscd.bonds.system import BondedSystem, clusters
from asphalt_nscd.nscd.stepping.break_modes import StandBy
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel

SHAPE = "shape/"


@dataclass(frozen=True)
class Model:
    """A specimen ready for tests.

    `basis` (d, k) is that of the reduced form; `sphere_height` (n,) over the foot in m; `head` is "free" or "blocked";
    `stand_by` holds directions for breaks; `digest` is that of the file; `shape`: see `condensing._shape`;
    `volume_reduction` is the part of its volume that each sphere lost when it was cut.
    """

    system: BondedSystem
    basis: np.ndarray
    geometry: Shape
    sphere_height: np.ndarray
    name: str
    head: str
    stand_by: StandBy | None = None
    digest: str = ""
    shape: dict[str, np.ndarray] = field(default_factory=dict)
    volume_reduction: float = 0.0

    @property
    def whole(self) -> Model:
        """Itself, as that of a `ModelExcerpt`."""
        return self

    @property
    def spheres(self) -> int:
        """How many."""
        return self.sphere_height.size

    @property
    def bonds(self) -> int:
        """How many, broken ones included."""
        return self.system.gap.size

    @property
    def reduced_form(self) -> tuple[ReducedModel, StandBy | None]:
        """The reduced model without broken bonds; and directions for breaks."""
        if self.stand_by is None:
            return ReducedModel(self.system, self.basis), None
        reduced = self.stand_by.model(self.system, self.basis, [])
        assert reduced is not None, "without broken bonds there is nothing to miss"
        return reduced, self.stand_by

    @property
    def along(self) -> np.ndarray:
        """Coordinates of velocity to means over the layers (k, l)."""
        return (self.layers.mean @ self.basis).T

    def is_whole(self, broken: Sequence[int]) -> bool:
        """Whether a path of the bonds that are left joins all plates."""
        left = np.ones(self.bonds, bool)
        left[broken] = False
        plates = len(self.geometry.plates)
        # plates of different clusters have no path of bonds between them
        plate = clusters(self.shape["first"][left], self.shape["second"][left], self.spheres + plates)[
            -plates:
        ]
        return bool((plate == plate[0]).all())

    def require_whole(self, broken: Sequence[int]) -> None:
        """Refuse a specimen in two pieces."""
        if not self.is_whole(broken):
            raise InputError(
                f"{self.name}: the specimen is in two pieces, {len(broken)} of {counted(self.bonds, 'bond')} broke; "
                "lower the amplitude or raise the strength of the bonds."
            )

    @cached_property
    def static_factor(self) -> SuperLU | Multigrid:
        """Factors of the static stiffness, which steady oscillations of any frequency start from."""
        return static_factor(self.system, self.system.weight)

    @cached_property
    def layers(self) -> Layers:
        """Layers of the specimen, over which velocities are averaged."""
        return Layers.of(self.sphere_height, self.geometry, self.system.mass.size)


def read_model(path: str | Path) -> Model:
    """Read a model made by `condense` from HDF5."""
    return model_of(load(path, "model"))


def model_of(record: Record) -> Model:
    """The model in the content of its file."""
    arrays, attributes = record.arrays, record.attributes
    system = BondedSystem(
        operator=sparse.csr_matrix(
            (arrays["operator/data"], arrays["operator/indices"], arrays["operator/indptr"]),
            shape=(arrays["weight"].size, arrays["mass"].size),
        ),
        weight=arrays["weight"],
        mass=arrays["mass"],
        load=arrays["load"],
        driven=attributes["driven"],
        gap=arrays["gap"],
        strength=arrays["strength"],
        friction=attributes["friction"],
        position=arrays["position"],
        place=arrays.get("place"),
    )
    geometry = shape_of(attributes)
    own, shape = (
        {name.removeprefix(prefix): value for name, value in arrays.items() if name.startswith(prefix)}
        for prefix in ("stand_by/", SHAPE)
    )
    return Model(
        system,
        arrays["basis"],
        geometry,
        arrays["sphere_height"],
        attributes["name"],
        attributes["head"],
        StandBy.from_arrays(own) if own else None,
        record.digest,
        shape,
        attributes.get("volume_reduction", np.nan),  # files of earlier versions do not say it
    )
