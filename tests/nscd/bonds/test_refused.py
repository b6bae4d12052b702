"""Systems that have no answer are refused in one sentence; none runs for ever."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis


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


def test_a_reduced_model_of_bodies_that_touch(beam_system):
    """The share of no gap that closes is infinite, or none at all."""
    touching = replace(beam_system, gap=0.0 * beam_system.gap)
    with pytest.raises(ValueError, match=r"^gap: the reduced model counts shares of gaps"):
        ReducedModel(touching, ritz_basis(touching, 1))


@pytest.mark.parametrize("kind, options", [(CondensedStepper, ()), (SweepingStepper, (1e-4, 50))])
def test_a_motion_beyond_all_numbers_ends(beam_system, quick_law, kind, options):
    state = CondensedState.rest_state(beam_system, quick_law)
    stepper = kind(beam_system, quick_law, 1e-4, state, *options)
    with (
        np.errstate(over="ignore"),
        pytest.raises(ArithmeticError, match="the motion of a step is not finite"),
    ):
        stepper.advance(1e308)
