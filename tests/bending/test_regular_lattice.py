"""Reduced equations that rounding leaves singular, as those of a packing on a regular lattice."""

from __future__ import annotations

import numpy as np
import pytest
from theory.specimens import jittered_beam

from asphalt_nscd.bending.bending_test import bond_law, run_test
from asphalt_nscd.bending.case import LoadCase
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.model import model_of
from asphalt_nscd.bending.settings import Bonds, Numerics
from asphalt_nscd.files.store import Record
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper
from asphalt_nscd.rheology.burgers import Burgers


def test_the_full_system_takes_over_where_the_reduced_one_is_singular(monkeypatch):
    def singular(stepper: ReducedStepper) -> np.ndarray:
        return np.linalg.inv(np.zeros((2, 2)))

    model = model_of(Record(*condensed(jittered_beam(area="facets"), "beam", Bonds()), ""))
    law, case = bond_law(Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)), LoadCase(10.0, 1e-7, 1.0)
    # by paths followed in one call, and step by step
    for scheme in ("euler", "fitted"):
        usual = run_test(model, law, case, Numerics(2e-3, 3, scheme=scheme))
        with monkeypatch.context() as patched:
            patched.setattr(ReducedStepper, "_step_inverse", singular)
            found = run_test(model, law, case, Numerics(2e-3, 3, scheme=scheme))
        assert found.force == pytest.approx(usual.force, rel=1e-6, abs=1e-7 * abs(usual.force).max())
        assert found.residual < 1e-6 and found.time.size == 50
