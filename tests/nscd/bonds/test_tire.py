"""Bonds that tire, by closed form: in series, side by side, askew; and the parts of a cycle jump."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from asphalt_nscd.nscd.bonds.fatigue import (
    FatigueHistory,
    Jumps,
    _step_that_takes,
    remaining_stiffness,
    strain,
    tire,
)
from asphalt_nscd.nscd.bonds.system import BondedSystem

FINE, EXPONENT = Jumps(bond=0.001, growth=0.0, stiffness=0.002), 4.0


def rate(amplitude):
    """Of bonds that endure a strain of 1e-3 for a million cycles."""
    return 1e-6 * (1e3 * amplitude) ** EXPONENT


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
    course = tire(system, np.ones(2), rate, 1e-3, 0.5, FINE)
    assert course.life() == pytest.approx(1e6 * (2**5 - (4 / 3) ** 5) / 5, rel=2e-3)
    assert course.damage == pytest.approx([2 / 3, 0.0], abs=2e-3)


def test_of_two_bonds_side_by_side_the_shorter_is_lost_first():
    system = along_a_line([[0, 1], [0, 1], [1, 0]], [1.0, 1.0, np.inf])  # the third holds what nothing pulls
    course = tire(system, np.array([1.0, 2.0, 1.0]), rate, 1e-3, 0.3, FINE)
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
    lives = [tire(system, np.ones(2), rate, 1e-3, 0.5, FINE).life() for system in (straight, askew)]
    assert lives == pytest.approx([0.5e6, 0.5e6], rel=2e-3)


def test_parts_of_a_jump():
    """A jump ends where bonds have lost so much energy, of which one can lose no more than it has left."""
    assert remaining_stiffness(np.array([0.0, 0.4, 1.0])) == pytest.approx(np.repeat([1.0, 0.6, 1e-3], 3))
    assert strain(np.array([3j, 0, 4, 1, 2, 2]), np.array([2.0, 6.0])) == pytest.approx([2.5, 0.5])
    energy, speed, damage = np.array([1.0, 2.0]), np.array([0.1, 0.2]), np.array([0.0, 0.9])
    for lost, cycles in ((0.25, 0.5), (0.4, 2.0), (1.1, 9.0), (1.21, np.inf)):
        assert _step_that_takes(lost, energy, speed, damage) == pytest.approx(cycles, rel=1e-5)
    assert Jumps().finer(4.0) == Jumps(0.025, 2.5e-4, 2.5e-3)


def test_first_jumps_are_as_long_as_their_limits_allow():
    """Two like bonds that pull alike: the fastest loses a tenth, the head a hundredth, or cycles grow by a tenth."""
    system = along_a_line([[0, 1], [0, 1], [1, 0]], [1.0, 1.0, np.inf])
    length = np.array([1.0, 2.0, 1.0])
    for jumps, first in ((Jumps(0.1, 0.0, 1.0), 1e5), (Jumps(1.0, 0.0, 0.01), 2e-2 / (17 / 16) * 1e6)):
        course = tire(system, length, rate, 1e-3, 0.9, jumps)
        assert course.cycles[1] == pytest.approx(first, rel=1e-6)
    growing = tire(system, length, rate, 1e-3, 0.5, Jumps(1e-3, 0.1, 1.0)).cycles
    assert growing[1] == pytest.approx(1e3) and growing[20:30] == pytest.approx(1.1 * growing[19:29])


def test_life_is_interpolated_and_unknown_of_what_lives():
    course = FatigueHistory(
        np.array([0.0, 10.0, 30.0]), np.array([1.0, 0.6, 0.2]), np.zeros(3, int), np.ones(1)
    )
    assert (course.life(), course.life(0.9)) == pytest.approx((15.0, 2.5)) and np.isnan(course.life(0.1))


def test_a_strain_that_tires_no_bond_is_refused():
    system = along_a_line([[0, 1], [1, 0]], [np.inf, np.inf])
    with pytest.raises(ArithmeticError, match="no bond tires at this strain"):
        tire(system, np.ones(2), rate, 1e-3)
