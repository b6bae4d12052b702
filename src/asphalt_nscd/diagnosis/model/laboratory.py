"""What every laboratory adds to its tests: temperatures within the tolerance of their control, specimens, mountings.

An isotherm is held to some tenths of a kelvin, each specimen on it too. Each specimen has relaxation times and each
mounting a level and a phase of its own. None of that is a fault, and without it every table holds one: of 80 drawn
tables that have nothing else, 28 were given a name. The sizes are inferred from the table by restricted likelihood,
beside the discrepancy and with the cause that is tried in the model; few isotherms and specimens say little of them, so
that each has a prior with a source. Where one isotherm or specimen may be at fault, the others say how careful the
laboratory is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.criteria import LABORATORY, SAME_CONTROL
from asphalt_nscd.diagnosis.model import discrepancy, likelihood
from asphalt_nscd.diagnosis.model.discrepancy import Process, Processes
from asphalt_nscd.diagnosis.model.joint import Fitted, Joint, Vector

STEP = 0.05  # K or of ln time, of a derivative
ISOTHERMS, SPECIMENS = "isotherm temperature", "specimen temperature"
OF_FEW = (ISOTHERMS, "specimen times")  # of which a table holds so few that one at fault enlarges them
FEW = 2


@dataclass(frozen=True)
class Laboratory:
    """Sizes of the effects of LABORATORY in a table, in their units."""

    sizes: dict[str, float]

    def factor(self, joint: Joint, at: Fitted, mounting: NDArray[np.int64]) -> NDArray[np.complex128]:
        """Factor (n, q) of the covariance of ln E* that the laboratory adds; `mounting` (n,) numbers mountings."""
        # A second specimen, of which a next test is, brings what a single one has not.
        roots = _roots(joint, at, mounting).items()
        return np.hstack([self.sizes.get(kind, LABORATORY[kind].size) * root for kind, root in roots])

    def joint_beside(self, joint: Joint, at: Fitted) -> Joint:
        """The model whose noise is that of single tests, `joint`'s, and what the laboratory adds."""
        factor = self.factor(joint, at, joint.noise.block)
        noise = joint.noise.add_discrepancy(np.concatenate([factor.real, factor.imag]))
        return Joint(joint.observed, joint.base, noise)


def processes(joint: Joint, fitted: Fitted) -> Processes:
    """Processes of the discrepancy, then of what the laboratory adds in its usual sizes, of several isotherms."""
    beside = discrepancy.processes(joint, fitted)
    # On one isotherm a mounting is the level of its specimen, and a temperature belongs to the law.
    if joint.observed.isotherms.size < 2:
        return beside
    own = {
        kind: LABORATORY[kind].size * root for kind, root in _roots(joint, fitted, joint.noise.block).items()
    }
    ranks = [root.shape[1] for root in own.values()]
    return Processes(
        (*beside.described, *(Process(kind, "both") for kind in own)),
        (*beside.roots, *own.values()),
        np.hstack([beside.factor, *(joint.noise.whiten(root) for root in own.values())]),
        np.concatenate([beside.block, np.repeat(len(beside.roots) + np.arange(len(own)), ranks)]),
        np.concatenate([beside.usual, np.ones(len(own))]),
        np.concatenate([beside.spread, [LABORATORY[kind].spread for kind in own]]),
    )


def is_everyday(found: Processes) -> NDArray[np.bool_]:
    """Which of the processes (m,) a laboratory adds to any table."""
    return np.array([one.kind in LABORATORY for one in found.described])


def sizes_beside_fault(found: Processes, fitted: Fitted, variances: Vector) -> Processes:
    """The processes with sizes of OF_FEW known, as they are where any one isotherm or specimen may be at fault."""
    model, usual, spread = likelihood.reduce(found, fitted), found.usual.copy(), found.spread.copy()
    kinds = [one.kind for one in found.described]
    for k, kind in enumerate(kinds):
        columns = np.flatnonzero(found.block == k)
        if kind in OF_FEW and columns.size > FEW:
            every = likelihood.directions(model, fitted, found.factor[:, columns])
            free = [every.column(at) for at in range(columns.size)]
            if kind == ISOTHERMS:
                prior = _same_control(variances[kinds.index(SPECIMENS)])
                variance = likelihood.typical_variance(model, free, k, prior, variances)
            else:
                variance = min(likelihood.estimate(model, one, variances).variances[k] for one in free)
            usual[k], spread[k] = np.sqrt(variance), 0.0
    return replace(found, usual=usual, spread=spread)


def _same_control(variance: float) -> tuple[float, float]:
    """Usual size of isotherms' errors and spread of its logarithm, given the variance that specimens on them have."""
    of_isotherms, of_specimens = LABORATORY[ISOTHERMS].spread, LABORATORY[SPECIMENS].spread
    alike = SAME_CONTROL * of_isotherms / of_specimens * np.log(np.sqrt(variance))
    return float(np.exp(alike)), of_isotherms * float(np.sqrt(1.0 - SAME_CONTROL**2))


def inferred(found: Processes, variances: Vector) -> Laboratory:
    """The sizes of a laboratory by the variances (m,) of the processes."""
    return Laboratory(
        {
            one.kind: LABORATORY[one.kind].size * float(np.sqrt(variance))
            for one, variance in zip(found.described, variances, strict=True)
            if one.kind in LABORATORY
        }
    )


def alone(joint: Joint) -> Joint:
    """The model whose noise is the scatter of single tests, beside which a laboratory's errors can be sized."""
    if joint.observed.isotherms.size < 2:
        return joint
    # What a block shares is its mounting's: it is not counted twice.
    noise = replace(joint.noise, shared=np.zeros_like(joint.noise.shared), discrepancy=None)
    return Joint(joint.observed, joint.base, noise)


def _roots(joint: Joint, at: Fitted, mounting: NDArray[np.int64]) -> dict[str, NDArray[np.complex128]]:
    """What one unit of each effect does to ln E*, a column for each mounting."""
    mounted = np.eye(int(mounting.max()) + 1, dtype=complex)[mounting]
    observed, per_kelvin = joint.observed, _temperature_slope(joint, at.law)[:, None]
    roots = {
        ISOTHERMS: per_kelvin * (observed.isotherm[:, None] == observed.isotherms),
        SPECIMENS: per_kelvin * mounted,
        "mounting, modulus": mounted,
        "mounting, phase": 1j * mounted,
    }
    # Times of a single specimen are the law's.
    if len(observed.names) > 1:
        specimens = np.eye(len(observed.names))[observed.specimen]
        roots["specimen times"] = _time_slope(joint, at.law)[:, None] * specimens
    return roots


def _time_slope(joint: Joint, law: Vector) -> NDArray[np.complex128]:
    """Derivative (n,) of ln E* along ln of all relaxation times."""
    observed = joint.observed
    low, high = (
        joint.base.modulus(law, observed.omega * np.exp(step), observed.temperature)[0]
        for step in (-STEP, STEP)
    )
    return np.asarray(np.log(high / low) / (2.0 * STEP), complex)


def _temperature_slope(joint: Joint, law: Vector) -> NDArray[np.complex128]:
    """Derivative (n,) of ln E* along the temperature."""
    observed = joint.observed
    low, high = (
        joint.base.modulus(law, observed.omega, observed.temperature + step)[0] for step in (-STEP, STEP)
    )
    return np.asarray(np.log(high / low) / (2.0 * STEP), complex)
