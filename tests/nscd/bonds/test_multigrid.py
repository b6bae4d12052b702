"""Multigrid beside factors: the same solutions, and chosen where factors would not fit."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from asphalt_nscd.nscd.bonds import implicit_operator as shifted
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.statics import static_motion
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.reduced_model import SHIFT, ritz_basis
from asphalt_nscd.specimen.system import bending_system

LAW = BondLaw(24.3e9, 3.71e9, np.array([48.4e9]), np.array([0.773e9]))


@pytest.fixture(scope="module", params=["free", "blocked"])
def system(request, make_beam):
    return bending_system(make_beam(shape=(4, 4, 14)), 0.35, 2.7e6, 0.7, head=request.param)


def test_rigid_motions_open_no_bond_between_spheres(system):
    """All bonds but those of the fixed foot; three translations and three rotations, independent."""
    motions = system.rigid_motions()
    assert motions.shape == (system.mass.size, 6) and np.linalg.matrix_rank(motions) == 6
    if system.mass.size % 6:
        return  # a blocked head does not rotate with the rest
    whole = np.diff(system.operator.indptr) == 12
    opening = np.abs(system.operator @ motions)[whole]
    assert whole.sum() > 500 and opening.max() < 1e-15


def test_the_solutions_of_factors(system):
    free = system.free
    matrix = (system.stiffness() + SHIFT * sparse.diags_array(system.mass)).tocsc()[free][:, free]
    rng = np.random.default_rng(1)
    force = rng.normal(size=(free.size, 3)) * np.sqrt(matrix.diagonal())[:, None]
    expected = shifted.factorise(matrix, system).solve(force)
    multigrid = Multigrid(matrix, system.rigid_motions()[free])
    assert len(multigrid.levels.levels) > 1
    np.testing.assert_allclose(multigrid.solve(force), expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    np.testing.assert_array_equal(multigrid.solve(force[:, 0]), multigrid.solve(force)[:, 0])


def test_the_same_to_the_bit_whatever_has_been_drawn_before(system):
    """Spectral radii are estimated from random vectors; the generator of the caller is left as it was."""
    free = system.free
    matrix = (system.stiffness() + SHIFT * sparse.diags_array(system.mass)).tocsc()[free][:, free]
    force, found = np.sqrt(matrix.diagonal()), []
    for seed in (1, 2):
        np.random.seed(seed)
        found.append(Multigrid(matrix, system.rigid_motions()[free]).solve(force))
        assert np.random.rand() == np.random.RandomState(seed).rand()
    np.testing.assert_array_equal(*found)


def test_static_solutions_are_no_iteration_within_another(system, monkeypatch):
    """Solved once for each Krylov vector; for static ones, cycles precondition."""
    monkeypatch.setattr(shifted, "LARGEST_FACTORED", system.free.size - 1)
    solved = []
    solve = Multigrid.solve
    monkeypatch.setattr(
        Multigrid, "solve", lambda self, force: solved.append(force.shape) or solve(self, force)
    )
    ritz_basis(system, 2)
    assert [shape for shape in solved if len(shape) == 2] == [(system.free.size, 2)] * 2
    assert len(solved) == 2 + 4


def test_a_static_motion_leaves_no_force_on_what_is_free(system, monkeypatch):
    """To thirteen digits, though multigrid alone solves to twelve."""
    monkeypatch.setattr(shifted, "LARGEST_FACTORED", system.free.size - 1)
    motion, head = static_motion(system), np.zeros(system.mass.size)
    head[system.driven] = 1.0
    left, begun = (
        (system.operator.T @ (system.weight * (system.operator @ u)))[system.free] for u in (motion, head)
    )
    assert np.linalg.norm(left) < 1e-13 * np.linalg.norm(begun)


def test_a_test_without_factors(system, monkeypatch):
    """Steps of the full system and the reduced basis, the same to 1e-8 where factors are too large."""

    def run():
        stepper = CondensedStepper(system, LAW, 5e-5, CondensedState.rest_state(system, LAW))
        force = [stepper.advance(v) for v in (1e-3, 2e-3, -1e-3)]
        return type(stepper._operator._factor).__name__, np.array(force), ritz_basis(system, 3)

    direct, force, basis = run()
    monkeypatch.setattr(shifted, "LARGEST_FACTORED", system.free.size - 1)
    other, its_force, its_basis = run()
    assert (direct, other) == ("SuperLU", "Multigrid")
    np.testing.assert_allclose(its_force, force, rtol=1e-8)
    root = np.sqrt(system.weight)[:, None]  # the same space: projections on one another
    spaces = [np.linalg.qr(root * (system.operator @ b[:, 1:]))[0] for b in (basis, its_basis)]
    assert np.linalg.svd(spaces[0].T @ spaces[1], compute_uv=False).min() > 1 - 1e-6
    np.testing.assert_allclose(its_basis[:, 0], basis[:, 0], rtol=0, atol=1e-8)
