"""Directions kept ready for breaks: the small matrices they are taken in by, and what they save."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve

from asphalt_nscd.nscd.stepping.break_modes import StandBy
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.projection import Projection
from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis, shifted_factor
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper

DT = 5e-5
AMPLITUDE = 4e-5
READY = 12  # bonds: in so short a beam others break than in one of full size
DRIVEN = AMPLITUDE * np.sin(2 * np.pi * 40.0 * DT * np.arange(271))


@pytest.fixture(scope="module")
def basis(beam_system):
    return ritz_basis(beam_system, 12)


@pytest.fixture(scope="module")
def stand_by(beam_system, basis):
    return StandBy.of(beam_system, basis, shifted_factor(beam_system), READY)


@pytest.mark.parametrize("places", [[], [1], [3, 0, 2]])
def test_combination_of_a_projection(beam_system, basis, places):
    """Columns mixed and bonds removed in small matrices, against a projection of the mixed columns of the
    system without these bonds."""
    rng = np.random.default_rng(5)
    removable = [40, 7, 90, 22]
    mixing = rng.normal(size=(basis.shape[1], 9))
    found = Projection.of(beam_system, basis, [], removable).combined(mixing, np.array(places, int))
    expected = Projection.of(beam_system, basis @ mixing, [removable[place] for place in places])
    for name in ("mass", "stiffness", "load", "head_norm", "load_norm"):
        wanted = getattr(expected, name)
        np.testing.assert_allclose(getattr(found, name), wanted, rtol=0, atol=1e-12 * np.abs(wanted).max())
    for motion in rng.normal(size=(5, 19)) * np.repeat([1e-3, 1e3, 1.0], [9, 9, 1]):
        missing = np.linalg.norm(expected.residual_factor @ motion)
        assert np.linalg.norm(found.residual_factor @ motion) == pytest.approx(missing, rel=1e-12)


def test_bonds_are_kept_ready_in_the_order_in_which_they_would_break(beam_system, stand_by):
    """Each is the most stressed of the static solution without those before it, by the full equations."""
    free, driven, operator = beam_system.free, beam_system.driven, beam_system.operator
    weight = beam_system.weight.copy()
    assert stand_by.bonds.size == READY
    unbroken = None
    for bond in stand_by.bonds[:3]:
        stiffness = (operator.T @ sparse.diags_array(weight) @ operator).tocsc()
        motion = np.zeros(beam_system.mass.size)
        motion[driven] = 1.0
        motion[free] = spsolve(stiffness[free][:, free], -stiffness[free][:, [driven]].toarray()[:, 0])
        reaction = (weight * (operator @ motion)).reshape(-1, 3)
        shear = np.hypot(reaction[:, 1], reaction[:, 2])
        stress = np.maximum(np.abs(reaction[:, 0]), shear) / beam_system.strength
        assert bond == np.argmax(stress)
        unbroken = stress if unbroken is None else unbroken
        weight[3 * bond : 3 * bond + 3] = 0.0
    order = np.argsort(-unbroken, kind="stable")
    assert not np.isin(stand_by.bonds[:3], order[:20]).all()  # redistribution brings others forward
    assert np.isfinite(beam_system.strength[stand_by.bonds]).all()


def test_model_without_two_bonds(beam_system, basis, stand_by):
    """As if projected anew; the basis itself stands first and unchanged, all of it orthonormal."""
    broken = stand_by.bonds[[4, 1]].tolist()
    model = stand_by.model(beam_system, basis, broken)
    np.testing.assert_array_equal(model.basis[:, : basis.shape[1]], basis)
    anew = Projection.of(beam_system, model.basis, broken)
    for name in ("mass", "stiffness", "load"):
        wanted = getattr(anew, name)
        np.testing.assert_allclose(getattr(model, name), wanted, rtol=0, atol=1e-11 * np.abs(wanted).max())
    whole = Projection.of(beam_system, model.basis, []).stiffness[1:, 1:]
    np.testing.assert_allclose(whole, np.eye(whole.shape[0]), rtol=0, atol=1e-10)
    assert not model.weight.reshape(-1, 3)[broken].any()
    other = int(np.setdiff1d(np.arange(beam_system.gap.size), stand_by.bonds)[0])
    assert stand_by.model(beam_system, basis, [broken[0], other]) is None


def run(system, law, basis, stand_by, driven=DRIVEN):
    """(force, stepper) with every step checked to 1e-6."""
    stepper = ReducedStepper(stand_by.model(system, basis, []), law, DT, 1e-6, stand_by=stand_by)
    return stepper.run(driven)[0], stepper


def in_full(system, law, driven=DRIVEN):
    stepper = CondensedStepper(system, law, DT, CondensedState.rest_state(system, law))
    return np.array([stepper.advance(v) for v in np.diff(driven, prepend=0.0) / DT]), stepper


def test_breaks_without_a_factorisation(beam_system, quick_law, basis, stand_by):
    """Bonds break as in the full system, one enrichment each, and no factor is ever made."""
    reference, complete = in_full(beam_system, quick_law)
    force, stepper = run(beam_system, quick_law, basis, stand_by)
    assert len(complete.state.broken) >= 2
    assert stepper.state.broken == complete.state.broken
    assert stepper.enrichments == len(complete.state.broken)
    assert stepper._operator is None
    np.testing.assert_allclose(force, reference, rtol=0, atol=1e-7 * np.abs(reference).max())
    certificate = stepper.certificate()
    assert certificate.largest_residual <= 1e-6 and certificate.largest_utilisation <= 1.0


def keeping(stand_by, system, basis, bonds):
    """With the directions of these bonds only."""
    places = [np.flatnonzero(stand_by.bonds == bond)[0] for bond in bonds]
    blocks = [stand_by.directions[:, stand_by.owner == place] for place in places]
    directions = np.hstack([np.empty((basis.shape[0], 0), np.float32), *blocks])
    owner = np.repeat(np.arange(len(bonds)), [block.shape[1] for block in blocks])
    projection = Projection.of(system, np.hstack([basis, directions]), [], bonds)
    return replace(
        stand_by, bonds=np.array(bonds, int), owner=owner, directions=directions, projection=projection
    )


@pytest.mark.parametrize("kept", [0, 1])
def test_directions_are_found_when_a_bond_without_them_breaks(beam_system, quick_law, basis, stand_by, kept):
    """With those of the next to break; then it goes on as if they had been there from the beginning."""
    reference, complete = in_full(beam_system, quick_law)
    fewer = keeping(stand_by, beam_system, basis, complete.state.broken[:kept])
    force, stepper = run(beam_system, quick_law, basis, fewer)
    assert stepper._operator is None and stepper._shifted is not None
    assert stepper._stand_by.bonds.size > kept + 1
    assert np.isin(complete.state.broken, stepper._stand_by.bonds).all()
    assert stepper.state.broken == complete.state.broken
    assert stepper.enrichments == len(complete.state.broken)
    np.testing.assert_allclose(force, reference, rtol=0, atol=1e-7 * np.abs(reference).max())
