"""Bonds that are films between spheres, against lubrication theory, finite elements and the bounds of elasticity."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.forecasting.film import (
    Films,
    Matrix,
    Solid,
    bulk_modulus,
    deviatoric_stiffness,
    film_stiffness,
    pair_stiffness,
)
from asphalt_nscd.specimen.prism import pull
from asphalt_nscd.specimen.trimming import Specimen
from theory.specimens import jittered_beam

STONE = Solid(60e9, 0.2)
RIGID = Solid(60e18, 0.2)
SYRUP = Matrix(np.array(3.0), 1e20)  # G = 1 Pa, incompressible
FINE = 4000  # rings where logarithms are read off

# Approach of two spheres in a cylinder of free sides over M A / l, side 0.9 of the smaller radius, K = 2.5 GPa:
# ratio of radii, gap over the smaller radius, M [Pa], finite elements (benchmarks/film_law.py pairs)
ELEMENTS = [
    (1.0, 0.3, 6e8, 4.324),
    (1.0, 0.1, 6e5, 13.54),
    (1.0, 0.03, 6e6, 41.66),
    (0.3, 0.1, 6e8, 23.02),
    (0.3, 0.01, 6e6, 493.2),
    (0.1, 0.003, 6e5, 6107.0),
]

# Sliding: ratio of radii, gap over the smaller radius, M [Pa], side over the smaller radius (none for the cell of a
# cubic lattice), finite elements over one material (benchmarks/film_law.py shears), tolerance
SLIDING = [
    (1.0, 0.003, 6e3, 0.9, 13.55, 0.05),
    (0.3, 0.01, 6e3, 0.9, 35.69, 0.05),
    (0.1, 0.03, 6e3, 0.9, 79.86, 0.05),
    (1.0, 0.1, 6e8, None, 2.671, 0.2),
    (1.0, 0.03, 6e8, None, 3.505, 0.2),
]


def bitumen(modulus: float) -> Matrix:
    """A nearly incompressible matrix of Young's `modulus` [Pa]; its bulk modulus is 2.5 GPa."""
    return Matrix(np.array(modulus), 2.5e9)


def pair(gap: float, ratio: float = 1.0, side: float = 0.9) -> Films:
    """One film between two spheres, of which the larger one has the radius 1.

    `ratio` is the smaller radius over the larger; `gap` and the facet's radius `side`, a disc, are over the smaller.
    """
    return Films(*np.array([[1.0], [ratio], [gap * ratio], [np.pi * (side * ratio) ** 2]]))


def test_one_material(row):
    """Matrix and grains alike: the bond of the homogeneous network, whatever the gap."""
    same = Matrix(np.array(STONE.modulus), STONE.bulk)
    for gap in (0.003, 0.3):
        films = pair(gap, 0.4)
        homogeneous = STONE.modulus * films.area[0] / films.length[0]
        for name, found in zip(
            ("normal", "tangential"), film_stiffness(films, STONE, same, 0.5), strict=True
        ):
            name = f"one material, {name} stiffness over E A / l, gap {gap}"
            row(name, 1.0, found[0] / homogeneous, 1e-12, "docs/mapping.md")


def test_lubrication(row):
    """Rigid spheres in an incompressible film: Jeffrey & Onishi (1984), whose logarithms hold for any radii."""
    source = "Jeffrey & Onishi 1984"
    for ratio in (1.0, 0.2):
        a, gaps = ratio / (1.0 + ratio), np.array([2e-4, 8e-4]) * ratio
        found = [deviatoric_stiffness(pair(h / ratio, ratio), RIGID, SYRUP, FINE) for h in gaps]
        normal, tangential = (np.array([stiffness[k][0] for stiffness in found]) for k in (0, 1))
        leading = 6.0 * np.pi * a**2 / gaps
        name = f"ratio of radii {ratio}, squeezed film"
        row(f"{name}, over 6 pi mu a^2 / h", 1.0, normal[0] / leading[0], 3e-3, source)
        # the difference of two gaps, four times apart, has no constant: the factor of the logarithm is left
        second = (normal - leading) @ [1.0, -1.0] / np.log(4.0)
        expected = 6.0 * np.pi * ratio * (1.0 + 7.0 * ratio + ratio**2) / (5.0 * (1.0 + ratio) ** 3)
        row(f"{name}, factor of ln(1/h)", expected, second, 0.1, source)
        slide = (tangential @ [1.0, -1.0]) / np.log(4.0)
        expected = 1.6 * np.pi * ratio * (2.0 + ratio + 2.0 * ratio**2) / (1.0 + ratio) ** 3
        name = f"ratio of radii {ratio}, sheared film, factor of ln(1/h)"
        row(name, expected, slide, 0.01, source)
    plane = deviatoric_stiffness(pair(2e-4, 1.0), RIGID, SYRUP, FINE)[0][0]
    wall = Films(*np.array([[1.0], [0.0], [2e-4], [np.pi * 0.81]]))  # a radius of 0 is a plane
    found = deviatoric_stiffness(wall, RIGID, SYRUP, FINE)[0][0] / plane
    row("sphere and plane over two spheres", 4.0, found, 0.01, "Brenner 1961: 6 pi mu R^2 / h")


