"""Facets of packings where they are known, against half-spaces, and what they must fill."""

from __future__ import annotations

import numpy as np
import pytest
from naive.power_diagram import cell

from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.specimen.network import region_of
from asphalt_nscd.specimen.power_diagram import Region, power_diagram

GEOMETRY = Geometry(b=10e-3, B=22e-3, e=12e-3, h=40e-3, mass=0.01, mobile_mass=0.0)


def box(*size):
    """The region [0, size] of each axis."""
    size = np.array(size, float)
    normal = np.concatenate([np.eye(3), -np.eye(3)])
    return Region(normal, np.concatenate([size, np.zeros(3)]), size / 2)


def lattice(shape, pitch):
    cells = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1).reshape(-1, 3)
    return pitch * (cells + 0.5)


@pytest.fixture(scope="module")
def packing():
    """Spheres of 0.3 to 1.5 mm that do not overlap, in the trapezoid; many cells reach its edges."""
    rng, region = np.random.default_rng(7), region_of(GEOMETRY)
    position, radius = np.empty((0, 3)), np.empty(0)
    for _ in range(4000):
        point = rng.uniform([-11e-3, -6e-3, 0], [11e-3, 6e-3, 40e-3])
        size = rng.choice([0.3e-3, 0.7e-3, 1.5e-3])
        apart = np.linalg.norm(position - point, axis=1) - radius
        if (region.normal @ point < region.offset - 1e-5).all() and (apart > size).all():
            position, radius = np.vstack([position, point]), np.append(radius, size)
    assert 300 < radius.size < 3000
    return position, radius


def test_simple_cubic_lattice():
    """Each facet is a^2, though eight cells meet in every corner; faces of the box are at a/2."""
    a = 2e-3
    position = lattice((4, 3, 5), a)
    facets = power_diagram(position, np.full(60, 0.4 * a), box(4 * a, 3 * a, 5 * a))
    between = facets.second < 60
    assert between.sum() == 3 * 3 * 5 + 4 * 2 * 5 + 4 * 3 * 4 and (~between).sum() == 2 * (12 + 15 + 20)
    np.testing.assert_allclose(facets.area, a**2, rtol=1e-12)
    np.testing.assert_allclose(facets.length[between], a, rtol=1e-12)
    np.testing.assert_allclose(facets.length[~between], a / 2, rtol=1e-12)
    centre = (
        position[facets.first]
        + facets.length[:, None] * facets.frame[:, 0] / np.where(between, 2, 1)[:, None]
    )
    np.testing.assert_allclose(facets.centroid, centre, atol=1e-15)
    np.testing.assert_allclose(facets.spread[:, :2], a**2 / 12, rtol=1e-10)
    np.testing.assert_allclose(facets.spread[:, 2], 0.0, atol=1e-12 * a**2)


def test_body_centred_lattice():
    """A cell inside is a truncated octahedron: eight hexagons of 3 sqrt(3) a^2 / 16, six squares of a^2 / 8."""
    a = 3e-3
    corners = lattice((5, 5, 5), a)
    middles = lattice((4, 4, 4), a) + a / 2
    position = np.concatenate([corners, middles])
    facets = power_diagram(position, np.full(len(position), 0.4 * a), box(5 * a, 5 * a, 5 * a))
    centre = int(np.argmin(np.linalg.norm(position - 2.5 * a, axis=1)))
    mine = (facets.first == centre) | (facets.second == centre)
    near = facets.length[mine] < 0.9 * a
    assert near.sum() == 8 and (~near).sum() == 6
    np.testing.assert_allclose(facets.area[mine][near], 3 * np.sqrt(3) / 16 * a**2, rtol=1e-12)
    np.testing.assert_allclose(facets.area[mine][~near], a**2 / 8, rtol=1e-12)


def test_plane_between_unequal_spheres():
    """At (l^2 + ri^2 - rj^2) / (2 l) from the larger one, clipped at the box."""
    position, radius = np.array([[3e-3, 2e-3, 2e-3], [8e-3, 2e-3, 2e-3]]), np.array([2e-3, 0.5e-3])
    facets = power_diagram(position, radius, box(10e-3, 4e-3, 5e-3))
    (b,) = np.flatnonzero(facets.second == 1)
    assert facets.area[b] == pytest.approx(20e-6, rel=1e-12)
    assert facets.centroid[b] == pytest.approx([3e-3 + (25 + 4 - 0.25) / 10 * 1e-3, 2e-3, 2.5e-3], rel=1e-12)
    assert sorted(facets.spread[b, :2]) == pytest.approx([16e-6 / 12, 25e-6 / 12], rel=1e-10)


