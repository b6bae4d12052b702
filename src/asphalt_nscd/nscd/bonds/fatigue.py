"""Bonds that tire: their damage over many cycles of a head driven by a constant amplitude, by cycle jumps.

A bond of damage D, from 0 to 1, has 1 - D of its stiffness. D grows by rate(e) per cycle, e being the amplitude of the
bond's opening over its length. In steady oscillation of bonds of one law, far below the resonance, all openings are
those of the static motion of the head, whatever E* is: one real solution stands for many cycles. The damage of a jump
is that of its first cycle times their number, limited so that bonds and stiffness change little in a jump.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from asphalt_nscd.nscd.bonds.statics import Statics
from asphalt_nscd.nscd.bonds.system import BondedSystem

LEFT = 1e-3  # share of its stiffness that a lost bond keeps: spheres on lost bonds alone stay in place
TOLERANCE = 1e-6  # of the static solution
ENOUGH_ITERATIONS = 15  # of a solution with factors of the bonds as they were


@dataclass(frozen=True)
class Jumps:
    """Limits of a jump over many cycles, each as a share.

    `bond` is what the fastest bond may lose, unless `growth` of the cycles gone allows more; `stiffness` is what
    the specimen may lose at most.
    """

    bond: float = 0.1
    growth: float = 1e-3
    stiffness: float = 0.01

    def finer(self, times: float) -> Jumps:
        """Jumps `times` shorter: all three limits divided by `times`."""
        return Jumps(self.bond / times, self.growth / times, self.stiffness / times)


@dataclass(frozen=True)
class FatigueHistory:
    """What became of the bonds, with a row for the start of each jump.

    `cycles` (j,) have gone; `stiffness` (j,) is that of the head over that of sound bonds; `lost` (j,) counts the bonds
    lost; `damage` (b,) is that of each bond at the end.
    """

    cycles: np.ndarray
    stiffness: np.ndarray
    lost: np.ndarray
    damage: np.ndarray

    def life(self, share: float = 0.5) -> float:
        """Cycles at which a `share` of the sound stiffness is left, interpolated; NaN where more stays."""
        return float(np.interp(-share, -self.stiffness, self.cycles, right=np.nan))


def remaining_stiffness(damage: np.ndarray) -> np.ndarray:
    """Share (3 b,) of its stiffness that each component of a bond keeps at `damage` (b,)."""
    return np.repeat(np.maximum(1.0 - damage, LEFT), 3)


def strain(opening: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Norm (b,) of the `opening` (3 b,) [m], real or complex, over the `length` (b,) [m] of bonds."""
    return np.asarray(np.linalg.norm(opening.reshape(-1, 3), axis=1) / length)


def tire(
    system: BondedSystem,
    length: np.ndarray,
    rate: Callable[[np.ndarray], np.ndarray],
    amplitude: float,
    until: float = 0.5,
    jumps: Jumps = Jumps(),
) -> FatigueHistory:
    """Drive the head at an `amplitude` [m] until only the share `until` of its first stiffness is left.

    `length` (b,) in m; `rate` gives the damage per cycle (b,) at strains (b,). Bonds of infinite strength do not tire;
    ArithmeticError where no bond tires at this amplitude.
    """
    tires = np.isfinite(system.strength)
    damage, cycles = np.zeros(length.size), 0.0
    # without inertia, about 1 % of the force of a trapezoid at 25 Hz
    statics, rows = Statics(system, TOLERANCE, ENOUGH_ITERATIONS, 20 * ENOUGH_ITERATIONS), []
    while True:
        weight = system.weight * remaining_stiffness(damage)
        opening = system.operator @ statics.motion(weight)
        # twice the energy of a unit motion of the head is its stiffness: no force at the head has to be formed
        stiffness = float(weight @ opening**2)
        rows.append((cycles, stiffness, np.count_nonzero(damage >= 1.0)))
        # looked at before the jump, so that the last row is the first one below the limit, and `life` can
        # interpolate
        if stiffness <= until * rows[0][1]:
            break
        speed = np.where(tires & (damage < 1.0), rate(strain(amplitude * opening, length)), 0.0)
        if not speed.max() > 0.0:
            raise ArithmeticError("no bond tires at this strain")
        # to first order the head loses what bonds lose of their energy at this motion, that of least energy
        energy = (system.weight * opening**2).reshape(-1, 3).sum(axis=1)
        # a few overloaded bonds would keep every jump short: the cycles gone may always grow by a thousandth
        step = max(jumps.bond / speed.max(), jumps.growth * cycles)
        step = min(step, _step_that_takes(jumps.stiffness * stiffness, energy, speed, damage))
        damage = np.minimum(damage + step * speed, 1.0)
        cycles += step
    table = np.array(rows, float)
    return FatigueHistory(table[:, 0], table[:, 1] / table[0, 1], table[:, 2].astype(int), damage)


def _step_that_takes(lost: float, energy: np.ndarray, speed: np.ndarray, damage: np.ndarray) -> float:
    """Cycles after which bonds of `energy` (b,) [m] have lost `lost` [m] of it, as `damage` (b,) grows by `speed` (b,).

    A bond can lose no more than it has: the loss is concave in the cycles, and Newton's method from zero never passes
    the solution. Infinity where it has none.
    """
    step = 0.0
    for _ in range(50):
        loses = step * speed < 1.0 - damage
        slope = float(energy @ (speed * loses))
        gap = lost - float(energy @ np.minimum(step * speed, 1.0 - damage))
        if gap <= 1e-6 * lost:
            break
        if slope == 0.0:
            return np.inf
        step += gap / slope
    return step
