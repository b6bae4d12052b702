"""Which kernels each of the two compilations of a study calls, and so leaves in the cache."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

# From the cache where they stand there: which are called does not depend on it.
CALLED = """
import json, sys
from numba.core.dispatcher import Dispatcher
from asphalt_nscd.cli import group
from asphalt_nscd.nscd import native
group.main(["compile", sys.argv[1]], standalone_mode=False)
kernels = {}
for name, module in sys.modules.items():
    if name.startswith("asphalt_nscd.nscd."):
        for one in vars(module).values():
            if isinstance(one, Dispatcher) and one.py_func.__module__ == name and one.signatures:
                kernels[f"{name[18:]}.{one.__name__}"] = len(one.signatures)
print(json.dumps([kernels, len(native._loaded)]))
"""


def called(step):
    """Kernels that a compilation calls, `folder.module.function`, with the number of types of each; native ones."""
    command = [sys.executable, "-c", CALLED, step]
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=600)
    return json.loads(done.stdout)


def test_a_step_compiles_its_own_kernels_and_those_of_no_other():
    bending, native = called("simulate")
    assert {name.partition(".")[0] for name in bending} == {"bonds", "stepping"}
    assert bending["bonds.system._opening_rows"] == 1  # for the bonds of the paper and for facets
    assert native == 1
    pouring, _ = called("deposit")
    assert "spheres.granular.step" in pouring and "spheres.neighbours._partners" in pouring
    assert not set(pouring) & set(bending)
