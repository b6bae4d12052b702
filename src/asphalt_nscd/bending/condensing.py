"""Condensing: a specimen's bonds and spheres into the model and the excerpt that tests need."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from asphalt_nscd.bending.excerpt import write_excerpt
from asphalt_nscd.bending.model import SHAPE, model_of
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, save
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.statics import static_stiffness
from asphalt_nscd.nscd.stepping.break_modes import BONDS, StandBy
from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis, shifted_factor
from asphalt_nscd.specimen.contents import Content
from asphalt_nscd.specimen.cutting import read_specimen
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen

KRYLOV_STEPS = 12  # two vectors each; leaves residuals of 1e-8 and below in the paper's tests


def idle_option_note(bonds: Bonds, area: str) -> str:
    """A sentence on a chosen option of `bonds` that changes nothing in bonds by this `area`; empty if there is none."""
    name, other = ("poisson", "paper") if area == "facets" else ("kt_over_kn", "facets")
    value = getattr(bonds, name)
    if value == getattr(Bonds(), name):
        return ""
    return (
        f"bonds: {name} = {value:g} changes nothing in bonds by area {area!r}; leave it out, or cut the specimen by "
        f"area {other!r}."
    )


def condense(
    specimen_file: str | Path,
    bonds: Bonds,
    output: str | Path,
    excerpt_output: str | Path | None = None,
    stand_by: int | None = None,
) -> tuple[int, float, str]:
    """Condense a specimen to a model file: number of unknowns, static |E*| over the bonds' modulus, kind of area."""
    specimen = read_specimen(specimen_file)
    arrays, attributes = condensed(specimen, Path(specimen_file).stem, bonds, stand_by)
    digest = save(output, "model", arrays, attributes)
    model = model_of(Record(arrays, attributes, digest))
    if excerpt_output is not None:
        write_excerpt(excerpt_output, model, digest)
    # column 0 of the basis is the static motion of the head
    static = specimen.geometry.form_factor() * static_stiffness(model.system, arrays["basis"][:, 0])
    return int(arrays["mass"].size), static, specimen.area


def condensed(specimen: Specimen, name: str, bonds: Bonds, stand_by: int | None = None) -> Content:
    """Arrays and attributes of the model file of a specimen; InputError where its bonds leave some body free.

    `stand_by` bonds have directions ready for their break, those the driven motion breaks first; a test that breaks
    others finds theirs itself, for seconds. None: BONDS, but none of facets, which bear stress so evenly that they
    seldom break.
    """
    system = bending_system(
        specimen, bonds.poisson, bonds.yield_Pa, bonds.friction, bonds.head, kt_over_kn=bonds.kt_over_kn
    )
    g, shifted = system.operator, shifted_factor(system)
    try:
        basis = ritz_basis(system, KRYLOV_STEPS, shifted)
    except ArithmeticError as error:
        raise InputError(f"{name}: {error}; raise gap_max_mm, or take a packing of more spheres.") from None
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
        "place": system.place,
        "sphere_height": specimen.position[:, 2],
        **{f"{SHAPE}{name}": values for name, values in _shape(specimen).items()},
    }
    if not isinstance(shifted, Multigrid):  # multigrid would take longer than the breaks it may save
        # facets bear stress so evenly that they seldom break: a test in which one does finds its directions
        most = (0 if specimen.area == "facets" else BONDS) if stand_by is None else stand_by
        ready = StandBy.of(system, basis, shifted, most).arrays()
        arrays |= {f"stand_by/{name}": value for name, value in ready.items()}
    attributes = {
        "name": name,
        "head": bonds.head,
        "driven": system.driven,
        "friction": bonds.friction,
        "volume_reduction": specimen.volume_reduction,
        **specimen.geometry.attributes(),
    }
    return arrays, attributes


def _shape(specimen: Specimen) -> dict[str, np.ndarray]:
    """position_m (n, 3), radius_m (n,); of bonds: bodies joined (b,) (n and above: plates), point_m (b, 3), area."""
    network = specimen.network
    return {
        "position_m": specimen.position,
        "radius_m": specimen.radius,
        "first": network.first,
        "second": network.second,
        "point_m": network.point,
        "area_m2": network.area,
    }
