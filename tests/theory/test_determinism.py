"""Equal bits: across two runs, with one thread allowed and two, and from a checkpoint.

Every step of the command line is one thread, whatever is allowed: BLAS on two sums in another order. Only pouring
takes more where it is told to; see spheres.py.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

import numpy as np

from asphalt_nscd.bending.bending_test import run_test
from asphalt_nscd.bending.case import LoadCase, Numerics, RunOptions
from asphalt_nscd.bending.checkpoint import Checkpoint
from asphalt_nscd.bending.model import Model
from asphalt_nscd.nscd.stepping.break_modes import StandBy
from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis, shifted_factor
from asphalt_nscd.specimen.granular_bed import PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from theory.specimens import QUICK_LAW, jittered_beam
from theory.test_methods import beam
from theory.test_spheres import advanced, balls

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def digest() -> str:
    """Of the states of a pile in motion, of a condensed run with breaking bonds, a reduced one, and contacts."""
    from asphalt_nscd.nscd import solve_contacts
    from asphalt_nscd.nscd.stepping.scheme import VARIABLES
    from theory.assemblies import box_stack
    from theory.test_methods import march

    box = (0.017, 0.016, 0.05)
    position, radius = random_lattice(
        np.array([3e-3, 5e-3]), np.array([20, 10]), box, np.random.default_rng(3)
    )
    pile = advanced(balls(position, radius, box=box), 300, PouringNumerics(2e-4, 1e-6, 200))
    sums = hashlib.sha256(pile.position.tobytes() + pile.velocity.tobytes())
    for method in ("condensed", "reduced"):
        run = march(method, "euler", beam(), QUICK_LAW, 100)
        force = [run.move_to(8e-5 * np.sin(2 * np.pi / 100 * n)) for n in range(100)]
        sums.update(np.array(force).tobytes())
        for name in VARIABLES:
            sums.update(run.now.values[name].tobytes())
    stack = box_stack(12, kick=1e-2)
    sums.update(solve_contacts(stack.W, stack.q, 0.5).reactions.tobytes())
    return sums.hexdigest()


def digest_elsewhere(threads: int) -> str:
    """The same in a process of its own, as steps of the command line run, with so many threads allowed."""
    script = "import asphalt_nscd.cli; from theory.test_determinism import digest; print(digest())"
    environment = os.environ | {name: str(threads) for name in THREADS}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_bits(row):
    one, again, two = (digest_elsewhere(threads) for threads in (1, 1, 2))
    source = "SHA-256 of all states"
    row("two runs, results that differ", 0.0, float(one != again), 0.0, source)
    row("one thread allowed and two, results that differ", 0.0, float(one != two), 0.0, source)


class _Stopped(Exception):
    pass


def outcome(method: str, scheme: str, checkpoint: Checkpoint | None = None, stop_after: int = -1) -> bytes:
    """All that a bending test with breaking bonds gives, if it is not stopped; reduced, then full."""
    specimen, system = jittered_beam(shape=(10, 9, 8)), beam(10, 9, 8)
    height = specimen.position[:, 2]
    basis = ritz_basis(system, 12)
    stand_by = StandBy.of(system, basis, shifted_factor(system))
    model = Model(system, basis, specimen.geometry, height, "beam", "free", stand_by)

    def progress(done: int, total: int) -> None:
        if done == stop_after:
            raise _Stopped

    case, numerics = LoadCase(400.0, 2.5e-5, 1.0), Numerics(5e-5, 5, method, scheme)
    record = run_test(model, QUICK_LAW, case, numerics, RunOptions(progress, True, checkpoint))
    assert record.velocity is not None
    broken, account = np.array(record.broken), np.array(list(record.details.values()))
    return b"".join(array.tobytes() for array in (record.force, record.velocity, broken, account))


def test_restart(row):
    for method, scheme in (("condensed", "fitted"), ("reduced", "euler")):
        with tempfile.TemporaryDirectory() as folder:
            checkpoint = Checkpoint(Path(folder, "run.h5"), 4, {})
            # between checkpoints, which are kept every four steps: some steps are made twice
            for stop_after in (11, 30):
                with suppress(_Stopped):
                    outcome(method, scheme, checkpoint, stop_after)
            differs = outcome(method, scheme, checkpoint) != outcome(method, scheme)
        what = f"{method}, {scheme}, stopped twice and continued, results that differ"
        row(what, 0.0, float(differs), 0.0, "the run without a stop")
