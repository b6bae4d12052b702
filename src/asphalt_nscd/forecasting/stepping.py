"""Time stepping of a network whose bonds differ: a Kelvin chain for each class of bonds, fitted over a band.

The stiffness of a film between elastic grains is a Stieltjes function of the modulus of its matrix; where the matrix
is a Kelvin chain, so is every bond. Bonds whose stiffness has one shape over frequency, to the error stated, share a
chain (docs/core.md). The frequency domain of the same network, without classes or chains, is the reference.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.interpolate import CubicSpline

from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.nscd.bonds.law import BondLaw, BondLaws
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.energy import Energies
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.scheme import Scheme
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.conversion import kelvin_chain

Stiffness = Callable[[NDArray[np.float64]], NDArray[np.complex128]]
"""Complex stiffness (f, 3 b) [N/m] of the components of all bonds at angular frequencies (f,) [rad/s]."""

CLASSES = 40
SAMPLES = 9  # frequencies in the band at which bonds are compared; between them shapes are interpolated
CHAIN_TOLERANCE = 2e-4  # largest |ln| of a chain over its shape
UNIT = 1e9  # Pa, mean modulus of a chain; the weight of a component is its stiffness over this
REDUCED_CYCLES = 2  # the last ones, for the harmonic fit


@dataclass(frozen=True)
class FittedBonds:
    """A system whose bonds have chains, and how far these are from what they stand for."""

    system: BondedSystem
    laws: BondLaws
    largest_error: float  # |ln(stiffness of the chain / of the bond)|, of any component in the band
    rms_error: float

    @property
    def elements(self) -> int:
        """Most Kelvin elements in a chain."""
        return len(self.laws.kelvin_springs)


@dataclass(frozen=True)
class SteppedTest:
    """What an oscillation stepped from rest gives."""

    stiffness: complex  # N/m, force over displacement of the head in the last cycles
    force: np.ndarray  # (n,) N
    broken: list[int]
    energies: Energies


def fit_bonds(
    system: BondedSystem,
    stiffness: Stiffness,
    lowest_omega: float,
    highest_omega: float,
    classes: int = CLASSES,
) -> FittedBonds:
    """The system with chains for bonds of this stiffness over a band [rad/s]; see FittedBonds for their error.

    `stiffness` gives complex (f, 3 b) [N/m] of all components at angular frequencies (f,) [rad/s]. At most `classes`
    chains: components of one shape over frequency share one. Weights become mean stiffnesses over UNIT.
    """
    omega = np.geomspace(lowest_omega, highest_omega, SAMPLES)
    logarithm = np.log(stiffness(omega).T)
    size = logarithm.real.mean(axis=1, keepdims=True)
    shape = logarithm - size
    centres, kind = _classes(np.hstack([shape.real, shape.imag]), classes)
    table, error = [], np.empty(shape.shape)
    for number, centre in enumerate(centres):
        chain = _chain(omega, centre[:SAMPLES] + 1j * centre[SAMPLES:])
        springs, dashpots = np.array(chain.kelvin_springs), np.array(chain.kelvin_dashpots)
        table.append(BondLaw(chain.spring, chain.dashpot, springs, dashpots))
        own = kind == number
        error[own] = np.abs(shape[own] - np.log(chain.complex_modulus(omega) / UNIT))
    fitted = replace(system, weight=np.exp(size[:, 0]) / UNIT)
    return FittedBonds(
        fitted, BondLaws(tuple(table), kind), float(error.max()), float(np.sqrt(np.mean(error**2)))
    )


def _chain(omega: np.ndarray, logarithm: np.ndarray) -> KelvinChain:
    """With the modulus UNIT exp(logarithm) (f,) at omega (f,) [rad/s], and smooth between."""
    along = CubicSpline(np.log(omega), logarithm)

    def modulus(at: np.ndarray) -> np.ndarray:
        return np.asarray(UNIT * np.exp(along(np.log(at))))

    return kelvin_chain(modulus, omega[0], omega[-1], CHAIN_TOLERANCE)[0]


def _classes(shape: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """(centres (c, 2 f), class of each (n,)) of shapes (n, 2 f); the same in each run."""
    # of fewer shapes than classes k-means would leave some classes empty
    distinct = np.unique(shape[:: max(1, len(shape) // 1000)].round(6), axis=0)
    centres, kind = kmeans2(shape, min(most, len(distinct)), minit="++", rng=0)
    used, kind = np.unique(kind, return_inverse=True)
    return centres[used], kind


def harmonic_stiffness(system: BondedSystem, stiffness: Stiffness, omega: float) -> complex:
    """Force over displacement of the head [N/m] in steady oscillation at `omega` [rad/s], without chains or steps.

    `stiffness` gives complex (f, 3 b) [N/m] of all components at angular frequencies (f,) [rad/s].
    """
    own = stiffness(np.array([omega]))[0]
    weight = np.abs(own)
    return driving_force(replace(system, weight=weight), own / weight, omega)


def step_test(
    bonds: FittedBonds, frequency: float, amplitude: float, cycles: int = 5, steps_per_cycle: int = 32
) -> SteppedTest:
    """Drive the head sinusoidally from rest, by the fitted scheme (nscd/stepping/scheme.py).

    `frequency` [Hz], within the band of the bonds, and `amplitude` of the head [m]; the stiffness is that of the last
    REDUCED_CYCLES. Few steps are enough: the scheme has no error of the time step in steady oscillation.
    """
    # the fitted scheme has no error of the time step in steady oscillation: a few steps a cycle are enough
    time_step = 1.0 / (frequency * steps_per_cycle)
    scheme = Scheme.named("fitted", 2.0 * np.pi / steps_per_cycle)
    state = CondensedState.rest_state(bonds.system, bonds.laws)
    stepper = CondensedStepper(bonds.system, bonds.laws, time_step / scheme.a, state)
    march = March(stepper, scheme, bonds.laws, time_step)
    time = time_step * np.arange(1, cycles * steps_per_cycle + 1)
    driven = amplitude * np.sin(2.0 * np.pi * frequency * time)
    force = np.array([march.move_to(place) for place in driven])
    found = harmonic_response(time, force, driven, frequency, cycles=REDUCED_CYCLES)
    ratio = found.force_amplitude / found.displacement_amplitude
    return SteppedTest(complex(ratio * np.exp(1j * found.phase)), force, state.broken, march.account.sums)