def test_against_half_spaces(packing):
    """Volumes of some cells and areas of all their facets, at faces, edges and corners too."""
    position, radius = packing
    region = region_of(GEOMETRY)
    facets, n = power_diagram(position, radius, region), radius.size
    distance = region.offset - position @ region.normal.T
    cells = facets.cells(position)
    edges = np.argsort(np.sort(distance, axis=1)[:, :3].sum(axis=1))[:12]
    for i in (*edges.tolist(), *range(0, n, 40)):
        volume, area = cell(i, position, radius, region.normal, region.offset)
        assert cells[i] == pytest.approx(volume, rel=1e-5)  # without facets that were left out
        mine = (facets.first == i) | (facets.second == i)
        other = np.where(facets.first == i, facets.second, facets.first)[mine].tolist()
        for j, found in zip(other, facets.area[mine].tolist()):
            assert found == pytest.approx(area.pop(j), rel=1e-7, abs=1e-15)
        assert sum(area.values()) < 1e-6 * volume ** (2 / 3)  # nothing of note is missing


def test_cells_fill_the_trapezoid(packing):
    """Volume, the area of each face, closed cells, and sum A l n n = V I."""
    position, radius = packing
    facets, n, (b, B, e, h) = (
        power_diagram(position, radius, region_of(GEOMETRY)),
        radius.size,
        (GEOMETRY.b, GEOMETRY.B, GEOMETRY.e, GEOMETRY.h),
    )
    volume = e * h * (B + b) / 2
    assert facets.volume == pytest.approx(volume, rel=1e-6)  # without facets that were left out
    faces = np.bincount(facets.second[facets.second >= n] - n, facets.area[facets.second >= n])
    side = e * np.hypot(h, (B - b) / 2)
    assert faces == pytest.approx([b * e, B * e, side, side, h * (B + b) / 2, h * (B + b) / 2], rel=1e-6)
    normal, own = facets.frame[:, 0], facets.second < n
    for axis in range(3):
        out = np.bincount(facets.first, facets.area * normal[:, axis], n)
        out -= np.bincount(facets.second[own], (facets.area * normal[:, axis])[own], n)
        assert np.abs(out).max() < 1e-5 * facets.area.mean()
    # divergence theorem: each cell gives V_i I, so does the specimen
    arms = np.einsum("f,fi,fj->ij", facets.area, facets.centroid - position[facets.first], normal)
    arms -= np.einsum(
        "f,fi,fj->ij", facets.area[own], facets.centroid[own] - position[facets.second[own]], normal[own]
    )
    np.testing.assert_allclose(arms, volume * np.eye(3), atol=1e-6 * volume)


def test_a_sphere_on_a_face_and_far_faces():
    """A centre on a face itself; faces many diameters away from the next sphere."""
    position = np.array([[0.0, 5e-3, 5e-3], [60e-3, 5e-3, 5e-3]])
    facets = power_diagram(position, np.full(2, 1e-3), box(100e-3, 10e-3, 10e-3))
    assert facets.volume == pytest.approx(1e-5, rel=1e-8)
    assert facets.area[facets.second == 1] == pytest.approx([1e-4], rel=1e-9)


def test_negligible_facets_are_left_out(monkeypatch):
    """Across the edges of a lattice moved a little out of place, facets are slivers."""
    a = 2e-3
    position = lattice((3, 3, 3), a) + np.random.default_rng(1).uniform(-1e-10, 1e-10, (27, 3))
    arguments = position, np.full(27, 0.4 * a), box(3 * a, 3 * a, 3 * a)
    assert power_diagram(*arguments).area.min() > 0.9 * a**2
    monkeypatch.setattr("asphalt_nscd.specimen.power_diagram.NEGLIGIBLE", 0.0)
    assert power_diagram(*arguments).area.min() < 1e-6 * a**2
