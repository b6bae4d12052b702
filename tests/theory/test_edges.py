"""The core at the edges of its range: what has no answer is refused or told, and the rest is right up to there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from asphalt_nscd.bending.condensing import Bonds
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.specimen.granular_bed import LARGEST_RATIO, PouringNumerics
from asphalt_nscd.specimen.preparation import unrest
from theory.grains import R, balls
from theory.specimens import chain


def refused(ask: Callable[[], Any]) -> float:
    """One where a call ends in its sentence, zero where it has an answer."""
    try:
        ask()
    except (InputError, ValueError):
        return 1.0
    return 0.0


def test_bonds(row):
    system, source = chain(3, 2e-3, 0.1), "a bond bears some force; bonded bodies do not overlap"
    strength, gap = np.where(np.arange(3) == 1, 0.0, 1.0), np.where(np.arange(3) == 1, -1e-9, 1.0)
    weak, overlapping = lambda: replace(system, strength=strength), lambda: replace(system, gap=gap)
    row("a bond of zero strength, refused", 1.0, refused(weak), 0.0, source)
    row("a bond of negative gap, refused", 1.0, refused(overlapping), 0.0, source)
    row("a yield stress of zero, refused", 1.0, refused(lambda: Bonds(yield_Pa=0.0)), 0.0, source)


def test_spheres_in_one_place(row):
    """They part, and no faster than overlaps are undone."""
    pair = balls([[0.5, 0.5, 0.5]] * 2, [R, 2 * R], gravity=(0, 0, 0))
    numerics = PouringNumerics.of(pair.radius, 4e-4)
    while pair.time < 3.5 * R / numerics.recovery_speed:
        pair.advance(numerics)
    apart = float(np.linalg.norm(pair.position[1] - pair.position[0])) / (3 * R)
    row("spheres in one place, distance over the sum of radii", 1.1, apart, 0.1, "parted, at 0.02 m/s")


def test_passing_grains(row):
    """Two grains pass 2.2 radii apart. A contact is looked for along the normal at the start of the step."""
    pair = balls([[0.5, 0.5, 0.5], [0.5 + 2.2 * R, 0.5, 0.5 + 5 * R]], friction=0.0, gravity=(0, 0, 0))
    pair.velocity[1, 2] = -5.0
    numerics = PouringNumerics.of(pair.radius, 4e-5)
    while pair.time < 4e-3:
        pair.advance(numerics)
    name = "grains that pass at 5 m/s, exchange in steps of 0.04 ms (m/s)"
    source = "nothing touches; in steps of 0.4 ms a tangent plane does"
    row(name, 0.0, abs(pair.velocity[1, 2] + 5.0), 1e-12, source)


def test_heavy_on_light(row):
    """A sphere on three small ones, of the largest mass ratio that is taken, and of a larger one."""
    ratio = LARGEST_RATIO
    # a tenth of a radius apart from each other: nothing but floor and heavy sphere holds them
    distance = 1.05 * 2 * R / np.sqrt(3.0)
    angle = np.arange(3) * 2 * np.pi / 3
    low = np.column_stack([0.5 + distance * np.cos(angle), 0.5 + distance * np.sin(angle), np.full(3, R)])
    height = R + np.sqrt(((ratio + 1) * R) ** 2 - distance**2)
    pile = balls(np.vstack([low, [0.5, 0.5, height]]), [R, R, R, ratio * R])
    numerics = PouringNumerics.of(pile.radius, 4e-4)
    while pile.time < 0.2:
        pile.advance(numerics)
    deep = -float(pile.contacts(1e-6)[1].min(initial=0.0)) / R
    beyond = refused(lambda: PouringNumerics.of(np.array([R, 1.01 * ratio * R]), 4e-4))
    row("1000 times as heavy on three, overlap at rest over the radius", 0.0, deep, 0.01, "Signorini")
    row("a larger mass ratio, refused", 1.0, beyond, 0.0, "sweeps do not converge")


def test_layer_out_of_balance(row):
    said = {"weight_balance": 0.74, "unbalanced_force": 0.0}
    still = {"weight_balance": 1e-4, "unbalanced_force": 4e-4}
    told = [float(bool(unrest(one))) for one in (said, still)]
    row("a layer whose walls bear 0.26 of its weight, told", 1.0, told[0], 0.0, "equilibrium")
    row("a layer at rest, told", 0.0, told[1], 0.0, "equilibrium")
