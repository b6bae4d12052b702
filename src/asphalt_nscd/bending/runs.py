"""How each method follows the actuator through a test, from rest.

Sparse matrices are imported where a run needs them: importing them takes as long as most reduced tests.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.bending.case import LoadCase, RunOptions
from asphalt_nscd.bending.layers import Layers
from asphalt_nscd.bending.settings import Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme

if TYPE_CHECKING:
    from asphalt_nscd.bending.excerpt import ModelExcerpt
    from asphalt_nscd.bending.model import Model
    from asphalt_nscd.nscd.bonds.head import HeadDevices
    from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
    from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper

Vector = NDArray[np.float64]
Details = dict[str, float | int]
RESIDUAL_TOLERANCE = 1e-6  # of the full equations, relative to the load of the head


@dataclass(frozen=True)
class Frame:
    """Motion and bond forces at one instant; motion is from where the specimen stands free of weight.

    `displacement` (d,) in m or rad; `velocity` (d,) in m/s or rad/s; `reaction` (3 b,) of the bonds in N, negative
    where they pull and zero for broken ones.
    """

    displacement: Vector
    velocity: Vector
    reaction: Vector

    @classmethod
    def of(cls, model: Model, state: CondensedState) -> Frame:
        """The instant at which the full system stands."""
        reaction = model.system.weight * state.sigma
        reaction.reshape(-1, 3)[state.broken] = 0.0
        return cls(state.displacement, state.velocity, reaction)


@dataclass
class Histories:
    """What a run gives, a row for each step, those at rest included.

    `force` (n,) of the actuator in N; `velocity` (n, l), means of the layers, in m/s; `broken` in the order of
    breaking; `full_steps` were made by the full system. `residual` is that of the full equations,
    of "sweeps" the relative change of the last sweep, and NaN if not checked.
    """

    force: Vector
    velocity: Vector
    broken: list[int] = field(default_factory=list)
    residual: float = np.nan
    details: Details = field(default_factory=dict)
    full_steps: int = 0
    frames: list[Frame] = field(default_factory=list)


def reduced(
    model: Model | ModelExcerpt, law: BondLaw, case: LoadCase, numerics: Numerics, options: RunOptions
) -> Histories:
    """Follow the actuator by the reduced system, and by the full one from where it is needed.

    The compiled kernel makes all steps in one call; an account, frames or another scheme than implicit Euler needs them
    one by one.
    """
    if numerics.scheme == "euler" and not (options.energy or options.frames):
        return path_run(model, law, case.rig, numerics.time_step, case.driven(numerics), options)
    # a two-step scheme is an implicit Euler step of length dt / a from an extrapolated state
    stepper = _reduced_stepper(model.whole, law, numerics.time_step / _scheme(case, numerics).a, case.rig)
    return _certified(stepper, model, _one_by_one(stepper, model.whole, law, (case, numerics), options))


def path_run(
    model: Model | ModelExcerpt,
    law: BondLaw,
    devices: HeadDevices,
    time_step: float,
    driven: Vector,
    options: RunOptions,
) -> Histories:
    """Follow any path of the actuator in one call; `driven` (n,) in m at the ends of steps of `time_step` in s."""
    stepper = _reduced_stepper(model, law, time_step, devices)
    return _certified(stepper, model, _run_whole_path(stepper, model, law, driven, options))


def _certified(stepper: ReducedStepper, model: Model | ModelExcerpt, run: Histories) -> Histories:
    # the kernel breaks bonds without looking for pieces: asked once, at the end
    if run.broken:
        model.whole.require_whole(run.broken)
    certificate = stepper.certificate()
    run.residual = certificate.largest_residual
    run.details = {
        "largest_utilisation": certificate.largest_utilisation,
        "smallest_gap_m": certificate.smallest_gap,
        "enrichments": certificate.enrichments,
        "full_steps": run.full_steps,
    } | run.details
    return run


def condensed(
    model: Model, law: BondLaw, case: LoadCase, numerics: Numerics, options: RunOptions
) -> Histories:
    """Follow the actuator by the full system, its bonds condensed, with the energy account."""
    from asphalt_nscd.nscd.stepping.condensed import CondensedState

    state = CondensedState.rest_state(model.system, law)
    dt = numerics.time_step / _scheme(case, numerics).a
    stepper = _full_stepper(model, law, dt, state, case.rig)
    return _one_by_one(stepper, model, law, (case, numerics), options)


def sweeps(model: Model, law: BondLaw, case: LoadCase, numerics: Numerics, options: RunOptions) -> Histories:
    """Follow the actuator by Gauss-Seidel on the bonds, as in the paper; bonds do not break."""
    from asphalt_nscd.nscd.stepping.condensed import CondensedState
    from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper

    state = CondensedState.rest_state(model.system, law)
    tolerance, most = numerics.tolerance, numerics.most_sweeps
    stepper = SweepingStepper(model.system, law, numerics.time_step, state, tolerance, most)
    run = _follow(stepper, np.concatenate([[0.0], case.driven(numerics)]), model.layers, options)
    run.residual = stepper.largest_change
    run.details = {"sweeps": stepper.sweeps, "tolerance": tolerance, "most_sweeps": most}
    return run


def _scheme(case: LoadCase, numerics: Numerics) -> Scheme:
    return Scheme.named(numerics.scheme, case.omega * numerics.time_step)


def _reduced_stepper(
    model: Model | ModelExcerpt, law: BondLaw, time_step: float, devices: HeadDevices
) -> ReducedStepper:
    # a cycle of the paper's specimen takes 0.2 CPU s so, 160 by full steps and 203 by fifty sweeps a step
    small, stand_by = model.reduced_form
    return ReducedStepper(small, law, time_step, RESIDUAL_TOLERANCE, devices=devices, stand_by=stand_by)


def _full_stepper(
    model: Model,
    law: BondLaw,
    dt: float,
    state: CondensedState,
    devices: HeadDevices,
    actuator: float = 0.0,
    options: RunOptions = RunOptions(),
) -> CondensedStepper:
    """Steps the full system until the specimen is in two pieces, or fails by the shares of the options."""
    from asphalt_nscd.nscd.stepping.condensed import CondensedStepper

    def check_broken(broken: Sequence[int]) -> None:
        model.require_whole(broken)
        if len(broken) > options.most_broken * model.bonds:
            raise InputError(
                f"{model.name}: the specimen fails, {len(broken)} of {counted(model.bonds, 'bond')} broke; lower the "
                "load or raise the strength of the bonds."
            )

    stepper = CondensedStepper(model.system, law, dt, state, devices, actuator)

    def check_closed(touching: Sequence[int]) -> None:
        # hundreds of contacts at once take half a minute a step
        if len(touching) > options.most_closed * model.bonds:
            raise InputError(
                f"{model.name}: the specimen is crushed, {counted(len(touching), 'gap')} of {model.bonds} closed; "
                "strains are no longer small: lower the load, or take a stiffer law."
            )

    stepper.on_break, stepper.on_contact = check_broken, check_closed
    return stepper


def _run_whole_path(
    stepper: ReducedStepper, model: Model | ModelExcerpt, law: BondLaw, driven: Vector, options: RunOptions
) -> Histories:
    layers = model.along
    try:
        force, coordinates = stepper.run(driven)
        run = Histories(force, coordinates @ layers, stepper.state.broken)
    except FullSystemNeeded as accepted:
        whole, done = model.whole, accepted.force.size
        state = stepper.full_state()
        # the full system goes on from where the last accepted step ended
        path = np.concatenate([[0.0], driven])[done:]
        full = _full_stepper(whole, law, stepper.dt, state, stepper.devices, path[0], options)
        rest = _follow(full, path, whole.layers, options, lambda: stepper.certify(full))
        force = np.concatenate([accepted.force, rest.force])
        velocity = np.concatenate([accepted.velocity @ layers, rest.velocity])
        run = Histories(force, velocity, state.broken, full_steps=driven.size - done)
    options.progress(driven.size, driven.size)
    return run


def _follow(
    stepper: CondensedStepper | SweepingStepper,
    path: Vector,
    layers: Layers,
    options: RunOptions,
    check: Callable[[], None] = lambda: None,
) -> Histories:
    """Steps of the full system along the actuator's displacements (n + 1,) [m]; `check` is called after each."""
    steps = path.size - 1
    run = _empty(steps, layers)
    velocity = np.diff(path) / stepper.dt
    for n in range(steps):
        run.force[n] = stepper.advance(velocity[n])
        run.velocity[n] = layers.mean @ stepper.state.velocity
        check()
        if n % 20 == 19:
            options.progress(n + 1, steps)
    return run


