"""The mechanical system of the bending test."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.twopoint import bending_share
from asphalt_nscd.specimen.prism import static_ratio
from asphalt_nscd.specimen.system import affine_modulus, affine_poisson, bending_system

POISSON, YIELD = 0.35, 2.7e6


def test_masses_and_loads(beam):
    """Spheres of 2/5 m r^2, a thin head plate b x e of the mobile mass; weight on every body."""
    system = bending_system(beam, POISSON, YIELD, 0.7)
    n, geometry = beam.radius.size, beam.geometry
    mass = system.mass.reshape(-1, 6)
    ball = beam.density * 4 / 3 * np.pi * beam.radius**3
    assert mass.shape == (n + 1, 6)
    np.testing.assert_allclose(mass[:n, :3], np.tile(ball[:, None], 3), rtol=1e-14)
    np.testing.assert_allclose(mass[:n, 3:], np.tile((0.4 * ball * beam.radius**2)[:, None], 3), rtol=1e-14)
    assert mass[:n, 0].sum() == pytest.approx(geometry.mass, rel=1e-13)
    m, b, e = geometry.mobile_mass, geometry.b, geometry.e
    np.testing.assert_allclose(
        mass[n], [m, m, m, m * e**2 / 12, m * b**2 / 12, m * (b**2 + e**2) / 12], rtol=1e-14
    )
    load = system.load.reshape(-1, 6)
    np.testing.assert_allclose(load[:, 2], -9.81 * mass[:, 2], rtol=1e-14)
    assert not np.delete(load, 2, axis=1).any()
    assert system.driven == 6 * n  # the head, along x
    assert not bending_system(beam, POISSON, YIELD, 0.7, gravity=0.0).load.any()


def test_masses_between_four_clamps(make_beam):
    """Cells bear the mass and turn as balls of their volume; the inner clamps move as one; weight acts along x."""
    beam = make_beam(shape=(3, 2, 12), area="facets", test=Beam.test)
    system = bending_system(beam, POISSON, YIELD, 0.7)
    n, cell, geometry = beam.radius.size, beam.network.cell, beam.geometry
    share = geometry.mass * cell / cell.sum()
    inertia = 0.4 * share * (3.0 * cell / (4.0 * np.pi)) ** (2 / 3)
    spheres = np.repeat(np.stack([share, inertia], axis=1), 3, axis=1)
    np.testing.assert_allclose(system.mass[: 6 * n].reshape(n, 6), spheres, rtol=1e-13)
    half, y2, x2 = geometry.mobile_mass / 2, geometry.breadth**2 / 12, geometry.depth**2 / 12
    clamp = [half, half, half * y2, half * x2, half * (x2 + y2)]
    outer = [0.0] * 2 + [0.0] * 3  # two rotations of one, and along the beam of the other
    np.testing.assert_allclose(system.mass[6 * n :], [2 * half, *clamp, *clamp, *outer], rtol=1e-13)
    load = np.zeros(system.mass.size)
    load[: 6 * n : 6], load[6 * n] = -9.81 * share, -9.81 * geometry.mobile_mass
    np.testing.assert_allclose(system.load, load, rtol=1e-13)
    assert system.driven == 6 * n
    with pytest.raises(InputError, match="four-point bending turns the specimen at its clamps; give free"):
        bending_system(beam, POISSON, YIELD, 0.7, head="blocked")


def test_static_ratio_is_that_of_the_inverse(beam):
    system = bending_system(beam, POISSON, YIELD, 0.7)
    stiffness = 1.0 / np.linalg.inv(system.stiffness().toarray())[system.driven, system.driven]
    expected = beam.geometry.form_factor() * stiffness
    assert static_ratio(system, beam.geometry) == pytest.approx(expected, rel=1e-8)


def test_weights_and_strengths(beam):
    """g in normal direction, g / (2 (1 + nu)) in both tangents; plates do not yield."""
    system = bending_system(beam, POISSON, YIELD, 0.7)
    network, n = beam.network, beam.radius.size
    weight = system.weight.reshape(-1, 3)
    np.testing.assert_allclose(weight[:, 0], network.area / network.length, rtol=1e-14)
    np.testing.assert_allclose(weight[:, 1:] / weight[:, :1], 1 / 2.7, rtol=1e-14)
    plate = (network.first >= n) | (network.second >= n)
    assert np.isinf(system.strength[plate]).all() and plate.any()
    np.testing.assert_allclose(system.strength[~plate], YIELD * network.area[~plate], rtol=1e-14)
    np.testing.assert_array_equal(system.gap, network.gap)
    assert system.friction == 0.7


def test_weights_of_facets(make_beam):
    """A / l in all three directions, over the part of bending in the deflection; poisson has no say."""
    beam = make_beam(area="facets")
    system = bending_system(beam, POISSON, YIELD, 0.7)
    network, n = beam.network, beam.radius.size
    weight = system.weight.reshape(-1, 3)
    share = bending_share(beam.geometry, 0.0)
    assert 0.5 < share < 0.98
    np.testing.assert_allclose(weight, np.tile(network.form[:, None] / share, 3), rtol=1e-14)
    np.testing.assert_array_equal(bending_system(beam, 0.1, YIELD, 0.7).weight, system.weight)
    plate = network.second >= n
    np.testing.assert_allclose(system.strength[~plate], YIELD * network.area[~plate], rtol=1e-14)
    weaker = bending_system(beam, POISSON, YIELD, 0.7, kt_over_kn=0.4).weight.reshape(-1, 3)
    np.testing.assert_allclose(weaker[:, 1:] / weaker[:, :1], 0.4, rtol=1e-14)
    expected = 1.0 / (affine_modulus(0.4) * bending_share(beam.geometry, affine_poisson(0.4)))
    np.testing.assert_allclose(weaker[:, 0] / network.form, expected, rtol=1e-14)


@pytest.mark.parametrize("ratio", [0.0, 0.37, 1.0, 3.0])
def test_affine_constants(ratio):
    """Against the stiffness of bonds along the axes of an icosahedron, isotropic in fourth order.

    sum(A l) = 3 V; C = sum(A l (n n n n + ratio (n n d - n n n n))) / V, d the unit tensor.
    """
    golden = (1 + np.sqrt(5)) / 2
    axes = np.array(
        [[0, 1, golden], [0, -1, golden], [1, golden, 0], [-1, golden, 0], [golden, 0, 1], [golden, 0, -1]]
    )
    axes = axes / np.linalg.norm(axes, axis=1)[:, None]
    four = np.einsum("fi,fj,fk,fl->ijkl", axes, axes, axes, axes)
    two = np.einsum("fi,fl,jk->ijkl", axes, axes, np.eye(3))
    two = (two + two.transpose(1, 0, 2, 3) + two.transpose(0, 1, 3, 2) + two.transpose(1, 0, 3, 2)) / 4
    stiffness = 3 / 6 * ((1 - ratio) * four + ratio * two)
    lame, shear = stiffness[0, 0, 1, 1], stiffness[0, 1, 0, 1]
    assert stiffness[0, 0, 0, 0] == pytest.approx(lame + 2 * shear, rel=1e-12)  # isotropic
    assert affine_modulus(ratio) == pytest.approx(shear * (3 * lame + 2 * shear) / (lame + shear), rel=1e-12)
    assert affine_poisson(ratio) == pytest.approx(lame / (2 * (lame + shear)), rel=1e-12, abs=1e-15)


def test_blocked_head_has_no_rotation(beam):
    """The three rotations of the head are gone, and with them a good part of the compliance."""
    free = bending_system(beam, POISSON, YIELD, 0.7)
    blocked = bending_system(beam, POISSON, YIELD, 0.7, head="blocked")
    np.testing.assert_array_equal(blocked.operator.toarray(), free.operator.toarray()[:, :-3])
    np.testing.assert_array_equal(blocked.mass, free.mass[:-3])
    stiffness = [
        1 / np.linalg.inv(system.stiffness().toarray())[system.driven, system.driven]
        for system in (free, blocked)
    ]
    assert 1.5 < stiffness[1] / stiffness[0] < 4.0  # of an elastic cantilever: 4, less for shear


def test_head_turns_about_its_middle(beam):
    """Rotation of the head about y opens its bonds in proportion to their distance x from the middle."""
    system = bending_system(beam, POISSON, YIELD, 0.7)
    network, n = beam.network, beam.radius.size
    turn = np.zeros(system.mass.size)
    turn[6 * n + 4] = 1.0
    opening = (system.operator @ turn)[::3]
    head = network.second == n
    np.testing.assert_allclose(opening[head], -network.point[head, 0], rtol=1e-12)
    assert not opening[~head].any()
