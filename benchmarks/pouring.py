"""The paper's 14 160 spheres poured and settled: the same lattice and physical time for every code.

python benchmarks/pouring.py nscd|liggghts|yade COUNTS --output ROW.csv
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
from rows import Clock, absent, run, write_rows

from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.preparation import DENSITY

TOPIC = "pouring"
BOX = (0.25, 0.025, 1.6)  # m
DURATION = 1.1  # s, by which the layer has come to rest
FALL = 0.55  # s of it that grains fall
FRICTION = 0.2
SOFT_STEP = {"liggghts": 1e-5, "yade": 8e-6}  # s, at a modulus of 1e7 Pa
HERE = Path(__file__).parent


def pour(position: np.ndarray, radius: np.ndarray) -> tuple[dict[str, object], np.ndarray]:
    """(row, positions at rest) by NSCD."""
    clock, numerics = Clock(), PouringNumerics.of(radius, 4e-4)
    bed = GranularBed.spheres_in_box(position, radius, BOX, DENSITY, ContactLaw(FRICTION, FRICTION))
    bed.let_fall()
    while bed.time < DURATION:
        bed.advance(numerics)
    speed = np.sqrt((bed.velocity[: radius.size, :3] ** 2).sum(axis=1).mean())
    gap = bed.contacts(1e-6)[1]
    remark = (
        f"rms speed {speed:.1e} m/s, overlap {max(0.0, -gap.min()) / radius.min():.2%} of the smallest radius"
    )
    return {"time_step_s": numerics.time_step, **clock.row(), "remark": remark}, bed.position


def liggghts(position: np.ndarray, radius: np.ndarray, folder: Path) -> dict[str, object]:
    """Hertz-Mindlin, the whole physical time."""
    spheres = np.column_stack([2.0 * radius, np.full(radius.size, DENSITY), position])
    sizes = "".join(f"0 {size} {axis}lo {axis}hi\n" for axis, size in zip("xyz", BOX, strict=True))
    atoms = "".join(f"{n} 1 " + " ".join(f"{x:.17g}" for x in row) + "\n" for n, row in enumerate(spheres, 1))
    (folder / "spheres.data").write_text(
        f"spheres\n\n{radius.size} atoms\n1 atom types\n\n{sizes}\nAtoms\n\n{atoms}"
    )
    script = (HERE / "pour.liggghts").read_text().format(
        x=BOX[0], y=BOX[1], z=BOX[2], friction=FRICTION, step=SOFT_STEP["liggghts"],
        steps=round(DURATION / SOFT_STEP["liggghts"]),
    )  # fmt: skip
    (folder / "in.pour").write_text(script)
    cpu, memory, _ = run(["liggghts", "-in", "in.pour"], folder)
    last = [line.split() for line in (folder / "log.liggghts").read_text().splitlines() if line.strip()]
    energy = next(float(words[2]) for words in reversed(last) if len(words) == 4 and words[0].isdigit())
    mass = DENSITY * 4.0 / 3.0 * np.pi * (radius**3).sum()
    remark = f"Hertz, E = 1e7 Pa; rms speed {np.sqrt(2.0 * energy / mass):.1e} m/s"
    return {"cpu_s": cpu, "memory_MB": memory, "remark": remark}


def yade(position: np.ndarray, rest: np.ndarray, radius: np.ndarray, folder: Path) -> dict[str, object]:
    """Cohesionless spheres: some steps of the fall and some at rest, scaled to the physical time."""
    np.savez(folder / "spheres.npz", start=position, rest=rest, radius=radius, box=BOX)
    _, memory, said = run(["yade", "-n", "-x", "-j1", str(HERE / "yade_pour.py")], folder)
    falling, resting = (float(line.split()[1]) for line in said.splitlines() if line.startswith("per-step"))
    cpu = (falling * FALL + resting * (DURATION - FALL)) / SOFT_STEP["yade"]
    remark = f"E = 1e7 Pa; scaled from {1e3 * falling:.1f} ms a step at the start and {1e3 * resting:.1f} ms at rest"
    return {"cpu_s": cpu, "memory_MB": memory, "remark": remark}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("code", choices=["nscd", *SOFT_STEP])
    parser.add_argument("counts", type=Path)
    parser.add_argument("--rest", type=Path, help="Positions at rest, npy: written by nscd, read by yade.")
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    row = None if told.code == "nscd" else absent(TOPIC, told.code, told.code)
    if row is None:
        position, radius = random_lattice(*read_counts(told.counts), BOX, np.random.default_rng(1))
        if told.code == "nscd":
            row, rest = pour(position, radius)
            np.save(told.rest, rest)
        else:
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                if told.code == "liggghts":
                    row = liggghts(position, radius, folder)
                else:
                    row = yade(position, np.load(told.rest), radius, folder)
            row["time_step_s"] = SOFT_STEP[told.code]
        row |= {"topic": TOPIC, "case": told.code, "spheres": radius.size}
    write_rows(told.output, [row])


if __name__ == "__main__":
    main()
