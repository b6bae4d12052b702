"""Beams in bending, stepped from rest."""

from __future__ import annotations

from functools import cache

import numpy as np

from asphalt_nscd.nscd.bonds.head import RIGID
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme
from asphalt_nscd.specimen.system import bending_system
from theory.specimens import jittered_beam

FREQUENCY, OMEGA = 40.0, 80 * np.pi


@cache
def beam(*shape: int) -> BondedSystem:
    """Two-point bending of a small `jittered_beam` of `shape` cells, (3, 2, 9) if none is given."""
    return bending_system(jittered_beam(shape=shape or (3, 2, 9)), 0.35, 2.7e6, 0.7)


def march(system, law, dt, name="euler", method="condensed", devices=RIGID, omega=OMEGA) -> March:
    """A run before its first step, by a scheme that knows `omega`; `method` "reduced" takes one law for all bonds."""
    scheme = Scheme.named(name, omega * dt)
    if method == "reduced":
        model = ReducedModel(system, ritz_basis(system, 12))
        stepper = ReducedStepper(model, law, dt / scheme.a, 1e-6, devices=devices)
    else:
        stepper = CondensedStepper(system, law, dt / scheme.a, CondensedState.at_rest(system, law), devices)
    return March(stepper, scheme, law, dt)


def followed(run: March, places: np.ndarray) -> np.ndarray:
    """Force [N] of the head at each of its `places` [m]."""
    return np.array([run.move_to(place) for place in places])


def stiffness(force: np.ndarray, steps: int, amplitude: float) -> complex:
    """Complex stiffness [N/m] of the head in the last cycle of a sine, from its `force` (n,) [N] at each step."""
    angle = 2 * np.pi / steps * np.arange(force.size - steps + 1, force.size + 1)
    return complex(2j * (force[-steps:] * np.exp(-1j * angle)).mean() / amplitude)
