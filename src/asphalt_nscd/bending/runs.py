"""How each method follows the actuator through a test, from rest.

Sparse matrices are imported where a run needs them: importing them takes as long as most reduced tests.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.bending.case import LoadCase, RunOptions
from asphalt_nscd.bending.settings import Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.law import AnyLaw, BondLaw
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme

if TYPE_CHECKING:
    from asphalt_nscd.bending.excerpt import ModelExcerpt
    from asphalt_nscd.bending.model import Model
    from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
    from asphalt_nscd.nscd.stepping.integrator import March

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
    of "sweeps" the relative change of the last sweep, and NaN if not checked. `ended` says why a run is shorter than
    asked.
    """

    force: Vector
    velocity: Vector
    broken: list[int] = field(default_factory=list)
    residual: float = np.nan
    details: Details = field(default_factory=dict)
    full_steps: int = 0
    ended: str = ""
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
    from asphalt_nscd.nscd.stepping.integrator import March

    # a two-step scheme is an implicit Euler step of length dt / a from an extrapolated state
    scheme = _scheme(case, numerics)
    stepper = _reduced_stepper(model.whole, law, numerics.time_step / scheme.a, case.rig)
    run = _follow(March(stepper, scheme, law, numerics.time_step), model.whole, case, numerics, options)
    return _certified(stepper, run)


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
    try:
        force, coordinates = stepper.run(driven)
        run = Histories(force, _layer_means(model, stepper, coordinates), stepper.state.broken)
        if run.broken and not model.whole.is_whole(run.broken):
            from asphalt_nscd.nscd.stepping.integrator import March

            # the kernel does not look for pieces: step by step, the run ends with the step that made them
            stepper = _reduced_stepper(model.whole, law, time_step, devices)
            march = March(stepper, Scheme(), law, time_step, account=False)
            run = march_along(march, model.whole, driven, options)
    except FullSystemNeeded as accepted:
        from asphalt_nscd.nscd.stepping.integrator import March

        # the full system goes on from where the last accepted step ended
        done = accepted.force.size
        place = float(driven[done - 1]) if done else 0.0
        full = _full_stepper(model.whole, law, time_step, stepper.full_state(), devices, options)
        march = March(full, Scheme(), law, time_step, place, account=False)
        run = march_along(march, model.whole, driven[done:], options, small=stepper)
        run.force = np.concatenate([accepted.force, run.force])
        run.velocity = np.concatenate([_layer_means(model, stepper, accepted.velocity), run.velocity])
    options.progress(driven.size, driven.size)
    return _certified(stepper, run)


def _layer_means(model: Model | ModelExcerpt, stepper: ReducedStepper, coordinates: Vector) -> Vector:
    """Mean velocities of the layers (n, l) [m/s] by coordinates (n, k); a break has widened the basis."""
    along = model.along
    if coordinates.shape[1] > len(along):
        along = (model.whole.layers.mean @ stepper.model.basis).T
    return np.asarray(coordinates @ along)


def _certified(stepper: ReducedStepper, run: Histories) -> Histories:
    """Add to a run what its reduced stepper certifies."""
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
    from asphalt_nscd.nscd.stepping.integrator import March

    state, scheme = CondensedState.rest_state(model.system, law), _scheme(case, numerics)
    stepper = _full_stepper(model, law, numerics.time_step / scheme.a, state, case.rig, options)
    return _follow(March(stepper, scheme, law, numerics.time_step), model, case, numerics, options)


