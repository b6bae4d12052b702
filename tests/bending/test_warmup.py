"""What each of the two compilations of a study leaves in the cache."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow


def compiled(step, cache):
    """Kernels in the cache after a compilation, `folder/module.function`, and how many types each was compiled for."""
    code = f"from asphalt_nscd.cli import main; main(['compile', {step!r}])"
    subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"ASPHALT_NSCD_CACHE": str(cache)},
        check=True,
        timeout=600,
    )
    types = {}
    for path in cache.glob("core-*/*/*.nbc"):
        name = f"{path.parent.name.partition('_')[0]}/{path.name.partition('-')[0]}"
        types[name] = types.get(name, 0) + 1
    return types


def test_a_step_compiles_its_own_kernels_and_those_of_no_other(tmp_path):
    bending = compiled("simulate", tmp_path / "bending")
    assert {name.partition("/")[0] for name in bending} == {"bonds", "stepping"}
    assert bending["bonds/system._opening_rows"] == 1  # for the bonds of the paper and for facets
    assert len(list(tmp_path.glob("bending/core-*/*.native"))) == 1
    pouring = compiled("deposit", tmp_path / "pouring")
    assert "spheres/granular.step" in pouring and "spheres/neighbours._partners" in pouring
    assert not set(pouring) & set(bending)
