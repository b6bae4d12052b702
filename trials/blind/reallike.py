"""Tables like measured ones: a mix of `laws`, and what real tables show that no law has.

    background, seal = draw(7, "broken_hot")

All tables have few temperatures and specimens, missing tests, levels that wobble between specimens and isotherms,
and a discrepancy common to all specimens, of a family that is no Gaussian process. KINDS says what each adds;
the sizes are those seen in real tables. None holds a cause of the catalogue. Nothing here comes from the
package under test.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .backgrounds import AMPLITUDE, Background
from .design import factorial
from .laws import draw_law

Logarithm = NDArray[np.complex128]  # added to ln E*, (n,): relative modulus, and phase [rad]

TEMPERATURES = (-10.0, 4.0, 10.0, 21.0, 30.0, 37.0, 45.0, 54.0)  # degC
LEAST_GAP = 8.0  # K between isotherms
BANDS = (
    (0.1, 0.5, 1.0, 5.0, 10.0, 25.0),
    (0.1, 0.3, 1.0, 3.0, 10.0, 25.0),
    (1.0, 3.0, 6.0, 10.0, 25.0, 40.0),
)
MOST_MISSING = 0.12  # share of the tests
LEAST_LEFT = 3  # tests of a specimen on an isotherm
PHASES = (0.5, 80.0)  # deg, that a table may show


@dataclass(frozen=True)
class Sizes:
    """Standard deviations of one table: of a test, of a specimen's level, of its level on one isotherm."""

    modulus: float
    phase: float  # rad
    specimen: float
    wobble: float
    discrepancy: float  # of ln|E*|; of the phase [rad] a third of it


def _rank(design: pd.DataFrame, column: str) -> NDArray[np.int64]:
    return np.unique(design[column].to_numpy(), return_inverse=True)[1]


def _band(design: pd.DataFrame) -> NDArray[np.float64]:
    """Place of each test in the band, by ln f, from 0 to 1."""
    x = np.log(design["frequency_Hz"].to_numpy(float))
    return (x - x.min()) / np.ptp(x)


