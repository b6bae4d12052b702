"""Tables that are valid and wild: whatever a machine, a mix or a spreadsheet may do to moduli and phases.

Each seed draws a mix, a design from one test to three hundred, and some of the faults that
real tables show, at sizes beyond real ones. Every value stays within the limits of a measurement table.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd
from drawn.design import factorial
from drawn.laws import draw_law
from drawn.reallike import KINDS, Sizes

MOST_TESTS = 300
MODULUS, PHASE = (0.11, 1.9e5), (-89.0, 89.9)  # MPa, deg: within the limits of a measurement table
SIZES = Sizes(0.02, np.radians(0.5), 0.1, 0.03)
BRANCH = (1e-4, 500.0)  # Hz, of a wild band

Table = pd.DataFrame
Random = np.random.Generator


def draw(seed: int) -> tuple[Table, str]:
    """The table of a seed, and what is wild about it."""
    rng = np.random.default_rng([seed, 9])
    table = _measured(_design(rng), rng)
    chosen = rng.permutation(list(FAULTS))[: rng.integers(0, 5)].tolist()
    for name in chosen:
        table = FAULTS[name](table, rng)
    table = table.iloc[:MOST_TESTS].reset_index(drop=True)
    table["E_MPa"] = table["E_MPa"].clip(*MODULUS)
    table["phase_deg"] = table["phase_deg"].clip(*PHASE)
    return table, " ".join(sorted(chosen))


def _design(rng: Random) -> Table:
    """From one test to MOST_TESTS; every second table is of a usual size."""
    if rng.random() < 0.5:
        specimens, temperatures, frequencies = rng.integers(2, 5), rng.integers(3, 7), rng.integers(5, 7)
    else:
        specimens, temperatures, frequencies = rng.integers(1, 7), rng.integers(1, 8), rng.integers(1, 11)
    low = rng.uniform(-30.0, 10.0)
    levels = np.round(low + np.cumsum(rng.uniform(1.0, 15.0, temperatures)), 1)
    band = BRANCH if rng.random() < 0.1 else (0.1, 30.0)
    tested = np.unique(np.round(np.exp(rng.uniform(*np.log(band), frequencies)), 4))
    return factorial([f"S{n}" for n in range(specimens)], levels, tested)


def _measured(design: Table, rng: Random) -> Table:
    omega = 2.0 * np.pi * design["frequency_Hz"].to_numpy()
    modulus = draw_law(rng).modulus(omega, design["temperature_C"].to_numpy())
    level = rng.normal(0.0, SIZES.specimen, design["specimen"].nunique())
    scatter = rng.choice([0.0, 1e-4, 0.01, 0.05])
    logarithm = np.log(np.abs(modulus)) + level[pd.factorize(design["specimen"])[0]]
    logarithm = logarithm + scatter * rng.standard_normal(len(design))
    phase = np.degrees(np.angle(modulus)) + 30.0 * scatter * rng.standard_normal(len(design))
    return design.assign(E_MPa=1e-6 * np.exp(logarithm), phase_deg=phase)


def _real_like(kind: str) -> Callable[[Table, Random], Table]:
    """A fault that real tables show, up to three times as large."""

    def fault(table: Table, rng: Random) -> Table:
        if table["frequency_Hz"].nunique() < 2:
            return table
        added = rng.uniform(0.5, 3.0) * KINDS[kind](table, SIZES, rng)
        phase = table["phase_deg"] + np.degrees(added.imag)
        return table.assign(E_MPa=table["E_MPa"] * np.exp(added.real), phase_deg=phase)

    return fault


def _level_wobble(table: Table, rng: Random) -> Table:
    cell = table.groupby(["specimen", "temperature_C"]).ngroup().to_numpy()
    return table.assign(E_MPa=table["E_MPa"] * np.exp(rng.normal(0.0, 0.3, cell.max() + 1))[cell])


def _delay(table: Table, rng: Random) -> Table:
    late = np.degrees(2.0 * np.pi * table["frequency_Hz"] * rng.uniform(-5e-3, 5e-3))
    return table.assign(phase_deg=table["phase_deg"] + late)


def _offset(table: Table, rng: Random) -> Table:
    return table.assign(phase_deg=table["phase_deg"] + rng.uniform(-30.0, 30.0))


def _missing(table: Table, rng: Random) -> Table:
    kept = rng.random(len(table)) > rng.uniform(0.1, 0.7)
    return table[kept] if kept.any() else table.iloc[:1]


def _one_specimen(table: Table, rng: Random) -> Table:
    return table[table["specimen"] == table["specimen"].iloc[0]]


def _two_frequencies(table: Table, rng: Random) -> Table:
    return table[table["frequency_Hz"].isin(table["frequency_Hz"].unique()[:2])]


def _scaled(table: Table, rng: Random) -> Table:
    """Moduli of a gel, of steel, or over all that a table may hold."""
    small, large = table["E_MPa"].min(), table["E_MPa"].max()
    factor = rng.choice([MODULUS[0] / small, MODULUS[1] / large])
    if rng.random() < 0.3:
        share = np.log(table["E_MPa"] / small) / max(np.log(large / small), 1e-9)
        return table.assign(E_MPa=MODULUS[0] * np.exp(np.log(MODULUS[1] / MODULUS[0]) * share))
    return table.assign(E_MPa=factor * table["E_MPa"])


def _elastic(table: Table, rng: Random) -> Table:
    """A reference beam: one modulus, phases of about zero, at times zero exactly."""
    phase_scatter = rng.choice([0.0, 0.05])
    modulus, phase = rng.standard_normal((2, len(table)))
    return table.assign(E_MPa=7e4 * (1.0 + 0.01 * modulus), phase_deg=phase_scatter * phase)


def _viscous(table: Table, rng: Random) -> Table:
    phase = 89.5 + 0.2 * rng.standard_normal(len(table))
    return table.assign(E_MPa=0.2 + 0.02 * table["frequency_Hz"], phase_deg=phase)


def _nearly_equal(table: Table, rng: Random) -> Table:
    """Tests repeated to all digits but the last, under another specimen's name or as replicates."""
    again = table.sample(frac=rng.uniform(0.1, 1.0), random_state=rng)
    again = again.assign(E_MPa=again["E_MPa"] * (1.0 + 1e-9))
    if rng.random() < 0.5:
        return pd.concat([table, again.assign(specimen=again["specimen"] + "b")])
    return pd.concat([table.assign(replicate=1), again.assign(replicate=2)])


