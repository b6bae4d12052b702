"""Coupled contacts: closed solutions of one, the conditions themselves, and the naive twin."""

from __future__ import annotations

import numpy as np
import pytest
from naive.friction import naive_contacts

from asphalt_nscd.nscd.friction import solve_contacts

MASSES = np.diag([2.0, 7.0, 7.0])  # 1/kg, a ball of 0.5 kg on a plane


@pytest.mark.parametrize(
    ("free", "impulse"),
    [
        ([0.3, 1.0, -2.0], [0.0, 0.0, 0.0]),  # opens
        ([-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]),  # stops
        ([-2.0, 1.4, -1.4], [1.0, -0.2, 0.2]),  # sticks
        ([-2.0, 4.2, -5.6], [1.0, -0.24, 0.32]),  # slips: 0.4 against the direction (3, -4)/5
        ([0.0, 5.0, 0.0], [0.0, 0.0, 0.0]),  # touches without pressing
    ],
)
def test_one_contact(free, impulse):
    """Closed solutions with friction 0.4; the error of 1e-12 stands relative to the free velocity."""
    np.testing.assert_allclose(solve_contacts(MASSES, np.array(free), 0.4), impulse, atol=1e-11)


def test_slip_with_a_coupled_normal():
    """A rod that digs in: W_nt = 1 makes friction press harder, r_n (w_nn - mu w_nt) = -q_n."""
    w = np.array([[2.0, 1.0, 0.0], [1.0, 4.0, 0.0], [0.0, 0.0, 4.0]])
    r = solve_contacts(w, np.array([-1.0, 10.0, 0.0]), 0.5)
    np.testing.assert_allclose(r, np.array([1.0, -0.5, 0.0]) / 1.5, atol=1e-10)


def random_problem(seed, contacts):
    """A Delassus operator of `contacts` on more degrees of freedom than rows, and free velocities."""
    rng = np.random.default_rng(seed)
    rows = 3 * contacts
    jacobian = rng.normal(size=(rows, rows + 6))
    w = jacobian @ jacobian.T / (rows + 6) + 0.2 * np.eye(rows)
    q = rng.normal(0, 1.0, rows)
    q[::3] -= 0.5
    return w, q


@pytest.mark.parametrize("friction", [0.0, 0.2, 0.7])
@pytest.mark.parametrize("contacts", [1, 4, 15])
def test_natural_map(contacts, friction):
    """Signorini and Coulomb written out, to 1e-10: (u_n, r_n) complementary, friction in the cone,
    against the slip and of full strength where there is slip."""
    statuses = np.zeros(3, int)
    for seed in range(10):
        w, q = random_problem(seed, contacts)
        r = solve_contacts(w, q, friction)
        u = (w @ r + q).reshape(-1, 3)
        r = r.reshape(-1, 3)
        force, slip = np.hypot(r[:, 1], r[:, 2]), np.hypot(u[:, 1], u[:, 2])
        assert (r[:, 0] >= 0).all() and (u[:, 0] > -1e-10).all()
        assert np.abs(r[:, 0] * u[:, 0]).max() < 1e-10
        assert (force <= friction * r[:, 0] + 1e-12).all()
        power = (r[:, 1:] * u[:, 1:]).sum(axis=1)
        np.testing.assert_allclose(power, -friction * r[:, 0] * slip, atol=1e-10)
        pressed, still = r[:, 0] > 1e-8, slip < 1e-9
        statuses += [(~pressed).sum(), (pressed & still).sum(), (pressed & ~still).sum()]
    if contacts > 1:
        assert statuses[0] > 0 and statuses[2] > 0  # open and slipping both occurred
    if contacts > 1 and friction > 0.5:
        assert statuses[1] > 0  # and sticking


@pytest.mark.parametrize("friction", [0.0, 0.3, 0.7])
def test_naive_twin(friction):
    for seed in range(5):
        w, q = random_problem(seed, 5)
        expected = naive_contacts(w, q, friction)
        np.testing.assert_allclose(solve_contacts(w, q, friction), expected, atol=1e-10)


def test_redundant_contacts_share_the_load():
    """Four legs of one body: the operator is singular, the sum of the forces is not."""
    legs = np.array([[1.0, 1, 0], [1, -1, 0], [-1, -1, 0], [-1, 1, 0]])
    jacobian = np.zeros((12, 6))
    for k, arm in enumerate(legs):
        for row, axis in enumerate(np.eye(3)[[2, 0, 1]]):
            jacobian[3 * k + row] = np.concatenate([axis, np.cross(arm, axis)])
    w = jacobian @ np.diag([1.0, 1, 1, 3, 3, 3]) @ jacobian.T
    q = jacobian @ np.array([0.05, 0.0, -1.0, 0.0, 0.0, 0.0])
    r = solve_contacts(w, q, 0.5)
    np.testing.assert_allclose(jacobian.T @ r, [-0.05, 0, 1, 0, 0, 0], atol=1e-11)


def test_unsolved_contacts_are_an_error():
    w, q = random_problem(0, 8)
    with pytest.raises(ArithmeticError, match="contacts not solved: error .* above 1.0e-12"):
        solve_contacts(w, q, 0.5, most_sweeps=3)


def test_no_motion_no_impulse():
    np.testing.assert_array_equal(solve_contacts(np.eye(6), np.zeros(6), 0.5), np.zeros(6))