def test_finite_elements(row):
    """Elastic grains, compressible bitumen: two spheres in a cylinder with free sides."""
    for ratio, gap, modulus, expected in ELEMENTS:
        films, solid = pair(gap, ratio), bitumen(modulus)
        along = modulus * (1.0 - 0.2 * (1.0 - float(solid.shear) / STONE.shear))
        found = pair_stiffness(films, STONE, solid, (np.array(along), STONE.modulus))[0][0]
        unit = modulus * films.area[0] / films.length[0]
        name = f"approach over M A / l, ratio {ratio}, gap {gap}, M {modulus / 1e6:g} MPa"
        row(name, expected, found / unit, 0.07, "finite elements")


def test_sliding(row):
    """Spheres that do not turn: rigid pairs between free sides, and a cubic lattice of equal, elastic ones.

    The law is known to be too soft in the lattice (docs/film.md); the tolerance is by how much.
    """
    for ratio, gap, modulus, side, expected, tolerance in SLIDING:
        length = 1.0 + ratio + gap * ratio
        films, solid = pair(gap, ratio, side or length / np.sqrt(np.pi)), bitumen(modulus)
        one_material = solid.shear * films.area[0] / length
        found = deviatoric_stiffness(films, STONE, solid)[1][0] / one_material - (1.0 if side else 0.0)
        test = "free sides" if side else "lattice"
        name = f"sliding over {'G' if side else '2 G'} A / l, {test}, ratio {ratio}, gap {gap}"
        row(name, expected, found / (1.0 if side else 2.0), tolerance, "finite elements")


def test_network(row):
    """A pulled prism of spheres between the bounds of Hashin & Shtrikman; few grains: Einstein and Smallwood."""
    for fill, modulus in ((0.45, 6e5), (0.45, 6e8), (0.3, 6e6)):
        prism = jittered_beam(seed=4, shape=(5, 4, 12), fill=fill, area="facets")
        fraction, solid = solid_fraction(prism), bitumen(modulus)
        found, low, high = young(prism, solid), *bounds(solid, fraction)
        place = np.log(found / low) / np.log(high / low)
        name = f"{fraction:.2f} of grains, M {modulus / 1e6:g} MPa, place of ln E between its bounds"
        row(name, 0.25, place, 0.25, "Hashin & Shtrikman 1963", 1.0)
    prism = jittered_beam(seed=4, shape=(5, 4, 12), fill=0.2, area="facets")
    fraction = solid_fraction(prism)
    found, source = young(prism, bitumen(6e5)) / 6e5, "Einstein 1906, Smallwood 1944"
    row(f"{fraction:.3f} of grains, E over M", 1 + 2.5 * fraction, found, 0.12, source)


def solid_fraction(prism: Specimen) -> float:
    """Volume of the spheres, which must not overlap, over that of the prism."""
    of = prism.geometry
    return float(4.0 / 3.0 * np.pi * (prism.radius**3).sum() / (of.width * of.thickness * of.h))


def young(prism: Specimen, solid: Matrix) -> float:
    """Young's modulus [Pa] of a network of films of `solid`, pulled between the plates of the prism."""
    bonds, n = prism.network, prism.radius.size
    radius = np.append(prism.radius, [0.0, 0.0])  # plates are planes
    films = Films(radius[bonds.first], radius[bonds.second], bonds.gap, bonds.area)
    assert (bonds.second < n + 2).all()
    stiffness = film_stiffness(films, STONE, solid, solid_fraction(prism))
    share = np.column_stack([stiffness[0], stiffness[1], stiffness[1]]) / bonds.form[:, None]
    return pull(prism, share)[0]


def bounds(solid: Matrix, fraction: float) -> tuple[float, float]:
    """Lower and upper bound [Pa] of Young's modulus of stone in a matrix by Hashin & Shtrikman.

    `solid`, the matrix, is the softer of the two; `fraction` is that of the stone.
    """
    soft, hard = (float(solid.bulk), float(solid.shear)), (STONE.bulk, STONE.shear)
    found = []
    for (k, g), (bulk, shear), share in ((soft, hard, fraction), (hard, soft, 1.0 - fraction)):
        rest = 1.0 - share
        k_whole = k + share / (1.0 / (bulk - k) + 3.0 * rest / (3.0 * k + 4.0 * g))
        g_whole = g + share / (1.0 / (shear - g) + 1.2 * rest * (k + 2.0 * g) / (g * (3.0 * k + 4.0 * g)))
        found.append(9.0 * k_whole * g_whole / (3.0 * k_whole + g_whole))
    return found[0], found[1]


def test_bulk(row):
    """An incompressible matrix under bitumen's compliance: volumes add up."""
    found = float(bulk_modulus(STONE, bitumen(6e3), 0.4))
    row("bulk modulus, soft matrix (Pa)", 1 / (0.4 / STONE.bulk + 0.6 / 2.5e9), found, 1e-4, "Reuss")
