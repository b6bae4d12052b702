"""Bonds against a look at all pairs: who is bonded, where, in which frame, with which form factor."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.specimen.network import bond_network

HEIGHT, REACH = 0.03, 2e-3


@pytest.fixture(scope="module")
def cloud():
    """80 spheres in a slab between foot and head, apart or not; all inside the plates."""
    rng = np.random.default_rng(5)
    radius = rng.uniform(0.8e-3, 2.5e-3, 80)
    position = rng.uniform([-6e-3, -6e-3, 0], [6e-3, 6e-3, HEIGHT], (80, 3))
    position[:, 2] = np.clip(position[:, 2], radius + 1e-4, HEIGHT - radius - 1e-4)
    return position, radius


def brute_force(position, radius):
    """{(first, second): (normal, point, gap, length, rmin)}; spheres as unordered pairs, plates by number."""
    n, bonds = len(radius), {}
    for i in range(n):
        for j in range(i + 1, n):
            length = np.linalg.norm(position[j] - position[i])
            gap = length - radius[i] - radius[j]
            if gap < REACH:
                normal = (position[j] - position[i]) / length
                point = 0.5 * (position[i] + radius[i] * normal + position[j] - radius[j] * normal)
                bonds[i, j] = normal, point, gap, length, min(radius[i], radius[j])
        up, foot, head = np.array([0.0, 0, 1]), position[i, 2], HEIGHT - position[i, 2]
        x, y, _ = position[i]
        if foot - radius[i] < REACH:  # from the foot (n + 1) up to the sphere
            bonds[n + 1, i] = up, np.array([x, y, (foot - radius[i]) / 2]), foot - radius[i], foot, radius[i]
        if head - radius[i] < REACH:  # from the sphere up to the head (n)
            bonds[i, n] = (
                up,
                np.array([x, y, HEIGHT - (head - radius[i]) / 2]),
                head - radius[i],
                head,
                radius[i],
            )
    return bonds


def test_bonds_are_those_of_brute_force(cloud):
    position, radius = cloud
    network, expected = bond_network(position, radius, HEIGHT, REACH), brute_force(position, radius)
    n, found = radius.size, set()
    for b, (i, j) in enumerate(zip(network.first.tolist(), network.second.tolist())):
        swapped = max(i, j) < n and i > j
        found.add((j, i) if swapped else (i, j))
        normal, point, gap, length, rmin = expected[(j, i) if swapped else (i, j)]
        np.testing.assert_allclose(network.frame[b, 0], -normal if swapped else normal, atol=1e-14)
        np.testing.assert_allclose(network.point[b], point, atol=1e-16)
        assert network.gap[b] == pytest.approx(gap, abs=1e-17)
        assert network.length[b] == pytest.approx(length, rel=1e-14)
        assert network.area[b] == pytest.approx(np.pi * rmin**2, rel=1e-14)
        assert network.form[b] == pytest.approx(np.pi * rmin**2 / length, rel=1e-14)
    assert found == expected.keys() and network.first.size == len(expected)
    assert (network.first == n + 1).any() and (network.second == n).any()
    assert not (network.second == n + 1).any() and not (network.first == n).any()


def test_frames_are_right_handed_and_orthonormal(cloud):
    frame = bond_network(*cloud, HEIGHT, REACH).frame
    np.testing.assert_allclose(
        frame @ frame.transpose(0, 2, 1), np.broadcast_to(np.eye(3), frame.shape), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(frame), 1.0, rtol=1e-13)


def test_reach_is_exclusive():
    """Two spheres whose gap is 2 mm, a little more, a little less."""
    for change, bonds in ((1e-9, 0), (-1e-9, 1)):
        position = np.array([[0.0, 0, 0.015], [4e-3 + change, 0, 0.015]])
        assert bond_network(position, np.full(2, 1e-3), HEIGHT, REACH).gap.size == bonds
