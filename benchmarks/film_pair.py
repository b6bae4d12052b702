"""Two spheres and the film between them in a cylinder as wide as the facet, by finite elements.

Axially symmetric, quadratic displacement and linear pressure (Taylor-Hood), which do not lock where the matrix is
incompressible. The planes through the centres move apart without friction; the side of the cylinder is free. Needs
scikit-fem and gmsh.
"""

from __future__ import annotations

from dataclasses import dataclass

import gmsh
import numpy as np
from scipy.sparse import bmat
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP1, ElementTriP2, ElementVector, MeshTri
from skfem.helpers import grad


@dataclass(frozen=True)
class Pair:
    """Radii, gap, radius of the cylinder."""

    first: float
    second: float
    gap: float
    side: float

    @property
    def length(self) -> float:
        return self.first + self.second + self.gap


def mesh(pair: Pair, fineness: float) -> tuple[MeshTri, np.ndarray]:
    """Triangles of the half plane (r, z), and which are grain; fineness: elements across the film."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 1)
    try:
        occ = gmsh.model.occ
        cell = occ.addRectangle(0.0, 0.0, 0.0, pair.side, pair.length)
        discs = [
            occ.addDisk(0, 0, 0, pair.first, pair.first),
            occ.addDisk(0, pair.length, 0, pair.second, pair.second),
        ]
        parts, _ = occ.intersect([(2, cell)], [(2, d) for d in discs], removeObject=False)
        occ.fragment([(2, cell)], parts)
        occ.synchronize()
        a = pair.first * pair.second / (pair.first + pair.second)
        large = 0.12 * min(pair.second, pair.side)
        middle = pair.first + 0.5 * pair.gap

        def size(dim, tag, x, y, z, lc):
            h = pair.gap + x * x / (2.0 * a)
            away = max(abs(y - middle) - 0.5 * h, 0.0)
            return min(large, h / fineness + 0.25 * away)

        gmsh.model.mesh.setSizeCallback(size)
        for name in (
            "Mesh.MeshSizeExtendFromBoundary",
            "Mesh.MeshSizeFromPoints",
            "Mesh.MeshSizeFromCurvature",
        ):
            gmsh.option.setNumber(name, 0)
        gmsh.model.mesh.generate(2)
        tags, points, _ = gmsh.model.mesh.getNodes()
        place = np.full(int(tags.max()) + 1, -1)
        place[tags.astype(int)] = np.arange(tags.size)
        _, _, nodes = gmsh.model.mesh.getElements(2)
        elements = place[np.concatenate(nodes).astype(int).reshape(-1, 3)]
        points = points.reshape(-1, 3)[:, :2]
    finally:
        gmsh.finalize()
    middle_points = points[elements[:, :3]].mean(axis=1)
    grain = (np.hypot(*middle_points.T) < pair.first) | (
        np.hypot(middle_points[:, 0], middle_points[:, 1] - pair.length) < pair.second
    )
    corners, where = np.unique(elements[:, :3], return_inverse=True)
    return MeshTri(points[corners].T.copy(), where.reshape(-1, 3).T.copy()), grain


def normal_stiffness(
    pair: Pair, grain: tuple[float, float], matrix: tuple[float, float], fineness: float
) -> float:
    """Force over approach; (shear modulus, bulk modulus) of grain and matrix."""
    cells, inside = mesh(pair, fineness)
    displacement = Basis(cells, ElementVector(ElementTriP2()), intorder=4)
    pressure = displacement.with_element(ElementTriP1())
    shear = np.where(inside, grain[0], matrix[0])[:, None]
    lame = np.where(inside, grain[1], matrix[1])[:, None] - 2.0 / 3.0 * shear

    @BilinearForm
    def stretch(u, v, w):
        r, du, dv = w.x[0], grad(u), grad(v)
        sheared = 0.5 * (du[0, 1] + du[1, 0]) * (dv[0, 1] + dv[1, 0])
        return 2.0 * w.shear * r * (du[0, 0] * dv[0, 0] + du[1, 1] * dv[1, 1] + sheared + u[0] * v[0] / r**2)

    @BilinearForm
    def volume(u, q, w):
        return w.x[0] * (grad(u)[0, 0] + grad(u)[1, 1] + u[0] / w.x[0]) * q

    @BilinearForm
    def compression(p, q, w):
        return -w.x[0] * p * q / w.lame

    weights = {"shear": shear * np.ones_like(displacement.dx), "lame": lame * np.ones_like(displacement.dx)}
    a = stretch.assemble(displacement, **weights)
    b = volume.assemble(displacement, pressure)
    c = compression.assemble(pressure, lame=weights["lame"])
    matrix_ = bmat([[a, b.T], [b, c]]).tocsc()
    low = displacement.get_dofs(lambda x: np.isclose(x[1], 0.0)).all("u^2")
    high = displacement.get_dofs(lambda x: np.isclose(x[1], pair.length)).all("u^2")
    axis = displacement.get_dofs(lambda x: np.isclose(x[0], 0.0)).all("u^1")
    x = np.zeros(matrix_.shape[0])
    x[high] = 1.0
    fixed = np.unique(np.concatenate([low, high, axis]))
    free = np.setdiff1d(np.arange(x.size), fixed)
    x[free] = splu(matrix_[free][:, free].tocsc()).solve(-(matrix_[free] @ x))
    return 2.0 * np.pi * float((matrix_ @ x)[high].sum())
