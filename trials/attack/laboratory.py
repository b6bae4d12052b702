"""A campaign as a laboratory runs it: what is tested, and by how much everything is off that nobody calls a fault.

Chamber and specimen are some tenths of a kelvin off. Specimens differ in level and in their times. Each mounting, one
specimen at one temperature, has an error of its own in level, phase and slope that all its tests share; single tests
scatter beside. All of it grows to the warm side. The numbers are ranges that laboratories state: 2 to 5 % between
specimens, 1 to 2 % and 0.1 to 0.25 deg between mountings, half a per cent and a tenth of a degree within one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Any

import numpy as np
import pandas as pd
from drawn.design import factorial

from .mixes import LAWS, SHIFTS, Complex, Mix, Vector

BENDING, CYLINDER = "bending", "tension-compression"
DESIGNS = {
    BENDING: [
        ((-10.0, 0.0, 10.0, 15.0, 20.0, 30.0), (3.0, 6.0, 10.0, 25.0, 30.0, 40.0)),
        ((0.0, 10.0, 20.0, 30.0), (1.0, 3.0, 10.0, 30.0)),
        ((-10.0, 0.0, 10.0, 20.0, 30.0), (3.0, 10.0, 25.0, 40.0)),
        ((-5.0, 10.0, 25.0), (3.0, 10.0, 30.0)),
    ],
    CYLINDER: [
        ((4.0, 20.0, 35.0, 50.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)),
        ((4.0, 20.0, 40.0), (0.1, 1.0, 10.0)),
        ((-10.0, 4.0, 21.0, 37.0, 54.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)),
        ((4.0, 21.0, 37.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)),
    ],
}
DESIGNS_AND_BENCHES = 8  # return after so many campaigns
BROKEN_EVERY, MISSING_EVERY, ORDER_EVERY, AMPLITUDES_EVERY = 4, 3, 4, 8
AMPLITUDES = (30e-6, 63e-6)  # m at the head
Response = Callable[[Vector, Vector], Complex]


@dataclass(frozen=True)
class Campaign:
    """Tests before any fault.

    tests: (n rows) specimen, temperature_C, frequency_Hz, and amplitude_m [m] or order where the laboratory notes them;
    response(warming [K], tuning): ln E* (n,) [Pa] of each test, had the specimen been warmer and the frequency times
    tuning; own: (n,) what everyday errors add to ln E*; warmer: (n,) by how much [K] a specimen was
    warmer than its label; broken: isotherm whose gauges slip, or None.
    """

    name: str
    bench: str
    tests: pd.DataFrame
    response: Response
    own: Complex
    warmer: Vector
    broken: float | None = None
    about: dict[str, Any] = field(default_factory=dict)

    @property
    def omega(self) -> Vector:
        return 2.0 * np.pi * self.tests["frequency_Hz"].to_numpy(float)

    @property
    def temperature(self) -> Vector:
        return self.tests["temperature_C"].to_numpy(float)

    @property
    def isotherms(self) -> list[float]:
        return sorted(map(float, self.tests["temperature_C"].unique()))

    @property
    def specimens(self) -> list[str]:
        return sorted(self.tests["specimen"].unique())

    def at(self, specimen: str | None = None, temperature: float | None = None) -> np.ndarray:
        """(n,) tests of a specimen, an isotherm, or a sweep."""
        rows = np.ones(len(self.tests), bool)
        if specimen is not None:
            rows &= (self.tests["specimen"] == specimen).to_numpy()
        return rows if temperature is None else rows & (self.temperature == temperature)

    def unmoved(self) -> Complex:
        """ln E* (n,) without a fault."""
        return self.response(np.zeros(len(self.tests)), np.ones(len(self.tests))) + self.own


def written(campaign: Campaign, log_modulus: Complex) -> pd.DataFrame:
    """The table that a laboratory hands over: four digits of |E*| [MPa], hundredths of a degree."""
    norm = np.exp(log_modulus.real) * 1e-6
    digits = 10.0 ** (np.floor(np.log10(norm)) - 3.0)
    return campaign.tests.assign(
        E_MPa=np.round(norm / digits) * digits, phase_deg=np.round(np.degrees(log_modulus.imag), 2)
    )


def invented(number: int, seed: int) -> Campaign:
    """Campaign `number` of a seed: laws, shifts, benches and designs in turn, the rest by chance."""
    rng = np.random.default_rng([seed, number])
    law, shift = list(LAWS)[number % len(LAWS)], list(SHIFTS)[(number // 2) % len(SHIFTS)]
    bench = (BENDING, CYLINDER)[number % 2]
    temperatures, frequencies = DESIGNS[bench][(number // 2) % len(DESIGNS[bench])]
    specimens = [f"S{k + 1}" for k in range((3, 4, 2, 3, 4, 3)[number % 6])]
    amplified = bench == BENDING and number % AMPLITUDES_EVERY == 2
    amplitudes = {"amplitude_m": AMPLITUDES} if amplified else {}
    tests = factorial(specimens, temperatures, frequencies, **amplitudes)
    if number % ORDER_EVERY == 1:  # each specimen from cold to warm, by chance within an isotherm
        tests["order"] = 0
        for s in specimens:
            part = tests.index[tests["specimen"] == s].to_numpy()
            start = rng.permutation(len(temperatures))
            isotherm = np.searchsorted(temperatures, tests.loc[part, "temperature_C"])
            key = start[isotherm] + rng.random(part.size)
            tests.loc[part, "order"] = np.argsort(np.argsort(key)) + 1
    mix = Mix.draw(law, shift, rng)
    campaign = everyday(f"table {number + 1}", bench, tests, mix, rng)
    turn = max(0, number // DESIGNS_AND_BENCHES - 2)  # from the 25th on in other designs
    if (number + turn) % BROKEN_EVERY == 3:
        campaign = _broken(campaign, rng)
    if number % MISSING_EVERY == 1:
        campaign = without(campaign, rng.choice(len(tests), size=int(rng.integers(1, 4)), replace=False))
    return campaign


def sound_campaigns(seed: int, first: int = 0) -> Iterator[Campaign]:
    """Those of a seed whose gauges do not slip, from number `first` on."""
    return (one for one in (invented(number, seed) for number in count(first)) if one.broken is None)


def everyday(name: str, bench: str, tests: pd.DataFrame, mix: Mix, rng: np.random.Generator) -> Campaign:
    """Errors that no laboratory is without."""
    n = len(tests)
    t, f = (tests[column].to_numpy(float) for column in ("temperature_C", "frequency_Hz"))
    control = rng.uniform(0.2, 0.5)  # K, the bound that the laboratory states
    slower, error, own = np.zeros(n), np.zeros(n), np.zeros(n, complex)
    between, wanders = rng.uniform(0.02, 0.05), rng.uniform(0.07, 0.2)  # of |E*|; of ln time
    level, phase = rng.uniform(0.008, 0.02), np.radians(rng.uniform(0.08, 0.25))  # of a mounting
    tilt, lean = rng.uniform(0.001, 0.003), np.radians(rng.uniform(0.02, 0.06))  # of a mounting, per ln f
    single, turn = rng.uniform(0.004, 0.01), np.radians(rng.uniform(0.06, 0.2))  # of a test
    warm = 1.0 + (t - t.min()) / np.ptp(t)
    chamber = {value: rng.uniform(-control, control) / 2.0 for value in np.unique(t)}
    for specimen in tests["specimen"].unique():
        mine = (tests["specimen"] == specimen).to_numpy()
        own[mine] += between * rng.standard_normal()
        slower[mine] += wanders * rng.standard_normal()
        for value in chamber:
            rows = mine & (t == value)
            along = np.log(f[rows]) - np.log(f).mean()
            error[rows] = chamber[value] + rng.uniform(-control, control) / 2.0
            own[rows] += warm[rows] * (level * rng.standard_normal() + tilt * rng.standard_normal() * along)
            turned = phase * rng.standard_normal() + lean * rng.standard_normal() * along
            own[rows] += 1j * warm[rows] * turned
    own += warm * (single * rng.standard_normal(n) + 1j * turn * rng.standard_normal(n))

    def response(warming: Vector, tuning: Vector) -> Complex:
        return mix.log_modulus(f * tuning, t + error + warming, slower)

    about = {"law": mix.law, "shift": mix.shift, "control_K": control}
    return Campaign(name, bench, tests, response, own, error, about=about)


def _broken(campaign: Campaign, rng: np.random.Generator) -> Campaign:
    """Gauges slip on the warmest isotherm: the slower the test, the more |E*| falls and the phase with it."""
    warmest, f = campaign.isotherms[-1], campaign.tests["frequency_Hz"].to_numpy(float)
    own = campaign.own.copy()
    for specimen in campaign.specimens:
        rows = campaign.at(specimen, warmest)
        slow = (np.log(f.max() / f[rows]) / np.ptp(np.log(f))) ** rng.uniform(0.6, 1.6)
        # More phase would go with less modulus in a causal mix; here there is less of both.
        own[rows] -= slow * (rng.uniform(0.15, 0.4) + 1j * np.radians(rng.uniform(3.0, 8.0)))
    return replace(campaign, own=own, broken=warmest)


def without(campaign: Campaign, rows: np.ndarray) -> Campaign:
    """The campaign without these tests."""
    kept = np.setdiff1d(np.arange(len(campaign.tests)), rows)
    whole = len(campaign.tests)

    def response(warming: Vector, tuning: Vector) -> Complex:
        spread, stretched = np.zeros(whole), np.ones(whole)
        spread[kept], stretched[kept] = warming, tuning
        return campaign.response(spread, stretched)[kept]

    tests = campaign.tests.iloc[kept].reset_index(drop=True)
    own, warmer = campaign.own[kept], campaign.warmer[kept]
    return replace(campaign, tests=tests, response=response, own=own, warmer=warmer)
