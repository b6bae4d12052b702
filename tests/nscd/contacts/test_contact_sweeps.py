"""The compiled sweeps and error against their naive twins, to rounding."""

from __future__ import annotations

import numpy as np
import pytest
from naive.friction import naive_extrapolation, naive_natural_map, naive_sweep, nearest_in_cone, one_contact
from scipy import sparse

from asphalt_nscd.nscd.contacts import coulomb
from asphalt_nscd.nscd.contacts import gauss_seidel as kernels
from asphalt_nscd.nscd.contacts.problem import ContactProblem


def random_problem(seed, contacts=6):
    rng = np.random.default_rng(seed)
    jacobian = rng.normal(size=(3 * contacts, 3 * contacts + 4))
    return jacobian @ jacobian.T / contacts, rng.normal(-0.3, 1.0, 3 * contacts), rng


@pytest.mark.parametrize("friction", [0.0, 0.3, 0.8])
def test_one_contact(friction):
    """Full blocks; those for which friction this strong has one solution only: small W_nt."""
    rng = np.random.default_rng(3)
    seen = set()
    for _ in range(60):
        factor = rng.normal(size=(3, 6))
        w = factor @ factor.T + 3.0 * np.eye(3)
        q = rng.normal(-0.5, 1.0, 3)
        expected = one_contact(w, q, friction)
        found = np.array(coulomb.one_contact(w, *q, friction))
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13)
        slip = np.linalg.norm((w @ found + q)[1:]) > 1e-12
        seen.add("open" if found[0] == 0 else "slip" if slip else "stick")
    assert seen == ({"open", "slip"} if friction == 0.0 else {"open", "slip", "stick"})


def test_one_contact_without_tangential_motion():
    """A sphere pressed head-on whose block is singular in the tangential plane."""
    assert coulomb.one_contact(np.diag([2.0, 0.0, 0.0]), -2.0, 0.0, 0.0, 0.3) == (1.0, 0.0, 0.0)
    n, t, s = coulomb.one_contact(np.diag([2.0, 0.0, 0.0]), -2.0, 3.0, 4.0, 0.5)  # slips
    np.testing.assert_allclose((n, t, s), (1.0, -0.3, -0.4), rtol=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_sweep(friction):
    w, q, _ = random_problem(1)
    problem = ContactProblem.of(w, q, friction)
    r, expected = np.zeros(q.size), np.zeros(q.size)
    for _ in range(3):
        kernels.sweep_once(problem.start, problem.other, problem.block, q, problem.friction, r)
        expected = naive_sweep(w, q, friction, expected)
        np.testing.assert_allclose(r, expected, rtol=0, atol=1e-12)
    assert np.abs(r).max() > 0.1


def test_natural_map():
    """On reactions that solve nothing, so that both errors are of order one."""
    for seed in range(5):
        w, q, rng = random_problem(seed)
        mu, r = rng.uniform(0.0, 1.0, 6), rng.normal(size=q.size)
        found = ContactProblem.of(w, q, mu).errors(r)
        np.testing.assert_allclose(found, naive_natural_map(w, q, mu, r), rtol=1e-13)
        assert min(found) > 0.05


def test_natural_map_of_parts():
    """Unitless, a part that W does not couple to the others counts by itself, unless hardly anything moves in it."""
    w, q, rng = random_problem(3)
    r = rng.normal(size=q.size)
    alone = naive_natural_map(w, q, 0.4, r)[1]
    both = sparse.block_diag([w, np.eye(3)]).tocsr()
    for speed, seen in ((1e5, 1.0), (1e14, 0.0)):  # of a contact apart that is solved
        q_both, r_both = np.array([*q, -speed, 0, 0]), np.array([*r, speed, 0, 0])
        scaled = ContactProblem.of(both, q_both, 0.4).errors(r_both)[1]
        assert scaled == pytest.approx(seen * alone, rel=1e-12, abs=1e-3 * alone * (1.0 - seen))
        assert scaled > 0.0


@pytest.mark.parametrize("friction", [0.0, 0.4, 3.0])
def test_projection(friction):
    for z in np.random.default_rng(2).normal(size=(40, 3)):
        found = coulomb.project_on_cone(*z, friction)
        np.testing.assert_allclose(found, nearest_in_cone(z, friction), rtol=0, atol=1e-14)


def extrapolated(results, changes, room=5):
    """The kernel's, from results and changes in order; the room for more holds what must not be read."""
    of_results, of_changes = np.full((2, room, results.shape[1]), 7.0)
    kept = len(results) - 1
    of_results[:kept], of_changes[:kept] = np.diff(results, axis=0), np.diff(changes, axis=0)
    return kernels.extrapolated(
        results[-1], changes[-1], of_results, of_changes, of_changes @ of_changes.T, kept
    )


@pytest.mark.parametrize("count", [1, 2, 6])
def test_extrapolation(count):
    rng = np.random.default_rng(4)
    results, changes = rng.normal(size=(2, count, 9))
    expected = naive_extrapolation(results, changes) if count > 1 else results[0]
    np.testing.assert_allclose(extrapolated(results, changes), expected, rtol=1e-11)


@pytest.mark.parametrize("sweeps", [1, 4, 12])
def test_accelerated_sweeps(sweeps):
    """The same numbers as sweeps and extrapolations written out, with more of them than are kept."""
    w, q, _ = random_problem(7, contacts=10)
    problem = ContactProblem.of(w, q, 0.4)
    weight = np.repeat(1 / np.sqrt(problem.length), 3)
    r, results, changes = np.zeros(q.size), [], []
    for _ in range(sweeps):
        results.append(naive_sweep(w, q, 0.4, r))
        changes.append(weight * (results[-1] - r))
        r = results[-1]
        if len(results) > 1:
            r = naive_extrapolation(
                np.array(results[-kernels._DEPTH - 1 :]), np.array(changes[-kernels._DEPTH - 1 :])
            )
    sizes = np.linalg.norm(changes, axis=1)
    assert (sizes[1:] < 2 * sizes[:-1]).all()  # none led astray, for which there is another way
    found, count = problem.sweeps(0.0, sweeps, np.zeros(q.size))
    assert count == sweeps
    np.testing.assert_allclose(found, results[-1], rtol=0, atol=1e-9)


def test_accelerated_sweeps_return_the_best_and_stop():
    w, q, _ = random_problem(7)
    problem = ContactProblem.of(w, q, 0.4)
    nothing = np.zeros(q.size)
    r, sweeps = problem.sweeps(1e-10, 500, nothing)
    assert sweeps < 100 and max(problem.errors(r)) <= 1e-10
    r, sweeps = problem.sweeps(1e-10, 2, nothing)
    assert sweeps == 2 and 1e-10 < max(problem.errors(r)) < max(problem.errors(np.zeros_like(r)))
    solved, _ = problem.sweeps(1e-10, 500, nothing)
    r, sweeps = problem.sweeps(1e-10, 500, solved)
    assert sweeps == 1 and max(problem.errors(r)) <= 1e-10
    _, sweeps = problem.sweeps(0.0, 10_000, nothing)
    assert sweeps < 1000  # rounding is reached: no progress, no end
