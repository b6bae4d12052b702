"""Kinematics of the bonds: rigid motion, power, finite differences, naive twin; yield measure."""

from __future__ import annotations

import numpy as np
import pytest
from naive.bonds import naive_forces, naive_openings
from scipy import sparse
from scipy.spatial.transform import Rotation

from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator


@pytest.fixture(scope="module")
def bodies(beam):
    """Arguments of opening_operator for the beam: spheres, head plate (n) and fixed foot (n + 1)."""
    network, n = beam.network, beam.radius.size
    position = np.concatenate([beam.position, [[0.0, 0.0, beam.geometry.h]]])
    assert network.first.max() > n  # some bonds start at the foot, some end at the head
    assert (network.second == n).any()
    return network.first, network.second, network.frame, network.point, position


def test_naive_twin(bodies):
    velocity = np.random.default_rng(1).normal(size=bodies[4].shape[:1] + (6,))
    found = opening_operator(*bodies) @ velocity.ravel()
    expected = naive_openings(*bodies, velocity)
    np.testing.assert_allclose(found.reshape(-1, 3), expected, rtol=0, atol=1e-14)


def test_reactions_act_on_the_bodies_as_forces_at_the_point(bodies):
    """G^T R is force and torque of R on the second body and of -R on the first: virtual power."""
    operator = opening_operator(*bodies)
    reaction = np.random.default_rng(2).normal(size=(bodies[0].size, 3))
    forces = operator.T @ reaction.ravel()
    np.testing.assert_allclose(forces.reshape(-1, 6), naive_forces(*bodies, reaction), rtol=0, atol=1e-14)


def test_finite_differences(bodies):
    """Points of action carried by small finite rotations: G is their relative displacement, to O(eps)."""
    first, second, frame, point, position = bodies
    rng = np.random.default_rng(4)
    velocity = rng.normal(size=(len(position), 6)) * np.repeat([1.0, 100.0], 3)
    errors = []
    for eps in (1e-4, 5e-5):
        apart = np.zeros((first.size, 3))
        for body, sign in ((first, -1.0), (second, 1.0)):
            moves = body < len(position)
            b = body[moves]
            turn = Rotation.from_rotvec(eps * velocity[b, 3:])
            carried = position[b] + eps * velocity[b, :3] + turn.apply(point[moves] - position[b])
            apart[moves] += sign * (carried - point[moves])
        measured = np.einsum("bcd,bd->bc", frame, apart) / eps
        predicted = (opening_operator(*bodies) @ velocity.ravel()).reshape(-1, 3)
        errors.append(np.abs(measured - predicted).max())
    assert errors[1] < 1e-2 * np.abs(predicted).max()
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.05)


def test_opening_is_positive_when_bodies_part():
    """Two spheres on the x axis, frame along it: pulling the second away opens the normal component."""
    frame = np.array([[[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]])
    position = np.array([[0.0, 0, 0], [3e-3, 0, 0]])
    operator = opening_operator(np.array([0]), np.array([1]), frame, np.array([[1.5e-3, 0, 0]]), position)
    velocity = np.zeros(12)
    velocity[6] = 1.0
    np.testing.assert_array_equal(operator @ velocity, [1, 0, 0])
    velocity[:] = 0
    velocity[11] = 100.0  # the second turns about z: its left side moves by -1.5 mm x 100/s along y
    np.testing.assert_allclose(operator @ velocity, [0, -0.15, 0], atol=1e-16)


def small_system(**changes) -> BondedSystem:
    """Two bonds along x from a fixed wall: to the driven body 0 and on to the free body 1."""
    rows = np.zeros((6, 12))
    rows[:3, :3] = np.eye(3)
    rows[3:, :3], rows[3:, 6:9] = -np.eye(3), np.eye(3)
    given = dict(
        operator=sparse.csr_matrix(rows),
        weight=np.arange(1.0, 7.0),
        mass=np.ones(12),
        load=np.zeros(12),
        driven=3,
        gap=np.ones(2),
        strength=np.array([2.0, 4.0]),
        friction=0.5,
    )
    return BondedSystem(**given | changes)


def test_yield_in_tension_and_in_shear_but_not_in_compression():
    system = small_system()
    cases = [
        ([-2.0, 0, 0, -1, 0, 0], [1.0, 0.25]),  # tension: negative reaction
        ([2e3, 0, 0, 1e9, 0, 0], [0.0, 0.0]),  # compression never
        ([0, 3, -4, 0, 0, 8], [2.5, 2.0]),  # shear of either sign, norm of both tangents
        ([1e3, 0, 1, -2, 1, 1], [0.5, 0.5]),  # the larger of the two counts
    ]
    for reaction, expected in cases:
        np.testing.assert_allclose(
            system.utilisation(np.array(reaction, float)), np.maximum(expected, 0), rtol=1e-15
        )


def test_plate_bonds_never_yield():
    system = small_system(strength=np.array([np.inf, 1.0]))
    np.testing.assert_array_equal(system.utilisation(np.array([-1e300, 1e300, 0, -3, 0, 0])), [0.0, 3.0])


def test_stiffness_and_free_degrees_of_freedom(beam_system):
    """K = G^T w G, symmetric; broken bonds leave it through zero weights."""
    system = beam_system
    g, w = system.operator.toarray(), system.weight.copy()
    np.testing.assert_allclose(system.stiffness().toarray(), g.T @ (w[:, None] * g), rtol=1e-12, atol=1e-18)
    w[3:6] = 0.0
    np.testing.assert_allclose(system.stiffness(w).toarray(), g.T @ (w[:, None] * g), rtol=1e-12, atol=1e-18)
    assert system.free.size == system.mass.size - 1 and system.driven not in system.free
    values = np.linalg.eigvalsh(system.stiffness().toarray()[np.ix_(system.free, system.free)])
    assert values.min() > 0  # held by foot and drive, nothing can float
