"""Bonds that are facets: plates, equilibrium under a uniform strain, prisms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.system import opening_operator
from asphalt_nscd.specimen.network import bond_network, facet_network
from asphalt_nscd.specimen.prism import cut_prism, pull, pulled_system, stretched
from asphalt_nscd.specimen.trimming import trim

STRAIN = np.array([[1.0, 0.4, -0.7], [0.4, -0.6, 0.2], [-0.7, 0.2, 0.3]])
EQUAL = np.ones(3)


@pytest.fixture(scope="module")
def block(make_beam):
    return make_beam(seed=4, shape=(6, 5, 16), area="facets")


def test_plates_and_gaps(block):
    """Bonds to foot and head have the area of each end and the distance to it; gaps are between surfaces."""
    network, n, geometry = block.network, block.radius.size, block.geometry
    assert not (network.first >= n).any()
    for plate, level, out in ((n, geometry.h, 1.0), (n + 1, 0.0, -1.0)):
        own = network.second == plate
        sphere = network.first[own]
        assert network.area[own].sum() == pytest.approx(geometry.b * geometry.e, rel=1e-9)
        np.testing.assert_allclose(network.length[own], np.abs(level - block.position[sphere, 2]), rtol=1e-10)
        np.testing.assert_allclose(network.frame[own, 0], np.tile([0, 0, out], (own.sum(), 1)), atol=1e-10)
        np.testing.assert_allclose(network.point[own, 2], level, atol=1e-14)
        np.testing.assert_allclose(network.gap[own], network.length[own] - block.radius[sphere], atol=1e-17)
    between = network.second < n
    i, j = network.first[between], network.second[between]
    apart = np.linalg.norm(block.position[j] - block.position[i], axis=1)
    np.testing.assert_allclose(network.gap[between], apart - block.radius[i] - block.radius[j], atol=1e-16)


def test_clamps_within_a_beam_cut_it(make_beam):
    """A clamp takes the section from each side that has spheres; none is bonded through it, and cells fill the beam."""
    beam = make_beam(shape=(3, 2, 12), area="facets", test=Beam.test)
    network, n, h = beam.network, beam.radius.size, beam.geometry.h
    section = beam.geometry.depth * beam.geometry.breadth
    assert network.cell.sum() == pytest.approx(section * h, rel=1e-6)
    for k, (level, sides) in enumerate(((h / 3, 2), (2 * h / 3, 2), (0.0, 1), (h, 1))):
        own = network.second == n + k
        sphere = network.first[own]
        above = beam.position[sphere, 2] - level
        areas = [network.area[own][above < 0].sum(), network.area[own][above > 0].sum()]
        assert sorted(areas) == pytest.approx([section * (sides - 1), section], rel=1e-6)
        np.testing.assert_allclose(network.length[own], np.abs(above), rtol=1e-10)
        np.testing.assert_allclose(network.frame[own, 0, 2], -np.sign(above), atol=1e-10)
        surface = np.abs(above) - (beam.radius[sphere] if sides == 1 else 0.0)
        np.testing.assert_allclose(network.gap[own], surface, atol=1e-15)
    between = network.second < n
    part = np.digitize(beam.position[:, 2], [h / 3, 2 * h / 3])
    assert (part[network.first[between]] == part[network.second[between]]).all()


def residual(specimen, network, tangential):
    """Largest force and torque on the spheres inside under STRAIN, over those of single bonds."""
    n = specimen.radius.size
    operator = opening_operator(
        network.first, network.second, network.frame, network.point, specimen.position
    )
    motion = np.hstack([specimen.position @ STRAIN, np.zeros((n, 3))]).ravel()
    weight = (network.form[:, None] * [1.0, tangential, tangential]).ravel()
    force = (operator.T @ (weight * (operator @ motion))).reshape(n, 6)
    half = np.array([specimen.geometry.b, specimen.geometry.e]) / 2
    inside = (half - np.abs(specimen.position[:, :2]) > 5e-3).all(axis=1)
    inside &= np.abs(specimen.position[:, 2] - specimen.geometry.h / 2) < specimen.geometry.h / 2 - 5e-3
    assert inside.sum() > 20
    scale = network.area.mean()
    return np.abs(force[inside, :3]).max() / scale, np.abs(force[inside, 3:]).max() / scale / 4e-3


def test_uniform_strain_is_an_equilibrium(block):
    """Where kt = kn and bonds act at centroids: no force, no torque. Otherwise there is."""
    force, torque = residual(block, block.network, 1.0)
    assert force < 1e-4 and torque < 1e-4  # facets left out: 1e-6 of a section each
    assert residual(block, block.network, 0.4)[0] > 0.05
    reach = block.radius[block.network.first] + block.network.gap / 2
    between = replace(
        block.network, point=block.position[block.network.first] + reach[:, None] * block.network.frame[:, 0]
    )
    assert residual(block, between, 1.0)[0] < 1e-4 and residual(block, between, 1.0)[1] > 0.02


def test_a_prism_of_facets_has_the_modulus_of_its_bonds(block):
    """Exactly where kt = kn, without contraction; softer otherwise, and it contracts."""
    modulus, poisson = pull(block, EQUAL)
    assert modulus == pytest.approx(1.0, abs=1e-6) and poisson == pytest.approx(0.0, abs=1e-6)
    modulus, poisson = pull(block, np.array([1.0, 0.37, 0.37]))
    assert 0.6 < modulus < 0.95 and 0.02 < poisson < 0.25  # not isotropic: a lattice, jittered
    paper = pull(
        replace(block, network=bond_network(block.position, block.radius, block.geometry.h, 2e-3)), EQUAL
    )
    assert abs(paper[0] - 1.0) > 0.1


def test_strain_is_that_of_the_middle_third_and_stress_that_of_the_plate(block):
    """Of a motion that is given: by -0.3, -0.1 and 0.8 in the middle, three times as much elsewhere."""
    weight = (block.network.form[:, None] * [1.0, 0.4, 0.4]).ravel()
    system, h = pulled_system(block, weight), block.geometry.h
    outside = np.abs(block.position[:, 2] - h / 2) >= h / 6
    moved = block.position * [-0.3, -0.1, 0.8] * np.where(outside, 3.0, 1.0)[:, None]
    motion = np.append(np.hstack([moved, np.zeros_like(moved)]).ravel(), 0.8 * h)
    stress = (weight * (system.operator @ motion) ** 2).sum() / (block.geometry.b * block.geometry.e)
    assert stretched(block, system, motion) == pytest.approx((stress / 0.8, 0.4 / 1.6), rel=1e-10)


def test_a_prism_cut_out_of_a_layer(make_beam):
    """Along x of the layer; a cut through spheres does no harm to facets."""
    layer = make_beam(seed=2, shape=(8, 6, 20), area="facets")
    lying = layer.position[:, [2, 1, 0]] + [0.0, 12e-3, 16e-3]  # 80 mm long, 24 wide, 32 high
    geometry = Geometry(b=18e-3, B=18e-3, e=14e-3, h=50e-3, mass=1.0, mobile_mass=0.0)
    prism = cut_prism(
        lying,
        layer.radius,
        np.array([11e-3, 5e-3, 6e-3]),
        geometry,
        lambda p, r: facet_network(p, r, geometry),
    )
    x, y, z = prism.position.T
    within = (lying > [11e-3, 5e-3, 6e-3]) & (lying < [61e-3, 19e-3, 24e-3])
    kept = within.all(axis=1)
    np.testing.assert_allclose(x, lying[kept, 2] - 15e-3, atol=1e-15)
    np.testing.assert_allclose(y, lying[kept, 1] - 12e-3, atol=1e-15)
    np.testing.assert_allclose(z, lying[kept, 0] - 11e-3, atol=1e-15)
    assert prism.radius.tolist() == layer.radius[kept].tolist() and prism.loose_grains == 0
    assert pull(prism, EQUAL)[0] == pytest.approx(1.0, abs=1e-5)


def test_trim_forms_facets():
    """Of shrunk spheres; none is loose, and what gap they have does not matter."""
    rng = np.random.default_rng(2)
    cells = np.stack(np.meshgrid(np.arange(18), np.arange(3), np.arange(8), indexing="ij"), -1).reshape(-1, 3)
    radius = rng.uniform(1.2e-3, 1.6e-3, len(cells))
    position = np.array([60e-3, 10e-3, 26.4e-3]) / [18, 3, 8] * (cells + 0.5)
    position += rng.uniform(-5e-5, 5e-5, cells.shape)
    geometry = Geometry(b=10e-3, B=20e-3, e=10e-3, h=60e-3, mass=0.02, mobile_mass=0.008)
    specimen = trim(position, radius, geometry, 0.1, 1e-6, "facets")
    assert specimen.area == "facets" and specimen.loose_grains == 0
    again = facet_network(specimen.position, specimen.radius, geometry)
    assert all(
        value.tobytes() == specimen.network.arrays()[name].tobytes() for name, value in again.arrays().items()
    )
    assert specimen.network.gap.max() > 2e-3
