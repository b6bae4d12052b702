"""Generalised Maxwell model: a spring and Maxwell branches side by side, whose relaxation is a Prony series."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.chain import KelvinChain

SAME_RATE = 1e-8  # relative: between closer rates no zero is found by numbers of sixteen digits


@dataclass(frozen=True)
class MaxwellSeries:
    """Law of one temperature, E(t) = long_term + sum of moduli exp(-t / times).

    `long_term` [Pa], zero where the material flows; `moduli` (m,) [Pa] and relaxation `times` (m,) [s] of the branches,
    all positive.

    >>> series = MaxwellSeries(1e9, (4e9, 5e9), (0.1, 10.0))
    >>> series.instantaneous, series.relaxation_modulus(0.0).item()
    (10000000000.0, 10000000000.0)
    """

    long_term: float
    moduli: tuple[float, ...]
    times: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.moduli) != len(self.times):
            raise InputError(
                f"Prony series: {len(self.moduli)} moduli and {len(self.times)} relaxation times; "
                "give one of each for every branch."
            )
        if not 0.0 <= self.long_term < np.inf or not all(0 < x < np.inf for x in (*self.moduli, *self.times)):
            raise InputError("Prony series: a value is not positive; give moduli in Pa and times in s.")

    @property
    def instantaneous(self) -> float:
        """Instantaneous modulus E(0) [Pa], all springs side by side."""
        return self.long_term + sum(self.moduli)

    @property
    def weights(self) -> tuple[float, ...]:
        """Modulus of each branch as a share of the instantaneous modulus (m,), as Abaqus and Ansys take them."""
        return tuple(modulus / self.instantaneous for modulus in self.moduli)

    def solid(self, share: float) -> MaxwellSeries:
        """The same branches with a long-term modulus of at least `share` of the instantaneous one, as a solid has."""
        least = share * sum(self.moduli) / (1.0 - share)
        return MaxwellSeries(max(self.long_term, least), self.moduli, self.times)

    def complex_modulus(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus E* [Pa] at angular frequencies [rad/s]."""
        turned = 1j * np.asarray(omega, dtype=float)[..., None] * np.asarray(self.times)
        return self.long_term + (np.asarray(self.moduli) * turned / (1.0 + turned)).sum(axis=-1)

    def relaxation_modulus(self, time: ArrayLike) -> NDArray[np.float64]:
        """Stress per unit of constant strain, E(t) [Pa], at times after loading [s]."""
        decay = np.exp(-np.asarray(time, dtype=float)[..., None] / np.asarray(self.times))
        return self.long_term + (np.asarray(self.moduli) * decay).sum(axis=-1)


def series_of(chain: KelvinChain) -> MaxwellSeries:
    """A Kelvin chain as a generalised Maxwell model, without approximation.

    The relaxation rates r are the zeros of the compliance on the negative axis, D(-r) = 0; one lies between each pair
    of neighbouring poles of D, which are 0 (of the dashpot) and the retardation rates. The modulus of a branch is the
    residue of 1/D there, 1 / (r |D'(-r)|) (Tschoegl 1989, ch. 4). A Burgers law has two branches and no spring. A chain
    without a spring is refused, because its instantaneous modulus is not finite.
    """
    if np.isinf(chain.spring):
        raise InputError(
            "Kelvin chain: it has no spring, so its instantaneous modulus is not finite; fit a Prony series."
        )
    springs, dashpots = _merged(chain)
    poles = springs / dashpots
    flows = bool(np.isfinite(chain.dashpot))
    fluidity = 1.0 / chain.dashpot

    def compliance(rate: float) -> float:
        flow = fluidity / rate if flows else 0.0
        return float(1.0 / chain.spring - flow + (1.0 / (springs - rate * dashpots)).sum())

    # D(-r) falls to minus infinity beyond each pole and rises to 1/E at infinite rates: one zero follows each.
    starts = [0.0, *poles] if flows else list(poles)
    ends = [*starts[1:], np.inf]
    rates = [_zero_after(compliance, start, end) for start, end in zip(starts, ends, strict=False)]
    moduli = []
    for rate in rates:
        slope = fluidity / rate**2 + (dashpots / (springs - rate * dashpots) ** 2).sum()
        # the residue of 1/D at its pole; the slope is a sum of positive terms, without cancellation
        moduli.append(float(1.0 / (rate * slope)))
    # a dashpot in series relaxes all stress; else what is left at t = infinity is the static modulus
    long_term = 0.0 if flows else 1.0 / compliance(0.0)
    order = np.argsort(1.0 / np.array(rates))
    return MaxwellSeries(
        long_term, tuple(moduli[i] for i in order), tuple(float(1.0 / rates[i]) for i in order)
    )


def _merged(chain: KelvinChain) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Springs and dashpots by rising retardation rate; elements of one rate are one element."""
    springs, dashpots = np.array(chain.kelvin_springs), np.array(chain.kelvin_dashpots)
    order = np.argsort(springs / dashpots)
    springs, rates = springs[order], (springs / dashpots)[order]
    # elements of one rate are one element: D would have a double pole, and no zero between them
    first = np.concatenate([[True], np.diff(rates) > SAME_RATE * rates[1:]])[: rates.size]
    together = 1.0 / np.bincount(np.cumsum(first) - 1, weights=1.0 / springs, minlength=first.sum())
    return together, together / rates[first]


def _zero_after(function: Callable[[float], float], start: float, end: float) -> float:
    """Zero of a function that rises from minus infinity at `start` to infinity at a finite `end`, else to a limit."""
    if start == 0.0:
        # it falls to minus infinity towards the pole, so that some step towards it finds the sign
        low = 1e-3 * (end if np.isfinite(end) else 1.0)
        while function(low) > 0.0:
            low *= 1e-3
    else:
        # a zero may lie as close to its pole as two numbers can
        gap = 1e-3 * ((end - start) if np.isfinite(end) else start)
        while gap > 1e-15 * start and function(start + gap) > 0.0:
            gap *= 0.1
        low = start + gap
    if np.isfinite(end):
        gap = 1e-3 * (end - low)
        while gap > 1e-15 * end and function(end - gap) < 0.0:
            gap *= 0.1
        high = end - gap
    else:
        high = 2.0 * low
        while function(high) < 0.0:
            high *= 2.0
    # rates lie decades apart: only the relative tolerance says anything
    return float(brentq(function, low, high, xtol=1e-300, rtol=1e-14))
