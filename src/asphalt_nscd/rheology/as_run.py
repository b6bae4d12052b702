"""A test as it is run: stress from rest, cycle after cycle, and the record read as a machine reads it.

A cyclic compression is a haversine, (1 - cos omega t)/2: it presses on average, so the mix creeps while it oscillates.
Each Kelvin element then follows its stress exactly, with s = a + Re(b e^{i omega t}) and relaxation time tau:

    e(t) = a/E_k + Re(b e^{i omega t} / (E_k (1 + i omega tau))) + (e(0) - steady part at 0) e^{-t/tau}.

Read with a term for the drift, the phase is that of the law within hundredths of a degree. Read without one, it
comes out too large by what the creep of the last cycles adds to the sine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.rheology.chain import KelvinChain

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Programme:
    """Loading of one frequency, and how its record is read.

    `haversine`, else the stress oscillates about zero; `cycles` in all, of which the last `read` are fitted; `drift`:
    whether the fit has a term for it.
    """

    haversine: bool = True
    cycles: int = 10
    read: int = 5
    drift: bool = False
    samples: int = 50  # in a cycle

    def angles(self) -> Vector:
        """omega t (s,) [rad] of the samples, from the start."""
        return 2.0 * np.pi * np.arange(self.cycles * self.samples + 1) / self.samples

    def stress(self, angle: Vector) -> Vector:
        """Stress (s,) at omega t [rad], of amplitude one."""
        return 1.0 - np.cos(angle) if self.haversine else np.sin(angle)

    def phasor(self, signal: Vector, angle: Vector) -> complex:
        """Complex amplitude of a signal (s,) by least squares over the cycles that are read; `angle` omega t [rad]."""
        last = slice(-self.read * self.samples, None)
        angle = angle[last]
        terms = [np.cos(angle), np.sin(angle), np.ones_like(angle), *[angle] * self.drift]
        cosine, sine, *_ = np.linalg.lstsq(np.column_stack(terms), signal[last], rcond=None)[0]
        return complex(cosine, -sine)


def modulus_as_read(
    chain: KelvinChain, frequencies: Sequence[float], programme: Programme
) -> NDArray[np.complex128]:
    """E* (n,) [Pa] that a machine reads of a linear mix, tested from rest at frequencies (n,) [Hz] in this order.

    >>> elastic = KelvinChain(10e9, np.inf, (), ())
    >>> abs(modulus_as_read(elastic, [1.0], Programme())).round(-3)
    array([1.e+10])
    """
    flows = bool(np.isfinite(chain.dashpot))  # then the last element is the dashpot, which has no spring
    springs = np.array([*chain.kelvin_springs, *[0.0] * flows])
    dashpots = np.array([*chain.kelvin_dashpots, *[chain.dashpot] * flows])
    strain = np.zeros(springs.size)  # of each element, for a stress amplitude of 1 Pa
    read = []
    for frequency in frequencies:
        omega = 2.0 * np.pi * frequency
        angle = programme.angles()
        time, stress = angle / omega, programme.stress(angle)
        # the stress is mean + Re(turning e^{i omega t})
        mean, turning = (1.0, -1.0 + 0j) if programme.haversine else (0.0, -1j)
        history = _elements(springs, dashpots, strain, mean, turning, omega, time)
        total = stress / chain.spring + history.sum(axis=1)
        strain = history[-1]
        read.append(programme.phasor(stress, angle) / programme.phasor(total, angle))
    return np.array(read)


def _elements(
    springs: Vector,
    dashpots: Vector,
    start: Vector,
    mean: float,
    turning: complex,
    omega: float,
    time: Vector,
) -> NDArray[np.float64]:
    """Strain (n, m) [1/Pa] of each element from `start` (m,), by the form above; without spring it is a dashpot."""
    stiffness = springs + 1j * omega * dashpots
    oscillating = (turning * np.exp(1j * omega * time[:, None]) / stiffness).real
    rate = springs / dashpots
    # (1 - exp(-t rate)) / spring, which is t / dashpot where there is no spring
    scale = np.where(rate > 0.0, np.where(springs > 0.0, springs, 1.0), dashpots)
    creep = np.where(rate > 0.0, -np.expm1(-time[:, None] * rate), time[:, None]) / scale
    fading = np.exp(-time[:, None] * rate)
    return mean * creep + oscillating + (start - oscillating[0]) * fading
