"""Periodic packings of spheres in the unit cell, and the bond network of their power diagram."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.optimize import minimize
from scipy.sparse.linalg import splu

from asphalt_nscd.forecasting.film import Films
from asphalt_nscd.specimen.power_diagram import Region, power_diagram


def jammed(count: int, widest: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 3) and radii (n,) of spheres that just touch; radii spread evenly in log from 1 to `widest`.

    The spheres repel each other where they overlap; they grow by bisection as far as they can without.
    """
    rng = np.random.default_rng(seed)
    size = widest ** (np.arange(count) / (count - 1.0))
    unit = (4.0 / 3.0 * np.pi * (size**3).sum()) ** (-1.0 / 3.0)
    position = rng.random((count, 3))
    i, j = np.triu_indices(count, 1)

    def energy(flat: np.ndarray, radius: np.ndarray) -> tuple[float, np.ndarray]:
        x = flat.reshape(-1, 3)
        apart = x[j] - x[i]
        apart -= np.rint(apart)
        length = np.linalg.norm(apart, axis=1)
        over = np.maximum(radius[i] + radius[j] - length, 0.0) / (2.0 * radius.mean())
        pull = (over / length / (2.0 * radius.mean()))[:, None] * apart
        slope = np.zeros_like(x)
        np.add.at(slope, i, pull)
        np.add.at(slope, j, -pull)
        return 0.5 * float((over**2).sum()), slope.ravel()

    low, high = 0.3, 0.75
    while high - low > 2e-4:
        fraction = 0.5 * (low + high)
        radius = size * unit * fraction ** (1.0 / 3.0)
        options = {"maxiter": 5000, "ftol": 1e-18, "gtol": 1e-10}
        found = minimize(energy, position.ravel(), (radius,), "L-BFGS-B", jac=True, options=options)
        if found.fun < 1e-9 * count:
            low, position, kept = fraction, found.x.reshape(-1, 3), radius
        else:
            high = fraction
    return position % 1.0, kept


@dataclass(frozen=True)
class PeriodicNetwork:
    """Bonds of a periodic cell; the facet between two cells, each counted once."""

    films: Films
    share: np.ndarray  # of the bond in the cell: a half where a facet is listed from both sides
    operator: sparse.csr_matrix  # openings (3 b,) of the motions (6 n,)
    offset: np.ndarray  # (3 b, 3, 3) openings of a mean strain

    def stiffness(self, normal: np.ndarray, tangential: np.ndarray) -> np.ndarray:
        """Stress (6, 6) of the six mean strains, in Mandel's order, of bonds of these stiffnesses (b,)."""
        weight = (self.share[:, None] * np.column_stack([normal, tangential, tangential])).ravel()
        affine = np.stack([np.einsum("bij,ij->b", self.offset, basis) for basis in MANDEL], axis=1)
        g = self.operator[:, 3:]  # one sphere does not move
        matrix = (g.T @ sparse.diags_array(weight) @ g).tocsc()
        load = g.T @ (weight[:, None] * affine)
        motion = splu(matrix + 1e-13 * sparse.diags_array(matrix.diagonal())).solve(-load)
        return affine.T @ (weight[:, None] * (affine + g @ motion))


def _mandel() -> np.ndarray:
    basis = np.zeros((6, 3, 3))
    for k in range(3):
        basis[k, k, k] = 1.0
        i, j = [(1, 2), (0, 2), (0, 1)][k]
        basis[3 + k, i, j] = basis[3 + k, j, i] = np.sqrt(0.5)
    return basis


MANDEL = _mandel()


def isotropic(stiffness: np.ndarray) -> tuple[float, float]:
    """Bulk and shear modulus of the isotropic part of a stiffness in Mandel's order."""
    trace = stiffness[:3, :3].sum()
    return trace / 9.0, (np.trace(stiffness) - trace / 3.0) / 10.0


def network(position: np.ndarray, radius: np.ndarray) -> PeriodicNetwork:
    """Facets of the power diagram of the periodic packing in the unit cell."""
    n = radius.size
    shift = np.stack(np.meshgrid(*[(0, -1, 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    many = (position[None] + shift[:, None]).reshape(-1, 3)
    normal = np.vstack([np.eye(3), -np.eye(3)])
    region = Region(normal, np.array([2.0, 2, 2, 1, 1, 1]), np.full(3, 0.5))
    facets = power_diagram(many, np.tile(radius, len(shift)), region)
    inner = (facets.second < len(many)) & ((facets.first < n) | (facets.second < n))
    i, j = facets.first[inner], facets.second[inner]
    share = np.where((i < n) & (j < n), 1.0, 0.5)  # a facet to an image is found from both sides
    frame, point = facets.frame[inner], facets.centroid[inner]
    here, there = point - many[i], point - many[j]
    a, b = i % n, j % n
    operator = _openings(a, b, frame, here, there, n)
    apart = many[j] - many[i]
    offset = np.einsum("bka,bc->bkac", frame, apart).reshape(-1, 3, 3)
    films = Films(radius[a], radius[b], facets.length[inner] - radius[a] - radius[b], facets.area[inner])
    return PeriodicNetwork(films, share, operator, offset)


def _openings(
    a: np.ndarray, b: np.ndarray, frame: np.ndarray, here: np.ndarray, there: np.ndarray, n: int
) -> sparse.csr_matrix:
    """Openings of bonds between bodies a and b, seen from each by the arms here and there (b, 3) [m]."""
    bonds = a.size
    rows = np.repeat(np.arange(3 * bonds).reshape(bonds, 3), 12, axis=1).ravel()
    turned = [
        np.cross(arm[:, None, :], frame) for arm in (here, there)
    ]  # frame . (w x arm) = w . (arm x frame)
    values = np.concatenate([-frame, -turned[0], frame, turned[1]], axis=2)
    columns = np.concatenate([6 * a[:, None] + np.arange(6), 6 * b[:, None] + np.arange(6)], axis=1)
    columns = np.repeat(columns[:, None, :], 3, axis=1)
    return sparse.csr_matrix((values.ravel(), (rows, columns.ravel())), shape=(3 * bonds, 6 * n))
