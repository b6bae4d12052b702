"""Prediction of isotherms and frequencies left out of the fit."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from asphalt_nscd.diagnosis.model.joint import Complex, Fitted, Joint

FOLDS = 20  # of a table at most; neighbours beyond that are left out together


@dataclass
class HeldOut:
    """Predictions of rows that were left out of a fit; each set is made once."""

    joint: Joint
    _made: dict[tuple[int, str], Complex] = field(default_factory=dict)

    def predictions(self, fitted: Fitted, part: str) -> Complex:
        """ln E* (n,) of each row from a fit without the rows that share its `part`, "isotherm" or "frequency"."""
        # By identity, for arrays have no hash.
        key = id(fitted), part
        if key not in self._made:
            values, label = np.unique(getattr(self.joint.observed, part), return_inverse=True)
            label = label * min(values.size, FOLDS) // values.size
            predicted = np.empty(label.size, complex)
            for fold in np.unique(label):
                rows = np.flatnonzero(label == fold)
                predicted[rows] = self.joint.predict(self.joint.refit_without(rows, fitted))[rows]
            self._made[key] = predicted
        return self._made[key]
