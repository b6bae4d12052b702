"""Two spheres and the film between them in a cylinder as wide as the facet, by finite elements.

Axially symmetric, quadratic displacement and linear pressure (Taylor-Hood), which do not lock where the matrix is
incompressible. The planes through the centres move apart without friction; the side of the cylinder is free. Needs
scikit-fem and gmsh.
"""

from __future__ import annotations

from dataclasses import dataclass

import gmsh
import numpy as np
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP1, ElementTriP2, ElementVector, LinearForm, MeshTri
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


def shear_stiffness(
    pair: Pair, grain: tuple[float, float], matrix: tuple[float, float], fineness: float, slope: bool
) -> float:
    """Force along the planes over their displacement against each other; grains do not turn.

    All motions go with the cosine of the angle about the axis, along r and z, and with its sine around. slope: the
    side moves along z as neighbours in a sheared packing do; else it is free, and the planes do not move along z.
    """
    cells, inside = mesh(pair, fineness)
    # u_r = a + b, u_around = b - a: where r is zero, b and u_z are
    displacement = Basis(cells, ElementVector(ElementTriP2(), 3), intorder=4)
    pressure = displacement.with_element(ElementTriP1())
    shear = np.where(inside, grain[0], matrix[0])[:, None]
    lame = np.where(inside, grain[1], matrix[1])[:, None] - 2.0 / 3.0 * shear

    def strains(u, r):
        du = grad(u)
        out, around = u[0] + u[1], u[1] - u[0]
        rr, out_z = du[0, 0] + du[1, 0], du[0, 1] + du[1, 1]
        round_r, round_z = du[1, 0] - du[0, 0], du[1, 1] - du[0, 1]
        return (
            rr,
            2.0 * u[1] / r,
            du[2, 1],
            out_z + du[2, 0],
            round_r - (out + around) / r,
            round_z - u[2] / r,
        )

    @BilinearForm
    def stretch(u, v, w):
        r = w.x[0]
        one, other = strains(u, r), strains(v, r)
        straight = sum(p * q for p, q in zip(one[:3], other[:3], strict=True))
        sheared = sum(p * q for p, q in zip(one[3:], other[3:], strict=True))
        return w.shear * r * (2.0 * straight + sheared)

    @BilinearForm
    def volume(u, q, w):
        return w.x[0] * sum(strains(u, w.x[0])[:3]) * q

    @BilinearForm
    def compression(p, q, w):
        return -w.x[0] * p * q / w.lame

    @LinearForm
    def turning(v, w):
        dv = grad(v)
        return w.own * w.x[0] * (2.0 * dv[0, 1] - dv[2, 0] - v[2] / w.x[0])

    weights = {"shear": shear * np.ones_like(displacement.dx), "lame": lame * np.ones_like(displacement.dx)}
    a = stretch.assemble(displacement, **weights)
    b = volume.assemble(displacement, pressure)
    c = compression.assemble(pressure, lame=weights["lame"])
    upper = displacement.global_coordinates()[1] > pair.first + 0.5 * pair.gap
    turns = [
        turning.assemble(displacement, own=(inside[:, None] & (upper == half)).astype(float))
        for half in ((False, True) if slope else ())
    ]
    turns = csr_matrix(np.array(turns).reshape(len(turns), a.shape[0]))
    matrix_ = bmat([[a, b.T, turns.T], [b, c, None], [turns, None, None]]).tocsc()

    def at(where, *names):
        dofs = displacement.get_dofs(where)
        return np.concatenate([dofs.all(name) for name in names])

    on_axis, low = (lambda x: np.isclose(x[0], 0.0)), (lambda x: np.isclose(x[1], 0.0))
    high, side = (lambda x: np.isclose(x[1], pair.length)), (lambda x: np.isclose(x[0], pair.side))
    x = np.zeros(matrix_.shape[0])
    moved = at(high, "u^1")
    x[moved] = 1.0
    fixed = [moved, at(low, "u^1", "u^2"), at(high, "u^2"), at(on_axis, "u^2", "u^3")]
    fixed.append(displacement.N + pressure.get_dofs(on_axis).all())
    if slope:
        x[at(side, "u^3")] = pair.side / pair.length
        fixed.append(at(side, "u^3"))
    else:
        fixed += [at(low, "u^3"), at(high, "u^3")]
    free = np.setdiff1d(np.arange(x.size), np.unique(np.concatenate(fixed)))
    x[free] = splu(matrix_[free][:, free].tocsc()).solve(-(matrix_[free] @ x))
    return np.pi * float((matrix_ @ x)[moved].sum())
