"""Law, causes and discrepancy of a table fitted together, and the size of a cause in such a fit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.causes._cause import Place, Setting
from asphalt_nscd.diagnosis.model import discrepancy, laboratory, likelihood
from asphalt_nscd.diagnosis.model.discrepancy import Processes
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.model.likelihood import Direction, Estimate, Reduced
from asphalt_nscd.diagnosis.model.start import first_laws, fit_roughness, price_of_roughness
from asphalt_nscd.diagnosis.observed.observations import Observations

Vector = NDArray[np.float64]
SETTLED = 2  # rounds of fitting law and discrepancy in turn
SMOOTHED = 3  # the same of roughness and discrepancy, at most
SAME = 1e-9  # relative difference of starts that is rounding
CONVERGED = 0.01  # change of the objective at which a fit beside a discrepancy ends


@dataclass(frozen=True)
class State:
    """A fit of law and causes beside the discrepancy, and the model linearised there.

    The noise of `plain` is the scatter alone, that of `wide` has all processes too; `fitted` is under wide, `linear`
    under plain at the same parameters; `model` is reduced to the processes, of `variances` (m,).
    """

    plain: Joint
    wide: Joint
    fitted: Fitted
    linear: Fitted
    model: Reduced
    variances: Vector

    @property
    def hidden(self) -> Vector:
        """Variances (m,) of the discrepancy, zero of what a laboratory adds to any table."""
        return np.where(laboratory.is_everyday(self.model.processes), 0.0, self.variances)

    @property
    def everyday(self) -> Joint:
        """The model whose noise holds what the laboratory adds, and no discrepancy."""
        if self.plain.observed.isotherms.size < 2:
            return self.plain
        return laboratory.inferred(self.model.processes, self.variances).joint_beside(self.plain, self.fitted)

    @property
    def misfit(self) -> float:
        """-2 ln of the likelihood with the law integrated out (Laplace), the causes at their best."""
        law = self.fitted.law.size + self.fitted.scales.size
        return (
            self.fitted.objective
            + float(np.linalg.slogdet(self.fitted.precision[:law, :law])[1])
            + self.wide.noise.log_determinant
            + self.model.processes.prior(self.variances)[0]
            + price_of_roughness(self.plain.spectrum)
        )


def begin(plain: Joint, fitted: Fitted) -> State:
    """Fit law, discrepancy and laboratory with the causes of the fit, mostly none, from where its law stands."""
    linear = plain.linearise(fitted.law, fitted.scales, fitted.active)
    found = laboratory.processes(plain, linear)
    start = likelihood.estimate(likelihood.reduce(found, linear)).variances
    # A law that was fitted without the laboratory's errors has bent to them.
    straight = settle(plain, found, linear, linear.active, start)
    known = laboratory.sizes_beside_fault(straight.model.processes, straight.linear, straight.variances)
    return smoothed(settle(plain, known, straight.fitted, linear.active, straight.variances))


def refit_causes(state: State, active: tuple[Candidate, ...]) -> State:
    """Fit anew with other causes."""
    return settle(state.plain, state.model.processes, state.fitted, active, state.variances)


def settle(
    plain: Joint, found: Processes, at: Fitted, active: tuple[Candidate, ...], variances: Vector
) -> State:
    """Fit law, causes and discrepancy in turn, from the law and scales of `at` and `variances` (m,)."""
    law, scales = at.law, at.scales
    for _ in range(SETTLED):
        noise = plain.noise.add_discrepancy(found.covariance_factor(variances))
        wide = Joint(plain.observed, plain.base, noise)
        fitted = wide.fit(law, scales, active, CONVERGED)
        law, scales, active = fitted.law, fitted.scales, fitted.active
        linear = plain.linearise(law, scales, active)
        model = likelihood.reduce(found, linear)
        variances = likeliest(model, variances).variances
    return State(plain, wide, fitted, linear, model, variances)


def likeliest(
    model: Reduced, variances: Vector, cause: Direction | None = None, place: Place = None
) -> Estimate:
    """The likeliest of several answers: of the least misfit."""
    return min(answers(model, variances, cause, place), key=lambda estimate: estimate.misfit)


def answers(
    model: Reduced, variances: Vector, cause: Direction | None = None, place: Place = None
) -> Iterator[Estimate]:
    """Estimates from several starts; `variances` (m,) is one of them, without what may be the doing of the cause.

    Which of three specimens is odd, or a phase that is off at every frequency for a modulus that is, may be told in two
    ways, and one start finds one of them.
    """
    starts = [lean(model.processes, variances, place)]
    if cause is None:
        of_all = [one.kind == "all" for one in model.processes.described]
        starts = [variances, np.where(of_all, discrepancy.LEAST, variances), *starts]
    for k, start in enumerate(starts):
        # What is none already is left as it is: the starts are often one.
        if not any(np.allclose(start, other, SAME, 0.0) for other in starts[:k]):
            yield likelihood.estimate(model, cause, start)
    yield likelihood.estimate(model, cause, None)


def lean(found: Processes, variances: Vector, place: Place = None) -> Vector:
    """Variances (m,) without what a cause at a place has enlarged: the laboratory's, and the discrepancy there."""
    usual = np.minimum(variances, found.usual**2)
    at = set(place) if isinstance(place, tuple) else {place} - {None}
    there = np.array([bool(at & {one.specimen, one.isotherm}) for one in found.described])
    # One frequency off in all tests looks like what all isotherms have in common.
    there |= isinstance(place, Setting) & np.array([one.kind == "all" for one in found.described])
    return np.where(there, discrepancy.LEAST, np.where(laboratory.is_everyday(found), usual, variances))


