"""Devices between the actuator and the head of a specimen, and between the head and the ground.

Seen from its head, a specimen is affine within an implicit step: the head velocity v+ takes the
force F0 + Z v+ (F0 from the history, Z [N s/m] its impedance). With a clamp of compliance C to the
actuator at z+, and a spring k, a Coulomb slider F_s and an extra mass m at the head, the balance

    F0 + Z v+ + m (v+ - v)/dt + k (x + dt v+) + r = (z+ - x - dt v+) / C,   r in F_s Sign(v+)

is one monotone inclusion in v+ with an explicit solution. Times C it holds for a rigid clamp too.
The specimen itself still has a driven head: nothing else about it changes.
"""

from __future__ import annotations

from dataclasses import dataclass

from asphalt_nscd.nscd.compiled import compiled


@dataclass(frozen=True)
class HeadDevices:
    """clamp_compliance C [m/N], guide_stiffness k [N/m], guide_friction F_s [N], head_mass m [kg]."""

    clamp_compliance: float = 0.0
    guide_stiffness: float = 0.0
    guide_friction: float = 0.0
    head_mass: float = 0.0

    @property
    def of_head(self) -> tuple[float, float, float, float]:
        """(C, k, F_s, m), for the compiled functions."""
        return (
            float(self.clamp_compliance), float(self.guide_stiffness), float(self.guide_friction),
            float(self.head_mass),
        )  # fmt: skip


RIGID = HeadDevices()


@compiled
def follow_actuator(devices, dt, free_force, impedance, actuator, x, v):
    """(v+, r): head velocity [m/s] and force of the slider [N], by the balance above.

    At rest on a rigid clamp the slider's force is undetermined and taken as zero.
    """
    clamp, spring, slider, mass = devices
    push = clamp * (free_force - mass * v / dt + spring * x) + x - actuator
    held = min(max(push, -clamp * slider), clamp * slider)
    velocity = (held - push) / (clamp * (impedance + mass / dt + spring * dt) + dt)
    if velocity != 0.0:
        return velocity, slider if velocity > 0.0 else -slider
    return velocity, -push / clamp if clamp > 0.0 else 0.0


@compiled
def actuator_force(devices, dt, force, friction, x, v, velocity):
    """Force of the actuator [N] where the head, moving at v+, takes `force` and `friction`."""
    _, spring, _, mass = devices
    return force + friction + spring * (x + dt * velocity) + mass * (velocity - v) / dt
