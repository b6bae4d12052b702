"""Why a name may belong to an effect that the catalogue lacks, although its cause fits.

A look-alike takes most of an unknown effect but not its shape. So each name competes with rivals that have no name:
a smooth effect over ln f, common to all tests; one that changes with temperature too; and the cause itself with a
size of its own on each isotherm, or at each frequency. All are Gaussian processes beside the discrepancy
(`discrepancy`), their variances estimated by restricted likelihood with the cause in the model. A name is in
doubt if its size is less than six standard errors beside a rival, or if a smooth rival makes the tests 20 times as
likely beside it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.causes._cause import Place
from asphalt_nscd.diagnosis.criteria import ABSORBED, ENOUGH, MANY_ISOTHERMS, MOST_SPECIMENS, TWENTY_TIMES
from asphalt_nscd.diagnosis.model import discrepancy, likelihood
from asphalt_nscd.diagnosis.model.discrepancy import Process, Processes
from asphalt_nscd.diagnosis.model.fit_beside import State
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.model.likelihood import Direction, Estimate, Reduced
from asphalt_nscd.diagnosis.observed.observations import Observations

Vector = NDArray[np.float64]
Key = tuple[str, Place]
FIRST = 0.05  # size at which the search for the size of a rival begins, in its own units
RIVAL = Process("rival", "both")


def find_doubts(state: State, named: Sequence[Candidate]) -> dict[Key, list[str]]:
    """Why names may belong to an effect that the catalogue lacks: sentences by cause and place, for doubtful names."""
    active = {candidate.key: candidate for candidate in state.fitted.active}
    found: dict[Key, list[str]] = {}
    for candidate in named:
        taken = active[candidate.key]
        own = [
            *_size_doubts(taken, state.plain.observed),
            *_shared_doubts(candidate, named, len(state.plain.observed.names)),
            *_rival_doubts(state, taken),
        ]
        # a cause that was found after a doubtful one was fitted beside it
        if not own and found:
            own = ["It was found after another cause that is itself not certain"]
        if own:
            found[candidate.key] = own
    return found


def _size_doubts(candidate: Candidate, observed: Observations) -> Iterator[str]:
    """A size at the bound of the search, and one that these tests cannot have."""
    for parameter, value in candidate.pinned:
        unit = "" if parameter.unit in ("1", "-") else f" {parameter.unit}"
        yield f"Its {parameter.name.replace('_', ' ')} stands at the bound of {value:g}{unit}"
    yield from filter(None, [candidate.cause.impossible(np.array(candidate.values), observed)])


def _shared_doubts(candidate: Candidate, named: Sequence[Candidate], specimens: int) -> Iterator[str]:
    """A fault of one specimen that most of them would have to share; one isotherm after another that is off."""
    same = sum(one.cause.name == candidate.cause.name for one in named)
    if isinstance(candidate.place, str) and same > 1 and same >= MOST_SPECIMENS * specimens:
        yield f"It is named at {same} of {specimens} specimens, so it is no fault of a single one"
    if isinstance(candidate.place, float) and same >= MANY_ISOTHERMS:
        yield f"It is named at {same} isotherms: a shift with temperature that is not of WLF's form looks the same"


def _drop_cause(state: State, candidate: Candidate) -> tuple[Fitted, NDArray, NDArray[np.complex128]]:
    """The fit with a cause taken out, its whitened direction (2n, 1), and what it does to ln E* (n,)."""
    linear = state.linear
    number = [one.key for one in linear.active].index(candidate.key)
    first = linear.place_of(candidate.key)
    columns = range(first, first + len(candidate.values))
    direction = linear.jacobian[:, [first]]
    size = candidate.values[0] / candidate.typical[0]
    rest, back = linear.fixed(columns), direction[:, 0] * size
    out = replace(rest, residual=linear.residual + back, gradient=rest.gradient + rest.jacobian.T @ back)
    effect = size * state.plain.direction(linear.law, linear.scales, linear.active, number, 0)
    return out, direction, effect


def _estimate_beside(
    state: State, rest: Fitted, direction: NDArray | None, roots: Sequence[NDArray]
) -> Estimate:
    """A cause estimated beside all processes and further ones with these factors (n, rank).

    direction: whitened (2n, 1), of the cause; None for the processes in its place.
    """
    found, more = state.model.processes, len(roots)
    ranks = [root.shape[1] for root in roots]
    every = Processes(
        (*found.described, *(RIVAL for _ in roots)),
        (*found.roots, *roots),
        np.hstack([found.factor, *(state.plain.noise.whiten(root) for root in roots)]),
        np.concatenate([found.block, len(found.roots) + np.repeat(np.arange(more), ranks)]),
        np.concatenate([found.usual, np.ones(more)]),
        np.concatenate([found.spread, np.full(more, np.inf)]),
    )
    model: Reduced = likelihood.reduce(every, rest)
    along: Direction | None = None if direction is None else likelihood.directions(model, rest, direction)
    begin = np.concatenate([state.variances, np.full(more, FIRST**2)])
    # the likelihood of a variance may have two maxima, one of them at none: from either side
    tried = [likelihood.estimate(model, along, start) for start in (begin, None)]
    return min(tried, key=lambda one: one.misfit)


def _rival_doubts(state: State, candidate: Candidate) -> Iterator[str]:
    rest, direction, effect = _drop_cause(state, candidate)
    if isinstance(candidate.place, float) and _followed(rest, direction):
        yield "A shift with temperature of unusual form looks the same"

    def estimate(along: NDArray | None, *roots: NDArray) -> Estimate:
        return _estimate_beside(state, rest, along, roots)

    alone = estimate(direction)
    observed, sigma = state.plain.observed, state.plain.noise.sigma
    smooth = [estimate(direction, sigma[0] * root, 1j * sigma[1] * root) for root in _smooth(observed)]
    least = min(abs(one.z) for one in (alone, *smooth))
    known = [
        words
        for words, roots in _shaped(state.plain)
        if estimate(None, *roots).misfit < alone.misfit - TWENTY_TIMES
    ]
    if known:
        alike = " or ".join(known)
        yield f"{alike[:1].upper()}{alike[1:]} would look the same"
    elif least < ENOUGH:
        yield (
            "Another error that varies smoothly with frequency could look the same, and the evidence for this one is "
            "weak"
        )
    # A look-alike leaves of an unknown effect what it cannot follow.
    elif min(one.misfit for one in smooth) < alone.misfit - TWENTY_TIMES:
        yield "The tests hold more beside it that changes with frequency, of which it may be a part"
    for words, label in (("isotherms", observed.isotherm), ("frequencies", observed.frequency)):
        parts = effect[:, None] * (label[:, None] == np.unique(label))
        parts = parts[:, np.abs(parts).max(axis=0) > 0.0]
        # Only where smooth rivals leave it enough: else weak evidence has been told already.
        if parts.shape[1] > 1 and abs(estimate(direction, parts).z) < ENOUGH <= least:
            yield f"Its size may differ between {words}"


def _followed(rest: Fitted, direction: NDArray) -> bool:
    """Whether a fit without a cause follows all but a trifle of it; direction: whitened (2n, 1)."""
    d = direction[:, 0]
    taken = rest.jacobian.T @ d
    return bool(d @ d - taken @ np.linalg.solve(rest.precision, taken) <= ABSORBED * (d @ d))


def _shaped(plain: Joint) -> Iterator[tuple[str, list[NDArray[np.complex128]]]]:
    """Errors that laboratories make and the catalogue lacks: words, and factors (n, 1), each with a size of its own."""
    observed, (of_modulus, of_phase) = plain.observed, plain.noise.sigma
    size, phase = np.abs(observed.modulus), 1j * observed.logarithm.imag
    away = observed.temperature - observed.temperature.mean()
    for words, shapes, unit in (
        ("a phase read on a wrong scale", [phase], of_phase),
        ("a machine's compliance taken off |E*| alone", [size], of_modulus),
        (
            "a constant added to |E*|",
            [1.0 / size, 1.0 / size**2],
            of_modulus,
        ),  # the logarithm to second order
        ("a change of |E*| with temperature that is no shift", [away], of_modulus),
    ):
        lengths = [float(np.sqrt(np.mean(np.abs(shape) ** 2))) for shape in shapes]
        if min(lengths) > 0.0:
            yield (
                words,
                [(unit * s / one)[:, None].astype(complex) for s, one in zip(shapes, lengths, strict=True)],
            )


def _smooth(observed: Observations) -> Iterator[NDArray]:
    """Factors (n, rank) of a smooth effect over ln f, the same at all temperatures and changing with them."""
    log_f = np.log(observed.frequency)[:, None] / discrepancy.LENGTH

    def along(apart: NDArray) -> NDArray:
        return discrepancy.LEVEL + np.exp(-0.5 * apart[0] ** 2)

    yield discrepancy.factor_of(log_f, along, discrepancy.LEFT_OUT["all"])
    span = discrepancy.ACROSS * max(float(np.ptp(observed.isotherms)), 1.0)
    yield discrepancy.factor_of(
        np.hstack([log_f, observed.isotherm[:, None] / span]),
        lambda apart: along(apart) * np.exp(-0.5 * apart[1] ** 2),
        discrepancy.LEFT_OUT["all"],
    )
