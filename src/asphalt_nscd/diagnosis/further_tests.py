"""Tests that a laboratory could do next, what each costs, and the model of a diagnosis at all of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis import discrepancy, levels
from asphalt_nscd.diagnosis.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import HEAD
from asphalt_nscd.diagnosis.diagnose import Diagnosis
from asphalt_nscd.diagnosis.information import Knowledge, Linear, Tested, parts
from asphalt_nscd.diagnosis.joint import Candidate, Fitted, Joint, Noise
from asphalt_nscd.diagnosis.observations import Observations

NEW, METAL = "a new specimen", "a metal reference specimen"
METAL_MODULUS, METAL_LEVEL = 70e9, 0.03  # Pa, aluminium; how well its modulus and the form factor are known
ISOTHERMS = 12  # of a table at most, at which further tests are weighed
APART = 8.0  # K between isotherms, from which one between them is worth a test
BEYOND = 10.0  # K beyond the tests
COLDEST, WARMEST = -20.0, 60.0  # degC
HALF = 0.5  # of the strain, at which linearity is checked


@dataclass(frozen=True)
class Costs:
    """Machine hours; those of a usual laboratory."""

    mounting: float = 0.5
    conditioning: float = 2.0  # of a specimen to a temperature other than that of the room
    room: tuple[float, float] = (15.0, 25.0)  # degC
    new_specimen: float = 4.0  # cored, trimmed, glued
    cycles: float = 20.0
    pause: float = 1.0 / 60.0  # at each frequency

    def hours(self, specimen: str, temperature: float, frequencies: Sequence[float]) -> float:
        away = specimen != METAL and not self.room[0] <= temperature <= self.room[1]
        fixed = self.mounting + self.conditioning * away + self.new_specimen * (specimen == NEW)
        return fixed + sum(self.cycles / f / 3600.0 + self.pause for f in frequencies)

    @property
    def sentence(self) -> str:
        return (
            f"Hours: {self.mounting:g} h to mount a specimen, {self.conditioning:g} h to bring it to a temperature "
            f"outside {self.room[0]:g} to {self.room[1]:g} degC, {self.new_specimen:g} h to prepare a new one, "
            f"{self.cycles:g} cycles and one minute at each frequency."
        )


@dataclass(frozen=True)
class Sweep:
    """One specimen at one temperature over some frequencies, at the usual strain or at half of it."""

    specimen: str
    temperature: float
    frequencies: tuple[float, ...]
    half_strain: bool
    tested: Tested
    hours: float


@dataclass(frozen=True)
class Possible:
    """The model at the tests done and at all that could follow.

    candidates: causes, in the order of the effects. departures: what effects come next, each with what it is about:
    "linear" and an isotherm (what changes at half the strain if the departure is proportional to the strain), "repeat"
    and a test that cannot be used, or "level" and an isotherm or specimen that is odd (by how much they depart).
    metal_frequencies: of the rows that follow those of the table [Hz].
    """

    table: Observations
    linear: Linear
    old: Tested
    sweeps: tuple[Sweep, ...]
    candidates: tuple[Candidate, ...]
    departures: tuple[tuple[str, str], ...]
    metal_frequencies: NDArray[np.float64]


def possible(diagnosis: Diagnosis, costs: Costs) -> Possible:
    """All sweeps, with the model linearised at the last fit."""
    observed = _with_strain(diagnosis.observed)
    fitted, base = diagnosis.ladder.fitted, diagnosis.ladder.joint.base
    laws_between = isinstance(base, FlexibleSpectrum)  # a Burgers law says nothing of another temperature
    table = _table(observed, temperatures(observed) if laws_between else observed.isotherms.tolist())
    noise = _noise(diagnosis.noise, observed, table)
    joint = Joint(table, base, noise)
    scales = np.append(fitted.scales, 0.0)
    candidates = _candidates(observed, table, fitted.active)
    at = joint.linearise(fitted.law, scales, fitted.active)
    nuisance, precision = _of_law(joint, at)
    keys = tuple(c.key for c in fitted.active)
    effects = np.column_stack([_effect(joint, at, candidate, keys) for candidate in candidates])
    names, roots, variances = _discrepancy(diagnosis, joint, at)
    of_law = nuisance.shape[1]
    nuisance = np.hstack([nuisance, *roots])
    sizes = np.concatenate(
        [np.full(root.shape[1], v) for root, v in zip(roots, variances, strict=True)] or [np.zeros(0)]
    )
    precision = _block(precision, 1.0 / sizes)
    metal = _metal(observed)
    rows = _metal_rows(metal, table, names, roots, nuisance.shape[1])
    effects = np.vstack([effects, _metal_effects(metal, candidates)])
    level = np.zeros((rows.shape[0] + table.size, 1), complex)
    level[table.size :] = 1.0
    nuisance = np.hstack([np.vstack([nuisance, rows]), level])
    linear = Linear(nuisance, _block(precision, np.array([METAL_LEVEL**-2])), effects)
    n = observed.size
    old = Tested(np.arange(n), _scatter(noise.within[:, :n], noise.shared[:, :n], noise.block[:n]))
    sweeps = tuple([*_sweeps(observed, table, noise, costs), *_metal_sweeps(metal, table.size, noise, costs)])
    known = Knowledge(linear, [old])
    # The law stands at its best already, so that only the discrepancy moves.
    left = parts(observed.logarithm - fitted.modelled)
    moved = known.expected(parts(linear.nuisance[old.rows]).T @ np.linalg.solve(old.scatter, left))
    departures = {
        ("linear", f"{t:g} degC"): _halved(table, t, departure, linear)
        for t, departure in _departures(linear, moved, names, roots, of_law, _doubtful(diagnosis)).items()
    }
    departures |= _odd(diagnosis, table, linear)
    departures |= _repeats(diagnosis, table, at.modelled + (linear.nuisance @ moved)[: table.size], linear)
    linear = replace(linear, effects=np.column_stack([linear.effects, *departures.values()]))
    return Possible(table, linear, old, sweeps, candidates, tuple(departures), metal.frequency)


def _repeats(
    diagnosis: Diagnosis, table: Observations, expected: NDArray[np.complex128], linear: Linear
) -> dict[tuple[str, str], NDArray[np.complex128]]:
    """By how much each test that cannot be used departs from what the others say of it, at the row that repeats it."""
    whole = diagnosis.whole or diagnosis.observed
    found = {}
    for one in diagnosis.suspects:
        if one.used:
            continue
        name, t, f = whole.names[whole.specimen[one.row]], whole.isotherm[one.row], whole.frequency[one.row]
        again = (
            (table.specimen == whole.specimen[one.row])
            & (table.isotherm == t)
            & (table.frequency == f)
            & ~_half(table)
        )
        if again.any():
            row = int(np.flatnonzero(again)[-1])
            effect = np.zeros(linear.effects.shape[0], complex)
            effect[row] = whole.logarithm[one.row] - expected[row]
            found["repeat", f"{name} at {t:g} degC, {f:g} Hz"] = effect
    return found


def _odd(
    diagnosis: Diagnosis, table: Observations, linear: Linear
) -> dict[tuple[str, str], NDArray[np.complex128]]:
    """By how much an isotherm or specimen is odd, at the rows that repeat it: ln E* (N,)."""
    done = diagnosis.whole or diagnosis.observed
    found: dict[tuple[str, str], NDArray[np.complex128]] = {}
    for one in [*levels.odd(done), *levels.odd_phases(done)]:
        again = (table.specimen == table.names.index(one["specimen"])) & ~_half(table)
        again[: diagnosis.observed.size] = False
        if one["temperature_C"] is not None:
            again &= table.isotherm == one["temperature_C"]
        size = np.log(one["factor"]) if "factor" in one else 1j * np.radians(one["phase_deg"])
        effect = np.zeros(linear.effects.shape[0], complex)
        effect[: table.size][again] = size
        found["level", levels.described(one)[0]] = effect
    return found


def _departures(
    linear: Linear,
    moved: NDArray,
    names: Sequence[str],
    roots: Sequence[NDArray],
    first: int,
    doubtful: Sequence[float],
) -> dict[float, NDArray[np.complex128]]:
    """By isotherm [degC], ln E* (N,) that its own discrepancy takes up."""
    found: dict[float, NDArray[np.complex128]] = {}
    for name, root in zip(names, roots, strict=True):
        place = name.rsplit(", ", 1)[0]
        t = float(place.removesuffix(" degC")) if place.endswith(" degC") else np.nan
        if t in doubtful:
            at = slice(first, first + root.shape[1])
            found[t] = found.get(t, 0.0) + linear.nuisance[:, at] @ moved[at]
        first += root.shape[1]
    return found


def _doubtful(diagnosis: Diagnosis) -> list[float]:
    """Isotherms [degC] whose own discrepancy is larger than the scatter of a test."""
    large = [name.rsplit(", ", 1)[0] for name, size in diagnosis.ladder.discrepancy.items() if size > 1.0]
    return [float(t) for t in diagnosis.observed.isotherms if f"{t:g} degC" in large]


def _half(table: Observations) -> NDArray[np.bool_]:
    strain = table.known("amplitude")
    return np.asarray(strain < 0.5 * (1.0 + HALF) * np.median(strain))


def _halved(
    table: Observations, t: float, departure: NDArray[np.complex128], linear: Linear
) -> NDArray[np.complex128]:
    here = np.zeros(linear.effects.shape[0], bool)
    here[: table.size] = (table.isotherm == t) & _half(table)
    return np.where(here, -HALF * departure, 0.0)


def _with_strain(observed: Observations) -> Observations:
    """With amplitudes relative to the usual one, where the table has none."""
    if observed.amplitude is not None:
        return observed
    return replace(observed, amplitude=np.ones(observed.size), whole=None)


def temperatures(observed: Observations) -> list[float]:
    """Isotherms tested (a dozen at most), one between any two that are far apart, one beyond either end [degC]."""
    tested = _some(observed.isotherms, ISOTHERMS)
    middle = [round(float(a + b) / 2.0) for a, b in pairwise(tested) if b - a >= APART]
    ends = [round(float(tested[0] - BEYOND)), round(float(tested[-1] + BEYOND))]
    inside = [t for t in (*middle, *ends) if COLDEST <= t <= WARMEST]
    return sorted({*map(float, tested), *map(float, inside)})


def frequencies(observed: Observations) -> list[float]:
    """Frequencies tested (at most eight of them), and one below them [Hz]."""
    tested = _some(observed.frequencies, 8)
    lower = float(f"{tested[0] / 3.0:.1g}")
    return [*([lower] if lower >= 0.01 else []), *map(float, tested)]


def _some(values: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """At most so many of them, spread evenly, both ends among them."""
    return values[np.unique(np.linspace(0, values.size - 1, min(most, values.size)).round().astype(int))]


def _table(observed: Observations, at: Sequence[float]) -> Observations:
    """The tests done, then every specimen, with a new one, at every temperature and frequency and two strains."""
    names = (*observed.names, NEW)
    full = [(s, t, f, 1.0) for s in range(len(names)) for t in at for f in frequencies(observed)]
    half = [
        (s, t, f, HALF)
        for s in range(len(observed.names))
        for t in _some(observed.isotherms, ISOTHERMS)
        for f in observed.frequencies
    ]
    specimen, temperature, frequency, strain = (np.array(column) for column in zip(*full, *half, strict=True))
    like = np.array([np.flatnonzero(observed.specimen == min(s, len(names) - 2))[0] for s in specimen])
    more = replace(
        observed.subset(like),
        specimen=specimen,
        temperature=temperature,
        frequency=frequency,
        amplitude=strain * float(np.median(observed.known("amplitude"))),
        nominal_temperature=temperature,
    )
    course: dict[str, Any] = {
        name: _after(observed, name, specimen)
        for name in ("order", "cycles", "time_step")
        if getattr(observed, name) is not None
    }
    more = replace(more, **course)
    both: dict[str, Any] = {
        name: np.concatenate([getattr(observed, name), getattr(more, name)])
        for name in (
            "specimen",
            "temperature",
            "frequency",
            "modulus",
            "form_factor",
            "inertia",
            "amplitude",
            *course,
        )
    }
    return replace(
        observed,
        **both,
        names=names,
        nominal_temperature=np.concatenate([observed.isotherm, temperature]),
        strain=None,
        quality={},
        whole=observed.table,
    )


def _after(observed: Observations, name: str, specimen: NDArray[np.int64]) -> NDArray[np.float64]:
    """A column for tests to come (n,): a specimen has borne all of its tests, a new one none; steps are as usual."""
    column = observed.known(name)
    if name == "time_step":
        return np.full(specimen.size, float(np.median(column)))
    borne = [column[observed.specimen == k].max() for k in range(len(observed.names))]
    return np.array([*borne, column.min()])[specimen]


def _noise(noise: Noise, observed: Observations, table: Observations) -> Noise:
    """Scatter of each isotherm; that of the whole table on a new one. Every sweep is a mounting of its own."""
    within, shared = (np.empty((2, table.size)) for _ in range(2))
    for wide, known in ((within, noise.within), (shared, noise.shared)):
        wide[:] = known.mean(axis=1, keepdims=True)
        for t in observed.isotherms:
            wide[:, table.isotherm == t] = known[:, observed.isotherm == t].mean(axis=1, keepdims=True)
        wide[:, : observed.size] = known
    block = np.concatenate([noise.block, noise.block.max() + 1 + np.arange(table.size - observed.size)])
    return replace(noise, within=within, shared=shared, block=block, discrepancy=None)


def _scatter(within: NDArray, shared: NDArray, block: NDArray) -> NDArray[np.float64]:
    same = block[:, None] == block
    out = np.zeros((2 * block.size, 2 * block.size))
    for k, (single, common) in enumerate(zip(within, shared, strict=True)):
        at = slice(k * block.size, (k + 1) * block.size)
        out[at, at] = np.diag(single**2) + np.outer(common, common) * same
    return out


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


def _effect(joint: Joint, at: Fitted, candidate: Candidate, active: tuple) -> NDArray[np.complex128]:
    if candidate.key in active:
        return joint.direction(at.law, at.scales, at.active, active.index(candidate.key), 0)
    return joint.direction(at.law, at.scales, (*at.active, candidate), len(at.active), 0)


def _of_law(joint: Joint, at: Fitted) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Derivatives (N, q) with respect to law, scales and shapes of causes; the precision of their priors."""
    modulus, slope = joint.apparent(at.law, at.active, at.scales)
    shapes = [
        joint.direction(at.law, at.scales, at.active, k, j)
        for k, candidate in enumerate(at.active)
        for j in range(1, len(candidate.values))
    ]
    rows = joint.base.prior(at.law)[1]
    precision = _block(rows.T @ rows, np.full(at.scales.size, joint.noise.scale**-2))
    return np.column_stack([slope / modulus[:, None], *shapes]), _block(precision, np.ones(len(shapes)))


