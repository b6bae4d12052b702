"""Tests that a laboratory could do next, as sweeps over frequency, and what each costs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from asphalt_nscd.diagnosis.next_tests.information import Tested
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations

NEW, METAL = "a new specimen", "a metal reference specimen"
METAL_MODULUS = 70e9  # Pa, aluminium
ISOTHERMS = 12  # of a table at most, at which further tests are weighed
APART = 8.0  # K between isotherms, from which one between them is worth a test
BEYOND = 10.0  # K beyond the tests
COLDEST, WARMEST = -20.0, 60.0  # degC
HALF = 0.5  # of the strain, at which linearity is checked


@dataclass(frozen=True)
class Costs:
    """Machine hours of a usual laboratory.

    `mounting`, `pause` (at each frequency) and `new_specimen` (cored, trimmed, glued) in h; `conditioning` [h] is to a
    temperature outside `room` [degC]; `cycles` counts load cycles at each frequency.
    """

    mounting: float = 0.5
    conditioning: float = 2.0
    room: tuple[float, float] = (15.0, 25.0)
    new_specimen: float = 4.0
    cycles: float = 20.0
    pause: float = 1.0 / 60.0

    def hours(self, specimen: str, temperature: float, frequencies: Sequence[float]) -> float:
        """Machine hours of a sweep of one specimen [h], at a temperature [degC] over frequencies [Hz]."""
        away = specimen != METAL and not self.room[0] <= temperature <= self.room[1]
        fixed = self.mounting + self.conditioning * away + self.new_specimen * (specimen == NEW)
        return fixed + sum(self.cycles / f / 3600.0 + self.pause for f in frequencies)

    @property
    def sentence(self) -> str:
        """What was assumed of the hours, for a reader."""
        return (
            f"Hours: {self.mounting:g} h to mount a specimen, {self.conditioning:g} h to bring it to a temperature "
            f"outside {self.room[0]:g} to {self.room[1]:g} degC, {self.new_specimen:g} h to prepare a new one, "
            f"{self.cycles:g} cycles and one minute at each frequency."
        )


@dataclass(frozen=True)
class Sweep:
    """Tests of one specimen at one temperature [degC] over some frequencies [Hz], and the hours that they take."""

    specimen: str
    temperature: float
    frequencies: tuple[float, ...]
    half_strain: bool
    tested: Tested
    hours: float


def temperatures(observed: Observations) -> list[float]:
    """Isotherms tested (twelve at most), one between any two far apart, one beyond either end [degC], ascending."""
    tested = _thinned(observed.isotherms, ISOTHERMS)
    middle = [round(float(a + b) / 2.0) for a, b in pairwise(tested) if b - a >= APART]
    ends = [round(float(tested[0] - BEYOND)), round(float(tested[-1] + BEYOND))]
    inside = [t for t in (*middle, *ends) if COLDEST <= t <= WARMEST]
    return sorted({*map(float, tested), *map(float, inside)})


def frequencies(observed: Observations) -> list[float]:
    """Frequencies tested (at most eight of them), and one below them [Hz], ascending."""
    tested = _thinned(observed.frequencies, 8)
    # A third, to a digit that a machine can be set to; below 0.01 Hz twenty cycles take more than half an hour.
    lower = float(f"{tested[0] / 3.0:.1g}")
    return [*([lower] if lower >= 0.01 else []), *map(float, tested)]


def _thinned(values: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """At most `most` of the values, spread evenly, both ends among them."""
    return values[np.unique(np.linspace(0, values.size - 1, min(most, values.size)).round().astype(int))]


def fill_strain(observed: Observations) -> Observations:
    """The same tests with amplitudes relative to the usual one, where the table has none."""
    if observed.amplitude is not None:
        return observed
    return replace(observed, amplitude=np.ones(observed.size), whole=None)


def every_test(observed: Observations, at: Sequence[float]) -> Observations:
    """The tests done, then every specimen and a new one at all temperatures `at` [degC] and frequencies.

    Last, at half the strain, all frequencies of the table at some of the isotherms tested of a specimen. The modulus of
    a test to come is that of another one, until the law says it.
    """
    names = (*observed.names, NEW)
    full = [(s, t, f, 1.0) for s in range(len(names)) for t in at for f in frequencies(observed)]
    tested = set(zip(observed.specimen.tolist(), observed.isotherm.tolist(), strict=True))
    half = [  # beside the tests at the usual strain
        (s, t, f, HALF)
        for s in range(len(observed.names))
        for t in _thinned(observed.isotherms, ISOTHERMS).tolist()
        for f in observed.frequencies
        if (s, t) in tested
    ]
    specimen, temperature, frequency, strain = (np.array(column) for column in zip(*full, *half, strict=True))
    # A new specimen has no row yet: it takes the geometry of the last one.
    like = np.array([np.flatnonzero(observed.specimen == min(s, len(names) - 2))[0] for s in specimen])
    course: dict[str, Any] = {
        name: _coming_column(observed, name, specimen)
        for name in ("order", "cycles", "time_step")
        if getattr(observed, name) is not None
    }
    done = replace(observed, nominal_temperature=observed.isotherm, strain=None, quality={})
    more = replace(
        done.subset(like),
        specimen=specimen,
        temperature=temperature,
        frequency=frequency,
        amplitude=strain * float(np.median(observed.known("amplitude"))),
        nominal_temperature=temperature,
        **course,
    )
    both: dict[str, Any] = {
        name: np.concatenate([column, getattr(more, name)]) for name, column in done.columns.items()
    }
    # Effects stay relative to the largest strain and the last cycle of the tests done.
    return replace(done, **both, names=names, whole=observed.table)


def _coming_column(observed: Observations, name: str, specimen: NDArray[np.int64]) -> NDArray[np.float64]:
    """A column for tests to come (n,): a specimen has borne all of its tests, a new one none; steps are as usual."""
    column = observed.known(name)
    if name == "time_step":
        return np.full(specimen.size, float(np.median(column)))
    borne = [column[observed.specimen == k].max() for k in range(len(observed.names))]
    return np.array([*borne, column.min()])[specimen]


def half_strain_rows(table: Observations) -> NDArray[np.bool_]:
    """Rows of tests at half the usual strain (N,)."""
    strain = table.known("amplitude")
    return np.asarray(strain < 0.5 * (1.0 + HALF) * np.median(strain))


def noise_of(noise: Noise, observed: Observations, table: Observations) -> Noise:
    """Noise of all N tests: scatter by isotherm, of the whole table on a new one; each new sweep is a mounting."""
    within, shared = (np.empty((2, table.size)) for _ in range(2))
    for wide, known in ((within, noise.within), (shared, noise.shared)):
        wide[:] = known.mean(axis=1, keepdims=True)
        for t in observed.isotherms:
            wide[:, table.isotherm == t] = known[:, observed.isotherm == t].mean(axis=1, keepdims=True)
        wide[:, : observed.size] = known
    conditions = np.column_stack([table.specimen, table.isotherm, half_strain_rows(table)])[observed.size :]
    sweep = np.unique(conditions, axis=0, return_inverse=True)[1].ravel()
    block = np.concatenate([noise.block, noise.block.max() + 1 + sweep])
    return replace(noise, within=within, shared=shared, block=block, discrepancy=None)


def scatter_of(within: NDArray, shared: NDArray, block: NDArray) -> NDArray[np.float64]:
    """Covariance (2n, 2n) of ln|E*|, then phase, from standard deviations (2, n) of a test and of its mounting."""
    same = block[:, None] == block
    of_tests, of_mountings = within**2, shared[:, :, None] * shared[:, None] * same
    return block_diag(*map(np.diag, of_tests)) + block_diag(*of_mountings)


def sweeps_at(observed: Observations, table: Observations, noise: Noise, costs: Costs) -> Iterator[Sweep]:
    """Sweeps of all specimens, made of the rows of `table` behind those of `observed`; `noise` is that of all N."""
    first = observed.size
    halved = half_strain_rows(table)
    groups: dict[tuple, dict[float, int]] = {}
    for row in range(first, table.size):
        key = (int(table.specimen[row]), float(table.isotherm[row]), bool(halved[row]))
        groups.setdefault(key, {}).setdefault(float(table.frequency[row]), row)
    for (specimen, temperature, half), rows in groups.items():
        every = tuple(sorted(rows))
        usual = tuple(f for f in every if f >= observed.frequencies[0])
        # A part of the band saves minutes of hours, and cannot be held against its own isotherm.
        for chosen in dict.fromkeys([usual] if half else [usual, every]):
            at, name = np.array([rows[f] for f in chosen]), table.names[specimen]
            scatter = scatter_of(noise.within[:, at], noise.shared[:, at], np.zeros(at.size, int))
            hours = costs.hours(name, temperature, chosen)
            yield Sweep(name, temperature, chosen, half, Tested(at, scatter), hours)


def metal_tests(observed: Observations) -> Observations:
    """Tests of a metal specimen, one row for each of the frequencies tested (at most eight)."""
    # in one order, however the table is sorted
    rows = np.lexsort((np.array(observed.names)[observed.specimen], observed.temperature))
    tested, first = np.unique(observed.frequency[rows], return_index=True)
    at = rows[first[np.isin(tested, frequencies(observed))]]
    return replace(observed.subset(at), modulus=np.full(at.size, METAL_MODULUS + 0j))


def sweeps_on_metal(metal: Observations, first: int, noise: Noise, costs: Costs) -> Iterator[Sweep]:
    """Sweeps of a metal specimen, whose rows stand behind those of the table, from row `first` on."""
    f = [float(value) for value in metal.frequency]
    ends = sorted({0, len(f) - 1})  # both: of one frequency nobody tells an offset from a delay
    for chosen in dict.fromkeys([tuple(range(len(f))), tuple(sorted({*ends, len(f) // 2})), tuple(ends)]):
        at = np.array(chosen) + first
        one = np.full((2, at.size), np.array(noise.sigma)[:, None])
        tested = Tested(at, scatter_of(one, np.zeros_like(one), np.zeros(at.size, int)))
        used = tuple(f[k - first] for k in at)
        yield Sweep(METAL, 20.0, used, False, tested, costs.hours(METAL, 20.0, used))
