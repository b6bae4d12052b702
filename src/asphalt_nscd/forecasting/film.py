"""Stiffness of a bond that is a film of matrix between two elastic spheres; docs/film.md says how right it is.

The facet of the power diagram is taken as a disc around the line of centres; r is the distance from that line.

**Lines.** On a line at r stand grain, film of thickness h(r), grain, in series under the stress 2 G e. Beyond the
smaller grain the line runs through matrix and one grain, beyond both through matrix alone.

**Pressure.** The film, squeezed, must flow out or be compressed. Its pressure obeys Reynolds' equation

    -(1/r) d/dr(r h^3/(12 G c) dp/dr) + p h / (K - 2 G/3) = h (e_film - e_grain),   p = 0 at the rim of the facet,

c = 1 + c1 (s1^2 + s2^2) + c2 s1 s2 of the slopes s = r/R of both surfaces. With c1 = 19/30 and c2 = -11/15, and no fit,
lines and pressure give the exact solution for rigid spheres up to its second term (Jeffrey & Onishi 1984), for every
ratio of radii lambda = R2/R1, with a = R1 R2 / (R1 + R2):

    k = 6 pi G a^2 / h + 6 pi G R1 lambda (1 + 7 lambda + lambda^2) / (5 (1 + lambda)^3) ln(1/h) + ...

A film that cannot flow has a layer's stiffness K + 4 G / 3. K governs films thinner than sqrt(G/K) of their width.

**Grains that yield.** The mean stress of the facet compresses grains over their whole length, what exceeds it over
about the width of the spot on which it acts, as in Hertz's contact: 3.3 (1 - nu^2) sqrt(r^2 + 3/4 a h). The factors 3.3
(`SPOT`) and 3/4 are fitted to finite elements of two spheres, and nothing else is.

**Shear.** Strain a packing by eps_xz without turning its grains. On a facet whose normal is z, du_x/dz is that of lines
in shear and du_z/dx has the mean eps, since neighbours in x move by l eps: k_t = G int dA/h + G A / l, grains in series
in the first term. Between spheres of different size the film is a wedge; its pressure obeys the equation above with
p / r^2 added for the flow around. Both have the logarithm of spheres that do not turn (Jeffrey & Onishi 1984):

    k_t = 8 pi G a (2 + lambda + 2 lambda^2) / (5 (1 + lambda)^2) ln(1/h) + ...

**The common pressure.** A network of such pairs has the shear modulus of the mix, but not its Poisson's ratio: the
pressure lambda tr(eps), which all films share, is no matter of pairs. `film_stiffness` scales the pairs to the Young's
modulus 9 K G / (3 K + G) of this shear modulus, with K the lower bound of Hashin & Shtrikman; so one material gives
the bond of docs/mapping.md, k = E A / l for normal and shear.

Sources: rigid spheres: Jeffrey & Onishi, J. Fluid Mech. 139 (1984) 261; Kim & Karrila, Microhydrodynamics (1991),
ch. 11; Brenner, Chem. Eng. Sci. 16 (1961) 242. A flat film, E (1 + 2 S^2): Gent & Lindley, Proc. Inst. Mech. Eng. 173
(1959) 111. Grains that limit a thin film: Leroy & Charlaix, J. Fluid Mech. 674 (2011) 389. Bounds: Hashin & Shtrikman,
J. Mech. Phys. Solids 11 (1963) 127.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.nscd.compiled import compiled

RINGS = (
    24  # of a facet: 1 % of the stiffness at a gap of a thousandth of the radius, a tenth of that at a tenth
)
SPOT = 3.3  # depth of grain under a spot over sqrt(r^2 + 3/4 a h) and 1 - nu^2, by finite elements


@dataclass(frozen=True)
class Solid:
    """An isotropic elastic solid: Young's modulus E [Pa] and Poisson's ratio."""

    modulus: float
    poisson: float

    @property
    def shear(self) -> float:
        """G [Pa]."""
        return self.modulus / (2.0 * (1.0 + self.poisson))

    @property
    def bulk(self) -> float:
        """K [Pa]."""
        return self.modulus / (3.0 * (1.0 - 2.0 * self.poisson))


@dataclass(frozen=True)
class Films:
    """Two spheres, the gap between them and the facet between their cells; one row each.

    Radii (b,) and positive `gap` (b,) in m, `area` (b,) of the facet in m2; `second_radius` is 0 for a rigid plane.
    """

    first_radius: np.ndarray
    second_radius: np.ndarray
    gap: np.ndarray
    area: np.ndarray

    def __post_init__(self) -> None:
        if not (np.asarray(self.gap) > 0.0).all():
            raise ValueError("a film needs a gap above zero: grains that touch or overlap have none")

    @property
    def length(self) -> np.ndarray:
        """Between the centres (b,) [m]."""
        return self.first_radius + self.second_radius + self.gap


@dataclass(frozen=True)
class Matrix:
    """What is between the grains: E (...), real or complex, as many as are asked for, and K (...) [Pa]."""

    modulus: np.ndarray
    bulk: np.ndarray | float

    @property
    def shear(self) -> np.ndarray:
        """G (...) [Pa]."""
        bulk, young = np.asarray(self.bulk), np.asarray(self.modulus)
        return 3.0 * bulk * young / (9.0 * bulk - young)


def film_stiffness(
    films: Films, grain: Solid, matrix: Matrix, solid_fraction: float
) -> tuple[np.ndarray, np.ndarray]:
    """Normal and tangential stiffness (..., b) [N/m] of the bonds of a network that has the mix's Young's modulus.

    The tangential opening is that of the surfaces, rotations of the spheres included. `solid_fraction` is the volume of
    grains in a volume of grains and matrix.
    """
    normal, tangential = deviatoric_stiffness(films, grain, matrix)
    scale = _young(films, bulk_modulus(grain, matrix, solid_fraction), normal, tangential)[..., None]
    return normal * scale, tangential * scale


def bulk_modulus(grain: Solid, matrix: Matrix, solid_fraction: float) -> np.ndarray:
    """K (...) [Pa] of the mix: the lower bound of Hashin & Shtrikman (1963), where bitumen flows the value itself.

    `solid_fraction` is the volume of grains in a volume of grains and matrix.
    """
    bulk, stiffer = np.asarray(matrix.bulk), grain.bulk - np.asarray(matrix.bulk)
    share = 3.0 * (1.0 - solid_fraction) / (3.0 * bulk + 4.0 * matrix.shear)
    return bulk + solid_fraction * stiffer / (1.0 + stiffer * share)


def deviatoric_stiffness(
    films: Films, grain: Solid, matrix: Matrix, rings: int = RINGS
) -> tuple[np.ndarray, np.ndarray]:
    """As `film_stiffness`, of a network that has the mix's shear modulus; one material: k = 2 G A / l.

    `rings` is into how many rings a facet is divided.
    """
    return pair_stiffness(films, grain, matrix, (2.0 * matrix.shear, 2.0 * grain.shear), rings)


def pair_stiffness(
    films: Films, grain: Solid, matrix: Matrix, along: tuple[np.ndarray, float], rings: int = RINGS
) -> tuple[np.ndarray, np.ndarray]:
    """Normal and tangential stiffness (..., b) [N/m] of pairs by lines, pressure, yielding grains and shear.

    The head of this module says how. `along` holds the moduli D of film (...) and grain along a line [Pa], 2 G where
    the volume is kept; `rings` is into how many rings a facet is divided.
    """
    shear, bulk, stretch = np.broadcast_arrays(matrix.shear, matrix.bulk, along[0])
    kind = np.result_type(shear, bulk, stretch, np.float64)
    given = np.array([value.ravel() for value in (shear, bulk, stretch)], kind)
    rows = np.array(np.broadcast_arrays(*np.atleast_1d(*vars(films).values())), float)
    found = np.empty((2, given.shape[1], rows.shape[1]), kind)
    # lines and pressure together have the logarithm of Jeffrey & Onishi for any ratio of radii
    share = float(np.real(given[2, 0] / given[0, 0]))
    one = (19.2 - 2.0 * share) / 24.0
    slopes = np.array([one, (9.6 - 6.0 * share) / 24.0 - one])
    spot = SPOT * (1.0 - grain.poisson**2) * along[1] / grain.modulus
    _pairs(rows, given, slopes, along[1], grain.shear, spot, rings, found)
    normal, tangential = found.reshape((2, *shear.shape, -1))
    return normal, tangential


def _young(films: Films, bulk: np.ndarray, normal: np.ndarray, tangential: np.ndarray) -> np.ndarray:
    """Factor (...) that gives pairs the Young's modulus of their shear modulus and the mix's bulk modulus (...).

    Pairs in all directions, of mean stiffnesses s A / l and t A / l, have the shear modulus (2 s + 3 t) / 10 and
    Young's modulus s (2 s + 3 t) / (4 s + t).
    """
    volume = (films.area * films.length).sum()
    s, t = (stiffness @ films.length**2 / volume for stiffness in (normal, tangential))
    shear = (2.0 * s + 3.0 * t) / 10.0
    return 9.0 * bulk * shear / (3.0 * bulk + shear) * (4.0 * s + t) / (s * (2.0 * s + 3.0 * t))


@compiled
def _pairs(rows, given, slopes, grain, grain_shear, spot, n, found):
    first, second, gap, area = rows
    shear, bulk, stretch = given
    width, film, stone, near = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    flow = np.empty(n)  # 4 rho h^3 / (12 c d rho) across the outer edge of a ring, rho = r^2
    round_flow, tilt = np.empty(n), np.empty(n)  # h^3 / (12 c rho) around; half the difference of the slopes
    upper, of_one, of_mean = np.empty(n, shear.dtype), np.empty(n, shear.dtype), np.empty(n, shear.dtype)
    for b in range(gap.size):
        r1, r2 = first[b], second[b]
        q1, q2 = r1 * r1, r2 * r2
        length = r1 + r2 + gap[b]
        start = 2.0 * gap[b] * (r1 * r2 / (r1 + r2) if r2 > 0.0 else r1)
        section = area[b] / np.pi
        # rings grow with the gap there: most of the force is where the grains are nearest
        span = np.log1p(section / start) / n
        inner = 0.0
        for i in range(n):
            outer = start * np.expm1(span * (i + 1.0))
            width[i] = (outer - inner) / section
            inner = outer
            middle = start * np.expm1(span * (i + 0.5))
            t1, t2 = np.sqrt(max(q1 - middle, 0.0)), np.sqrt(max(q2 - middle, 0.0))
            stone[i], film[i] = t1 + t2, length - t1 - t2
            depth = spot * np.sqrt(middle + 0.375 * start)
            near[i] = min(t1, depth) + min(t2, depth)
            further = start * np.expm1(span * (i + 1.5)) if i < n - 1 else outer
            edge = length - np.sqrt(max(q1 - outer, 0.0)) - np.sqrt(max(q2 - outer, 0.0))
            s1, s2 = min(outer / q1, 1.0), (min(outer / q2, 1.0) if r2 > 0.0 else 0.0)
            turned = 1.0 + slopes[0] * (s1 + s2) + slopes[1] * np.sqrt(s1 * s2)
            flow[i] = outer * edge**3 / (3.0 * turned * (further - middle) * section)
            round_flow[i] = film[i] ** 3 / (12.0 * turned * middle)
            between = t1 > 0.0 and (t2 > 0.0 or r2 == 0.0)
            tilt[i] = 0.5 * np.sqrt(middle) * ((1.0 / r2 if r2 > 0.0 else 0.0) - 1.0 / r1) if between else 0.0
        for m in range(shear.size):
            g, d = shear[m], stretch[m]
            lame = bulk[m] - 2.0 / 3.0 * g
            # film strain e = own - shed p - back s of the line's pressure p and the facet's mean stress s
            before = 0.0 * g
            sheared, shear_back = 0.0 * g, 0.0 * g
            # Matrix flows between neighbouring rings alone: a tridiagonal system, eliminated outwards, solved inwards.
            for i in range(n):
                own = 1.0 / (film[i] + d * near[i] / grain)
                shed = near[i] / grain * own
                back = (stone[i] - near[i]) / grain * own
                # source e - (1 - e h) / stone, where there is a grain on the line
                inverse = 1.0 / stone[i] if stone[i] > 0.0 else 0.0
                gain = 1.0 + film[i] * inverse
                through = flow[i] / g
                pivot = film[i] * (gain * shed + 1.0 / lame) * width[i] + before + through
                of_one[i] = film[i] * (gain * own - inverse) * width[i]
                of_mean[i] = -film[i] * gain * back * width[i]
                if i > 0:
                    pivot -= before * upper[i - 1]
                    of_one[i] += before * of_one[i - 1]
                    of_mean[i] += before * of_mean[i - 1]
                inverted = 1.0 / pivot
                upper[i] = through * inverted
                of_one[i] *= inverted
                of_mean[i] *= inverted
                before = through
                slide = width[i] / (film[i] / g + near[i] / grain_shear)
                sheared += slide
                shear_back += slide * (stone[i] - near[i]) / grain_shear
            one, mean = 0.0 * g, 0.0 * g
            force, relief = 0.0 * g, 0.0 * g
            for i in range(n - 1, -1, -1):
                one = of_one[i] + upper[i] * one
                mean = of_mean[i] + upper[i] * mean
                own = 1.0 / (film[i] + d * near[i] / grain)
                rest = 1.0 - d * near[i] / grain * own
                force += (d * own + rest * one) * width[i]
                relief += (d * (stone[i] - near[i]) / grain * own - rest * mean) * width[i]
            found[0, m, b] = area[b] * force / (1.0 + relief)
            # slid along, the film between unequal slopes is a wedge: its pressure goes with the cosine about the axis
            slid = sheared / (1.0 + shear_back)
            before, wedge = 0.0 * g, 0.0 * g
            for i in range(n):
                own = (1.0 - (stone[i] - near[i]) / grain_shear * slid) / (
                    film[i] + g * near[i] / grain_shear
                )
                inverse = 1.0 / stone[i] if stone[i] > 0.0 else 0.0
                of_mean[i] = tilt[i] * film[i] * (own * (1.0 + film[i] * inverse) - inverse)
                shed = near[i] / grain / (film[i] + d * near[i] / grain)
                held = film[i] * ((1.0 + film[i] * inverse) * shed + 1.0 / lame) + round_flow[i] / g
                through = flow[i] / g
                pivot = held * width[i] + before + through
                of_one[i] = of_mean[i] * width[i]
                if i > 0:
                    pivot -= before * upper[i - 1]
                    of_one[i] += before * of_one[i - 1]
                upper[i] = through / pivot
                of_one[i] /= pivot
                before = through
            one = 0.0 * g
            for i in range(n - 1, -1, -1):
                one = of_one[i] + upper[i] * one
                wedge += one * of_mean[i] * width[i]
            found[1, m, b] = area[b] * (slid + 0.5 * wedge + g / length)