def _block(matrix: NDArray, diagonal: NDArray) -> NDArray[np.float64]:
    out = np.zeros((matrix.shape[0] + diagonal.size,) * 2)
    out[: matrix.shape[0], : matrix.shape[0]] = matrix
    out[range(matrix.shape[0], out.shape[0]), range(matrix.shape[0], out.shape[0])] = diagonal
    return out


def _discrepancy(
    diagnosis: Diagnosis, joint: Joint, at: Fitted
) -> tuple[list[str], list[NDArray[np.complex128]], list[float]]:
    """Names, roots (N, rank) and variances of the processes; a new isotherm between those tested, a usual specimen."""
    sizes = diagnosis.ladder.discrepancy
    if not sizes:
        return [], [], []
    found = discrepancy.processes(joint, at)
    tested = diagnosis.observed.isotherms
    variances = [_variance(name, sizes, tested) for name in found.names]
    kept = [k for k, variance in enumerate(variances) if variance > discrepancy.LEAST]
    return [found.names[k] for k in kept], [found.roots[k] for k in kept], [variances[k] for k in kept]


def _variance(name: str, sizes: dict[str, float], tested: NDArray[np.float64]) -> float:
    if name in sizes:
        return sizes[name] ** 2
    place, part = name.rsplit(", ", 1)
    if place.endswith(" degC"):
        known = [sizes.get(f"{t:g} degC, {part}", 0.0) for t in tested]
        return float(np.interp(float(place.removesuffix(" degC")), tested, known)) ** 2
    alike = [
        size**2
        for other, size in sizes.items()
        if other.startswith("specimen ") and other.endswith(f", {part}")
    ]
    return float(np.mean(alike)) if alike else 0.0


