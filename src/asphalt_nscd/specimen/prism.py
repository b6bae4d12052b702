"""A prism cut out of a layer and pulled between its end plates: modulus and Poisson's ratio of a network."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.statics import static_motion, static_stiffness
from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.specimen.network import Network
from asphalt_nscd.specimen.trimming import Specimen, held

MEASURED = 1.0 / 3.0  # of the length, in the middle: where strain is measured


def cut_prism(
    position: np.ndarray,
    radius: np.ndarray,
    corner: np.ndarray,
    geometry: Geometry,
    bond: Callable[[np.ndarray, np.ndarray], Network],
) -> Specimen:
    """Cut the spheres whose centres lie in a prism b x e x h; its length h along x of the layer, b along z.

    `position` (n, 3) and `radius` (n,) are of the layer, `corner` (3,) has the least x, y, z of the prism, in m.
    Spheres that hang on no chain of bonds between the ends are left out. Density 1 kg/m3: for statics.
    """
    size = np.array([geometry.h, geometry.e, geometry.b])
    local = position - corner
    inside = ((local > 0.0) & (local < size)).all(axis=1)
    upright = np.stack([local[:, 2] - geometry.b / 2, local[:, 1] - geometry.e / 2, local[:, 0]], axis=1)[
        inside
    ]
    radius = radius[inside]
    while True:
        network = bond(upright, radius)
        kept, _ = held(network, radius.size)
        if kept.all():
            return Specimen(geometry, upright, radius, 1.0, network, int(inside.sum()) - radius.size)
        upright, radius = upright[kept], radius[kept]


def pull(prism: Specimen, share: np.ndarray) -> tuple[float, float]:
    """E over the modulus of the bonds, and Poisson's ratio, of a prism whose ends are pulled apart; see `stretched`.

    `share` (3,) is the normal and two tangential stiffnesses of a bond over A / l.
    """
    system = pulled_system(prism, (prism.network.form[:, None] * share).ravel())
    return stretched(prism, system, static_motion(system))


def pulled_system(prism: Specimen, weight: np.ndarray) -> BondedSystem:
    """A prism between a fixed plate and one moved along z, for statics; `weight` (3 b,) of its bonds [m]."""
    n, network = prism.radius.size, prism.network
    position = np.concatenate([prism.position, [[0.0, 0.0, prism.geometry.h]]])
    operator = opening_operator(network.first, network.second, network.frame, network.point, position)
    kept = np.append(np.arange(6 * n), 6 * n + 2)  # the head moves along z alone
    ones = np.ones(6 * n + 1)
    return BondedSystem(
        operator=operator[:, kept],
        weight=weight,
        mass=1e-9 * ones,  # which statics do not use
        load=0.0 * ones,
        driven=6 * n,
        gap=np.maximum(network.gap, 0.0),  # which statics do not use
        strength=np.full(network.first.size, np.inf),
        friction=0.0,
        position=position,
    )


def stretched(prism: Specimen, system: BondedSystem, motion: np.ndarray) -> tuple[float, float]:
    """E over the modulus to which the weights refer, and Poisson's ratio, of a prism pulled.

    `motion` (d,) are displacements of its `pulled_system` where the plates part by one. The plates neither turn nor
    contract. Strains are slopes of a line through the displacements of the spheres in the middle third of the length;
    Poisson's ratio is the mean of both lateral ones. The stress is the force over the nominal section b e.
    """
    n, geometry = prism.radius.size, prism.geometry
    middle = np.abs(prism.position[:, 2] - geometry.h / 2) < MEASURED * geometry.h / 2
    along = motion[: 6 * n].reshape(n, 6)[middle, :3]
    strain = [np.polyfit(prism.position[middle, k], along[:, k], 1)[0] for k in range(3)]
    stress = static_stiffness(system, motion) / (geometry.width * geometry.thickness)
    return stress / strain[2], -(strain[0] + strain[1]) / (2.0 * strain[2])


def static_ratio(system: BondedSystem, shape: Shape) -> float:
    """c: static |E*| of a test by its form factor, over the modulus of the bonds."""
    return shape.form_factor() * static_stiffness(system, static_motion(system))
