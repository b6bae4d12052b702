"""Coupled contacts: closed solutions, the conditions themselves, and problems on which plain sweeps stall."""

from __future__ import annotations

import numpy as np
import pytest
from naive.friction import naive_contacts, naive_natural_map
from scipy import sparse
from theory.assemblies import (
    GRAVITY_STEP,
    arch,
    box_stack,
    spheres_in_a_box,
)

from asphalt_nscd.nscd import solve_contacts
from asphalt_nscd.nscd.contacts.gauss_seidel import sweep_once
from asphalt_nscd.nscd.contacts.problem import ContactProblem

MASSES = np.diag([2.0, 7.0, 7.0])  # 1/kg, a ball of 0.5 kg on a plane


def solved(W, q, mu, tolerance=1e-12):
    return solve_contacts(W, q, mu, tolerance).require_converged().reactions


def check_laws(W, q, mu, r, atol):
    """Signorini and Coulomb written out: (u_n, r_n) complementary, friction within its limit, against
    the slip and of full strength where there is slip. Counts of open, sticking, slipping contacts."""
    u, r = (W @ r + q).reshape(-1, 3), r.reshape(-1, 3)
    force, slip = np.hypot(r[:, 1], r[:, 2]), np.hypot(u[:, 1], u[:, 2])
    speed, impulse = np.abs(q).max(), np.abs(r).max()
    assert (r[:, 0] >= -atol * impulse).all() and (u[:, 0] >= -atol * speed).all()
    assert np.abs(r[:, 0] * u[:, 0]).max() <= atol * speed * impulse
    assert (force <= mu * r[:, 0] + atol * impulse).all()
    power = (r[:, 1:] * u[:, 1:]).sum(axis=1)
    np.testing.assert_allclose(power, -mu * r[:, 0] * slip, rtol=0, atol=atol * speed * impulse)
    pressed, still = r[:, 0] > 1e-7 * impulse, slip < 1e-7 * speed
    return np.array([(~pressed).sum(), (pressed & still).sum(), (pressed & ~still).sum()])


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
    np.testing.assert_allclose(solved(MASSES, free, 0.4), impulse, atol=1e-11)


def test_slip_with_a_coupled_normal():
    """A rod that digs in: W_nt = 1 makes friction press harder, r_n (w_nn - mu w_nt) = -q_n."""
    w = np.array([[2.0, 1.0, 0.0], [1.0, 4.0, 0.0], [0.0, 0.0, 4.0]])
    r = solved(w, [-1.0, 10.0, 0.0], 0.5)
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
def test_laws_of_contact(contacts, friction):
    statuses = np.zeros(3, int)
    for seed in range(10):
        w, q = random_problem(seed, contacts)
        statuses += check_laws(w, q, friction, solved(w, q, friction), 1e-10)
    if contacts > 1:
        assert statuses[0] > 0 and statuses[2] > 0  # open and slipping both occurred
    if contacts > 1 and friction > 0.5:
        assert statuses[1] > 0  # and sticking


@pytest.mark.parametrize("friction", [0.0, 0.3, 0.7])
def test_plain_sweeps_come_to_the_same(friction):
    for seed in range(2):
        w, q = random_problem(seed, 5)
        expected = naive_contacts(w, q, friction)
        np.testing.assert_allclose(solved(w, q, friction), expected, atol=1e-10)


STALLING = {
    "stack": (box_stack(12, kick=1e-2), 0.5),
    "tall stack": (box_stack(20, across=2, size=(0.3, 0.3, 2.0)), 0.3),
    "arch": (arch(21), 0.4),
    "spheres": (spheres_in_a_box(5), 0.3),
    "spheres, much friction": (spheres_in_a_box(4), 0.9),
}


@pytest.mark.parametrize("name", STALLING)
def test_where_plain_sweeps_stall(name):
    """More contacts than the bodies need: 2000 plain sweeps stay above 1e-8, the solver gets there."""
    assembly, mu = STALLING[name]
    problem = ContactProblem.of(assembly.W, assembly.q, mu)
    plain = np.zeros(assembly.q.size)
    for _ in range(2000):
        sweep_once(
            problem.start, problem.other, problem.block, problem.free_velocity, problem.friction, plain
        )
    assert max(problem.errors(plain)) > 1e-8
    solution = solve_contacts(assembly.W, assembly.q, mu, 1e-8)
    assert solution.converged and max(solution.error, solution.scaled_error) <= 1e-8
    check_laws(assembly.W, assembly.q, mu, solution.reactions, 1e-6)
    errors = naive_natural_map(assembly.W.toarray(), assembly.q, mu, solution.reactions)
    np.testing.assert_allclose([solution.error, solution.scaled_error], errors, rtol=0, atol=1e-13)
    np.testing.assert_allclose(solution.velocities, assembly.W @ solution.reactions + assembly.q, atol=1e-15)


