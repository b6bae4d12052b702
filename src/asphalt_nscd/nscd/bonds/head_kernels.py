"""The balance of `head`, solved within a step: compiled."""

from __future__ import annotations

from asphalt_nscd.nscd.compiled import compiled


@compiled
def follow_actuator(devices, dt, free_force, impedance, actuator, x, v):
    """Velocity v+ of the head [m/s] and force r of the slider [N] by the balance of `head`.

    At rest on a rigid clamp the slider's force is undetermined and taken as zero. `free_force` F0 [N] is that of the
    specimen on a head that stands still, `impedance` is Z [N s/m]; `actuator` [m] is its place at the end of the step
    `dt` [s], `x` [m] and `v` [m/s] are those of the head at its start.
    """
    clamp, spring, slider, mass = devices
    push = clamp * (free_force - mass * v / dt + spring * x) + x - actuator
    # the inclusion r in F_s Sign(v+) is a projection: sticking and sliding need no iteration
    held = min(max(push, -clamp * slider), clamp * slider)
    velocity = (held - push) / (clamp * (impedance + mass / dt + spring * dt) + dt)
    if velocity != 0.0:
        return velocity, slider if velocity > 0.0 else -slider
    return velocity, -push / clamp if clamp > 0.0 else 0.0


@compiled
def actuator_force(devices, dt, force, friction, x, v, velocity):
    """Force of the actuator [N], from the `force` that the head takes and the `friction` of the slider [N].

    `x` [m] and `v` [m/s] are of the head at the start of the step `dt` [s], `velocity` is v+ [m/s] at its end.
    """
    _, spring, _, mass = devices
    return force + friction + spring * (x + dt * velocity) + mass * (velocity - v) / dt