def _sweeps(observed: Observations, table: Observations, noise: Noise, costs: Costs) -> Iterator[Sweep]:
    first = observed.size
    halved = _half(table)
    groups: dict[tuple, dict[float, int]] = {}
    for row in range(first, table.size):
        key = (int(table.specimen[row]), float(table.isotherm[row]), bool(halved[row]))
        groups.setdefault(key, {}).setdefault(float(table.frequency[row]), row)
    for (specimen, temperature, half), rows in groups.items():
        for chosen in _frequency_sets(sorted(rows), observed.frequencies, half):
            at = np.array([rows[f] for f in chosen])
            yield _sweep(table.names[specimen], temperature, chosen, half, at, noise, costs)


def _sweep(
    specimen: str,
    temperature: float,
    chosen: tuple[float, ...],
    half: bool,
    at: NDArray[np.int64],
    noise: Noise,
    costs: Costs,
) -> Sweep:
    one = np.zeros(at.size, int)
    source = np.minimum(at, noise.within.shape[1] - 1)
    tested = Tested(at, _scatter(noise.within[:, source], noise.shared[:, source], one))
    return Sweep(specimen, temperature, chosen, half, tested, costs.hours(specimen, temperature, chosen))


def _frequency_sets(every: list[float], tested: NDArray, half: bool) -> list[tuple[float, ...]]:
    """The whole band, with a lower frequency, its halves and its ends."""
    usual = [f for f in every if f >= tested[0]]
    sets = [tuple(usual)]
    if not half:
        n = len(usual) // 2
        sets += [tuple(every), tuple(usual[:n]), tuple(usual[-n:]), (usual[0],), (usual[-1],)]
    return [chosen for chosen in dict.fromkeys(sets) if chosen]


