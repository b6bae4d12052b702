"""A laboratory as it writes: its words, units and marks, and the tests that it has. Knows nothing of the reader."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

Rows = list[list[Any]]
Sheets = dict[str, Rows]
UNITS = {"MPa": (1.0, 0), "GPa": (1e-3, 3), "ksi": (1 / 6.894757293, 1), "N/mm²": (1.0, 0)}


def words_of(known: str) -> dict[str, list[list[str]]]:
    """By language: words that the "reader" knows, "foreign" ones, and "later" ones, written after it was fixed."""
    with (Path(__file__).parent / "words.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row.pop("known") == known]
    return {row.pop("language"): [*(words.split(";") for words in row.values())] for row in rows}


LANGUAGES = words_of("reader")
SCHEMES = (
    ([4.0, 20.0, 40.0], [25.0, 10.0, 5.0, 1.0, 0.5, 0.1]),
    ([-10.0, 4.0, 21.0, 37.0, 54.0], [25.0, 10.0, 5.0, 1.0, 0.5, 0.1]),
    ([-10.0, 0.0, 10.0, 15.0, 20.0, 30.0], [1.0, 3.0, 10.0, 25.0, 30.0, 40.0]),
    ([0.0, 10.0, 20.0, 30.0], [0.1, 0.3, 1.0, 3.0, 10.0, 20.0]),
)


@dataclass(frozen=True)
class Tests:
    """What a file holds: |E*| [MPa] and phase [deg] by specimen, temperature [degC] and frequency [Hz]."""

    values: dict[tuple[str, float, float], tuple[float, float]]

    @property
    def specimens(self) -> list[str]:
        """In the order of the file."""
        return list(dict.fromkeys(s for s, _, _ in self.values))


class Laboratory:
    """How one laboratory writes: its words, units and marks, and the tests that it has."""

    def __init__(self, seed: int, languages: Mapping[str, list[list[str]]] = LANGUAGES) -> None:
        """Draw words, units and tests."""
        self.random = np.random.default_rng(seed)
        pick = self.pick
        self.language = pick(list(languages))
        *words, (mix,) = languages[self.language]
        modulus, phase, frequency, temperature, self.specimen, *self.statistics = map(pick, words)
        self.mix = mix
        self.unit = pick(["MPa", "MPa", "MPa", "GPa", "N/mm²", "ksi" if self.language == "en" else "GPa"])
        self.fahrenheit = self.unit == "ksi" and self.chance(0.7)
        self.radians = self.chance(0.1)
        left, right = pick([" (", ")"], [" [", "]"], [", ", ""])
        degree = "rad" if self.radians else pick("°", "deg" if self.language == "en" else "°")
        celsius = "°F" if self.fahrenheit else "°C"
        units = {"e": self.unit, "p": degree, "f": "Hz", "t": celsius}
        names = {"e": modulus, "p": phase, "f": frequency, "t": temperature}
        self.bare, self.units = names, units
        self.name = {key: f"{name}{left}{units[key]}{right}" for key, name in names.items()}
        self.tests = self._tests(int(self.random.integers(2, 5)))

    def pick(self, *options: Any) -> Any:
        """One of several options, or of those in the only one."""
        among = options[0] if len(options) == 1 else options
        return among[int(self.random.integers(len(among)))]

    def chance(self, share: float) -> bool:
        """True in this share of the cases."""
        return bool(self.random.random() < share)

    def _tests(self, specimens: int) -> Tests:
        """Tests of a Huet-Sayegh mix with scatter between and within specimens."""
        self.temperatures, frequencies = self.pick(SCHEMES)
        self.frequencies = frequencies[::-1] if self.chance(0.3) else frequencies
        label = self.pick("{n}", f"{self.specimen} {{n}}", "{letter}", "K1{n}", "B-0{n}", "2{n}/18")
        names = [label.format(n=n, letter="ABCDE"[n - 1]) for n in range(1, specimens + 1)]
        level, values = self.random.uniform(26e3, 38e3), {}
        for name in names:
            own = self.random.normal(0.0, 0.06)
            for t, f in product(self.temperatures, self.frequencies):
                shift = np.exp(2.303 * -9.0 * (t - 15.0) / (110.0 + t - 15.0))
                reduced = 1j * 2.0 * np.pi * f * 0.15 * shift
                star = 60.0 + (level - 60.0) / (1.0 + 2.1 * reduced**-0.2 + reduced**-0.57)
                size = abs(star) * np.exp(own + self.random.normal(0.0, 0.01))
                angle = max(np.degrees(np.angle(star)) + self.random.normal(0.0, 0.2), 0.5)
                values[name, t, f] = float(size), float(angle)
        return Tests(values)

    def e(self, value: float) -> float:
        """A modulus [MPa] as it is written."""
        factor, digits = UNITS[self.unit]
        return round(factor * value, digits) if digits else int(round(factor * value))

    def p(self, value: float) -> float:
        """A phase [deg] as it is written."""
        return round(np.radians(value), 4) if self.radians else round(value, 1)

    def t(self, value: float) -> float:
        """A temperature [degC] as it is written."""
        shown = round(1.8 * value + 32.0, 1) if self.fahrenheit else value
        return int(shown) if shown == int(shown) else shown

    def both(self, s: str, t: float, f: float) -> list[float]:
        """Modulus and phase of a test as they are written."""
        e, p = self.tests.values[s, t, f]
        return [self.e(e), self.p(p)]

    def star(self, s: str, t: float, f: float) -> complex:
        """E* of a test in the unit of the laboratory."""
        e, p = self.tests.values[s, t, f]
        return complex(UNITS[self.unit][0] * e * np.exp(1j * np.radians(p)))

    def names(self, keys: str) -> list[str]:
        """Those of several columns."""
        return [self.name[key] for key in keys]

    def sheet(self, s: str) -> str:
        """The name of the sheet of a specimen."""
        return s.replace("/", "-")

    def each(self, which: int, t: float, f: float, kinds: int = 0) -> list[float]:
        """Moduli (0) or phases (1) of all specimens, and so many kinds of what is computed of them."""
        values = [self.both(s, t, f)[which] for s in self.tests.specimens]
        return [*values, *self.computed(which, t, f, kinds)]

    def sweep(self, s: str, f: float) -> list[float]:
        """Moduli of a specimen at all temperatures, then phases."""
        return [self.both(s, t, f)[which] for which in (0, 1) for t in self.temperatures]

    def means(self) -> Rows:
        """A row of each condition."""
        return [[self.t(t), f, *(self.computed(w, t, f, 1)[0] for w in (0, 1))] for _, t, f in self.grid()]

    def grid(self, merged: bool = False) -> list[tuple[Any, float, float]]:
        """Temperature as it is shown, temperature and frequency of each condition; merged: shown once."""
        return [
            (None if merged and n else self.t(t), t, f)
            for t in self.temperatures
            for n, f in enumerate(self.frequencies)
        ]

    def computed(self, which: int, t: float, f: float, kinds: int) -> list[float]:
        """Mean, deviation and CV of the numbers written, the first so many."""
        values = [self.both(s, t, f)[which] for s in self.tests.specimens]
        mean, deviation = float(np.mean(values)), float(np.std(values, ddof=1))
        show = (self.e(mean / UNITS[self.unit][0]), self.p(np.degrees(mean) if self.radians else mean))[which]
        digits = 4 if self.radians or UNITS[self.unit][1] else 1
        return [show, round(deviation, digits), round(100 * deviation / mean, 1)][:kinds]
