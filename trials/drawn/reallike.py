"""What real tables show that no law has: functions of a design that give what is added to ln E* (n,).

KINDS says what each adds; the sizes are those seen in real tables. None is a cause of the catalogue, and nothing here
comes from the package under test.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Logarithm = NDArray[np.complex128]  # added to ln E*, (n,): relative modulus, and phase [rad]


@dataclass(frozen=True)
class Sizes:
    """Standard deviations of one table: of a test, of a specimen's level, of a discrepancy."""

    modulus: float
    phase: float  # rad
    specimen: float
    discrepancy: float  # of ln|E*|; of the phase [rad] a third of it


def _rank(design: pd.DataFrame, column: str) -> NDArray[np.int64]:
    return np.unique(design[column].to_numpy(), return_inverse=True)[1]


def _band(design: pd.DataFrame) -> NDArray[np.float64]:
    """Place of each test in the band, by ln f, from 0 to 1."""
    x = np.log(design["frequency_Hz"].to_numpy(float))
    return (x - x.min()) / np.ptp(x)


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
    """One specimen with about 0.6 of the modulus."""
    specimen = _rank(design, "specimen")
    return np.log(rng.uniform(0.55, 0.7)) * (specimen == rng.integers(specimen.max() + 1)).astype(complex)


def _rough(design: pd.DataFrame, sizes: Sizes, rng: np.random.Generator) -> Logarithm:
    """Three times the discrepancy of a table."""
    return _discrepancy(design, 3.0 * sizes.discrepancy, rng)


KINDS: dict[str, Callable[[pd.DataFrame, Sizes, np.random.Generator], Logarithm]] = {
    "heavy_tails": _heavy_tails,
    "broken_hot": _broken_hot,
    "hooks": _hooks,
    "gain_step": _gain_step,
    "odd_specimen": _odd_specimen,
    "rough": _rough,
}


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


def _discrepancy(design: pd.DataFrame, size: float, rng: np.random.Generator) -> Logarithm:
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
    return added
