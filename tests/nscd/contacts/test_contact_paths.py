"""Newton's method and the interior path: derivatives by differences, the algebra of the cone, convergence."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest
from naive.friction import nearest_in_cone
from theory.assemblies import box_stack, spheres_in_a_box

from asphalt_nscd.nscd.contacts import interior, newton
from asphalt_nscd.nscd.contacts.newton import linearised, refine
from asphalt_nscd.nscd.contacts.problem import ContactProblem
from asphalt_nscd.nscd.contacts.proximal import NEAR, proximal_points, softened


def random_problem(seed, friction=0.5, contacts=8):
    rng = np.random.default_rng(seed)
    jacobian = rng.normal(size=(3 * contacts, 3 * contacts + 4))
    q = rng.normal(-0.3, 1.0, 3 * contacts)
    return ContactProblem.of(jacobian @ jacobian.T / contacts, q, friction), rng


def cone_points(rng, count=20):
    tangential = rng.normal(size=(count, 2))
    return np.column_stack([np.hypot(*tangential.T) + rng.exponential(size=count), tangential])


def arrow(x):
    """Matrix of the Jordan product with x."""
    matrix = x[0] * np.eye(3)
    matrix[0, 1:] = matrix[1:, 0] = x[1:]
    return matrix


@pytest.mark.parametrize("friction", [0.0, 0.5, 2.0])
def test_residual_and_derivative(friction):
    """F is the natural map of each contact; dF = D dr + B W dr by central differences."""
    problem, rng = random_problem(0, friction)
    r = rng.normal(size=24)
    residual, by_reaction, by_velocity = linearised(problem, r)
    u = problem.velocity(r).reshape(-1, 3)
    for c, point in enumerate(r.reshape(-1, 3)):
        shifted = u[c] + [friction * np.hypot(u[c, 1], u[c, 2]), 0, 0]
        nearest = nearest_in_cone(point - problem.length[c] * shifted, friction)
        np.testing.assert_allclose(residual[3 * c : 3 * c + 3], point - nearest, atol=1e-13)
    direction, h = rng.normal(size=24), 1e-7
    change = (linearised(problem, r + h * direction)[0] - linearised(problem, r - h * direction)[0]) / (2 * h)
    du = (problem.matrix @ direction).reshape(-1, 3)
    predicted = np.einsum("aij,aj->ai", by_reaction, direction.reshape(-1, 3))
    predicted += np.einsum("aij,aj->ai", by_velocity, du)
    np.testing.assert_allclose(change, predicted.ravel(), atol=1e-6 * np.abs(change).max())


def test_a_step_of_newton_solves_the_linearised_equations_with_open_contacts_too():
    """(D + B (W + proximal / rho)) d = -F, in full."""
    problem, rng = random_problem(2)
    residual, by_reaction, by_velocity = linearised(problem, r := rng.normal(size=24))
    opened = np.abs(by_velocity).sum(axis=(1, 2)) == 0.0
    assert 0 < opened.sum() < 8
    direction = newton._newton_direction(problem, residual, by_reaction, by_velocity, 0.1)
    change = problem.matrix @ direction + 0.1 / np.repeat(problem.length, 3) * direction
    left = np.einsum("aij,aj->ai", by_reaction, direction.reshape(-1, 3))
    left += np.einsum("aij,aj->ai", by_velocity, change.reshape(-1, 3))
    np.testing.assert_allclose(left.ravel(), -residual, atol=1e-10 * np.abs(residual).max())


def test_newton_sharpens():
    """From a path stopped at 1e-4 two steps of quadratic gain reach 1e-12."""
    problem, _ = random_problem(1)
    path = interior.interior_path(problem, 3.0, 0.0)
    rough = next(r for r in path if max(problem.errors(r)) < 1e-4)
    assert max(problem.errors(rough)) > 1e-9
    r, steps = refine(problem, rough, 1e-12)
    assert max(problem.errors(r)) < 1e-12 and steps <= 2


def test_path_through_redundant_contacts():
    stack = box_stack(5, kick=1e-2)
    problem = ContactProblem.of(stack.W, stack.q, 0.5)
    path = islice(interior.interior_path(problem, 3.0, 0.0), 40)
    errors = [max(problem.errors(r)) for r in path]
    assert min(errors) < 1e-6


def test_scaling():
    """Nesterov and Todd's: symmetric, S x = S^-1 y."""
    rng = np.random.default_rng(2)
    x, y = cone_points(rng), cone_points(rng)
    for s, x_one, y_one in zip(interior._scaling(y, x), x, y, strict=True):
        np.testing.assert_allclose(s, s.T, rtol=1e-14)
        np.testing.assert_allclose(s @ s @ x_one, y_one, rtol=1e-10, atol=1e-10)