def _one_by_one(
    stepper: ReducedStepper | CondensedStepper,
    model: Model,
    law: BondLaw,
    what: tuple[LoadCase, Numerics],
    options: RunOptions,
) -> Histories:
    """Steps of any scheme with their energy account, from rest."""
    from asphalt_nscd.nscd.stepping.integrator import March

    case, numerics = what
    driven, layers = case.driven(numerics), model.layers
    march = March(stepper, _scheme(case, numerics), law, numerics.time_step)
    run = _empty(driven.size, layers)
    small = stepper if isinstance(stepper, ReducedStepper) else None
    framed = set((numerics.rest_steps + case.framed(numerics, options.frames)).tolist())
    along = np.empty((0, 0)) if small is None else layers.mean @ small.model.basis
    for n in range(driven.size):
        try:
            run.force[n] = march.move_to(driven[n])
        except FullSystemNeeded:
            assert small is not None, "the full system makes every step"
            state = small.full_state()
            march.go_on_with(_full_stepper(model, law, stepper.dt, state, case.rig))
            # the refused step left the state before it: the full system makes it
            run.force[n] = march.move_to(driven[n])
        if small is None:
            run.velocity[n] = layers.mean @ stepper.state.velocity
        elif march.stepper is small:
            # a break or an enrichment has widened the basis
            if small.model.basis.shape[1] != along.shape[1]:
                along = layers.mean @ small.model.basis
            run.velocity[n] = along @ small.state.velocity
        else:
            full = cast("CondensedStepper", march.stepper)
            small.certify(full)
            run.velocity[n] = layers.mean @ full.state.velocity
            run.full_steps += 1
        if n in framed:
            moving = march.stepper
            state = moving.full_state() if isinstance(moving, ReducedStepper) else moving.state
            run.frames.append(Frame.of(model, state))
        options.progress(n + 1, driven.size)
    run.broken, run.details = march.stepper.state.broken, march.account.sums.columns()
    return run


def _empty(steps: int, layers: Layers) -> Histories:
    return Histories(np.empty(steps), np.empty((steps, layers.height.size)))