def _unsorted(table: Table, rng: Random) -> Table:
    return table.sample(frac=1.0, random_state=rng)


def _rounded(table: Table, rng: Random) -> Table:
    """Whole degrees and two or three digits of the modulus."""
    digits = 10.0 ** (np.floor(np.log10(table["E_MPa"].clip(*MODULUS))) - rng.integers(1, 3))
    modulus = np.round(table["E_MPa"] / digits) * digits
    return table.assign(E_MPa=modulus, phase_deg=table["phase_deg"].round())


def _mean_temperatures(table: Table, rng: Random) -> Table:
    """What a thermometer read instead of what was set."""
    read = table["temperature_C"] + rng.normal(0.0, 0.3, len(table))
    return table.assign(temperature_C=read.round(1))


def _own_frequencies(table: Table, rng: Random) -> Table:
    """Each specimen at frequencies of its own, so that nothing is repeated."""
    factor = 1.0 + 0.2 * pd.factorize(table["specimen"])[0]
    return table.assign(frequency_Hz=(table["frequency_Hz"] * factor).round(4).clip(1e-4, 999.0))


def _ordered(table: Table, rng: Random) -> Table:
    order = rng.permutation(len(table)) + 1
    return table.assign(order=order, cycles=np.cumsum(order) if rng.random() < 0.5 else 10 * order)


def _amplitudes(table: Table, rng: Random) -> Table:
    return table.assign(amplitude_m=rng.choice([2e-5, 6e-5, 6.2e-5], len(table)))


def _no_pattern(table: Table, rng: Random) -> Table:
    """Moduli and phases that no law has: drawn alike everywhere."""
    modulus, phase = np.exp(rng.uniform(*np.log([10.0, 5e4]), len(table))), rng.uniform(*PHASE, len(table))
    return table.assign(E_MPa=modulus, phase_deg=phase)


FAULTS: dict[str, Callable[[Table, Random], Table]] = {
    **{kind: _real_like(kind) for kind in KINDS},
    "level_wobble": _level_wobble, "delay": _delay, "offset": _offset, "missing": _missing,
    "one_specimen": _one_specimen, "two_frequencies": _two_frequencies, "scaled": _scaled, "elastic": _elastic,
    "viscous": _viscous, "nearly_equal": _nearly_equal, "unsorted": _unsorted, "rounded": _rounded,
    "mean_temperatures": _mean_temperatures, "own_frequencies": _own_frequencies, "ordered": _ordered,
    "amplitudes": _amplitudes, "no_pattern": _no_pattern,
}  # fmt: skip
