"""Small specimens shared by the tests."""

from __future__ import annotations

import os
from collections.abc import Callable

import pytest

# Before numpy is loaded. Tests run side by side: more threads of BLAS only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from theory.specimens import QUICK_LAW, jittered_beam

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen


@pytest.fixture(scope="session")
def make_beam() -> Callable[..., Specimen]:
    return jittered_beam


@pytest.fixture(scope="session")
def quick_law() -> BondLaw:
    return QUICK_LAW


@pytest.fixture(scope="session")
def beam() -> Specimen:
    return jittered_beam()


@pytest.fixture(scope="session")
def beam_system(beam: Specimen) -> BondedSystem:
    return bending_system(beam, poisson=0.35, yield_stress=2.7e6, friction=0.7)
