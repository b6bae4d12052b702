"""Equal bits: across two runs, and with one thread allowed and two.

Every step of the command line is one thread, whatever is allowed: BLAS on two sums in another order.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys

import numpy as np

from asphalt_nscd.verification.row import Checks, Row

checks = Checks()

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def digest() -> str:
    """Of the states of a pile in motion, of a condensed run with breaking bonds and of a reduced one."""
    from asphalt_nscd.nscd.scheme import VARIABLES
    from asphalt_nscd.specimen.deposit import PouringNumerics
    from asphalt_nscd.specimen.lattice import random_lattice
    from asphalt_nscd.verification.methods import QUICK_LAW, beam, march
    from asphalt_nscd.verification.spheres import advanced, balls

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
    return sums.hexdigest()


def digest_elsewhere(threads: int) -> str:
    """The same in a process of its own, as steps of the command line run, with so many threads allowed."""
    script = (
        "import asphalt_nscd.cli; from asphalt_nscd.verification.determinism import digest; print(digest())"
    )
    environment = os.environ | {name: str(threads) for name in THREADS}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


@checks
def bits() -> list[Row]:
    one, again, two = (digest_elsewhere(threads) for threads in (1, 1, 2))
    source = "SHA-256 of all states"
    return [
        Row("two runs, results that differ", 0.0, float(one != again), 0.0, source),
        Row("one thread allowed and two, results that differ", 0.0, float(one != two), 0.0, source),
    ]
