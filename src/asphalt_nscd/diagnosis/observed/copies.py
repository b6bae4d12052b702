"""Tests that agree in every digit with tests of another specimen or temperature: a file was copied, not repeated."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import specimen_named

LEAST = 3  # tests alike in modulus and phase that are no chance, however few digits they have
SAME = 1e-9  # relative difference


@dataclass(frozen=True)
class Copy:
    """Two blocks of tests (specimen, isotherm [degC]) that agree in every digit at the same frequencies."""

    blocks: tuple[tuple[str, float], tuple[str, float]]
    rows: tuple[int, ...]

    def reason(self, specimen: str, isotherm: float) -> str:
        """What is wrong with one of the two blocks, its specimen and isotherm [degC], and how to mend it, in words."""
        other = self.blocks[self.blocks[0] == (specimen, isotherm)]
        return (
            f"equal in every digit to {specimen_named(other[0])} at {other[1]:g} degC: one was copied; look in the "
            "record which"
        )


def copied(observed: Observations) -> Iterator[Copy]:
    """Sweeps that are copies of each other: of one specimen, or of two at one temperature."""
    blocks: dict[tuple[str, float], dict[tuple[float, float], int]] = {}
    strain = np.zeros(observed.size) if observed.amplitude is None else observed.amplitude
    for row in range(observed.size):
        key = observed.names[observed.specimen[row]], float(observed.isotherm[row])
        blocks.setdefault(key, {})[float(observed.frequency[row]), float(strain[row])] = row
    for one, other in combinations(blocks, 2):
        if one[0] != other[0] and one[1] != other[1]:
            continue
        common = sorted(blocks[one].keys() & blocks[other].keys())
        rows = [[block[condition] for condition in common] for block in (blocks[one], blocks[other])]
        first, second = (observed.modulus[at] for at in rows)
        flat = np.allclose(
            first, first[:1], SAME, 0.0
        )  # one modulus at all frequencies tells nothing of a copy
        if len(common) >= LEAST and not flat and np.allclose(first, second, SAME, 0.0):
            yield Copy((one, other), (*rows[0], *rows[1]))


def refuse_copies(observed: Observations) -> None:
    """Refuse two specimens that agree in every digit wherever both were tested: copies have no scatter."""
    tests: dict[str, dict[int, complex]] = {name: {} for name in observed.names}
    for k, cell, modulus in zip(observed.specimen, observed.cell, observed.modulus, strict=True):
        tests[observed.names[k]][cell] = modulus
    for one, other in combinations(observed.names, 2):
        common = tests[one].keys() & tests[other].keys()
        first, second = ([tests[name][cell] for cell in common] for name in (one, other))
        if len(common) > 2 and np.allclose(first, second, SAME, 0.0):
            raise InputError(
                f"specimens {one} and {other} have the same modulus at all {len(common)} conditions they share: "
                "copies are not replicates and give no scatter; keep one of them."
            )


def refuse_copied_campaign(campaigns: Mapping[str, Observations]) -> None:
    """Refuse two campaigns (by name) of which one holds most tests of the other, in every digit."""
    tests = {
        name: set(zip(one.temperature, one.frequency, one.modulus, strict=True))
        for name, one in campaigns.items()
    }
    for one, other in combinations(tests, 2):
        common, fewest = len(tests[one] & tests[other]), min(len(tests[one]), len(tests[other]))
        if common >= LEAST and 2 * common > fewest:
            raise InputError(f"{one} and {other} hold the same {common} tests; leave one of them out.")
