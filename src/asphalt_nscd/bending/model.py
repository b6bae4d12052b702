"""A specimen condensed for tests: the whole model, and the excerpt of it that most tests need."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU

from asphalt_nscd.bending.excerpt import write_excerpt
from asphalt_nscd.bending.layers import Layers
from asphalt_nscd.files.store import Record, load, save
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.break_modes import BONDS, StandBy
from asphalt_nscd.nscd.stepping.harmonic import static_factor
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis, shifted_factor
from asphalt_nscd.specimen.preparation import Content, read_specimen
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen

SHAPE = "shape/"
KRYLOV_STEPS = 12  # two vectors each; leaves residuals of 1e-8 and below in the paper's tests


@dataclass(frozen=True)
class Bonds:
    """What bonds are beside their law, and whether the head rotates.

    head: "free" or "blocked". poisson: nu of Eqs. (8)-(11), for bonds by area "paper"; kt_over_kn: tangential over
    normal stiffness, for "facets". yield_Pa: stress at which a bond breaks. friction: where its gap then closes.

    >>> Bonds(head="blocked", yield_Pa=5e6).kt_over_kn
    1.0
    """

    head: str = "free"
    poisson: float = 0.35
    kt_over_kn: float = 1.0
    yield_Pa: float = 2.7e6
    friction: float = 0.7


@dataclass(frozen=True)
class Model:
    """A specimen ready for tests."""

    system: BondedSystem
    basis: np.ndarray  # (d, k) of the reduced form
    geometry: Geometry
    sphere_height: np.ndarray  # (n,) m
    name: str
    head: str
    stand_by: StandBy | None = None  # directions for breaks
    digest: str = ""  # of its file
    shape: dict[str, np.ndarray] = field(
        default_factory=dict
    )  # spheres and bonds of the specimen, see `_shape`

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
        """Without broken bonds; and directions for breaks."""
        if self.stand_by is None:
            return ReducedModel(self.system, self.basis), None
        reduced = self.stand_by.model(self.system, self.basis, [])
        assert reduced is not None, "without broken bonds there is nothing to miss"
        return reduced, self.stand_by

    @property
    def along(self) -> np.ndarray:
        """Coordinates of velocity to means over the layers (k, l)."""
        return (self.layers.mean @ self.basis).T

    @cached_property
    def static_factor(self) -> SuperLU | Multigrid:
        """For steady oscillation, whatever its frequency."""
        return static_factor(self.system)

    @cached_property
    def layers(self) -> Layers:
        """Over which velocities are averaged."""
        return Layers.of(self.sphere_height, self.geometry.h, self.system.mass.size)


def condense(
    specimen_file: str | Path,
    bonds: Bonds,
    output: str | Path,
    excerpt_output: str | Path | None = None,
    stand_by: int | None = None,
) -> int:
    """Assemble the system of a specimen, find its basis and directions for breaks, and save all; its unknowns.

    excerpt_output: for what most tests need of it. stand_by: see `condensed`.
    """
    arrays, attributes = condensed(read_specimen(specimen_file), Path(specimen_file).stem, bonds, stand_by)
    digest = save(output, "model", arrays, attributes)
    if excerpt_output is not None:
        write_excerpt(excerpt_output, model_of(Record(arrays, attributes, digest)), digest)
    return int(arrays["mass"].size)


def condensed(specimen: Specimen, name: str, bonds: Bonds, stand_by: int | None = None) -> Content:
    """Arrays and attributes of a model file; see `condense`.

    stand_by: so many bonds have directions ready for their break, those the driven motion breaks first. A test that
    breaks others finds theirs itself, for seconds. None: BONDS, but none of facets, which bear stress so evenly that
    they seldom break.
    """
    system = bending_system(
        specimen, bonds.poisson, bonds.yield_Pa, bonds.friction, bonds.head, kt_over_kn=bonds.kt_over_kn
    )
    g, shifted = system.operator, shifted_factor(system)
    basis = ritz_basis(system, KRYLOV_STEPS, shifted)
    arrays = {
        "basis": basis,
        "operator/indptr": g.indptr,
        "operator/indices": g.indices,
        "operator/data": g.data,
        "weight": system.weight,
        "mass": system.mass,
        "load": system.load,
        "gap": system.gap,
        "strength": system.strength,
        "position": system.position,
        "sphere_height": specimen.position[:, 2],
        **{f"{SHAPE}{name}": values for name, values in _shape(specimen).items()},
    }
    if not isinstance(shifted, Multigrid):  # by which they cost more than the few breaks they may save
        most = (0 if specimen.area == "facets" else BONDS) if stand_by is None else stand_by
        ready = StandBy.of(system, basis, shifted, most).arrays()
        arrays |= {f"stand_by/{name}": value for name, value in ready.items()}
    attributes = {
        "name": name,
        "head": bonds.head,
        "driven": system.driven,
        "friction": bonds.friction,
        **{name: getattr(specimen.geometry, name) for name in Geometry.__dataclass_fields__},
    }
    return arrays, attributes


def _shape(specimen: Specimen) -> dict[str, np.ndarray]:
    """position_m (n, 3), radius_m (n,); of bonds: bodies joined (b,) (n: head, n + 1: foot), point_m (b, 3), area."""
    network = specimen.network
    return {
        "position_m": specimen.position,
        "radius_m": specimen.radius,
        "first": network.first,
        "second": network.second,
        "point_m": network.point,
        "area_m2": network.area,
    }


def read_model(path: str | Path) -> Model:
    """The model in a file made by `condense`."""
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
    )
    geometry = Geometry(**{name: attributes[name] for name in Geometry.__dataclass_fields__})
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
    )
