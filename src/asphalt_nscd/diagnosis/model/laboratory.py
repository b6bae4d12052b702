"""What every laboratory adds to its tests: temperatures within the tolerance of their control, specimens, mountings.

An isotherm is held to some tenths of a kelvin, each specimen on it too. Each specimen has relaxation times and each
mounting a level and a phase of its own. None of that is a fault, and without it every table holds one: of 80 drawn
tables that have nothing else, 28 were given a name. The sizes are inferred from the table by restricted likelihood,
beside the discrepancy; few isotherms and specimens say little of them, so that each has a prior with a source.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import CHANNEL
from asphalt_nscd.diagnosis.criteria import LABORATORY
from asphalt_nscd.diagnosis.model import discrepancy, likelihood, start
from asphalt_nscd.diagnosis.model.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.model.discrepancy import Process, Processes
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint, Vector
from asphalt_nscd.diagnosis.model.likelihood import Reduced

STEP = 0.05  # K or of ln time, of a derivative
OF_FEW = (
    "isotherm temperature",
    "specimen times",
)  # of which a table holds so few that one at fault enlarges them
FEW = 2
CLOSE = 0.01  # change of the objective at which a fit of the law ends that sizes are estimated beside


@dataclass(frozen=True)
class Laboratory:
    """Sizes of the effects of LABORATORY in a table, in their units."""

    sizes: dict[str, float]

    def factor(self, joint: Joint, at: Fitted, mounting: NDArray[np.int64]) -> NDArray[np.complex128]:
        """Factor (n, q) of the covariance of ln E* that the laboratory adds; `mounting` (n,) numbers mountings."""
        # A second specimen, of which a next test is, brings what a single one has not.
        roots = _roots(joint, at, mounting).items()
        return np.hstack([self.sizes.get(kind, LABORATORY[kind].size) * root for kind, root in roots])

    def beside(self, joint: Joint, at: Fitted) -> Joint:
        """The model whose noise is that of single tests, `joint`'s, and what the laboratory adds."""
        factor = self.factor(joint, at, joint.noise.block)
        noise = joint.noise.add_discrepancy(np.concatenate([factor.real, factor.imag]))
        return Joint(joint.observed, joint.base, noise)


def processes(joint: Joint, fitted: Fitted) -> tuple[Processes, tuple[str, ...]]:
    """Processes of the discrepancy, then of what the laboratory adds in its usual sizes, and names of the latter."""
    own = {
        kind: LABORATORY[kind].size * root for kind, root in _roots(joint, fitted, joint.noise.block).items()
    }
    beside = discrepancy.processes(joint, fitted)
    found = Processes(
        (*beside.described, *(Process(kind, "both") for kind in own)),
        (*beside.roots, *own.values()),
        np.hstack([beside.factor, *(joint.noise.whiten(root) for root in own.values())]),
        np.concatenate(
            [
                beside.block,
                np.repeat(len(beside.roots) + np.arange(len(own)), [r.shape[1] for r in own.values()]),
            ]
        ),
        np.concatenate([beside.usual, np.ones(len(own))]),
        np.concatenate([beside.spread, [LABORATORY[kind].spread for kind in own]]),
    )
    return found, tuple(own)


def estimate(joint: Joint, fitted: Fitted) -> Laboratory:
    """Sizes of the laboratory's effects beside the discrepancy; the noise is the scatter of single tests."""
    found, kinds = processes(joint, fitted)
    model = likelihood.reduce(found, fitted)
    whole = likelihood.estimate(model).variances
    first = whole.size - len(kinds)
    return Laboratory(
        {
            kind: LABORATORY[kind].size * float(np.sqrt(_without_one(model, fitted, whole, first + k, kind)))
            for k, kind in enumerate(kinds)
        }
    )


def _without_one(model: Reduced, fitted: Fitted, whole: Vector, k: int, kind: str) -> float:
    """Variance of an effect; the least with one isotherm or specimen free, which may be at fault, of more than FEW."""
    columns = np.flatnonzero(model.processes.block == k)
    if kind not in OF_FEW or columns.size <= FEW:
        return float(whole[k])
    free = likelihood.directions(model, fitted, model.processes.factor[:, columns])
    each = (likelihood.estimate(model, free.column(at)).variances for at in range(columns.size))
    return min(float(variances[k]) for variances in each)


def alone(joint: Joint) -> Joint:
    """The model whose noise is the scatter of single tests."""
    # What a block shares is its mounting's: it is not counted twice.
    noise = replace(joint.noise, shared=np.zeros_like(joint.noise.shared), discrepancy=None)
    return Joint(joint.observed, joint.base, noise)


def add_laboratory(joint: Joint, fitted: Fitted) -> tuple[Joint, Laboratory | None]:
    """The model with what the laboratory adds to the scatter, and that; unchanged, and None, with one isotherm."""
    # On one isotherm a mounting is the level of its specimen, and a temperature belongs to the law.
    if not isinstance(joint.base, FlexibleSpectrum) or joint.observed.isotherms.size < 2:
        return joint, None
    # An error that the phases of all tests share is no sum of mountings. Beside a law that bends to it, they would seem
    # several times as large.
    shared = tuple(Candidate(cause, None, (0.0,)) for cause in CATALOGUE if cause.stage == CHANNEL)
    free, beside = start.fit_spectrum(joint.observed, joint.noise, (*fitted.active, *shared))
    held = alone(free)
    found = estimate(held, held.linearise(beside.law, beside.scales, beside.active))
    # A law that was fitted without them has bent to the temperatures: fitted beside them, it leaves them to the tests.
    straight = found.beside(held, beside).fit(beside.law, beside.scales, beside.active, CLOSE)
    found = estimate(held, held.linearise(straight.law, straight.scales, straight.active))
    return found.beside(alone(joint), fitted), found


def _roots(joint: Joint, at: Fitted, mounting: NDArray[np.int64]) -> dict[str, NDArray[np.complex128]]:
    """What one unit of each effect does to ln E*, a column for each mounting."""
    mounted = np.eye(int(mounting.max()) + 1, dtype=complex)[mounting]
    observed, per_kelvin = joint.observed, _temperature_slope(joint, at.law)[:, None]
    roots = {
        "isotherm temperature": per_kelvin * (observed.isotherm[:, None] == observed.isotherms),
        "specimen temperature": per_kelvin * mounted,
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
