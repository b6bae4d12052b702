"""A test step by step, by any time scheme, with its energy account."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from asphalt_nscd.layers import Layers
from asphalt_nscd.nscd.bonds import BondedSystem
from asphalt_nscd.nscd.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.energy import Energies
from asphalt_nscd.nscd.head import HeadDevices
from asphalt_nscd.nscd.law import BondLaw
from asphalt_nscd.nscd.marching import March
from asphalt_nscd.nscd.reduced_stepping import FullSystemNeeded, ReducedStepper
from asphalt_nscd.nscd.scheme import Scheme

Progress = Callable[[int, int], None]


@dataclass
class Steps:
    """Histories of a run, one row for each step, and its account at the end."""

    force: np.ndarray  # (n,) N, of the actuator
    velocity: np.ndarray  # (n, l) m/s, means of the layers
    energies: Energies
    broken: list[int]
    full_steps: int


def condensed_steps(
    system: BondedSystem, law: BondLaw, scheme: Scheme, dt: float, driven: np.ndarray,
    devices: HeadDevices, layers: Layers, progress: Progress,
) -> Steps:  # fmt: skip
    """Follow the actuator's displacements (n,) [m] by the full system, from rest."""
    state = CondensedState.at_rest(system, law)
    march = March(CondensedStepper(system, law, dt / scheme.a, state, devices), scheme, law, dt)
    steps = _empty(march, driven.size, layers)
    for n, place in enumerate(driven):
        steps.force[n] = march.move_to(place)
        steps.velocity[n] = layers.mean @ state.velocity
        progress(n + 1, driven.size)
    steps.broken, steps.full_steps = state.broken, driven.size
    return steps


def reduced_steps(
    stepper: ReducedStepper, law: BondLaw, scheme: Scheme, dt: float, driven: np.ndarray,
    layers: Layers, progress: Progress,
) -> Steps:  # fmt: skip
    """The same by a reduced stepper of step length dt / scheme.a, at rest, and by the full system where
    it needs that.
    """
    system, along = stepper.model.system, layers.mean @ stepper.model.basis
    march = March(stepper, scheme, law, dt)
    steps = _empty(march, driven.size, layers)
    for n, place in enumerate(driven):
        try:
            steps.force[n] = march.move_to(place)
        except FullSystemNeeded:
            state = stepper.full_state()
            march.go_on_with(CondensedStepper(system, law, dt / scheme.a, state, stepper.devices))
            steps.force[n] = march.move_to(place)
        if march.stepper is stepper:
            if stepper.model.basis.shape[1] != along.shape[1]:
                along = layers.mean @ stepper.model.basis
            steps.velocity[n] = along @ stepper.state.velocity
        else:
            stepper.certify(march.stepper)
            steps.velocity[n] = layers.mean @ march.stepper.state.velocity
            steps.full_steps += 1
        progress(n + 1, driven.size)
    steps.broken = march.stepper.state.broken
    return steps


def _empty(march: March, steps: int, layers: Layers) -> Steps:
    return Steps(np.empty(steps), np.empty((steps, layers.height.size)), march.account.sums, [], 0)
