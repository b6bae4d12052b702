"""The mechanical system of the bending test."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.specimen.system import bending_system

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
