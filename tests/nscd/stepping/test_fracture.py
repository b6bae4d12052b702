"""What a break leaves."""

from __future__ import annotations

import numpy as np
import pytest
from theory.specimens import system_of

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper

ELASTIC = BondLaw(1e10, 1e20, np.array([]), np.array([]))


def held_by_two_bonds(load: float) -> BondedSystem:
    """Head - strong bond - light body - two weak bonds side by side - wall. The body can move along these
    bonds (degree of freedom 1) and across them (2), where it bears the load [N]."""
    rows = np.zeros((9, 3))
    rows[0, :2] = [1.0, -1.0]
    for bond in (1, 2):
        rows[3 * bond, 1] = rows[3 * bond + 1, 2] = 1.0
    load = [0.0, 0.0, load]
    return system_of(
        rows, 1e-3, [1.0, 1e-3, 1e-3], 0, load, [1.0, 1e-9, 1e-9], [np.inf, 0.3, 0.31], friction=0.5
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
