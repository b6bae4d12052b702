"""The balance of `head`, solved within a step: compiled."""

from __future__ import annotations

from asphalt_nscd.nscd.compiled import compiled


@compiled
def follow_actuator(devices, dt, free_force, impedance, actuator, x, v):
    """Velocity of the head by the balance of `head`.

    At rest on a rigid clamp the slider's force is undetermined and taken as zero.

    Parameters
    ----------
    devices : tuple of float
        `HeadDevices.of_head`.
    dt : float
        Step [s].
    free_force : float
        F0, of the specimen on a head that stands still [N].
    impedance : float
        Z of the specimen [N s/m].
    actuator : float
        Where it stands at the end of the step [m].
    x, v : float
        Where the head stood [m], and its velocity [m/s], at the start.

    Returns
    -------
    float
        v+ of the head [m/s].
    float
        r, force of the slider [N].
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
    """Force of the actuator.

    Parameters
    ----------
    devices : tuple of float
        `HeadDevices.of_head`.
    dt : float
        Step [s].
    force : float
        That the head takes [N].
    friction : float
        Of the slider [N].
    x, v : float
        Where the head stood [m], and its velocity [m/s], at the start.
    velocity : float
        v+ of the head [m/s].

    Returns
    -------
    float
        [N].
    """
    _, spring, _, mass = devices
    return force + friction + spring * (x + dt * velocity) + mass * (velocity - v) / dt
