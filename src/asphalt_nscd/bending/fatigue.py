"""Fatigue in two-point bending at constant displacement of the head, EN 12697-24 annex A, on a numerical specimen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

from asphalt_nscd.bending.further_settings import STRAINS, FatigueLaw
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.fatigue import FatigueHistory, Jumps, remaining_stiffness, strain, tire
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.scheme import Scheme
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen

FAILURE = 0.5  # of the first stiffness, EN 12697-24
STEPS_PER_CYCLE = 32  # few are enough: the fitted scheme is exact in steady oscillation
LAYERS = 20
MOST_CYCLES = 10_000  # one by one


def largest_strain(geometry: Geometry, head: str = "free") -> float:
    """Largest strain of the faces in bending theory, per displacement of the head [1/m].

    The moment F (h - z) over E e w^2 / 6, w the width at z, F = E z0 / gamma by the form factor; EN 12697-24: K_eps.
    A `head` that is "blocked" bears a moment too, which keeps it from turning.

    >>> from asphalt_nscd.measurements.twopoint import PAPER, PAPER_AMPLITUDE
    >>> round(PAPER_AMPLITUDE * largest_strain(PAPER) * 1e6, 1)  # the paper: "less than 50e-6"
    48.6
    """
    if head == "blocked":
        return _largest_strain_of_blocked(geometry)
    height = largest_strain_at(geometry)
    width = geometry.B - (geometry.B - geometry.b) * height / geometry.h
    return 6.0 * (geometry.h - height) / (geometry.e * width**2) / geometry.form_factor()


def _largest_strain_of_blocked(geometry: Geometry) -> float:
    arm = np.linspace(geometry.h, 0.0, 2001)  # to the head, of sections from the foot up
    width = geometry.b + (geometry.B - geometry.b) * arm / geometry.h
    flexibility = 12.0 / (geometry.e * width**3)  # times E
    # of a unit force: its moment, less that which leaves the slope of the head zero
    moment = arm - np.trapezoid(flexibility * arm, arm) / np.trapezoid(flexibility, arm)
    moved = -np.trapezoid(flexibility * moment * arm, arm)
    return float(np.abs(6.0 * moment / (geometry.e * width**2)).max() / moved)


def largest_strain_at(geometry: Geometry) -> float:
    """Height over the foot of the largest strain [m]: where the width is twice the head's, or at the foot."""
    taper = (geometry.B - geometry.b) / geometry.h
    return 0.0 if taper == 0.0 else max(0.0, 2.0 * geometry.h - geometry.B / taper)


def fatigue(
    specimen: Specimen,
    strain_amplitude: float,
    law: FatigueLaw,
    bonds: Bonds = Bonds(),
    jumps: Jumps = Jumps(),
) -> FatigueHistory:
    """Tire a specimen at constant displacement of its head until FAILURE of its first stiffness.

    `strain_amplitude` is the largest strain of bending theory; `jumps` says how many cycles one solution may stand for.
    Bonds to the plates do not tire, as a test that fails at its glue does not count.
    """
    if not STRAINS.holds(strain_amplitude):
        raise InputError(f"strain = {strain_amplitude:g}; give an amplitude as 100e-6, {STRAINS}.")
    amplitude = strain_amplitude / largest_strain(_trapezoid(specimen), bonds.head)
    return tire(_system(specimen, bonds), specimen.network.length, law.rate, amplitude, FAILURE, jumps)


def cycle_by_cycle(
    specimen: Specimen,
    strain_amplitude: float,
    law: FatigueLaw,
    bond_law: BondLaw,
    frequency: float,
    bonds: Bonds = Bonds(),
) -> FatigueHistory:
    """Tire a specimen by full time steps, every cycle of them: with inertia and the law of the bonds.

    After each cycle bonds take the damage of the harmonics of their openings in it. The stiffness is |E*| by
    Eqs. (1)-(2), over that of the third cycle, and no gravity acts. `strain_amplitude` is the largest of bending
    theory; `frequency` in Hz.
    """
    geometry, system = _trapezoid(specimen), _system(specimen, bonds)
    length, tires = specimen.network.length, np.isfinite(system.strength)
    # no limit of strength: bonds of a fatigue test tire and do not break; which may tire was asked before
    system = replace(system, load=np.zeros_like(system.load), strength=np.full(length.size, np.inf))
    amplitude = strain_amplitude / largest_strain(geometry, bonds.head)
    omega = 2.0 * np.pi * frequency
    time_step = 1.0 / (frequency * STEPS_PER_CYCLE)
    scheme = Scheme.named("fitted", omega * time_step)
    state, march = CondensedState.rest_state(system, bond_law), None
    wave = np.exp(-1j * omega * time_step * np.arange(1, STEPS_PER_CYCLE + 1)) * 2.0 / STEPS_PER_CYCLE
    damage, rows = np.zeros(length.size), []
    for cycle in range(MOST_CYCLES):
        tired = replace(system, weight=system.weight * remaining_stiffness(damage))
        stepper = CondensedStepper(tired, bond_law, time_step / scheme.a, state)
        if march is None:
            march = March(stepper, scheme, bond_law, time_step)
        march.stepper = stepper
        force, motion = 0.0j, np.zeros(system.mass.size, complex)
        for step, harmonic in enumerate(wave, start=1):
            driven = amplitude * np.sin(omega * time_step * step)
            force += harmonic * march.move_to(driven)
            motion += harmonic * state.displacement
        head = motion[system.driven]
        modulus = geometry.form_factor() * (force / head + geometry.mass_factor() * omega**2)
        rows.append((cycle, abs(modulus), np.count_nonzero(damage >= 1.0)))
        if cycle > 2 and abs(modulus) <= FAILURE * rows[2][1]:
            break
        openings = strain(system.operator @ motion, length)
        damage = np.minimum(damage + np.where(tires, law.rate(openings), 0.0), 1.0)
    table = np.array(rows)
    return FatigueHistory(table[:, 0], table[:, 1] / table[2, 1], table[:, 2].astype(int), damage)


def table_of(course: FatigueHistory) -> pd.DataFrame:
    """Table of a fatigue history: cycles, stiffness over the first one, lost_bonds."""
    return pd.DataFrame({"cycles": course.cycles, "stiffness": course.stiffness, "lost_bonds": course.lost})


def profile_of(specimen: Specimen, course: FatigueHistory) -> pd.DataFrame:
    """Damage over height, for each of LAYERS layers: height_share of its middle, mean damage, share of bonds lost."""
    # a bond at the very head belongs to the uppermost layer
    layer = np.minimum(LAYERS * specimen.network.point[:, 2] / specimen.geometry.h, LAYERS - 1).astype(int)
    damage = pd.Series(course.damage)
    # a layer without bonds has no damage, and not NaN
    return pd.DataFrame(
        {
            "height_share": (np.arange(LAYERS) + 0.5) / LAYERS,
            "damage": damage.groupby(layer).mean().reindex(range(LAYERS), fill_value=0.0),
            "lost": (damage >= 1.0).groupby(layer).mean().reindex(range(LAYERS), fill_value=0.0),
        }
    )


def _trapezoid(specimen: Specimen) -> Geometry:
    if not isinstance(specimen.geometry, Geometry):
        raise InputError(
            f"fatigue: the specimen is one of {specimen.geometry.test}; give a trapezoid for two-point bending."
        )
    return specimen.geometry


def _system(specimen: Specimen, bonds: Bonds) -> BondedSystem:
    return bending_system(
        specimen, bonds.poisson, bonds.yield_Pa, bonds.friction, bonds.head, kt_over_kn=bonds.kt_over_kn
    )
