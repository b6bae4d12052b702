"""The model of a diagnosis at the tests done and at all that could follow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import HEAD
from asphalt_nscd.diagnosis.model import discrepancy
from asphalt_nscd.diagnosis.model.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.model.discrepancy import Process
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.next_tests import sweeps
from asphalt_nscd.diagnosis.next_tests.information import Knowledge, Linear, Tested
from asphalt_nscd.diagnosis.next_tests.sweeps import HALF, Costs, Sweep, half_strain_rows
from asphalt_nscd.diagnosis.observed.copies import copied
from asphalt_nscd.diagnosis.observed.observations import Complex, Observations, Vector
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis

Columns = Sequence[tuple[Process, slice]]  # of the nuisance, those of each process
METAL_LEVEL = 0.03  # how well the modulus of a metal specimen and its form factor are known


@dataclass(frozen=True)
class Departure:
    """By how much ln E* (N,) of tests departs from the model, and what that is about.

    `kind`: "linear", what changes at half the strain at an isotherm if the departure is proportional to the strain;
    "repeat", a test that cannot be used (`copied`: because it or another is a copy); "level", an isotherm or specimen
    that is odd (`odd`: the entry of diagnosis.json). `isotherm` in degC, `frequency` in Hz; None where it
    is everywhere.
    """

    kind: str
    effect: Complex
    specimen: str | None = None
    isotherm: float | None = None
    frequency: float | None = None
    odd: Mapping[str, Any] | None = None
    copied: bool = False


@dataclass(frozen=True)
class Possible:
    """The model at the tests done, then at all that could follow, then at tests of metal.

    `known` is what the tests done, `old`, say. Columns of the effects are `candidates`, then `departures`; rows of
    metal, at `metal_frequencies` [Hz], follow those of `table`.
    """

    table: Observations
    linear: Linear
    old: Tested
    known: Knowledge
    sweeps: tuple[Sweep, ...]
    candidates: tuple[Candidate, ...]
    departures: tuple[Departure, ...]
    metal_frequencies: Vector


def possible(diagnosis: Diagnosis, costs: Costs) -> Possible:
    """All sweeps that could follow, with the model linearised at the last fit."""
    observed = sweeps.fill_strain(diagnosis.observed)
    fitted, base = diagnosis.ladder.fitted, diagnosis.ladder.joint.base
    laws_between = isinstance(base, FlexibleSpectrum)  # a Burgers law says nothing of another temperature
    at_all = sweeps.temperatures(observed) if laws_between else observed.isotherms.tolist()
    table = sweeps.every_test(observed, at_all)
    noise = sweeps.noise_of(diagnosis.noise, observed, table)
    # A new specimen begins at the level of the mix, with the spread that specimens have.
    scales = np.append(fitted.scales, 0.0)
    # Some effects go with the modulus, which the law says of tests to come.
    said = Joint(table, base, noise).apparent(fitted.law, (), scales)[0][observed.size :]
    table = replace(table, modulus=np.concatenate([observed.modulus, said]))
    joint = Joint(table, base, noise)
    candidates = _candidates(observed, table, fitted.active)
    at = joint.linearise(fitted.law, scales, fitted.active)
    nuisance, precision = _law_derivatives(joint, at)
    keys = tuple(c.key for c in fitted.active)
    effects = np.column_stack([_effect(joint, at, candidate, keys) for candidate in candidates])
    blocks = [nuisance]
    if diagnosis.laboratory is not None:  # every sweep is a mounting of its own
        blocks.append(diagnosis.laboratory.factor(joint, at, noise.block))
        precision = block_diag(precision, np.eye(blocks[1].shape[1]))
    processes, roots, variances = _discrepancy(diagnosis, joint, at)
    ranks = [root.shape[1] for root in roots]
    ends = np.cumsum([sum(block.shape[1] for block in blocks), *ranks])
    columns = [(one, slice(a, b)) for one, (a, b) in zip(processes, pairwise(ends), strict=True)]
    metal = sweeps.metal_tests(observed)
    effects = np.vstack([effects, _metal_effects(metal, candidates)])
    whole = np.zeros((table.size + metal.size, int(ends[-1]) + 1), complex)
    whole[: table.size, :-1] = np.hstack([*blocks, *roots])
    # What the machine adds to all tests reaches metal. It has a level of its own besides: its phase and its slope over
    # frequency tell of the machine, its modulus hardly.
    like = [int(np.flatnonzero(table.frequency == f)[0]) for f in metal.frequency]
    for process, of_process in columns:
        if process.kind == "all":
            whole[table.size :, of_process] = whole[like, of_process]
    whole[table.size :, -1] = 1.0
    of_processes = np.diag(1.0 / np.repeat(variances, ranks))
    linear = Linear(whole, block_diag(precision, of_processes, METAL_LEVEL**-2), effects)
    n = observed.size
    old = Tested(np.arange(n), sweeps.scatter_of(noise.within[:, :n], noise.shared[:, :n], noise.block[:n]))
    further = [*sweeps.sweeps_at(observed, table, noise, costs)]
    further += sweeps.sweeps_on_metal(metal, table.size, noise, costs)
    known = Knowledge(linear, [old])
    # The law stands at its best already, so that only the discrepancy moves.
    moved = known.mean(observed.logarithm - fitted.modelled)
    departures = [
        *_nonlinear_departures(diagnosis, table, linear, moved, columns),
        *(_again(diagnosis, table, linear, one) for one in _odd(diagnosis)),
        *_repeats(diagnosis, table, at.modelled + (linear.nuisance @ moved)[: table.size], linear),
    ]
    linear = replace(linear, effects=np.column_stack([linear.effects, *(one.effect for one in departures)]))
    known = known.with_effects(linear.effects)
    return Possible(table, linear, old, known, tuple(further), candidates, tuple(departures), metal.frequency)


def _repeats(
    diagnosis: Diagnosis, table: Observations, expected: Complex, linear: Linear
) -> Iterator[Departure]:
    """By how much each test that cannot be used departs from what the others say of it, at the row that repeats it."""
    whole = diagnosis.whole or diagnosis.observed
    usual = ~half_strain_rows(table)
    of_copies = {row for one in copied(whole) for row in one.rows}
    for one in [suspect for suspect in diagnosis.suspects if not suspect.used]:
        k, t, f = whole.specimen[one.row], whole.isotherm[one.row], whole.frequency[one.row]
        again = (table.specimen == k) & (table.isotherm == t) & (table.frequency == f) & usual
        if again.any():
            # Tests to come stand behind those done: the last such row is the repetition.
            row = int(np.flatnonzero(again)[-1])
            effect = np.zeros(linear.effects.shape[0], complex)
            effect[row] = whole.logarithm[one.row] - expected[row]
            yield Departure("repeat", effect, whole.names[k], float(t), float(f), copied=one.row in of_copies)


def _odd(diagnosis: Diagnosis) -> list[dict[str, Any]]:
    """Faults of one place whose size is a factor on |E*| or a phase, as in diagnosis.json."""
    return [one for one in diagnosis.ladder.confined_faults if "factor" in one or "phase_deg" in one]


def _again(diagnosis: Diagnosis, table: Observations, linear: Linear, one: Mapping[str, Any]) -> Departure:
    """By how much an isotherm or specimen is odd, at the rows that repeat it."""
    again = (table.specimen == table.names.index(one["specimen"])) & ~half_strain_rows(table)
    again[: diagnosis.observed.size] = False
    if one["temperature_C"] is not None:
        again &= table.isotherm == one["temperature_C"]
    size = np.log(one["factor"]) if "factor" in one else 1j * np.radians(one["phase_deg"])
    effect = np.zeros(linear.effects.shape[0], complex)
    # A delay's phase is told at the highest frequency and falls with it.
    share = table.frequency[again] / diagnosis.observed.frequencies[-1] if "delay_s" in one else 1.0
    effect[: table.size][again] = size * share
    return Departure("level", effect, one["specimen"], one["temperature_C"], odd=one)


def _nonlinear_departures(
    diagnosis: Diagnosis, table: Observations, linear: Linear, moved: NDArray, columns: Columns
) -> Iterator[Departure]:
    """What half the strain changes at each isotherm whose own discrepancy is larger than the scatter of a test."""
    large = {one.isotherm for one, size in diagnosis.ladder.discrepancy.items() if size > 1.0}
    for t in dict.fromkeys(process.isotherm for process, _ in columns):
        if t is not None and t in large:
            own = sum(linear.nuisance[:, at] @ moved[at] for process, at in columns if process.isotherm == t)
            here = np.zeros(linear.effects.shape[0], bool)
            here[: table.size] = (table.isotherm == t) & half_strain_rows(table)
            yield Departure("linear", np.where(here, -HALF * own, 0.0), isotherm=t)


def _candidates(
    observed: Observations, table: Observations, active: tuple[Candidate, ...]
) -> tuple[Candidate, ...]:
    """Causes in the fit first, then every other one that tests could show, in one shape each."""
    places = {None, *observed.names, *map(float, observed.isotherms)}
    found = {candidate.key: candidate for candidate in active}
    for cause in CATALOGUE:
        shapes = cause.shapes(table)
        for place in cause.places(table):
            if place in places:
                middle = Candidate(cause, place, (0.0, *shapes[len(shapes) // 2]))
                found.setdefault(middle.key, middle)
    return tuple(found.values())


def _effect(joint: Joint, at: Fitted, candidate: Candidate, active: tuple) -> Complex:
    if candidate.key in active:
        return joint.direction(at.law, at.scales, at.active, active.index(candidate.key), 0)
    return joint.direction(at.law, at.scales, (*at.active, candidate), len(at.active), 0)


def _law_derivatives(joint: Joint, at: Fitted) -> tuple[Complex, Vector]:
    """Derivatives (N, q) of ln E* by law, scales and shapes of causes; the precision (q, q) of their priors."""
    modulus, slope = joint.apparent(at.law, at.active, at.scales)
    shapes = [
        joint.direction(at.law, at.scales, at.active, k, j)
        for k, candidate in enumerate(at.active)
        for j in range(1, len(candidate.values))
    ]
    rows = joint.base.prior(at.law)[1]
    of_scales = joint.noise.scale**-2 * np.eye(at.scales.size)
    precision = block_diag(rows.T @ rows, of_scales, np.eye(len(shapes)))
    return np.column_stack([slope / modulus[:, None], *shapes]), precision


def _discrepancy(
    diagnosis: Diagnosis, joint: Joint, at: Fitted
) -> tuple[list[Process], list[Complex], list[float]]:
    """Processes of the discrepancy, with root (N, rank) and variance of each."""
    sizes = diagnosis.ladder.discrepancy
    if not sizes:
        return [], [], []
    found = discrepancy.processes(joint, at)
    tested = diagnosis.observed.isotherms
    variances = [_variance(process, sizes, tested) for process in found.described]
    # A process of no size would have an infinite precision.
    kept = [k for k, variance in enumerate(variances) if variance > discrepancy.LEAST]
    return [found.described[k] for k in kept], [found.roots[k] for k in kept], [variances[k] for k in kept]


def _variance(process: Process, sizes: Mapping[Process, float], tested: Vector) -> float:
    """Variance of a process: as fitted; at a new isotherm between its neighbours', else the mean of its kind."""
    if process in sizes:
        return sizes[process] ** 2
    if process.isotherm is not None:
        known = [sizes.get(replace(process, isotherm=float(t)), 0.0) for t in tested]
        return float(np.interp(process.isotherm, tested, known)) ** 2
    alike = [size**2 for one, size in sizes.items() if (one.kind, one.part) == (process.kind, process.part)]
    return float(np.mean(alike)) if alike else 0.0


def _metal_effects(metal: Observations, candidates: Sequence[Candidate]) -> Complex:
    """What head and channel do to a test on metal; causes of the mix and of a specimen do nothing."""
    out = np.zeros((metal.size, len(candidates)), complex)
    for k, candidate in enumerate(candidates):
        if candidate.place is None and candidate.cause.stage >= HEAD:
            step = np.array([1e-3 * candidate.typical[0], *([0.0] * (len(candidate.values) - 1))])
            high, low = (
                candidate.cause.apparent(metal.modulus, np.array(candidate.values) + sign * step, metal)
                for sign in (1, -1)
            )
            out[:, k] = np.log(high / low) / 2e-3
    return out
