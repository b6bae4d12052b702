"""Stiffness of a bond that is a film of matrix between two elastic spheres (docs/film.md).

The facet of the power diagram is taken as a disc around the line of centres. On a line at distance r from it stand
grain, film of thickness h(r), grain. The deviatoric stress 2 G e runs through them in series. The film, squeezed, must
flow out between the grains or be compressed: its pressure obeys Reynolds' equation

    -(1/r) d/dr(r h^3/(12 G) dp/dr) + p h / K = h (e_film - e_grain),    p = 0 at the rim of the facet.

Forces in the convention of docs/mapping.md (one material: k = E A / l for normal and shear, Poisson's ratio zero): the
pressure that all films share is no matter of pairs, and enters by the ratio of Young's modulus to that of
the pairs (`_young`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.nscd.compiled import compiled

RINGS = 24  # of a facet; 96 change the stiffness by less than 0.2 %


@dataclass(frozen=True)
class Solid:
    """An isotropic elastic solid."""

    modulus: float  # E, Pa
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
    """Two spheres, the gap between them and the facet between their cells; one row each."""

    first_radius: np.ndarray  # (b,) m
    second_radius: np.ndarray  # (b,) m; 0 for a rigid plane
    gap: np.ndarray  # (b,) m, positive
    area: np.ndarray  # (b,) m2

    def __post_init__(self) -> None:
        if not (np.asarray(self.gap) > 0.0).all():
            raise ValueError("a film needs a gap above zero: grains that touch or overlap have none")


def film_stiffness(
    films: Films, grain: Solid, matrix_modulus: np.ndarray, matrix_bulk_modulus: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """Normal and tangential stiffness (..., b) [N/m] for Young's modulus (...) [Pa] of the matrix, real or complex.

    matrix_bulk_modulus [Pa]: one number, or one for each modulus. The tangential opening is that of the surfaces,
    rotations of the spheres included.
    """
    young = np.asarray(matrix_modulus)
    bulk = np.broadcast_to(matrix_bulk_modulus, young.shape)
    kind = np.result_type(young, bulk, np.float64)
    shear = (3.0 * bulk * young / (9.0 * bulk - young)).astype(kind)
    rows = [np.ascontiguousarray(value, float) for value in vars(films).values()]
    rows = [np.ascontiguousarray(row) for row in np.broadcast_arrays(*np.atleast_1d(*rows))]
    found = np.empty((2, shear.size, rows[0].size), kind)
    _pairs(*rows, grain.shear, shear.ravel(), np.ascontiguousarray(bulk.ravel().astype(kind)), found)
    normal, tangential = found.reshape((2, *young.shape, -1))
    return _young(films, grain, bulk, normal, tangential)


def _young(
    films: Films, grain: Solid, bulk: np.ndarray, normal: np.ndarray, tangential: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffnesses scaled so that pairs, which know no common pressure, have Young's modulus of the composite.

    Pairs of normal stiffness s A / l and tangential t A / l in all directions have the shear modulus (2 s + 3 t) / 10
    and Young's modulus s (2 s + 3 t) / (4 s + t); bulk moduli of grain and film act in series.
    """
    length = films.first_radius + films.second_radius + films.gap
    s, t = normal * length / films.area, tangential * length / films.area
    film = films.gap / length
    whole = 1.0 / (film / bulk[..., None] + (1.0 - film) / grain.bulk)
    shear = (2.0 * s + 3.0 * t) / 10.0
    scale = 9.0 * whole * shear / (3.0 * whole + shear) * (4.0 * s + t) / (s * (2.0 * s + 3.0 * t))
    return normal * scale, tangential * scale


@compiled
def _pairs(first, second, gap, area, grain, shear, bulk, found):
    n = RINGS
    width, film, stone = np.empty(n), np.empty(n), np.empty(n)
    flow = np.empty(n)  # 4 rho h^3 / (12 d rho) across the outer edge of a ring, rho = r^2
    upper = np.empty(n, shear.dtype)
    right = np.empty(n, shear.dtype)
    for b in range(gap.size):
        r1, r2 = first[b], second[b]
        length = r1 + r2 + gap[b]
        curved = r1 * r2 / (r1 + r2) if r2 > 0.0 else r1
        start = 2.0 * curved * gap[b]
        span = np.log1p(area[b] / np.pi / start) / n
        inner = 0.0
        for i in range(n):
            outer = start * np.expm1(span * (i + 1.0))
            width[i] = outer - inner
            inner = outer
            middle = start * np.expm1(span * (i + 0.5))
            stone[i] = np.sqrt(max(r1 * r1 - middle, 0.0)) + np.sqrt(max(r2 * r2 - middle, 0.0))
            film[i] = length - stone[i]
            next_one = start * np.expm1(span * (i + 1.5)) if i < n - 1 else outer
            at_edge = length - np.sqrt(max(r1 * r1 - outer, 0.0)) - np.sqrt(max(r2 * r2 - outer, 0.0))
            flow[i] = outer * at_edge**3 / (3.0 * (next_one - middle))
        for m in range(shear.size):
            g, k = shear[m], bulk[m]
            normal, tangential = 0.0 * g, 0.0 * g
            before = 0.0
            for i in range(n):
                # film strain = alpha - beta p; stress 2 g strain + p = 2 grain (strain of the grain)
                alpha = 1.0 / (film[i] + stone[i] * g / grain)
                beta = 0.5 * alpha * stone[i] / grain
                source = film[i] * alpha * (1.0 - g / grain) * width[i]
                yielding = film[i] * (beta + 0.5 * (1.0 - 2.0 * g * beta) / grain + 1.0 / k) * width[i]
                pivot = yielding + (before + flow[i]) / g
                right[i] = source
                if i > 0:
                    pivot -= before / g * upper[i - 1]
                    right[i] += before / g * right[i - 1]
                upper[i] = flow[i] / g / pivot
                right[i] /= pivot
                before = flow[i]
                normal += 2.0 * g * alpha * width[i]
                tangential += 2.0 * g * alpha * width[i]
            pressure = 0.0 * g
            for i in range(n - 1, -1, -1):
                pressure = right[i] + upper[i] * pressure
                beta = 0.5 * stone[i] / grain / (film[i] + stone[i] * g / grain)
                normal += (1.0 - 2.0 * g * beta) * pressure * width[i]
            found[0, m, b] = np.pi * normal
            found[1, m, b] = np.pi * tangential
