"""Errors of temperature that the shift law follows, so that only a shift which no mix has gives them away.

Four isotherms have three shifts between them, and the shift law has three parameters: it takes the bias of any one
isotherm. A score test then sees nothing. A fit with the bias shows how much nearer it brings the shift to those of
mixes.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.chance import ABSORBED, USUAL_THRESHOLD
from asphalt_nscd.diagnosis.joint import Candidate, Fitted, Joint


def gains(
    joint: Joint, fitted: Fitted, candidates: Sequence[Candidate], seen: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Gain (k,) in the objective of the biases that no score test sees (seen: (k,)), fitted; of all others zero.

    A bias that the law follows gains no more than the prior of the shift costs: where that is less than chance
    gives, nothing is fitted.
    """
    out = np.zeros(len(candidates))
    if (
        not isinstance(joint.base, FlexibleSpectrum)
        or joint.base.shift_strain(fitted.law) < USUAL_THRESHOLD**2
    ):
        return out
    for k, candidate in enumerate(candidates):
        if isinstance(candidate.place, float) and not seen[k]:
            refit = joint.fit(fitted.law, fitted.scales, (*fitted.active, candidate))
            out[k] = max(fitted.objective - refit.objective, 0.0)
    return out


def followed(rest: Fitted, direction: NDArray) -> bool:
    """Whether a fit without a cause follows all but a trifle of it; direction: whitened (2n, 1)."""
    d = direction[:, 0]
    taken = rest.jacobian.T @ d
    return bool(d @ d - taken @ np.linalg.solve(rest.precision, taken) <= ABSORBED * (d @ d))