def test_jordan_algebra():
    rng = np.random.default_rng(3)
    x, y = cone_points(rng), rng.normal(size=(20, 3))
    expected = [arrow(a) @ b for a, b in zip(x, y, strict=True)]
    np.testing.assert_allclose(interior._product(x, y), expected, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(interior._divide(x, np.array(expected)), y, rtol=1e-9, atol=1e-9)


def test_reach():
    """At the step it allows, the first point is on the boundary, and none is beyond."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        x, dx = cone_points(rng, 3), rng.normal(size=(3, 3))
        reach = interior._reach(x, dx)
        if np.isfinite(reach):
            end = x + reach * dx
            distance = end[:, 0] - np.hypot(end[:, 1], end[:, 2])
            assert abs(distance.min()) < 1e-8
    assert interior._reach(np.array([[1.0, 0.0, 0.0]]), np.array([[1.0, 0.5, 0.0]])) == np.inf


def test_softened_problem_has_the_solution_of_the_problem_where_it_stays():
    problem, rng = random_problem(4)
    r, x = rng.normal(size=24), rng.normal(size=24)
    soft = softened(problem, 0.3, r)
    damped = 0.3 / np.repeat(problem.length, 3)
    np.testing.assert_allclose(soft.velocity(x), problem.velocity(x) + damped * (x - r), atol=1e-12)
    np.testing.assert_allclose(soft.velocity(r), problem.velocity(r), atol=1e-12)
    # The blocks that sweeps see are those of the matrix.
    own = soft.matrix.toarray()[6:9, 6:9]
    np.testing.assert_allclose(soft.block[soft.own[2]], own, atol=1e-14)


def test_each_point_is_solved_to_a_share_of_what_the_problem_itself_lacks(monkeypatch):
    problem, _ = random_problem(4)
    asked, sweeps = [], ContactProblem.sweeps

    def watched(soft, aim, most, r):
        asked.append((aim, max(0.1 * 1e-8, NEAR * max(problem.errors(r)))))
        return sweeps(soft, aim, most, r)

    monkeypatch.setattr(ContactProblem, "sweeps", watched)
    proximal_points(problem, np.zeros(24), 1e-8, 6)
    aims, expected = zip(*asked)
    assert len(aims) > 2
    np.testing.assert_array_equal(aims, expected)


@pytest.mark.parametrize("cells, seed, friction", [(3, 10, 0.9), (3, 7, 1.2)])
def test_rough_spheres_that_no_interior_path_solves(cells, seed, friction):
    """Reactions of a pile held between walls, by proximal points alone."""
    pile = spheres_in_a_box(cells, seed=seed)
    problem = ContactProblem.of(pile.W, pile.q, friction)
    found, sweeps, _ = proximal_points(problem, np.zeros_like(problem.free_velocity), 1e-8, 400)
    assert max(problem.errors(found)) <= 1e-8 and sweeps > 500
    few, _, _ = proximal_points(problem, np.zeros_like(problem.free_velocity), 1e-8, 2)
    assert 1e-8 < max(problem.errors(few)) < max(problem.errors(np.zeros_like(few)))
