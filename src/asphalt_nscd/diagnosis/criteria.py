"""What decides whether a cause is named: how often and how large each is before any test, and bounds of probability.

Chances and sizes are judgements, to a factor of two or so, of what happens on such benches; no survey of laboratories
is at hand. A factor of two in a chance moves the size that is named by some 5 %. Tables that hold nothing but what
every laboratory adds (`laboratory`) should be given a name in 5 % of cases at most.
"""

from __future__ import annotations

from dataclasses import dataclass

NAMED, POSSIBLE = (
    0.95,
    0.5,
)  # probabilities from which a cause is named, and from which it is told as possible


@dataclass(frozen=True)
class Expected:
    """Chance that a campaign has a cause at all, and its usual size in the unit of its amplitude."""

    chance: float
    size: float


EXPECTED = {
    "phase_offset": Expected(0.06, 1.2),  # deg
    "channel_delay": Expected(0.06, 2.5e-4),  # s
    "moving_mass": Expected(0.04, 0.25),  # kg
    "guide_friction": Expected(0.03, 1.2e8),  # Pa
    "guide_stiffness": Expected(0.03, 1.2e8),  # Pa
    "loose_clamp": Expected(0.02, 8e-12),  # 1/Pa
    "specimen_geometry": Expected(0.06, 0.25),
    "temperature_bias": Expected(0.06, 2.0),  # K
    "self_heating": Expected(0.03, 1.5),  # K
    "strain_softening": Expected(0.04, 0.12),
    "damage": Expected(0.04, 0.12),
    "secondary_process": Expected(0.02, 2e9),  # Pa
    "solver": Expected(0.5, 1.0),  # of a simulated campaign
}
