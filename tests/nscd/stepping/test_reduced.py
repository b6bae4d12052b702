"""The Ritz basis and the projected system."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, append_columns, ritz_basis


def test_first_column_is_the_static_response(beam_system):
    """Unit motion of the drive, no force on any free degree of freedom; the others leave the drive alone."""
    basis = ritz_basis(beam_system, 4)
    force = beam_system.stiffness() @ basis[:, 0]
    assert basis[beam_system.driven, 0] == 1.0
    coupling = beam_system.stiffness()[:, [beam_system.driven]].toarray()[beam_system.free]
    assert np.abs(force[beam_system.free]).max() < 1e-12 * np.linalg.norm(
        coupling
    )  # conjugate gradients: 1e-13
    assert not basis[beam_system.driven, 1:].any()


@pytest.mark.parametrize("iterations", [0, 4, 12, 25])
def test_basis_is_orthonormal_in_the_stiffness(beam_system, iterations):
    """Two chains of Krylov vectors and the static sag; orthonormal to rounding however many there are.

    Column 0 is orthogonal to the others as well: they do not move the drive.
    """
    basis = ritz_basis(beam_system, iterations)
    assert basis.shape[1] == 2 + 2 * iterations
    gram = basis.T @ (beam_system.stiffness() @ basis)
    gram[0, 0] = 1.0
    np.testing.assert_allclose(gram, np.eye(gram.shape[0]), rtol=0, atol=1e-11)


def test_columns_without_a_direction_of_their_own_are_left_out(beam_system):
    basis = ritz_basis(beam_system, 2)
    rng = np.random.default_rng(1)
    fresh = rng.normal(size=basis.shape[0])
    fresh[beam_system.driven] = 0.0
    extra = np.column_stack([basis[:, 2] - 3 * basis[:, 4], fresh, 2 * fresh + basis[:, 1], 0 * fresh])
    wider = append_columns(beam_system, basis, extra)
    assert wider.shape[1] == basis.shape[1] + 1
    np.testing.assert_array_equal(wider[:, :-1], basis)
    inner = wider[:, 1:].T @ (beam_system.stiffness() @ wider[:, -1])
    np.testing.assert_allclose(inner, np.eye(wider.shape[1] - 1)[-1], atol=1e-11)


def test_nearly_dependent_columns_come_out_orthonormal(beam_system):
    """A column that differs by 1e-7 from one in the basis: what is left of it is mostly cancellation."""
    basis = ritz_basis(beam_system, 3)
    fresh = np.random.default_rng(2).normal(size=basis.shape[0])
    fresh[beam_system.driven] = 0.0
    fresh /= np.sqrt(fresh @ (beam_system.stiffness() @ fresh))
    wider = append_columns(beam_system, basis, (basis[:, 3] + 1e-7 * fresh)[:, None])
    gram = wider[:, 1:].T @ (beam_system.stiffness() @ wider[:, 1:])
    np.testing.assert_allclose(gram, np.eye(gram.shape[0]), rtol=0, atol=1e-10)


@pytest.mark.parametrize("broken", [(), (2, 30, 77)])
def test_projected_operators(beam_system, broken):
    system, basis = beam_system, ritz_basis(beam_system, 3)
    model = ReducedModel(system, basis, broken)
    weight = system.weight.copy()
    for bond in broken:
        weight[3 * bond : 3 * bond + 3] = 0.0
    rng = np.random.default_rng(3)
    a, s = rng.normal(size=(2, basis.shape[1])) * [[1e-3], [1e3]]
    np.testing.assert_allclose(model.mass, basis.T @ np.diag(system.mass) @ basis, rtol=1e-12, atol=1e-15)
    stiffness = basis.T @ system.stiffness(weight) @ basis
    np.testing.assert_allclose(model.stiffness, stiffness, rtol=0, atol=1e-12)

    # the small triangular factor gives the norm of the full residual
    sigma = (system.operator @ basis) @ s
    missing = (system.mass * (basis @ a) - system.load - system.operator.T @ (weight * sigma))[system.free]
    diagonal = system.stiffness().diagonal()[system.free]
    expected = np.linalg.norm(missing / np.sqrt(diagonal))
    found = np.linalg.norm(model.residual_factor @ np.concatenate([a, s, [1.0]]))
    assert found == pytest.approx(expected, rel=1e-11)
    column = (system.operator.T @ (system.weight * system.operator[:, [system.driven]].toarray()[:, 0]))[
        system.free
    ]
    assert model.head_norm == pytest.approx(np.linalg.norm(column / np.sqrt(diagonal)), rel=1e-13)
    assert model.load_norm == pytest.approx(
        np.linalg.norm(system.load[system.free] / np.sqrt(diagonal)), rel=1e-13
    )

    # shares of strength and of gaps
    reaction = (weight * sigma).reshape(-1, 3)
    finite = np.flatnonzero(np.isfinite(system.strength))
    own = model.reaction_of(finite) @ s * system.strength[finite, None]
    np.testing.assert_allclose(own, reaction[finite], rtol=0, atol=1e-12 * np.abs(reaction).max())
    everywhere = np.arange(system.gap.size)
    assert not model.reaction_of(np.setdiff1d(everywhere, finite)).any()
    closing = model.closing_of(everywhere) @ s * system.gap
    np.testing.assert_allclose(closing, -sigma[::3], rtol=0, atol=1e-12 * np.abs(sigma).max())


def test_bounds_hold_everywhere_in_the_envelope(beam_system):
    """No state within the envelope exceeds the bound, and none outside the candidates yields or closes."""
    model = ReducedModel(beam_system, ritz_basis(beam_system, 3))
    rng = np.random.default_rng(4)
    k = model.basis.shape[1]
    sigma, motion = 10 ** rng.uniform(2, 5, k), 10 ** rng.uniform(-5, -3, k)
    bound = model.bounds.utilisation(sigma)
    may_yield, may_close = model.bounds.candidates(sigma, motion)
    assert 0 < may_yield.size < bound.size and 0 < may_close.size < bound.size
    for _ in range(200):
        s, q = sigma * rng.choice([-1, 1, 0.3], k), motion * rng.choice([-1, 1, 0.3], k)
        share = beam_system.utilisation(model.weight * (model.opening @ s))
        assert (share <= bound * (1 + 1e-12)).all()
        assert np.isin(np.flatnonzero(share > 1.0), may_yield).all()
        head, others = model.bounds.head_bounds(np.arange(share.size), sigma).T
        assert (share <= (head * abs(s[0]) + others) * (1 + 1e-12)).all()
        closed = beam_system.gap + model.opening[::3] @ q < 0
        assert np.isin(np.flatnonzero(closed), may_close).all()
        assert (beam_system.gap + model.opening[::3] @ q).min() >= model.bounds.smallest_gap(motion) - 1e-18


def test_naive_twin_of_the_bounds(beam_system):
    """One coordinate at a time: the norm of the reactions over the strength, the closing over the gap."""
    model = ReducedModel(beam_system, ritz_basis(beam_system, 2), broken=[11])
    for a, unit in enumerate(np.eye(model.basis.shape[1])):
        reaction = (model.weight * model.opening[:, a]).reshape(-1, 3)
        found, wanted = (
            model.bounds.utilisation(unit),
            np.linalg.norm(reaction, axis=1) / beam_system.strength,
        )
        np.testing.assert_allclose(found, wanted, rtol=1e-13)  # processors differ in the last bit
        gap = (beam_system.gap - np.abs(model.opening[::3, a])).min()
        assert model.bounds.smallest_gap(unit) == pytest.approx(gap, rel=1e-13)


def test_a_direction_whose_square_vanishes_adds_nothing(beam_system):
    """1e-170 squared is zero: divided by its length of zero it ended in NaN."""
    basis = ritz_basis(beam_system, 1)
    extra = np.zeros((basis.shape[0], 3))
    extra[beam_system.free[:3], [0, 1, 2]] = [1.0, 1e-170, 2.0]
    larger = append_columns(beam_system, basis, extra)
    assert larger.shape[1] == basis.shape[1] + 2 and np.isfinite(larger).all()
