"""A head on a yielding clamp whose contacts hardly answer it."""

from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.head_kernels import follow_actuator
from asphalt_nscd.nscd.stepping.condensed import CondensedStepper


@pytest.mark.parametrize("seed", range(30))
def test_a_contact_force_that_only_the_solvers_tolerance_changes_is_met(seed):
    rng = np.random.default_rng(seed)
    force, dt = rng.normal(size=2), 2e-3
    following = np.array([1.0, rng.normal()])
    devices = HeadDevices(2.4e-9, 1.2e4, 1.0, 0.05)
    stepper = SimpleNamespace(
        system=SimpleNamespace(driven=0, mass=np.ones(2)),
        state=SimpleNamespace(displacement=np.zeros(2), velocity=np.zeros(2)),
        dt=dt,
        devices=devices,
        actuator=0.0,
        _follow_head=lambda: following,
        _coupling=lambda: np.array([1.0, 0.3]),
        _velocity=lambda impulse, head: np.array([head, 0.0]),
        _meet_contacts=lambda velocity: (velocity, force * (1.0 + 1e-12 * np.sin(1e12 * velocity[0]))),
    )
    impulse = 1e-3 * rng.normal(size=2)
    motion, contact_force, _ = CondensedStepper._move_by_clamp(stepper, impulse, 1e-3)
    free_force, impedance = (
        -float(following @ (impulse / dt + force)),
        (1.0 + float(stepper._coupling() @ following)) / dt,
    )
    expected, _ = follow_actuator(devices.head_constants, dt, free_force, impedance, dt * 1e-3, 0.0, 0.0)
    assert contact_force == pytest.approx(force, rel=1e-10)
    assert motion[0] == pytest.approx(expected, rel=1e-10)
