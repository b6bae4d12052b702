"""Fatigue: two bonds by closed form, the power of the strain, and cycle jumps beside every cycle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.fatigue import (
    cycle_by_cycle,
    fatigue,
    largest_strain,
    largest_strain_at,
    profile_of,
)
from asphalt_nscd.bending.further_settings import FatigueLaw
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.fatigue import Jumps, remaining_stiffness, tire
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.specimen.system import bending_system

PAPER = Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235)
# At 15 degC with viscosities lowered: from 40 Hz on transients are over in two cycles.
QUICK = bond_law(Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9))
FINE = Jumps(bond=0.001, growth=0.0, stiffness=0.002)
LAW = FatigueLaw(endured=1e-3, exponent=4.0)


def along_a_line(operator, strength) -> BondedSystem:
    """Bonds whose normal components alone carry; the last degree of freedom is driven."""
    operator = np.array(operator, float)
    bonds, size = operator.shape
    rows = np.zeros((3 * bonds, size))
    rows[::3] = operator
    return BondedSystem(
        sparse.csr_matrix(rows), np.ones(3 * bonds), np.ones(size), np.zeros(size), size - 1,
        np.zeros(bonds), np.array(strength, float), 0.0,
    )  # fmt: skip


def test_two_bonds_in_series_one_of_which_tires():
    # D opens it to a / (2 - D): the cycles to D are the integral of (2 - D)^m, and half of the stiffness is left at 2/3
    system = along_a_line([[1, 0], [-1, 1]], [1.0, np.inf])
    course = tire(system, np.ones(2), LAW.rate, 1e-3, 0.5, FINE)
    m = LAW.exponent
    assert course.life() == pytest.approx(1e6 * (2 ** (m + 1) - (4 / 3) ** (m + 1)) / (m + 1), rel=2e-3)
    assert course.damage == pytest.approx([2 / 3, 0.0], abs=2e-3)


def test_of_two_bonds_side_by_side_the_shorter_is_lost_first():
    system = along_a_line([[0, 1], [0, 1], [1, 0]], [1.0, 1.0, np.inf])  # the third holds what nothing pulls
    course = tire(system, np.array([1.0, 2.0, 1.0]), LAW.rate, 1e-3, 0.3, FINE)
    # the short one is lost after a million cycles, the long one has lost a sixteenth by then
    at = np.interp(1e6, course.cycles, course.stiffness)
    assert at == pytest.approx((1.0 - 1.0 / 16.0) / 2.0, abs=3e-3)
    assert course.life(0.3) == pytest.approx(16e6 * 0.4, rel=5e-3) and course.lost[-1] == 1


def test_a_bond_that_slides_tires_as_one_that_opens():
    """Moved askew, by 0.6 along its normal and 0.8 across it, a bond lives as long as one moved along its normal."""
    straight = along_a_line([[0, 1], [1, 0]], [1.0, np.inf])
    rows = straight.operator.toarray()
    rows[:3, 1] = [0.6, 0.0, 0.8]
    askew = replace(straight, operator=sparse.csr_matrix(rows))
    lives = [tire(system, np.ones(2), LAW.rate, 1e-3, 0.5, FINE).life() for system in (straight, askew)]
    assert lives == pytest.approx([0.5e6, 0.5e6], rel=2e-3)


def test_largest_strain_is_that_of_the_beam():
    height = np.linspace(0.0, PAPER.h, 100_001)
    width = PAPER.B - (PAPER.B - PAPER.b) * height / PAPER.h
    strain = 6.0 * (PAPER.h - height) / (PAPER.e * width**2) / PAPER.form_factor()
    assert largest_strain(PAPER) == pytest.approx(strain.max(), rel=1e-9)
    assert largest_strain_at(PAPER) == pytest.approx(height[strain.argmax()], abs=1e-5)
    assert largest_strain_at(replace(PAPER, b=0.05)) == largest_strain_at(replace(PAPER, b=PAPER.B)) == 0.0


def test_life_falls_by_the_power_of_strain_and_bonds_of_plates_do_not_tire(beam):
    one, two = (fatigue(beam, strain, LAW) for strain in (1e-4, 2e-4))
    assert one.life() / two.life() == pytest.approx(2.0**LAW.exponent, rel=1e-6)
    of_plates = np.maximum(beam.network.first, beam.network.second) >= beam.radius.size
    assert of_plates.any() and not one.damage[of_plates].any() and one.damage.max() == 1.0
    assert profile_of(beam, one)["damage"].idxmax() < 10  # below the middle


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
