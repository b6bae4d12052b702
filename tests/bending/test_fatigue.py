"""Fatigue of a specimen: the power of the strain, the profile, and cycle jumps beside every cycle."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.fatigue import (
    cycle_by_cycle,
    fatigue,
    largest_strain,
    largest_strain_at,
    profile_of,
    table_of,
)
from asphalt_nscd.bending.further_settings import FatigueLaw
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.fatigue import FatigueHistory, Jumps, remaining_stiffness
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.specimen.system import bending_system

PAPER = Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235)
# At 15 degC with viscosities lowered: from 40 Hz on transients are over in two cycles.
QUICK = bond_law(Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9))
LAW = FatigueLaw(endured=1e-3, exponent=4.0)


def test_largest_strain_is_that_of_the_beam():
    height = np.linspace(0.0, PAPER.h, 100_001)
    width = PAPER.B - (PAPER.B - PAPER.b) * height / PAPER.h
    strain = 6.0 * (PAPER.h - height) / (PAPER.e * width**2) / PAPER.form_factor()
    assert largest_strain(PAPER) == pytest.approx(strain.max(), rel=1e-9)
    assert largest_strain_at(PAPER) == pytest.approx(height[strain.argmax()], abs=1e-5)
    assert largest_strain_at(replace(PAPER, b=0.05)) == largest_strain_at(replace(PAPER, b=PAPER.B)) == 0.0


def test_a_blocked_head_strains_a_beam_as_theory_says():
    """A prism by 3 w / h^2, twice as much as a free one; a trapezoid by the frame of its two ends, as a stiffness."""
    prism = replace(PAPER, b=PAPER.B)
    assert largest_strain(prism, "blocked") == pytest.approx(2.0 * largest_strain(prism), rel=1e-6)
    arm = PAPER.h - (np.arange(20_000) + 0.5) * PAPER.h / 20_000
    width = PAPER.b + (PAPER.B - PAPER.b) * arm / PAPER.h
    bend = 12.0 / (PAPER.e * width**3) * PAPER.h / 20_000
    # displacement and slope of the head by its force and moment
    force, moment = np.linalg.solve([[bend @ arm**2, bend @ arm], [bend @ arm, bend.sum()]], [1.0, 0.0])
    strain = np.abs(6.0 * (force * arm + moment) / (PAPER.e * width**2)).max()
    assert largest_strain(PAPER, "blocked") == pytest.approx(strain, rel=1e-3)


def test_a_blocked_head_moves_by_less_for_the_same_strain(beam):
    free, blocked = (fatigue(beam, 2e-4, LAW, Bonds(head=head)).life() for head in ("free", "blocked"))
    assert blocked > 0.5 * free


def test_life_falls_by_the_power_of_strain_and_bonds_of_plates_do_not_tire(beam):
    one, two = (fatigue(beam, strain, LAW) for strain in (1e-4, 2e-4))
    assert one.life() / two.life() == pytest.approx(2.0**LAW.exponent, rel=1e-6)
    of_plates = np.maximum(beam.network.first, beam.network.second) >= beam.radius.size
    assert of_plates.any() and not one.damage[of_plates].any() and one.damage.max() == 1.0


def test_the_first_jump_is_that_of_the_static_motion(beam):
    """It takes 0.01 from the fastest bond, by its strain under the amplitude of bending theory."""
    system = bending_system(beam, 0.35, 2.7e6, 0.7)
    stiffness, motion = system.stiffness().toarray(), np.ones(system.mass.size)
    motion[system.free] = -np.linalg.solve(
        stiffness[np.ix_(system.free, system.free)], stiffness[system.free, system.driven]
    )
    opening = np.linalg.norm((system.operator @ motion).reshape(-1, 3), axis=1)
    strains = 2e-4 / largest_strain(beam.geometry) * opening / beam.network.length
    fastest = 1e-6 * (1e3 * strains[np.isfinite(system.strength)].max()) ** 4
    assert LAW.rate(np.array([2e-3])) == pytest.approx([16e-6])
    first = fatigue(beam, 2e-4, LAW, jumps=Jumps(0.01, 0.0, 1.0)).cycles[1]
    assert first == pytest.approx(0.01 / fastest, rel=1e-5)


def test_profile_and_table_of_a_history():
    """Means over twentieths of the height; a bond at the very head is in the last; without bonds a layer is sound."""
    point = np.array([[9.0, 9.0, z] for z in (0.0, 0.0499, 0.0501, 0.97, 1.0)]) * 0.2
    specimen = SimpleNamespace(network=SimpleNamespace(point=point), geometry=SimpleNamespace(h=0.2))
    history = FatigueHistory(
        np.array([0.0, 9.0]), np.array([1.0, 0.5]), np.array([0, 2]), np.array([1.0, 0.5, 0.2, 0.4, 1.0])
    )
    profile = profile_of(specimen, history)
    np.testing.assert_allclose(profile["height_share"], np.linspace(0.025, 0.975, 20))
    np.testing.assert_allclose(profile["damage"], [0.75, 0.2, *[0.0] * 17, 0.7])
    np.testing.assert_allclose(profile["lost"], [0.5, *[0.0] * 18, 0.5])
    assert table_of(history).to_dict("list") == {
        "cycles": [0.0, 9.0],
        "stiffness": [1.0, 0.5],
        "lost_bonds": [0, 2],
    }


def strain_for(cycles, specimen):
    """Largest strain that the specimen endures so many cycles."""
    return 1e-3 * (fatigue(specimen, 1e-3, LAW).life() / cycles) ** (1.0 / LAW.exponent)


def test_cycle_jumps_beside_every_cycle(beam):
    strain = strain_for(60.0, beam)
    jumped = fatigue(beam, strain, LAW, jumps=Jumps(0.02, 2e-4, 0.005))
    stepped = cycle_by_cycle(beam, strain, LAW, QUICK, 40.0)
    for share in (0.8, 0.65, 0.5):
        assert jumped.life(share) == pytest.approx(stepped.life(share), rel=0.04)


def test_what_is_left_after_the_last_cycle_is_that_of_the_frequency_domain_with_inertia(beam):
    """At 400 Hz the mass term of Eqs. (1)-(2) is 3 % of the stiffness at first and 8 % at last."""
    omega, mass = 2.0 * np.pi * 400.0, beam.geometry.mass_factor()
    stepped = cycle_by_cycle(beam, strain_for(60.0, beam), LAW, QUICK, 400.0)
    system = bending_system(beam, Bonds().poisson, Bonds().yield_Pa, Bonds().friction)

    def modulus(damage):
        tired = replace(system, weight=system.weight * remaining_stiffness(damage))
        return abs(driving_force(tired, QUICK.discrete_modulus(omega, 0.0), omega) + mass * omega**2)

    left = modulus(stepped.damage) / modulus(np.zeros_like(stepped.damage))
    assert stepped.stiffness[-1] == pytest.approx(left, rel=0.01)  # over that of the third cycle
