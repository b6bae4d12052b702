"""A test step by step, by any time scheme, with its energy account."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from asphalt_nscd.bending.checkpoint import Checkpoint
from asphalt_nscd.bending.layers import Layers
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.energy import Energies
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme

Progress = Callable[[int, int], None]
Arrays = dict[str, np.ndarray]


@dataclass
class Steps:
    """Histories of a run, one row for each step, and its account at the end."""

    force: np.ndarray  # (n,) N, of the actuator
    velocity: np.ndarray  # (n, l) m/s, means of the layers
    energies: Energies
    broken: list[int]
    full_steps: int
    done: int = 0


def condensed_steps(
    system: BondedSystem, law: BondLaw, scheme: Scheme, dt: float, driven: np.ndarray,
    devices: HeadDevices, layers: Layers, progress: Progress, checkpoint: Checkpoint | None = None,
) -> Steps:  # fmt: skip
    """Follow the actuator's displacements (n,) [m] by the full system, from rest or from the checkpoint."""
    kept = checkpoint.resume() if checkpoint else None
    state = CondensedState.at_rest(system, law)
    state.broken = [] if kept is None else kept["march/broken"].tolist()
    march = March(CondensedStepper(system, law, dt / scheme.a, state, devices), scheme, law, dt)
    steps = _started(march, driven.size, layers, kept)
    for n in range(steps.done, driven.size):
        steps.force[n] = march.move_to(driven[n])
        steps.velocity[n] = layers.mean @ state.velocity
        _count(steps, march, checkpoint)
        progress(n + 1, driven.size)
    steps.broken, steps.energies, steps.full_steps = state.broken, march.account.sums, driven.size
    return steps


def reduced_steps(
    stepper: ReducedStepper, law: BondLaw, scheme: Scheme, dt: float, driven: np.ndarray,
    layers: Layers, progress: Progress, checkpoint: Checkpoint | None = None,
) -> Steps:  # fmt: skip
    """The same by a reduced stepper of step length dt / scheme.a, at rest, and by the full system where
    it needs that.
    """
    kept = checkpoint.resume() if checkpoint else None
    system = stepper.model.system
    march = March(stepper, scheme, law, dt)
    if kept is not None:
        stepper.put(_below("reduced/", kept))
        if kept["full_steps"] > 0:
            full = CondensedState.at_rest(system, law)
            full.broken = kept["march/broken"].tolist()
            march.stepper = CondensedStepper(system, law, dt / scheme.a, full, stepper.devices)
    steps = _started(march, driven.size, layers, kept)
    along = layers.mean @ stepper.model.basis
    for n in range(steps.done, driven.size):
        try:
            steps.force[n] = march.move_to(driven[n])
        except FullSystemNeeded:
            state = stepper.full_state()
            march.go_on_with(CondensedStepper(system, law, dt / scheme.a, state, stepper.devices))
            steps.force[n] = march.move_to(driven[n])
        if march.stepper is stepper:
            if stepper.model.basis.shape[1] != along.shape[1]:
                along = layers.mean @ stepper.model.basis
            steps.velocity[n] = along @ stepper.state.velocity
        else:
            stepper.certify(march.stepper)
            steps.velocity[n] = layers.mean @ march.stepper.state.velocity
            steps.full_steps += 1
        _count(steps, march, checkpoint, stepper)
        progress(n + 1, driven.size)
    steps.broken, steps.energies = march.stepper.state.broken, march.account.sums
    return steps


def _started(march: March, count: int, layers: Layers, kept: Arrays | None) -> Steps:
    """Nothing yet, or what was kept, of which the march takes its part."""
    steps = Steps(np.empty(count), np.empty((count, layers.height.size)), march.account.sums, [], 0)
    if kept is not None:
        march.put(_below("march/", kept))
        steps.done, steps.full_steps = kept["force"].size, kept["full_steps"].item()
        steps.force[: steps.done], steps.velocity[: steps.done] = kept["force"], kept["velocity"]
    return steps


def _count(
    steps: Steps, march: March, checkpoint: Checkpoint | None, reduced: ReducedStepper | None = None
) -> None:
    """One step more, kept if it is time."""
    steps.done += 1
    if checkpoint is None or not checkpoint.is_due(steps.done, steps.force.size):
        return
    arrays = {f"march/{name}": value for name, value in march.arrays().items()}
    if reduced is not None:
        arrays |= {f"reduced/{name}": value for name, value in reduced.arrays().items()}
    arrays |= {"force": steps.force[: steps.done], "velocity": steps.velocity[: steps.done]}
    checkpoint.keep(arrays | {"full_steps": np.asarray(steps.full_steps)})


def _below(prefix: str, arrays: Arrays) -> Arrays:
    return {name.removeprefix(prefix): a for name, a in arrays.items() if name.startswith(prefix)}
