"""Why a name may belong to an effect that the catalogue lacks, although its cause fits.

A look-alike takes most of an unknown effect but not its shape. So each name competes with rivals that have no name:
a smooth effect over ln f, common to all tests; one that changes with temperature too; and the cause itself with a
size of its own on each isotherm, or at each frequency. All are Gaussian processes beside the discrepancy
(`discrepancy`), their variances estimated by restricted likelihood with the cause in the model. A name is in
doubt if its size is less than six standard errors beside a rival, or if a smooth effect remains beside it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis import discrepancy
from asphalt_nscd.diagnosis.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.discrepancy import Direction, Estimate, Processes, Reduced
from asphalt_nscd.diagnosis.joint import Candidate, Fitted, Joint

Vector = NDArray[np.float64]
Key = tuple[str, str | float | None]
# Standard errors that the size must keep beside each rival. Measured in drawn tables: look-alikes of a cause that the
# catalogue lacks keep up to 5.1, right names at three times the limit 8.7 or more.
ENOUGH = 6.0
REMAINS = 6.0  # gain of -2 ln likelihood by a smooth effect beside the cause: 20 times as likely
FIRST = 0.05  # size at which the search for the size of a rival begins, in its own units
MOST_SPECIMENS = 0.5  # share of the specimens at which a fault of one specimen may be named


def find_doubts(
    plain: Joint, fitted: Fitted, named: Sequence[Candidate], sizes: Sequence[float] = ()
) -> dict[Key, list[str]]:
    """Sentences for each name in doubt, by cause and place.

    plain: the joint model whose noise is the scatter alone; fitted: its last fit, with all causes in it; named: they,
    in the order found; sizes (m,): of the processes of a discrepancy in units of the scatter, where one was fitted.
    """
    active = {candidate.key: candidate for candidate in fitted.active}
    found: dict[Key, list[str]] = {}
    if not named or not isinstance(plain.base, FlexibleSpectrum):
        return found
    linear = plain.linearise(fitted.law, fitted.scales, fitted.active)
    processes = discrepancy.processes(plain, linear)
    variances = np.square(sizes) if len(sizes) else np.zeros(len(processes.names))
    table = _Table(plain, linear, processes, variances)
    for candidate in named:
        own = [*_at_bound(active[candidate.key]), *_of_many(candidate, named, len(plain.observed.names))]
        own += _beside_rivals(table, active[candidate.key])
        if not own and found:
            own = ["It was found after a name that is in doubt"]
        if own:
            found[candidate.key] = own
    return found


def _at_bound(candidate: Candidate) -> Iterator[str]:
    for parameter, value in zip(candidate.cause.parameters, candidate.values, strict=True):
        if value and np.isclose(value, [parameter.low, parameter.high], rtol=1e-6, atol=0.0).any():
            unit = "" if parameter.unit == "1" else f" {parameter.unit}"
            yield f"Its {parameter.name.replace('_', ' ')} stands at the bound of {value:g}{unit}"


def _of_many(candidate: Candidate, named: Sequence[Candidate], specimens: int) -> Iterator[str]:
    """A fault of one specimen that most of them would have to share."""
    same = sum(one.cause.name == candidate.cause.name for one in named)
    if isinstance(candidate.place, str) and same > 1 and same >= MOST_SPECIMENS * specimens:
        yield f"It is named at {same} of {specimens} specimens, so that it is no fault of one of them"


class _Table:
    """The last fit of a table and its discrepancy."""

    def __init__(self, plain: Joint, linear: Fitted, processes: Processes, variances: Vector) -> None:
        self.plain, self.linear = plain, linear
        self.processes, self.variances = processes, variances

    def without(self, candidate: Candidate) -> tuple[Fitted, NDArray, NDArray[np.complex128]]:
        """The fit with a cause taken out, its whitened direction (2n, 1), and what it does to ln E* (n,)."""
        linear, active = self.linear, list(self.linear.active)
        number = [one.key for one in active].index(candidate.key)
        first = linear.law.size + linear.scales.size + sum(len(one.values) for one in active[:number])
        columns = range(first, first + len(candidate.values))
        direction = linear.jacobian[:, [first]]
        size = candidate.values[0] / candidate.typical[0]
        rest = np.delete(linear.jacobian, columns, axis=1)
        back = direction[:, 0] * size
        out = replace(
            linear, jacobian=rest, residual=linear.residual + back,
            precision=np.delete(np.delete(linear.precision, columns, 0), columns, 1),
            gradient=np.delete(linear.gradient, columns) + rest.T @ back,
        )  # fmt: skip
        effect = size * self.plain.direction(linear.law, linear.scales, linear.active, number, 0)
        return out, direction, effect

    def beside(self, rest: Fitted, direction: NDArray, roots: Sequence[NDArray], usual: float) -> Estimate:
        """The cause estimated beside its discrepancy and further processes with these factors (n, rank)."""
        found = self.processes
        count = [*np.bincount(found.block), *(root.shape[1] for root in roots)]
        factor = np.hstack([found.factor, *(self.plain.noise.whiten(root) for root in roots)])
        every = Processes(
            (*found.names, *("rival" for _ in roots)), (*found.roots, *roots), factor,
            np.repeat(np.arange(len(count)), count), np.array([*found.usual, *(usual for _ in roots)]),
        )  # fmt: skip
        model: Reduced = discrepancy.reduce(every, rest)
        along: Direction = discrepancy.directions(model, rest, direction)
        begin = np.concatenate([self.variances, np.full(len(roots), FIRST**2)])
        tried = [discrepancy.estimate(model, along, start) for start in (begin, None)]
        return min(tried, key=lambda one: one.misfit)


def _beside_rivals(table: _Table, candidate: Candidate) -> Iterator[str]:
    rest, direction, effect = table.without(candidate)
    alone = table.beside(rest, direction, (), 1.0)
    observed, sigma = table.plain.observed, table.plain.noise.sigma
    least, remains = abs(alone.z), 0.0
    for root in _smooth(table.plain):
        one = table.beside(rest, direction, (sigma[0] * root, 1j * sigma[1] * root), 1.0)
        least, remains = min(least, abs(one.z)), max(remains, alone.misfit - one.misfit)
    if least < ENOUGH:
        yield (
            f"Beside a smooth effect without a name its size is {np.floor(10.0 * least) / 10.0:g} standard errors, "
            f"fewer than {ENOUGH:g}"
        )
    elif remains > REMAINS:
        yield "A smooth effect without a name remains beside it"
    for words, label in (("isotherms", observed.isotherm), ("frequencies", observed.frequency)):
        parts = effect[:, None] * (label[:, None] == np.unique(label))
        parts = parts[:, np.abs(parts).max(axis=0) > 0.0]
        if parts.shape[1] > 1 and abs(table.beside(rest, direction, (parts,), 1.0).z) < ENOUGH <= least:
            yield f"Its size may differ between {words}"


def _smooth(plain: Joint) -> Iterator[NDArray]:
    """Factors (n, rank) of a smooth effect over ln f, the same at all temperatures and changing with them."""
    observed = plain.observed
    log_f = np.log(observed.frequency)
    along = discrepancy.LEVEL + np.exp(-0.5 * ((log_f[:, None] - log_f) / discrepancy.LENGTH) ** 2)
    yield discrepancy.factor_of(along, discrepancy.LEFT_OUT["all"])
    span = discrepancy.ACROSS * max(float(np.ptp(observed.isotherms)), 1.0)
    warmer = (observed.isotherm[:, None] - observed.isotherm) / span
    yield discrepancy.factor_of(along * np.exp(-0.5 * warmer**2), discrepancy.LEFT_OUT["all"])