def _metal(observed: Observations) -> Observations:
    """A metal specimen at the frequencies tested."""
    at = np.array(
        [
            np.flatnonzero(observed.frequency == f)[0]
            for f in frequencies(observed)
            if f in observed.frequencies
        ]
    )
    return replace(observed.subset(at), modulus=np.full(at.size, METAL_MODULUS + 0j))


def _metal_effects(metal: Observations, candidates: Sequence[Candidate]) -> NDArray[np.complex128]:
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


def _metal_rows(
    metal: Observations,
    table: Observations,
    names: Sequence[str],
    roots: Sequence[NDArray[np.complex128]],
    columns: int,
) -> NDArray[np.complex128]:
    """Of the nuisance only what the machine adds to all tests reaches the metal."""
    rows = np.zeros((metal.size, columns), complex)
    first = columns - sum(root.shape[1] for root in roots)
    at = [int(np.flatnonzero(table.frequency == f)[0]) for f in metal.frequency]
    for name, root in zip(names, roots, strict=True):
        if name.startswith("all tests"):
            rows[:, first : first + root.shape[1]] = root[at]
        first += root.shape[1]
    return rows


def _metal_sweeps(metal: Observations, first: int, noise: Noise, costs: Costs) -> Iterator[Sweep]:
    f = [float(value) for value in metal.frequency]
    ends = sorted({0, len(f) // 2, len(f) - 1})
    for chosen in dict.fromkeys([tuple(range(len(f))), tuple(ends), (len(f) - 1,), (0, len(f) - 1)]):
        at = np.array(sorted(set(chosen))) + first
        one = np.full((2, at.size), np.array(noise.sigma)[:, None])
        tested = Tested(at, _scatter(one, np.zeros_like(one), np.zeros(at.size, int)))
        used = tuple(f[k - first] for k in at)
        yield Sweep(METAL, 20.0, used, False, tested, costs.hours(METAL, 20.0, used))
