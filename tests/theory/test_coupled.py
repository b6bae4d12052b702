"""Coupled contacts: walls, stacks, arches, spheres in a box, FCLIB's files; and what is no solution."""

from __future__ import annotations

import os
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from naive.friction import naive_natural_map

from asphalt_nscd.contact_problems.fclib import read_problem
from asphalt_nscd.nscd import solve_contacts
from asphalt_nscd.nscd.bonds.system import opening_operator
from asphalt_nscd.nscd.contacts.interior import interior_path
from asphalt_nscd.nscd.contacts.newton import refine
from asphalt_nscd.nscd.contacts.problem import ContactProblem
from asphalt_nscd.nscd.contacts.proximal import softened
from theory import assemblies
from theory.test_contacts import UPRIGHT, G

TOLERANCE = 1e-8
APART = "de Saxce's form, computed apart"


def wall(rows: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    """W (3 c, 3 c) [1/kg] and q (3 c,) [m/s] of a brick wall on the ground, under its weight in a step of 1 ms.

    In running bond, each brick rests on two lower ones by four corners each: highly hyperstatic, W far from full rank.
    The normal comes first in each contact. `rows` are courses, `across` the bricks in one.
    """
    length, depth, height, mass, dt = 0.2, 0.1, 0.06, 2.0, 1e-3
    centres = np.array(
        [[(k + 0.5 * (r % 2)) * length, 0.0, (r + 0.5) * height] for r in range(rows) for k in range(across)]
    )
    bodies = len(centres)
    first, second, point = [], [], []
    for n, centre in enumerate(centres):
        for m in [bodies] if n < across else range(bodies):
            if m < bodies:
                lower = centres[m]
                left, right = (
                    np.maximum(centre[0], lower[0]) - length / 2,
                    np.minimum(centre[0], lower[0]) + length / 2,
                )
                if abs(centre[2] - lower[2] - height) > 1e-9 or right - left < 1e-9:
                    continue
            else:
                left, right = centre[0] - length / 2, centre[0] + length / 2
            for x in (left, right):
                for y in (-depth / 2, depth / 2):
                    first.append(m)
                    second.append(n)
                    point.append([x, y, centre[2] - height / 2])
    contacts = len(first)
    operator = opening_operator(
        np.array(first), np.array(second), np.tile(UPRIGHT, (contacts, 1, 1)), np.array(point), centres
    )
    inertia = mass / 12 * np.array([depth**2 + height**2, length**2 + height**2, length**2 + depth**2])
    inverse = np.tile(np.concatenate([np.full(3, 1 / mass), 1 / inertia]), bodies)
    fall = np.zeros(6 * bodies)
    fall[2::6] = -G * dt
    dense = operator.toarray()
    return (dense * inverse) @ dense.T, dense @ fall


def natural_map(w: np.ndarray, q: np.ndarray, mu: float, r: np.ndarray) -> float:
    """Error of reactions `r` [N s] in units of energy, written out from the definition. Zero of a solution alone."""
    return naive_natural_map(w, q, mu, r)[1]


def test_stacks(row):
    for name, shape, across in (("a wall of four rows of bricks", 4, 4), ("a tower of ten bricks", 10, 1)):
        w, q = wall(shape, across)
        solution = solve_contacts(w, q, 0.6, tolerance=1e-8)
        error = natural_map(w, q, 0.6, solution.reactions)
        row(f"{name}, error of the natural map", 0.0, error, TOLERANCE, APART)
        # the lowest bricks come first, with four contacts each
        ground = solution.reactions[::3][: 4 * across].sum() / (shape * across * 2.0 * G * 1e-3)
        row(f"{name}, force on the ground over its weight", 1.0, ground, 1e-6, "equilibrium")


def twenty(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """W (60, 60) [1/kg], far from singular, and q (60,) [m/s] of twenty coupled contacts, most of which close."""
    rng = np.random.default_rng(seed)
    jacobian = rng.normal(size=(60, 66))
    q = rng.normal(size=60)
    q[::3] -= 0.5
    # far from singular: each method must solve it alone
    return jacobian @ jacobian.T / 66 + 0.2 * np.eye(60), q


def test_generated(row):
    """The worst of ten problems."""
    worst = 0.0
    for seed in range(10):
        w, q = twenty(seed)
        worst = max(worst, natural_map(w, q, 0.7, solve_contacts(w, q, 0.7, tolerance=1e-10).reactions))
    row("twenty coupled contacts, error of the natural map", 0.0, worst, 1e-9, APART)


def test_each_alone(row):
    """Each method by itself, for another would finish what a wrong one leaves."""
    (w, q), mu = twenty(0), 0.7
    problem = ContactProblem.of(w, q, mu)
    solved, _ = problem.sweeps(1e-15, 3000, np.zeros(60))
    # near enough for the statuses to be right, all that Newton's method is asked for
    near = solved * (1.0 + 1e-3 * np.random.default_rng(1).normal(size=60))
    path = list(islice(interior_path(problem, 3.0, 0.0), 10))
    soft = softened(problem, 0.3, solved)
    found = {
        "twenty sweeps": (natural_map(w, q, mu, problem.sweeps(1e-15, 20, np.zeros(60))[0]), 1e-10),
        "three Newton steps from a thousandth beside": (
            natural_map(w, q, mu, refine(problem, near, 1e-15, 3)[0]),
            1e-12,
        ),
        "ten steps of the interior path": (natural_map(w, q, mu, path[-1]), 1e-6),
        "the solution in the softened problem of its proximal point": (
            natural_map(soft.matrix.toarray(), soft.free_velocity, mu, solved),
            1e-12,
        ),
    }
    for name, (error, tolerance) in found.items():
        row(f"{name}, error of the natural map", 0.0, error, tolerance, APART)


def test_hyperstatic(row):
    """More contacts than the bodies need: plain Gauss-Seidel stalls on all of these."""
    for name, pile, mu in (
        ("twenty boxes with nine contacts at each face", assemblies.box_stack(20, kick=1e-2), 0.5),
        ("twenty slender boxes", assemblies.box_stack(20, 2, size=(0.3, 0.3, 2.0)), 0.3),
        ("an arch of 41 stones", assemblies.arch(41), 0.4),
        ("252 spheres in a box", assemblies.spheres_in_a_box(7, 6, 6), 0.3),
        ("252 spheres in a box, rough", assemblies.spheres_in_a_box(7, 6, 6), 0.5),
    ):
        solution = solve_contacts(pile.W, pile.q, mu, tolerance=TOLERANCE)
        error = natural_map(pile.W.toarray(), pile.q, mu, solution.reactions)
        row(f"{name}, error of the natural map", 0.0, error, TOLERANCE, APART)


def test_unsolved(row):
    """What is no solution must not be called one."""
    pile = assemblies.box_stack(8, kick=1e-2)
    stopped = solve_contacts(pile.W, pile.q, 0.5, TOLERANCE, most_sweeps=3, most_steps=0)
    immovable = solve_contacts(np.zeros((3, 3)), [-1.0, 0.0, 0.0], 0.5, TOLERANCE)
    row("stopped after three sweeps, called converged", 0.0, float(stopped.converged), 0.0, APART)
    row("a problem without solution, called converged", 0.0, float(immovable.converged), 0.0, "u_n < 0")


@pytest.mark.skipif("ASPHALT_NSCD_FCLIB" not in os.environ, reason="needs a folder of FCLIB")
def test_files(row):
    """FCLIB problems, which are not part of the repository: those in the folder $ASPHALT_NSCD_FCLIB."""
    for file in sorted(Path(os.environ["ASPHALT_NSCD_FCLIB"]).glob("*.hdf5")):
        problem = read_problem(file)
        solution = solve_contacts(problem.W, problem.q, problem.mu, TOLERANCE)
        error = max(solution.error, solution.scaled_error)
        row(f"FCLIB {file.stem}, error of the natural map", 0.0, error, TOLERANCE, "as Siconos's")
