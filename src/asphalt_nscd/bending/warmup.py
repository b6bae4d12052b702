"""Calls every compiled kernel once on a handful of spheres, which fills the compilation cache."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.bending.bending_test import run_test
from asphalt_nscd.bending.case import METHODS, LoadCase, Numerics
from asphalt_nscd.bending.model import Model
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.contacts.friction import solve_contacts
from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis
from asphalt_nscd.specimen.granulate import Granulate, PouringNumerics
from asphalt_nscd.specimen.network import bond_network
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen


def warm_up() -> None:
    """Pour eight spheres, bond a small beam, test it by each method."""
    corners = np.stack(np.meshgrid(*[[0.0, 1.0]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    position, radius = 2.1e-3 * (corners + 0.5), np.full(8, 1e-3)
    granulate = Granulate.in_box(position, radius, (4.2e-3,) * 3, 2600.0, 0.2)
    for _ in range(200):
        granulate.advance(PouringNumerics())
    granulate.velocity[:8, 2] = -2.0  # a rain has kernels of its own
    granulate.advance(PouringNumerics())
    granulate.contacts(1e-6)
    solve_contacts(np.eye(3), [-1.0, 0.5, 0.0], 0.5)
    geometry = Geometry(b=4.2e-3, B=4.2e-3, e=4.2e-3, h=4.2e-3, mass=1e-3, mobile_mass=1e-3)
    network = bond_network(position, radius, geometry.h, 1e-3)
    system = bending_system(Specimen(geometry, position, radius, 2600.0, network, 0), 0.35, 2.7e6, 0.7)
    model = Model(system, ritz_basis(system, 1), geometry, position[:, 2], "beam", "free")
    law = BondLaw(1e10, 1e9, np.array([1e10]), np.array([1e8]))
    for method in METHODS:
        run_test(model, law, LoadCase(40.0, 1e-9, 1.0), Numerics(1e-3, 1, method))
