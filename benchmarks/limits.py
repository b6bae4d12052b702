"""What holds each stage back: the same work on one core alone, and on all cores at once, beside copying of memory.

    python benchmarks/limits.py DEPOSIT.h5 MODEL.h5 --cores 2 --output LIMITS.csv

Work that takes longer on busy cores waits for what cores share: the last cache and memory. A unit of work moves so many
bytes to and from arrays that do not fit into a core's own cache; spheres and bodies, which do, are not counted.
Wall time counts here, so the machine has to be quiet.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.synchronize import Barrier
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.bending.model import model_of
from asphalt_nscd.files.store import load, write_table
from asphalt_nscd.nscd.bonds.gauss_seidel import PackedBonds
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.spheres.gauss_seidel import sweep_blocks
from asphalt_nscd.nscd.stepping.reduced_model import shifted_factor
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.preparation import DENSITY

LINE, NUMBER, INDEX = 64, 8, 4  # bytes: of a cache line, of a float64 and of an int32
COPIED = 8_000_000  # numbers: more than a core's own cache holds
SETTLING, SWEEPS = 50, 20  # steps, until the deposit has its impulses; sweeps in one call
FRICTION, TIME_STEP = 0.2, 4e-4  # of the paper's pouring: -, s
COMPLIANCE, STEP = 2e-11, 2e-5  # S [1/Pa] and s, as in the finest test of Fig. 6
LASTS, REPEATS = 4.0, 3  # s, of one measurement; turns of alone and all at once


@dataclass(frozen=True)
class Work:
    """Something done again and again: so many `units` a call, each of which moves so many bytes (None: not known)."""

    call: Callable[[], object]
    units: int
    bytes_of_unit: float | None


def copying(_: Path, __: Path) -> Work:
    source, target = np.ones(COPIED), np.empty(COPIED)
    return Work(lambda: np.copyto(target, source), COPIED, 2.0 * NUMBER)


@compiled
def sweep_all(slabs, workspace, friction, sweeps):
    """Plain sweeps over all contacts of all slabs."""
    for _ in range(sweeps):
        for s in range(slabs.begin.shape[0] - 1):
            count = slabs.begin[s + 1] - slabs.begin[s]
            sweep_blocks(
                slabs.blocks, slabs.begin[s], count, 0, (friction, friction), 1.0, np.inf, np.inf, workspace
            )


def sphere_sweeps(deposit: Path, _: Path) -> Work:
    arrays = load(deposit, "deposit").arrays
    position, radius, box = arrays["position"], arrays["radius"], tuple(arrays["box"])
    bed = GranularBed.in_box(position, radius, box, DENSITY, FRICTION)
    for _ in range(SETTLING):
        bed.advance(PouringNumerics.of(radius, TIME_STEP))
    slabs, workspace = bed._slabs, bed._workspace
    contacts = int((slabs.pair >= 0).sum())
    # a contact is a line, read and written; its block names it and both bodies
    return Work(
        lambda: sweep_all(slabs, workspace, FRICTION, SWEEPS), SWEEPS * contacts, 2.0 * LINE + 3.0 * INDEX
    )


def system_of(model: Path) -> BondedSystem:
    return model_of(load(model, "model")).system


def bond_sweeps(_: Path, model: Path) -> Work:
    system = system_of(model)
    mobility = STEP / system.mass
    mobility[system.driven] = 0.0
    bonds = PackedBonds(system.operator, mobility, COMPLIANCE / system.weight)
    velocity, nothing = np.zeros(system.mass.size), np.zeros(system.weight.size)
    velocity[system.driven] = 0.01  # m/s
    # of a bond 18 numbers are read and 6 written; its block names both bodies
    return Work(
        lambda: bonds.sweep_until_still(nothing, nothing, velocity, 0.0, SWEEPS),
        SWEEPS * bonds.visits.size,
        24.0 * NUMBER + 2.0 * INDEX,
    )


def factorisation(_: Path, model: Path) -> Work:
    system = system_of(model)
    return Work(lambda: shifted_factor(system), 1, None)


def solution(_: Path, model: Path) -> Work:
    system = system_of(model)
    factor, force = shifted_factor(system), np.ones(system.free.size)
    entries = factor.L.nnz + factor.U.nnz
    return Work(lambda: factor.solve(force), 1, entries * float(NUMBER + INDEX))


WORKS = {
    "copy a number": copying,
    "visit a contact of spheres": sphere_sweeps,
    "visit a bond": bond_sweeps,
    "factorise a specimen": factorisation,
    "solve with its factors": solution,
}


def _worker(name: str, files: tuple[Path, Path], barrier: Barrier, answer) -> None:
    """Begins together with all others; sends (s for a unit, bytes of a unit)."""
    work = WORKS[name](*files)
    work.call()  # compiles
    barrier.wait()
    walls, end = [], time.perf_counter() + LASTS
    while not walls or time.perf_counter() < end:
        began = time.perf_counter()
        work.call()
        walls.append(time.perf_counter() - began)
    answer.put((float(np.median(walls)) / work.units, work.bytes_of_unit))


def measured(name: str, files: tuple[Path, Path], cores: int) -> tuple[float, float | None]:
    """Median time of a unit [s] over `cores` processes at once, and bytes of a unit."""
    context = get_context("spawn")
    barrier, answer = context.Barrier(cores), context.Queue()
    processes = [context.Process(target=_worker, args=(name, files, barrier, answer)) for _ in range(cores)]
    for process in processes:
        process.start()
    told = [answer.get() for _ in processes]
    for process in processes:
        process.join()
    return float(np.median([wall for wall, _ in told])), told[0][1]


def compared(name: str, files: tuple[Path, Path], cores: int) -> dict[str, object]:
    """A row of the table; rates are of all cores together."""
    pairs = [(measured(name, files, 1), measured(name, files, cores)) for _ in range(REPEATS)]
    alone, together = (float(np.median([pair[k][0] for pair in pairs])) for k in range(2))
    moved = pairs[0][0][1]
    return {
        "work": name,
        "alone_s": alone,
        "all_cores_s": together,
        "slower": float(np.median([both[0] / one[0] for one, both in pairs])),
        "bytes": moved,
        "alone_GB_s": moved / alone / 1e9 if moved else None,
        "all_cores_GB_s": cores * moved / together / 1e9 if moved else None,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deposit", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    rows = pd.DataFrame([compared(name, (told.deposit, told.model), told.cores) for name in WORKS])
    copied = rows.loc[0, ["alone_GB_s", "all_cores_GB_s"]]
    rows["of_copy_percent"] = 100.0 * rows["all_cores_GB_s"] / copied["all_cores_GB_s"]
    write_table(told.output, rows)


if __name__ == "__main__":
    main()
