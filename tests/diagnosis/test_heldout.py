"""Predictions of what was left out of a fit have not seen it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_joint import fit, table  # noqa: F401  fixtures

from asphalt_nscd.diagnosis.model.heldout import FOLDS, HeldOut
from asphalt_nscd.diagnosis.model.joint import Joint


@pytest.mark.parametrize("part", ["isotherm", "frequency"])
def test_what_is_left_out_does_not_move_its_own_prediction(fit, part):  # noqa: F811
    joint, fitted = fit
    out = getattr(joint.observed, part) == 10.0
    changed = replace(joint.observed, modulus=joint.observed.modulus * np.where(out, 1.5, 1.0))
    predicted, of_changed = (
        HeldOut(Joint(observed, joint.base, joint.noise)).predictions(fitted, part)
        for observed in (joint.observed, changed)
    )
    np.testing.assert_allclose(of_changed[out], predicted[out], rtol=0.0, atol=1e-12)
    assert np.abs(of_changed[~out] - predicted[~out]).max() > 0.01  # the others have seen it
    inside = part == "frequency"  # 10 Hz lies between 3 and 30, 10 degC between -5 and 25
    assert np.abs(predicted[out] - joint.observed.logarithm[out]).max() < (0.08 if inside else 0.15)


def test_each_set_is_left_out_once_and_a_large_table_in_twenty_parts(fit):  # noqa: F811
    joint, fitted = fit
    left_out = []

    class Counted(Joint):
        def refit_without(self, rows, fitted):
            left_out.append(rows)
            return fitted

        def predict(self, fitted):
            return np.zeros(self.observed.size, complex)

    many = np.geomspace(0.1, 50.0, joint.observed.size)
    held = HeldOut(Counted(replace(joint.observed, frequency=many), joint.base, joint.noise))
    held.predictions(fitted, "frequency")
    assert held.predictions(fitted, "frequency") is held.predictions(fitted, "frequency")
    assert len(left_out) == FOLDS
    assert np.concatenate(left_out).tolist() == list(range(many.size))
