"""A beam pulled until it fractures: reduced and full follow the same hundred breaks; what a break leaves."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.break_modes import StandBy
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis, shifted_factor
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper
from asphalt_nscd.specimen.system import bending_system

pytestmark = pytest.mark.slow

DT = 5e-5
ELASTIC = BondLaw(1e10, 1e20, np.array([]), np.array([]))


def follow(stepper: CondensedStepper, driven: np.ndarray, start: float = 0.0) -> np.ndarray:
    return np.array([stepper.advance(v) for v in np.diff(driven, prepend=start) / stepper.dt])


def test_reduced_and_full_agree_on_a_hundred_breaks(make_beam, quick_law):
    """Stocky, so that its section has bonds enough. The reduced stepper enriches itself thirty times, then
    hands over to the full system in the middle of a cascade: the same bonds in the same order, the
    reaction to 1e-10 of its largest."""
    system = bending_system(make_beam(shape=(10, 9, 8)), 0.35, 2.7e6, 0.7)
    driven = 5e-6 * np.arange(1, 25)
    full = CondensedStepper(system, quick_law, DT, CondensedState.at_rest(system, quick_law))
    reference = follow(full, driven)
    order = full.state.broken
    assert len(order) >= 100 and len(set(order)) == len(order)

    shifted = shifted_factor(system)
    basis = ritz_basis(system, 12, shifted)
    stand_by = StandBy.of(system, basis, shifted)
    stepper = ReducedStepper(stand_by.model(system, basis, []), quick_law, DT, 1e-6, stand_by=stand_by)
    try:
        force, broken = stepper.run(driven)[0], stepper.state.broken
    except FullSystemNeeded as accepted:
        done, state = accepted.force.size, stepper.full_state()
        after = CondensedStepper(system, quick_law, DT, state)
        force = np.concatenate([accepted.force, follow(after, driven[done:], driven[done - 1])])
        broken = state.broken
    assert stepper.enrichments == stepper.most_enrichments
    assert broken == order
    np.testing.assert_allclose(force, reference, rtol=0, atol=1e-10 * np.abs(reference).max())


def held_by_two_bonds(load: float) -> BondedSystem:
    """Head - strong bond - light body - two weak bonds side by side - wall. The body can move along these
    bonds (degree of freedom 1) and across them (2), where it bears the load [N]."""
    rows = np.zeros((9, 3))
    rows[0, :2] = [1.0, -1.0]
    for bond in (1, 2):
        rows[3 * bond, 1] = rows[3 * bond + 1, 2] = 1.0
    return BondedSystem(
        sparse.csr_matrix(rows),
        np.full(9, 1e-3),
        np.array([1.0, 1e-3, 1e-3]),
        np.array([0.0, 0.0, load]),
        0,
        np.array([1.0, 1e-9, 1e-9]),
        np.array([np.inf, 0.3, 0.31]),
        friction=0.5,
    )


@pytest.mark.parametrize("load", [0.3, 0.8])
def test_a_broken_bond_is_a_frictional_contact(load):
    """Pulled, both weak bonds go within one step, the weaker first. Pushed back, the body rests on the wall
    and not below; pressed with N it bears 0.5 N across and slides under more, as Coulomb says."""
    system = held_by_two_bonds(load)
    stepper = CondensedStepper(system, ELASTIC, 1e-4, CondensedState.at_rest(system, ELASTIC))
    state = stepper.state
    stepper.advance(2e-7 / 1e-4)
    assert state.broken == [1, 2] and state.displacement[1] > 0.0
    stepper.advance((-1e-9 - 1e-7 - state.displacement[0]) / 1e-4)  # 1e-7 m of a spring of 1e7 N/m: 1 N
    for _ in range(60):
        stepper.advance(0.0)
    assert state.displacement[1] == pytest.approx(-1e-9, abs=1e-12)
    pressed = 1e-3 * state.sigma[0]
    assert pressed == pytest.approx(1.0, rel=1e-3)
    before = state.velocity[2]
    stepper.advance(0.0)
    if load < 0.5 * pressed:
        assert abs(state.velocity[2]) < 1e-12
    else:
        gained = (load - 0.5 * pressed) / 1e-3 * 1e-4
        assert state.velocity[2] - before == pytest.approx(gained, rel=1e-9)