def _nothing(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    return np.zeros(len(design), complex)


def _heavy_tails(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """One test in fifteen is off by Student's t with two degrees of freedom, times four."""
    n = len(design)
    hit = rng.random(n) < 1.0 / 15.0
    modulus, phase = np.clip(rng.standard_t(2.0, (2, n)), -6.0, 6.0) * 4.0
    return hit * (sizes.modulus * modulus + 1j * sizes.phase * phase)


def _broken_hot(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """The one or two hottest isotherms stiffen with frequency by more than their phase permits."""
    temperature = _rank(design, "temperature_C")
    broken = rng.integers(1, 3) if temperature.max() > 2 else 1
    weight = np.clip(temperature - temperature.max() + broken, 0, None) / broken
    steeper, lost = rng.uniform(0.15, 0.45), np.radians(rng.uniform(6.0, 18.0))
    x = _band(design)
    return weight * (steeper * (x - 0.5) - 1j * lost * x ** rng.uniform(0.7, 1.5))


def _hooks(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """About 5 deg too much at the highest frequency of the coldest isotherms, in most specimens."""
    cold = _rank(design, "temperature_C") < rng.integers(1, 3)
    specimen = _rank(design, "specimen")
    spared = rng.integers(specimen.max() + 1) if specimen.max() > 1 else -1
    hit = cold & (_band(design) == 1.0) & (specimen != spared)
    return hit * 1j * np.radians(rng.normal(5.0, 0.7, len(design)))


def _gain_step(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """A step of 10 to 20 % in the modulus above some 5 Hz, at every temperature."""
    above = design["frequency_Hz"].to_numpy(float) > rng.choice([3.0, 5.0, 9.0])
    step = rng.choice([-1.0, 1.0]) * rng.uniform(0.10, 0.20)
    return np.log1p(step) * above.astype(complex)


def _odd_specimen(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """One specimen with about 0.6 of the modulus; its phase, 1.2 of the others', is set in `draw`."""
    specimen = _rank(design, "specimen")
    return np.log(rng.uniform(0.55, 0.7)) * (specimen == rng.integers(specimen.max() + 1)).astype(complex)


def _rough(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """The discrepancy again, three times as large."""
    return _discrepancy(design, 3.0 * sizes.discrepancy, rng)[1]


def _mixed(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    return sum(part(design, sizes, rng) for part in (_heavy_tails, _broken_hot, _hooks))


KINDS: dict[str, Callable[[pd.DataFrame, Sizes, np.random.Generator], Logarithm]] = {
    "scatter": _nothing,
    "heavy_tails": _heavy_tails,
    "broken_hot": _broken_hot,
    "hooks": _hooks,
    "gain_step": _gain_step,
    "odd_specimen": _odd_specimen,
    "rough": _rough,
    "mixed": _mixed,
}
ODD_PHASE = 1.2  # of an odd specimen over the others


def _sine(x: NDArray, rng: np.random.Generator) -> NDArray:
    return np.sqrt(2.0) * np.sin(2.0 * np.pi * (rng.uniform(0.4, 1.4) * x + rng.random()))


def _walk(x: NDArray, rng: np.random.Generator) -> NDArray:
    """Steps of Student's t between one frequency and the next."""
    steps = np.cumsum(rng.standard_t(3.0, x.size))
    return (steps - steps.mean()) / max(steps.std(), 1e-9)


def _corner(x: NDArray, rng: np.random.Generator) -> NDArray:
    """Straight to one side of a corner, level to the other."""
    bend = np.maximum(x - rng.uniform(0.2, 0.7), 0.0)
    return rng.choice([-1.0, 1.0]) * (bend - bend.mean()) / max(bend.std(), 1e-9)


FAMILIES = {"sine": _sine, "walk": _walk, "corner": _corner}


def _discrepancy(design: pd.DataFrame, size: float, rng: np.random.Generator) -> tuple[str, Logarithm]:
    """A function of ln f for each isotherm, of one family for the table, larger where it is hot."""
    family = str(rng.choice(list(FAMILIES)))
    temperature, place = _rank(design, "temperature_C"), _rank(design, "frequency_Hz")
    x = np.linspace(0.0, 1.0, place.max() + 1)
    added = np.zeros(len(design), complex)
    for level in range(temperature.max() + 1):
        own = temperature == level
        growth = size * (0.5 + level / max(temperature.max(), 1))
        modulus, phase = FAMILIES[family](x, rng), FAMILIES[family](x, rng)
        added[own] = growth * (modulus + 1j * phase / 3.0)[place[own]]
    return family, added


def draw(
    seed: int, kind: str, columns: Collection[str] = (), shape: str | None = None
) -> tuple[Background, dict[str, Any]]:
    """A table of a kind, and its seal. columns: amplitude_m, cycles: what it shall have beside the usual ones."""
    law_seed, design_seed, noise_seed, kind_seed = np.random.SeedSequence(seed).spawn(4)
    law = draw_law(np.random.default_rng(law_seed), shape)
    rng = np.random.default_rng(design_seed)
    design = _design(rng, columns)
    sizes = Sizes(
        rng.uniform(0.006, 0.02),
        np.radians(rng.uniform(0.1, 0.4)),
        rng.uniform(0.02, 0.06),
        rng.uniform(0.01, 0.03),
        rng.uniform(0.004, 0.012),
    )
    family, added = _discrepancy(design, sizes.discrepancy, rng)
    own = KINDS[kind](design, sizes, np.random.default_rng(kind_seed))
    omega = 2.0 * np.pi * design["frequency_Hz"].to_numpy(float)
    modulus = law.modulus(omega, design["temperature_C"].to_numpy(float))
    turned = np.angle(modulus) * (ODD_PHASE - 1.0) * (own.real != 0.0) if kind == "odd_specimen" else 0.0
    logarithm = np.log(modulus) + added + own + 1j * turned
    logarithm = logarithm + _scatter(design, sizes, np.random.default_rng(noise_seed))
    phase = np.clip(np.degrees(logarithm.imag), *PHASES)
    table = design.assign(E_MPa=1e-6 * np.exp(logarithm.real), phase_deg=phase)
    if table["amplitude_m"].nunique() == 1:
        table = table.drop(columns="amplitude_m")
    table = table[_kept(table, rng)].reset_index(drop=True)
    odd = table["specimen"][0] if kind != "odd_specimen" else design["specimen"][int(own.real.argmin())]
    seal = {
        "seed": seed,
        "kind": kind,
        "law": asdict(law),
        "sizes": asdict(sizes),
        "family": family,
        "tests": len(table),
        "odd": str(odd) if kind == "odd_specimen" else None,
    }
    return Background(table, law), seal


def _design(rng: np.random.Generator, columns: Collection[str]) -> pd.DataFrame:
    count = int(rng.integers(3, 7))
    while True:
        temperatures = np.sort(rng.choice(TEMPERATURES, count, replace=False))
        if np.diff(temperatures).min() >= LEAST_GAP or count > 5:
            break
    return factorial(
        [f"S{n + 1}" for n in range(int(rng.integers(2, 5)))],
        temperatures.tolist(),
        BANDS[rng.integers(len(BANDS))],
        amplitudes=(30e-6, AMPLITUDE) if "amplitude_m" in columns else (AMPLITUDE,),
        order="shuffled" if "cycles" in columns else None,
        seed=int(rng.integers(2**31)),
    )


def _scatter(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """Level of each specimen, its wobble between isotherms, and scatter of each test."""
    specimen, temperature = _rank(design, "specimen"), _rank(design, "temperature_C")
    level = sizes.specimen * rng.standard_normal(specimen.max() + 1)[specimen]
    wobble = sizes.wobble * rng.standard_normal((specimen.max() + 1, temperature.max() + 1))
    modulus, phase = rng.standard_normal((2, len(design)))
    # A level comes with little phase, as a warmer specimen's would: a tenth, in rad.
    return (
        level
        + (1.0 - 0.1j) * wobble[specimen, temperature]
        + sizes.modulus * modulus
        + 1j * sizes.phase * phase
    )


def _kept(table: pd.DataFrame, rng: np.random.Generator) -> NDArray[np.bool_]:
    """All rows but a few; each specimen keeps LEAST_LEFT tests on each of its isotherms."""
    kept = np.ones(len(table), bool)
    wanted = int(rng.uniform(0.0, MOST_MISSING) * len(table))
    key = (table["specimen"].astype(str) + table["temperature_C"].astype(str)).to_numpy()
    for row in rng.permutation(len(table))[:wanted]:
        if kept[key == key[row]].sum() > LEAST_LEFT:
            kept[row] = False
    return kept
