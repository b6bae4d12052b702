"""An error of all tests at the highest frequency alone: too few samples in a cycle, or a frequency noted wrongly.

The catalogue lacks it, and a delay or a moving mass takes most of it. So it competes with each of them, as a change of
|E*| and of the phase of any size.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.criteria import AT_HIGHEST, TWENTY_TIMES
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search.doubts import Table
from asphalt_nscd.diagnosis.written import interval_95

FEWEST = 3  # frequencies: one of two says nothing of the other


@dataclass(frozen=True)
class AtHighest:
    """What all tests at the highest frequency [Hz] are off by in ln|E*| and phase [rad], each with standard error."""

    frequency: float
    modulus: tuple[float, float]
    phase: tuple[float, float]

    def rows(self, observed: Observations) -> NDArray[np.bool_]:
        """Tests (n,) at this frequency, of all specimens and temperatures."""
        return np.asarray(observed.frequency == self.frequency)

    def content(self, widened: float) -> dict[str, Any]:
        """The entry `highest_frequency` of `diagnosis.json`; `widened` is the factor on the intervals of all names."""
        return {
            "frequency_Hz": self.frequency,
            "modulus_percent": 100.0 * self.modulus[0],
            "modulus_interval_95": [100.0 * end for end in interval_95(*self.modulus, widened)],
            "phase_deg": float(np.degrees(self.phase[0])),
            "phase_interval_95": [float(np.degrees(end)) for end in interval_95(*self.phase, widened)],
        }


def _roots(plain: Joint) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Factors (n, 1) of the two parts of ln E*, in units of the scatter."""
    observed, (of_modulus, of_phase) = plain.observed, plain.noise.sigma
    there = (observed.frequency == observed.frequencies[-1]).astype(complex)[:, None]
    return of_modulus * there, 1j * of_phase * there


def explains_better(table: Table, candidate: Candidate) -> bool:
    """Whether such an error in a cause's place makes the tests 20 times as likely; False if frequencies are too few."""
    if table.plain.observed.frequencies.size < FEWEST:
        return False
    rest, direction, _ = table.drop_cause(candidate)
    alone = table.estimate_beside(rest, direction, ())
    return bool(table.estimate_beside(rest, None, _roots(table.plain)).misfit < alone.misfit - TWENTY_TIMES)


def find(table: Table) -> AtHighest | None:
    """Such an error beside the named causes, or None where the tests do not speak for it (AT_HIGHEST)."""
    plain, linear = table.plain, table.linear
    if plain.observed.frequencies.size < FEWEST:
        return None
    both = _roots(plain)
    gain = table.estimate_beside(linear, None, ()).misfit - table.estimate_beside(linear, None, both).misfit
    if gain < AT_HIGHEST:
        return None
    found = []
    for part, other, unit in zip(both, both[::-1], plain.noise.sigma, strict=True):
        one = table.estimate_beside(linear, plain.noise.whiten(part), (other,))
        found.append((float(unit * one.amplitude), float(unit * one.std_error)))
    return AtHighest(float(plain.observed.frequencies[-1]), *found)
