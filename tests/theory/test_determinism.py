"""Equal bits: across two runs, and with one thread allowed and two.

Every step of the command line is one thread, whatever is allowed: BLAS on two sums in another order. Only pouring
takes more where it is told to; see test_spheres.py.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys

import numpy as np
import pytest

from asphalt_nscd.nscd import solve_contacts
from asphalt_nscd.nscd.stepping.scheme import VARIABLES
from asphalt_nscd.specimen.granular_bed import PouringNumerics
from theory.assemblies import box_stack
from theory.grains import advanced, cloud
from theory.marches import beam, followed, march
from theory.specimens import QUICK_LAW

pytestmark = pytest.mark.slow

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def digest() -> str:
    """Of the states of a pile in motion, of a condensed run with breaking bonds, a reduced one, and contacts."""
    pile = advanced(cloud(3, 0.0, 0.5), 300, PouringNumerics(2e-4, 1e-6, 200))
    sums = hashlib.sha256(pile.position.tobytes() + pile.velocity.tobytes())
    for method in ("condensed", "reduced"):
        run = march(beam(), QUICK_LAW, 2.5e-4, method=method)
        sums.update(followed(run, 8e-5 * np.sin(2 * np.pi / 100 * np.arange(100))).tobytes())
        for name in VARIABLES:
            sums.update(run.now.values[name].tobytes())
    stack = box_stack(12, kick=1e-2)
    sums.update(solve_contacts(stack.W, stack.q, 0.5).reactions.tobytes())
    return sums.hexdigest()


def digest_elsewhere(threads: int) -> str:
    """The same in a process of its own, as steps of the command line run, with so many threads allowed."""
    script = "import asphalt_nscd.cli; from theory.test_determinism import digest; print(digest())"
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    environment |= {name: str(threads) for name in THREADS}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_bits(row):
    one, again, two = (digest_elsewhere(threads) for threads in (1, 1, 2))
    source = "SHA-256 of all states"
    row("two runs, results that differ", 0.0, float(one != again), 0.0, source)
    row("one thread allowed and two, results that differ", 0.0, float(one != two), 0.0, source)
