"""Systems that have no answer are refused in one sentence; none runs for ever."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper


@pytest.mark.parametrize("strength", [0.0, -1.0, np.nan])
def test_a_bond_without_strength(beam_system, strength):
    weak = beam_system.strength.copy()
    weak[3] = strength
    with pytest.raises(ValueError, match=r"^strength: each bond's must be greater than zero"):
        replace(beam_system, strength=weak)


@pytest.mark.parametrize("gap", [-1e-9, np.nan])
def test_bodies_that_overlap(beam_system, gap):
    narrow = beam_system.gap.copy()
    narrow[3] = gap
    with pytest.raises(ValueError, match=r"^gap: none may be negative; bonded bodies must not overlap"):
        replace(beam_system, gap=narrow)


def test_friction_that_drives(beam_system):
    with pytest.raises(ValueError, match=r"^friction = -1 must not be negative"):
        replace(beam_system, friction=-1.0)


def test_a_motion_beyond_all_numbers_ends(beam_system, quick_law):
    state = CondensedState.rest_state(beam_system, quick_law)
    stepper = CondensedStepper(beam_system, quick_law, 1e-4, state)
    with (
        np.errstate(over="ignore"),
        pytest.raises(ArithmeticError, match="the motion of a step is not finite"),
    ):
        stepper.advance(1e308)
