"""How time and memory grow with the number of spheres: preparation, condensed and reduced.

    python benchmarks/growth.py SPHERES LAW COUNTS --output ROWS.csv

The paper's grading, box and specimen, all lengths of box and specimen scaled alike.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
from rows import Clock, write_rows

from asphalt_nscd.bending import bond_law, condense, read_model, run_test
from asphalt_nscd.counts import read_counts
from asphalt_nscd.nscd.condensed import CondensedState, CondensedStepper
from asphalt_nscd.preparation import deposit, trim_deposit
from asphalt_nscd.rheology.laws_io import read_bond_law

BOX = (0.25, 0.025, 1.6)
GEOMETRY = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250}
MASS = {"mass_kg": 0.6, "mobile_mass_kg": 0.235}
MEASURED = 5  # steps of the full system


def measure(spheres: int, law_file: Path, counts_table: Path, folder: Path) -> list[dict[str, object]]:
    """Rows of all stages; the memory of each is the peak up to its end."""
    diameters, counts = read_counts(counts_table)
    share = spheres / counts.sum()
    scale = share ** (1.0 / 3.0)
    scaled = pd.DataFrame({"diameter_mm": 1e3 * diameters, "count": np.rint(counts * share).astype(int)})
    scaled.to_csv(folder / "counts.csv", index=False)
    box = tuple(scale * side for side in BOX)
    geometry = {key: scale * value for key, value in GEOMETRY.items()}
    geometry |= {key: share * value for key, value in MASS.items()}
    rows = []

    def stage(case: str, clock: Clock, remark: str = "", per: int = 1) -> None:
        row = clock.row()
        row["cpu_s"] /= per
        rows.append({"topic": "growth", "case": case, "spheres": spheres, "remark": remark} | row)

    clock = Clock()
    deposit(folder / "counts.csv", box, 1, 0.2, 6e-3, 30.0, 1.0, 4e-4, folder / "deposit.h5")
    trim_deposit(folder / "deposit.h5", geometry, 0.1, 2e-3, folder / "specimen.h5")
    stage("preparation: deposit and trim", clock)
    clock = Clock()
    condense(folder / "specimen.h5", "free", 0.35, 2.7e6, 0.7, folder / "model.h5")
    model, law = read_model(folder / "model.h5"), bond_law(read_bond_law(law_file))
    bonds = f"{model.system.gap.size} bonds"
    stage("preparation: condense", clock, bonds)
    run_test(model, law, 10.0, 1e-6, 1.0, 1e-3, 0)  # loads the kernels
    clock = Clock()
    run_test(model, law, 10.0, 63e-6, 1.0, 5e-5, 0)
    stage("reduced, a cycle", clock, bonds)
    clock = Clock()
    stepper = CondensedStepper(model.system, law, 5e-5, CondensedState.at_rest(model.system, law))
    stage("condensed, factors", clock, bonds)
    clock = Clock()
    for _ in range(MEASURED):
        stepper.advance(4e-3)
    stage("condensed, a step", clock, bonds, MEASURED)
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spheres", type=int)
    parser.add_argument("law", type=Path)
    parser.add_argument("counts", type=Path)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        write_rows(told.output, measure(told.spheres, told.law, told.counts, Path(folder)))


if __name__ == "__main__":
    main()
