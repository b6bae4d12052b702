"""A beam bent with growing amplitude until a hundred bonds broke: reduced and full, break by break.

The reduced model is enriched at each break, or hands over to the full system where it must; the energy
account is kept all the way, and two of its terms are summed apart from it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.break_modes import StandBy
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.energy import Energies
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis, shifted_factor
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import History, Scheme
from theory.marches import beam
from theory.specimens import QUICK_LAW
from theory.test_accounts import ACCOUNT

pytestmark = pytest.mark.slow

BREAKS = 100
DT, PERIOD = 5e-5, 20  # s; steps in a cycle
GROWTH = 1e-5  # m of amplitude in a cycle
LIMIT = 200  # steps: without fracture by then, something is wrong
NO_LIMIT = 10 * BREAKS  # enrichments, so that the full system is never needed
ALIKE, FORCE, CLOSES = 0.0, 1e-6, 1e-9  # asked for: the same bonds, 1e-4 and 1e-6


@dataclass
class Run:
    """Of one method: what it was asked and what it found."""

    force: list[float] = field(default_factory=list)  # N
    broken: list[int] = field(default_factory=list)
    full_steps: int = 0
    error: float = 0.0  # J, the largest of the account after any step
    energies: Energies | None = None
    fracture: float = 0.0  # J, summed here, bond by bond
    numerical: float = 0.0  # J, summed here from the changes in each step; of implicit Euler


def specimen() -> BondedSystem:
    """Stocky, so that its sections have bonds enough."""
    return beam(10, 9, 8)


def place(step: int) -> float:
    """Where the actuator stands at the end of a step [m]: a sine whose amplitude grows with time."""
    return GROWTH * step / PERIOD * np.sin(2 * np.pi * step / PERIOD)


def stepper_of(method: str, scheme: Scheme, most_enrichments: int) -> CondensedStepper | ReducedStepper:
    """A stepper, "full" or "reduced", of the beam at rest with no bond broken.

    It takes the step DT / a of `scheme`; after `most_enrichments` the reduced model hands over to the full system.
    """
    system, dt = specimen(), DT / scheme.a
    if method == "full":
        return CondensedStepper(system, QUICK_LAW, dt, CondensedState.rest_state(system, QUICK_LAW))
    shifted = shifted_factor(system)
    basis = ritz_basis(system, 12, shifted)
    stand_by = StandBy.of(system, basis, shifted)
    model = stand_by.model(system, basis, [])
    assert model is not None
    return ReducedStepper(model, QUICK_LAW, dt, 1e-6, most_enrichments, stand_by=stand_by)


@cache
def fractured(method: str, name: str, most_enrichments: int = 30) -> Run:
    """The run by "full" or "reduced" up to the step in which the hundredth bond breaks.

    It has forces [N], bonds in the order in which they broke, and the energy account; see also `stepper_of`.
    """
    scheme, run = Scheme.named(name, 2 * np.pi / PERIOD), Run()
    march = March(stepper_of(method, scheme, most_enrichments), scheme, QUICK_LAW, DT)
    while len(run.broken) < BREAKS and len(run.force) < LIMIT:
        before, reached = march.now, len(run.broken)
        at = place(len(run.force) + 1)
        try:
            run.force.append(march.move_to(at))
        except FullSystemNeeded:
            assert isinstance(march.stepper, ReducedStepper)
            state = march.stepper.full_state()
            march.go_on_with(CondensedStepper(specimen(), QUICK_LAW, DT / scheme.a, state))
            before = march.now  # in the coordinates of the full system
            run.force.append(march.move_to(at))
        run.broken = list(march.stepper.state.broken)
        run.full_steps += isinstance(march.stepper, CondensedStepper)
        run.error = max(run.error, abs(march.account.sums.error))
        if method == "full":
            sum_apart(run, march, before, run.broken[reached:])
    run.energies = march.account.sums
    return run


def sum_apart(run: Run, march: March, before: History, new: list[int]) -> None:
    """What new breaks release at the beginning of the step, and half the squares of all changes in it."""
    then, now = before.values, march.now.values
    rows = (3 * np.array(new, int)[:, None] + np.arange(3)).ravel()
    springs: list[tuple[float, str, Any]] = [(1.0 / QUICK_LAW.spring, "sigma", ...)]
    weight = specimen().weight
    springs += [(modulus, "memory", e) for e, modulus in enumerate(QUICK_LAW.kelvin_springs)]
    left = weight.copy()
    left[3 * np.array(run.broken, int)[:, None] + np.arange(3)] = 0.0
    for modulus, variable, part in springs:
        run.fracture += 0.5 * modulus * float(weight[rows] @ then[variable][part][rows] ** 2)
        change = now[variable][part] - then[variable][part]
        run.numerical += 0.5 * modulus * float(left @ change**2)
    run.numerical += 0.5 * float(specimen().mass @ (now["velocity"] - then["velocity"]) ** 2)


def test_reduced_against_full(row):
    for what, name, most in (
        ("reduced all the way", "euler", NO_LIMIT),
        ("reduced, then full", "euler", 30),
        ("reduced, then full, fitted scheme", "fitted", 30),
    ):
        full, reduced = fractured("full", name), fractured("reduced", name, most)
        alike = 0
        for one, other in zip(full.broken[:BREAKS], reduced.broken[:BREAKS], strict=False):
            if one != other:
                break
            alike += 1
        steps = min(len(full.force), len(reduced.force))
        difference = np.abs(np.subtract(full.force[:steps], reduced.force[:steps])).max()
        difference /= np.abs(full.force).max()
        source = "full system, bonds condensed"
        row(f"{what}: first breaks alike and in order", BREAKS, alike, ALIKE, source)
        row(f"{what}: reaction over its largest", 0.0, difference, FORCE, source)
    all_the_way = fractured("reduced", "euler", NO_LIMIT).full_steps
    row("reduced all the way: steps of the full system", 0, all_the_way, 0.0, "none needed")


def test_energy(row):
    for method, name, most in (
        ("full", "euler", 30),
        ("reduced", "euler", NO_LIMIT),
        ("full", "fitted", 30),
        ("reduced", "fitted", 30),
    ):
        run = fractured(method, name, most)
        assert run.energies is not None
        error = run.error / run.energies.actuator
        row(f"energy account of the fracture, {method}, {name}", 0.0, error, CLOSES, ACCOUNT)
    run = fractured("full", "euler")
    assert run.energies is not None
    sums, work = run.energies, run.energies.actuator
    stores, changes = "stores of each bond before it broke", "half the squares of the changes in each step"
    fracture, numerical = run.fracture / work, run.numerical / work
    row("energy released by fracture over the work", fracture, sums.fracture / work, 1e-9, stores)
    row("numerical dissipation over the work", numerical, sums.numerical / work, 1e-9, changes)