def test_each_contact_has_its_own_friction():
    """Two contacts without coupling: one sticks, the other slips."""
    w = sparse.block_diag([MASSES, MASSES]).tobsr((3, 3))
    r = solved(w, [-2.0, 1.4, 0.0, -2.0, 1.4, 0.0], np.array([0.4, 0.1]))
    np.testing.assert_allclose(r, [1.0, -0.2, 0.0, 1.0, -0.1, 0.0], atol=1e-11)


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_units_do_not_matter(factor):
    """With masses a million times smaller or larger, reactions are so, too, and are solved as well."""
    stack = box_stack(3)
    r = solve_contacts(stack.W * factor, stack.q, 0.5, 1e-9)
    assert r.converged
    check_laws(stack.W * factor, stack.q, 0.5, r.reactions, 1e-7)
    assert factor * r.reactions.reshape(3, 9, 3)[0, :, 0].sum() == pytest.approx(
        3 * stack.mass[0] * GRAVITY_STEP, rel=1e-8
    )


@pytest.mark.parametrize("steps", [0, 3])
def test_what_is_not_solved_is_said(steps):
    """Stopped early: not converged, with the error of what is returned; demanding it raises."""
    stack = box_stack(8, kick=1e-2)
    solution = solve_contacts(stack.W, stack.q, 0.5, 1e-8, most_sweeps=3, most_steps=steps)
    assert not solution.converged and solution.scaled_error > 1e-8
    errors = naive_natural_map(stack.W.toarray(), stack.q, 0.5, solution.reactions)
    np.testing.assert_allclose([solution.error, solution.scaled_error], errors, rtol=1e-9)
    with pytest.raises(ArithmeticError, match="contacts not solved: error .* after .* iterations"):
        solution.require_converged()


@pytest.mark.parametrize(
    "W",
    [
        np.zeros((3, 3)),  # between two bodies that cannot move, driven together
        np.array([[1.0, 3.0, 0.0], [3.0, 9.0, 0.0], [0.0, 0.0, 1.0]]),  # Painlevé: w_nn < mu w_nt
    ],
)
def test_without_a_solution_none_is_claimed(W):
    """However large the reactions grow, in which an error relative to them would vanish."""
    solution = solve_contacts(W, [-1.0, 1.0, 0.0], 0.5)
    assert not solution.converged and solution.scaled_error > 1e-4


@pytest.mark.parametrize("seed", range(12))
def test_of_an_indefinite_matrix_nothing_false_is_claimed(seed):
    """Sweeps diverge there, beyond all numbers."""
    rng = np.random.default_rng(seed)
    W, q = rng.normal(size=(18, 18)), rng.normal(size=18)
    W, q[::3] = W + W.T, q[::3] - 0.5
    solution = solve_contacts(W, q, 0.5, most_steps=20)
    with np.errstate(invalid="ignore"):  # there is no length where the trace is negative
        true = naive_natural_map(W, q, 0.5, solution.reactions)[0] < 1e-7
    assert true or not solution.converged


def test_no_part_hides_behind_another():
    """A body squeezed by two walls, and one that stops at a speed a million times higher."""
    squeezed = np.eye(6)
    squeezed[0, 3] = squeezed[3, 0] = -1.0
    W = sparse.block_diag([squeezed, 1e-6 * np.eye(3)])
    q = [-1.0, 0, 0, -1.0, 0, 0, -1e6, 0, 0]
    assert not solve_contacts(W, q, 0.5).converged


@pytest.mark.parametrize("size", [1e-300, 1e-160, 1e160, 1e300])
def test_reactions_are_proportional_to_velocities_of_any_size(size):
    w, q = np.diag([2.0, 3.0, 4.0]), np.array([-1.0, 0.5, 0.1])
    solution = solve_contacts(w, size * q, 0.5)
    expected = solve_contacts(w, q, 0.5)
    np.testing.assert_allclose(solution.reactions / size, expected.reactions, rtol=1e-13)
    np.testing.assert_allclose(solution.velocities / size, expected.velocities, rtol=1e-13, atol=1e-15)
    assert solution.converged


@pytest.mark.parametrize(
    ("W", "q", "mu", "message"),
    [
        (np.eye(6), np.zeros(3), 0.5, "three rows for each contact"),
        (np.eye(4), np.zeros(4), 0.5, "three rows for each contact"),
        (np.eye(6), np.zeros(6), [0.5], "one for each of the 2 contacts"),
        (np.eye(3), [np.nan, 0, 0], 0.5, "finite"),
        (np.eye(3), np.zeros(3), -0.5, "negative"),
        (1j * np.eye(3), np.zeros(3), 0.5, "real"),
        (1e160 * np.eye(3), -np.ones(3), 0.5, "units"),
        (1e-160 * np.eye(3), -np.ones(3), 0.5, "units"),
    ],
)
def test_no_contact_problem(W, q, mu, message):
    with pytest.raises(ValueError, match=message):
        solve_contacts(W, q, mu)


@pytest.mark.parametrize("tolerance", [0.0, -1e-8, np.nan, np.inf, 1.0])
def test_no_tolerance(tolerance):
    with pytest.raises(ValueError, match="tolerance"):
        solve_contacts(np.eye(3), -np.ones(3), 0.5, tolerance)
