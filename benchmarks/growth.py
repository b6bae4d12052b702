"""How time and memory grow with the number of spheres: preparation, reduced and condensed.

    python benchmarks/growth.py prepare SPHERES COUNTS --specimen FILE --output ROWS.csv
    python benchmarks/growth.py test SPHERES SPECIMEN LAW --output ROWS.csv

The paper's grading, box and specimen, all lengths but those of spheres scaled alike. Each stage of the
test is a process of its own, so that its peak memory is its own. One that would need more than
MOST_MEMORY says so in its row.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pandas as pd
from rows import Clock, write_rows

from asphalt_nscd.bending.bending_test import bond_law, run_test
from asphalt_nscd.bending.case import LoadCase
from asphalt_nscd.bending.condensing import condense
from asphalt_nscd.bending.model import read_model
from asphalt_nscd.bending.settings import Bonds, Numerics
from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.measurements.twopoint import complex_modulus
from asphalt_nscd.nscd.bonds.implicit_operator import LARGEST_FACTORED
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.rheology.laws_io import read_bond_law
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.cutting import trim_deposit
from asphalt_nscd.specimen.preparation import deposit
from asphalt_nscd.specimen.settings import Cutting, Pouring, Vibration

BOX = (0.25, 0.025, 0.64)  # m; the paper's 1.6 m high lattice is mostly empty, and its fall long
GEOMETRY = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250}
MASS = {"mass_kg": 0.6, "mobile_mass_kg": 0.235}
VIBRATION, WHOLE_VIBRATION = 0.1, 1.0  # s, made here and in the paper
FREQUENCY, TIME_STEP = 10.0, 5e-5
SLOPE = 26e-6 / 0.25  # amplitude over height, by which hardly a bond breaks at any size
MEASURED = 5  # steps of the full system
MOST_MEMORY = 16 * 2**30  # bytes

CONDENSE, REDUCED, CONDENSED = "condense", "reduced, a cycle", "condensed, a step"

Row = dict[str, object]


def prepare(spheres: int, counts_table: str, specimen: str) -> list[Row]:
    """Pour, vibrate for a part of the paper's second, trim and bond."""
    diameters, counts = read_counts(counts_table)
    share = spheres / counts.sum()
    scale = share ** (1.0 / 3.0)
    box = tuple(scale * side for side in BOX)
    geometry = {key: scale * value for key, value in GEOMETRY.items()}
    geometry |= {key: share * value for key, value in MASS.items()}
    left = {}  # CPU time when a stage of the deposit was last seen

    def progress(stage: str, done: float, total: float) -> None:
        left[stage] = time.process_time() - clock.began
        print(f"{left[stage]:.0f} s: {stage} {done:.3g} of {total:.3g}", flush=True)

    with tempfile.TemporaryDirectory(dir=Path(specimen).parent) as name:
        folder = Path(name)
        scaled = pd.DataFrame({"diameter_mm": 1e3 * diameters, "count": np.rint(counts * share).astype(int)})
        scaled.to_csv(folder / "counts.csv", index=False)
        clock = Clock()
        pouring = Pouring(box, seed=1, vibration=Vibration(duration=VIBRATION))
        deposit(folder / "counts.csv", pouring, folder / "deposit.h5", progress)
        deposited, clock = clock.row(), Clock()
        trim_deposit(folder / "deposit.h5", geometry, Cutting(), specimen)
    vibrating = left["vibrating"] - left["settling"]
    scaled_up = vibrating * WHOLE_VIBRATION / VIBRATION
    memory = {"memory_MB": deposited["memory_MB"]}
    return [
        {"case": "pour and settle", "cpu_s": deposited["cpu_s"] - vibrating} | memory,
        {"case": "vibrate", "cpu_s": scaled_up, "remark": f"scaled from {VIBRATION} s to {WHOLE_VIBRATION} s"}
        | memory,
        {"case": "trim and bond"} | clock.row(),
    ]


def reduce(specimen: str, model: str) -> list[Row]:
    """The static solution and the vectors of the reduced form."""
    clock = Clock()
    condense(specimen, Bonds(), model)
    return [{"case": CONDENSE} | clock.row()]


