"""Calls the compiled kernels of a study once on a handful of spheres, which fills the compilation cache.

Contacts between bodies, which a study needs only where the gap of a broken bond closes, are compiled when one does.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from asphalt_nscd.measurements.twopoint import Geometry

_CORNERS = np.stack(np.meshgrid(*[[0.0, 1.0]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
_POSITION, _RADIUS = 2.1e-3 * (_CORNERS + 0.5), np.full(8, 1e-3)  # m
_GEOMETRY = Geometry(b=4.2e-3, B=4.2e-3, e=4.2e-3, h=4.2e-3, mass=1e-3, mobile_mass=1e-3)


def pour() -> None:
    """Pour eight spheres and look for those that are to be bonded."""
    from asphalt_nscd.nscd.spheres.laws import ContactLaw
    from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
    from asphalt_nscd.specimen.network import bond_network

    bed = GranularBed.spheres_in_box(_POSITION, _RADIUS, (4.2e-3,) * 3, 2600.0, ContactLaw(0.2, 0.2))
    for _ in range(200):
        bed.advance(PouringNumerics())
    bed.velocity[:8, 2] = -2.0  # a rain has kernels of its own
    bed.advance(PouringNumerics())
    bed.contacts(1e-6)
    bond_network(_POSITION, _RADIUS, _GEOMETRY.h, 1e-3)


def bend() -> None:
    """Bond eight spheres to a beam and test it by each method."""
    from asphalt_nscd.bending.bending_test import run_test
    from asphalt_nscd.bending.case import LoadCase
    from asphalt_nscd.bending.model import Model
    from asphalt_nscd.bending.settings import METHODS, Numerics
    from asphalt_nscd.nscd.bonds.law import BondLaw
    from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis
    from asphalt_nscd.specimen.network import facet_network
    from asphalt_nscd.specimen.system import bending_system
    from asphalt_nscd.specimen.trimming import Specimen

    position = _POSITION - [2.1e-3, 2.1e-3, 0.0]  # a specimen stands about its axis
    network = facet_network(position, _RADIUS, _GEOMETRY)
    law = BondLaw(1e10, 1e9, np.array([1e10]), np.array([1e8]))
    specimen = Specimen(_GEOMETRY, position, _RADIUS, 2600.0, network, 0)
    system = bending_system(specimen, 0.35, 2.7e6, 0.7)
    model = Model(system, ritz_basis(system, 1), _GEOMETRY, position[:, 2], "beam", "free")
    for method in METHODS:
        run_test(model, law, LoadCase(40.0, 1e-9, 1.0), Numerics(1e-3, 1, method))


STEPS: dict[str, Callable[[], None]] = {"deposit": pour, "simulate": bend}
"""Which of these calls the kernels of a step of the command line, and of those that follow on it."""
