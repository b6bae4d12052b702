"""What the level of a specimen would be under other readings of the paper's words on its bonds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from asphalt_nscd.nscd.bonds.implicit_operator import factors
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen


def ratio_without_moments(specimen: Specimen, poisson: float) -> float:
    """Static |E*| over the modulus of the bonds if forces act at the barycentres, so that no body is turned.

    Then a tangential force resists the turning of a whole specimen as it resists shear. `poisson`: Eqs. (8)-(11).
    """
    system = bending_system(specimen, poisson, np.inf, 0.0)
    translations = np.arange(system.mass.size) % 6 < 3
    driven = np.flatnonzero(translations) == system.driven
    operator = system.operator[:, translations]
    stiffness = (operator.T @ sparse.diags_array(system.weight) @ operator).tocsc()
    of_head = stiffness[:, driven].toarray()[:, 0]
    displacement = np.ones(driven.size)
    displacement[~driven] = factors(stiffness[~driven][:, ~driven]).solve(-of_head[~driven])
    # 81 for the paper's first specimen, where it is 1.1 with moments
    return float(specimen.geometry.form_factor() * of_head @ displacement)


def with_mean_radius(specimen: Specimen) -> Specimen:
    """The same bonds with the area pi r^2 of both spheres' mean radius r; that to a plate keeps the sphere's r."""
    network = specimen.network
    ends = np.stack([network.first, network.second])
    radius = np.append(specimen.radius, [np.nan, np.nan])[ends]
    # |E*| of the paper's specimen is then 2.4 times that of its law
    return replace(specimen, network=replace(network, area=np.pi * np.nanmean(radius, axis=0) ** 2))


def farther_plates(specimen: Specimen, distance: float) -> Specimen:
    """The same bonds, those to a plate longer by `distance` [m]: l0 ends behind the plate's surface."""
    network = specimen.network
    plate = np.maximum(network.first, network.second) >= specimen.radius.size
    return replace(
        specimen, network=replace(network, length=np.where(plate, network.length + distance, network.length))
    )


def crossing(specimen: Specimen) -> np.ndarray:
    """Whether the line of each bond between two spheres (c,) passes through a third; plate bonds are left out."""
    n, network = specimen.radius.size, specimen.network
    between = np.maximum(network.first, network.second) < n
    first, second, length = network.first[between], network.second[between], network.length[between]
    start = specimen.position[first]
    direction = (specimen.position[second] - start) / length[:, None]
    # from the middle of a bond: no sphere farther away meets its line
    reach = 0.5 * length + specimen.radius.max()
    near = cKDTree(specimen.position).query_ball_point(start + 0.5 * length[:, None] * direction, reach)
    bond = np.repeat(np.arange(first.size), [len(spheres) for spheres in near])
    third = np.concatenate([np.empty(0, int), *near]).astype(int)
    other = (third != first[bond]) & (third != second[bond])
    bond, third = bond[other], third[other]
    apart = specimen.position[third] - start[bond]
    along = np.einsum("ij,ij->i", apart, direction[bond]).clip(0.0, length[bond])
    distance = np.linalg.norm(apart - along[:, None] * direction[bond], axis=1)
    crossed = np.zeros(first.size, bool)
    crossed[bond[distance < specimen.radius[third]]] = True
    return crossed