def sweeps(model: Model, law: BondLaw, case: LoadCase, numerics: Numerics, options: RunOptions) -> Histories:
    """Follow the actuator by Gauss-Seidel on the bonds, as in the paper; bonds do not break."""
    from asphalt_nscd.nscd.stepping.condensed import CondensedState
    from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper
    from asphalt_nscd.nscd.stepping.integrator import March

    system = model.system
    in_sixes = system.place is None or (system.place == np.arange(system.mass.size)).all()
    # a sweep asks six numbers of each body, and divides by its mass
    if not in_sixes or not system.mass[system.free].all():
        raise InputError(
            f"{model.name}: the method sweeps moves spheres and one head that has a mass; choose the method reduced or "
            "condensed."
        )
    state = CondensedState.rest_state(system, law)
    tolerance, most = numerics.tolerance, numerics.most_sweeps
    stepper = SweepingStepper(system, law, numerics.time_step, state, tolerance, most)
    run = _follow(
        March(stepper, Scheme(), law, numerics.time_step, account=False), model, case, numerics, options
    )
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
    law: AnyLaw,
    dt: float,
    state: CondensedState,
    devices: HeadDevices,
    options: RunOptions,
) -> CondensedStepper:
    """Steps the full system until the specimen is in two pieces, or fails by the shares of the options."""
    from asphalt_nscd.nscd.stepping.condensed import CondensedStepper

    def check_broken(broken: Sequence[int]) -> None:
        # a commanded force would throw what is loose
        if options.to_failure and not devices.clamp_compliance:
            return
        model.require_whole(broken)
        if not options.to_failure and len(broken) > options.most_broken * model.bonds:
            raise InputError(
                f"{model.name}: the specimen fails, {len(broken)} of {counted(model.bonds, 'bond')} broke; lower the "
                "load or raise the strength of the bonds."
            )

    stepper = CondensedStepper(model.system, law, dt, state, devices)

    def check_closed(touching: Sequence[int]) -> None:
        # hundreds of contacts at once take half a minute a step
        if len(touching) > options.most_closed * model.bonds:
            raise InputError(
                f"{model.name}: the specimen is crushed, {counted(len(touching), 'gap')} of {model.bonds} closed; "
                "strains are no longer small: lower the load, or take a stiffer law."
            )

    stepper.on_break, stepper.on_contact = check_broken, check_closed
    return stepper


def _follow(march: March, model: Model, case: LoadCase, numerics: Numerics, options: RunOptions) -> Histories:
    """Make the steps of a test one by one."""
    framed = set((numerics.rest_steps + case.framed(numerics, options.frames)).tolist())
    return march_along(march, model, case.driven(numerics), options, framed)


def march_along(
    march: March,
    model: Model,
    path: Vector,
    options: RunOptions,
    framed: Container[int] = (),
    small: ReducedStepper | None = None,
    after: Callable[[], None] = lambda: None,
) -> Histories:
    """Steps that end with the actuator along `path` (n,) [m]; those in `framed` are kept whole; `after` follows each.

    The full system takes over where the reduced one cannot go on; `small`, reduced, certifies what that does.
    """
    layers = model.layers
    run, broken = Histories(np.empty(path.size), np.empty((path.size, layers.height.size))), 0
    if isinstance(march.stepper, ReducedStepper):
        small, along = march.stepper, layers.mean @ march.stepper.model.basis
    for n, place in enumerate(path):
        try:
            run.force[n] = _step(march, place, model, options)
            if small is not None and march.stepper is not small:
                small.certify(cast("CondensedStepper", march.stepper))
                run.full_steps += 1
            if len(march.stepper.state.broken) != broken and not options.to_failure:
                broken = len(march.stepper.state.broken)
                model.require_whole(march.stepper.state.broken)
            after()
        except (InputError, ArithmeticError) as error:
            if not options.keeps_record:
                raise
            run.ended, run.force, run.velocity = str(error), run.force[:n], run.velocity[:n]
            break
        state = march.stepper.state
        if march.stepper is small:
            # a break or an enrichment has widened the basis
            if small.model.basis.shape[1] != along.shape[1]:
                along = layers.mean @ small.model.basis
            run.velocity[n] = along @ state.velocity
        else:
            run.velocity[n] = layers.mean @ state.velocity
        if n in framed:
            full = small.full_state() if small is not None and march.stepper is small else state
            run.frames.append(Frame.of(model, cast("CondensedState", full)))
        # each twentieth step is told
        if n % 20 == 19 or n + 1 == path.size:
            options.progress(n + 1, path.size)
    run.broken = list(march.stepper.state.broken)
    if march.accounts:
        run.details = march.account.sums.columns()
    return run


def _step(march: March, place: float, model: Model, options: RunOptions) -> float:
    """Force [N] of a step, by the full system where the reduced one refuses it."""
    try:
        return march.move_to(place)
    except FullSystemNeeded:
        small = march.stepper
        assert isinstance(small, ReducedStepper), "the full system makes every step"
        # the refused step left the state before it: the full system makes it
        state = small.full_state()
        march.go_on_with(_full_stepper(model, march.law, small.dt, state, small.devices, options))
        return march.move_to(place)