def reduced_cycle(model_file: str, law_file: str) -> list[Row]:
    """A cycle of the reduced system; kernels are loaded by a short one."""
    model, law = read_model(model_file), read_bond_law(law_file)
    bonds = bond_law(law)
    amplitude = SLOPE * model.geometry.h
    run_test(model, bonds, LoadCase(FREQUENCY, 0.01 * amplitude, 1.0), Numerics(1e-3, 0))
    clock = Clock()
    record = run_test(model, bonds, LoadCase(FREQUENCY, amplitude, 1.0), Numerics(TIME_STEP, 0))
    row = clock.row()
    response = harmonic_response(record.time, record.force, record.displacement, FREQUENCY, cycles=1)
    modulus = complex_modulus(
        model.geometry, FREQUENCY, response.force_amplitude, response.displacement_amplitude, response.phase
    )
    ratio = modulus / law.complex_modulus(2.0 * np.pi * FREQUENCY)
    remark = (
        f"{model.sphere_height.size} spheres and {model.system.gap.size} bonds in the specimen, "
        f"{len(record.broken)} broken, E over law {abs(ratio):.3f}, "
        f"phase over law {np.degrees(np.angle(ratio)):+.2f} deg, residual {record.residual:.0e}"
    )
    return [{"case": REDUCED, "remark": remark} | row]


def condensed_steps(model_file: str, law_file: str) -> list[Row]:
    """Steps of the full system, and what comes before the first."""
    model, law = read_model(model_file), bond_law(read_bond_law(law_file))
    clock = Clock()
    stepper = CondensedStepper(model.system, law, TIME_STEP, CondensedState.rest_state(model.system, law))
    factors, clock = clock.row(), Clock()
    for _ in range(MEASURED):
        stepper.advance(2.0 * np.pi * FREQUENCY * SLOPE * model.geometry.h)
    steps = clock.row()
    steps["cpu_s"] /= MEASURED
    solver = "multigrid" if model.system.free.size > LARGEST_FACTORED else "factors"
    return [
        {"case": "condensed, factors", "remark": solver} | factors,
        {"case": CONDENSED, "remark": solver} | steps,
    ]


def limit_memory() -> None:
    """An allocation beyond it raises MemoryError."""
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))


def alone(case: str, stage: Callable[..., list[Row]], *arguments: object) -> list[Row]:
    """The rows of a stage run by a process of its own; one that says why where it cannot be done."""
    with ProcessPoolExecutor(1, get_context("spawn"), limit_memory) as pool:
        try:
            return pool.submit(stage, *arguments).result()
        except (MemoryError, ArithmeticError, BrokenProcessPool) as error:
            told = f"not done within {MOST_MEMORY / 2**30:g} GiB: {type(error).__name__} {error}"
            return [{"case": case, "remark": told.strip()}]


def test(specimen: str, law: str) -> list[Row]:
    """All stages from the specimen on."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder, "model.h5")
        rows = alone(CONDENSE, reduce, specimen, model)
        for case, stage in ((REDUCED, reduced_cycle), (CONDENSED, condensed_steps)):
            if model.exists():
                rows += alone(case, stage, model, law)
            else:
                rows.append({"case": case, "remark": f"not done: needs {CONDENSE}"})
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parts = parser.add_subparsers(dest="part", required=True)
    for name, files in (("prepare", ["counts"]), ("test", ["specimen", "law"])):
        part = parts.add_parser(name)
        part.add_argument("spheres", type=int)
        for file in files:
            part.add_argument(file)
        part.add_argument("--output", type=Path, required=True)
    parts.choices["prepare"].add_argument("--specimen", required=True)
    told = parser.parse_args()
    if told.part == "prepare":
        rows = prepare(told.spheres, told.counts, told.specimen)
    else:
        rows = test(told.specimen, told.law)
    write_rows(told.output, [{"topic": "growth", "spheres": told.spheres} | row for row in rows])


if __name__ == "__main__":
    main()
