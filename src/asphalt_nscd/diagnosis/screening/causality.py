"""Where modulus and phase contradict each other, whatever the law of the mix.

A linear material answers to forces only after they act, so its phase is the slope of ln|E*| over the
frequency: phase = pi/2 d ln|E*| / d ln omega for a smooth law (the local Kramers-Kronig relation, exact for a
power law). Departures from a fitted law obey it too; what does not is no relaxation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from asphalt_nscd.diagnosis.model.joint import Fitted
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations

SHOWN = 3  # of the others
ALPHA_PER_TABLE = 0.01  # that any pair of frequencies is reported where nothing is wrong
AGREES = 0.6  # share of the larger departure: even a single relaxation time keeps slope and phase nearer


@dataclass(frozen=True)
class Contradiction:
    """Neighbouring frequencies [Hz] of an isotherm [degC]: phase measured, and phase that the slope asks for [rad]."""

    temperature: float
    low: float
    high: float
    measured: float
    asked: float
    z: float  # in standard deviations


def contradictions(observed: Observations, fitted: Fitted, noise: Noise) -> list[Contradiction]:
    """Pairs of neighbouring frequencies where modulus and phase contradict each other, the worst first."""
    left = observed.logarithm - fitted.modelled
    found, tried = [], 0
    for temperature in observed.isotherms:
        at = observed.isotherm == temperature
        frequencies = np.unique(observed.frequency[at])
        for low, high in zip(frequencies[:-1], frequencies[1:], strict=True):
            rows = [at & (observed.frequency == f) for f in (low, high)]
            common = np.intersect1d(*(observed.specimen[one] for one in rows))
            if not common.size:
                continue
            # Of the same specimens: their levels differ by more than a slope does.
            rows = [one & np.isin(observed.specimen, common) for one in rows]
            first, second = (complex(left[one].mean()) for one in rows)
            tried += 1
            quarter = 0.5 * np.pi / np.log(high / low)
            by_slope, by_phase = quarter * (second.real - first.real), 0.5 * (second.imag + first.imag)
            count = min(map(np.count_nonzero, rows))
            # The slope is a difference of two tests, the phase their mean.
            sigma = np.hypot(quarter * np.sqrt(2.0) * noise.sigma[0], np.sqrt(0.5) * noise.sigma[1])
            z = abs(by_slope - by_phase) / sigma * np.sqrt(count)
            if abs(by_slope - by_phase) < AGREES * max(abs(by_slope), abs(by_phase)):
                continue
            modelled = float(fitted.modelled.imag[rows[0] | rows[1]].mean())
            found.append(
                Contradiction(
                    float(temperature),
                    float(low),
                    float(high),
                    modelled + by_phase,
                    modelled + by_slope,
                    float(z),
                )
            )
    # Two-sided, and shared by all pairs tried (Bonferroni).
    least = -ndtri(0.5 * ALPHA_PER_TABLE / max(tried, 1))
    return sorted((one for one in found if one.z > least), key=lambda one: -one.z)


def told(found: list[Contradiction], causes: bool) -> list[str]:
    """All contradictions in a sentence, none without any; `causes` says whether named ones are in the fit."""
    if not found:
        return []
    worst, others = found[0], found[1:]
    also = ", ".join(f"{one.low:g} - {one.high:g} Hz at {one.temperature:g} degC" for one in others[:SHOWN])
    also += f" and {len(others) - SHOWN} more" if len(others) > SHOWN else ""
    also = f"; likewise {also}" if also else ""
    included = ", the causes above included" if causes else ""
    return [
        f"At {worst.temperature:g} degC, from {worst.low:g} to {worst.high:g} Hz, the slope of log |E*| against log f "
        f"requires a phase of {np.degrees(worst.asked):.1f} deg{included}. {np.degrees(worst.measured):.1f} deg were "
        f"measured ({worst.z:.1f} standard deviations apart{also}). No linear material does that. Either the response "
        "is not linear there, or the machine changes its gain or resonates."
    ]
