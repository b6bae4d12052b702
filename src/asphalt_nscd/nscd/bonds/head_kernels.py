"""The balance of `head`, solved within a step: compiled."""

from __future__ import annotations

from asphalt_nscd.nscd.compiled import compiled


@compiled
def follow_actuator(devices, dt, free_force, impedance, actuator, x, v):
    """(v+, r): head velocity [m/s] and force of the slider [N], by the balance of `head`.

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