def smoothed(state: State) -> State:
    """Fit anew with the roughness of the law that is likeliest beside the discrepancy."""
    for _ in range(SMOOTHED):
        before = state
        wide, fitted = fit_roughness(state.wide, state.fitted, CONVERGED)
        plain = Joint(state.plain.observed, wide.base, state.plain.noise)
        state = settle(plain, state.model.processes, fitted, fitted.active, state.variances)
        if wide.spectrum.roughness == before.wide.spectrum.roughness:
            break
    return state


def afresh(state: State, active: tuple[Candidate, ...]) -> State:
    """Fit law and causes before there is a discrepancy, which else keeps what it took up without them."""
    laws = [state.fitted.law, *first_laws(state.plain)]
    fits = [state.plain.fit(law, state.fitted.scales, active, CONVERGED) for law in laws]
    fitted, known = min(fits, key=lambda one: one.objective), state.model.processes
    found = laboratory.processes(state.plain, fitted)
    found = replace(found, usual=known.usual, spread=known.spread)
    start = likelihood.estimate(likelihood.reduce(found, fitted)).variances
    return settle(state.plain, found, fitted, fitted.active, start)


def taken_amplitude(
    state: State, candidate: Candidate, rows: NDArray | None = None, sizes_too: bool = False
) -> Estimate:
    """Amplitude of a cause in the fit, in typical units; `sizes_too` adds the error of the discrepancy's sizes."""
    first = state.fitted.place_of(candidate.key)
    plain, model, linear = state.plain, state.model, state.linear
    if rows is not None:
        plain = Joint(plain.observed.subset(rows), plain.base, plain.noise.subset(rows))
        linear = plain.linearise(state.fitted.law, state.fitted.scales, state.fitted.active)
    d = linear.jacobian[:, [first]]
    rest = linear.fixed(first)
    found, start = model.processes, state.variances
    if rows is not None:
        found, start = row_processes(found, plain, rows, start)
    model = likelihood.reduce(found, rest)
    pointing = likelihood.directions(model, rest, d)
    found_value = likelihood.estimate(model, pointing, start)
    if sizes_too:
        found_value = likelihood.widen_error(model, pointing, found_value)
    active = next(one for one in state.fitted.active if one.key == candidate.key)
    stands = active.values[0] / active.typical[0]
    # The estimate is what the fit, standing at this size, still lacks.
    return replace(found_value, amplitude=found_value.amplitude + stands)


def row_processes(
    found: Processes, plain: Joint, rows: NDArray, variances: Vector
) -> tuple[Processes, Vector]:
    """The processes of some rows (r,) and their variances, without those that reach none of the rows."""
    kept = np.array([bool(root[rows].any()) for root in found.roots])
    part = found.selected(kept)
    roots = tuple(root[rows] for root in part.roots)
    factor = np.hstack([plain.noise.whiten(root) for root in roots])
    return replace(part, roots=roots, factor=factor), variances[kept]


def shape_cost(fitted: Fitted, candidate: Candidate, observed: Observations) -> float:
    """What the freedom of a cause's shapes costs: -2 ln of the share of their prior that tests leave them (Laplace).

    The prior is about as wide as the fit's about each start. The share is that given the amplitude, whose own error is
    counted with its own prior. Zero for a cause without shapes.
    """
    if not candidate.shaped:
        return 0.0
    first = fitted.place_of(candidate.key)
    at = slice(first, first + len(candidate.values))
    own = fitted.covariance[at, at]
    left = float(np.linalg.slogdet(own)[1] - np.log(own[0, 0]))
    starts = np.ptp(np.array(candidate.cause.shapes(observed)), axis=0) / candidate.typical[1:]
    return float((2.0 * np.log1p(starts / np.sqrt(2.0 * np.pi))).sum()) - left
