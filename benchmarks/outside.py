"""Spheres poured by LIGGGHTS and by this program, bonded and bent alike: |E*| of the beams side by side.

    python benchmarks/outside.py COUNTS.csv --box 0.06,0.01,0.2 --seeds 1,2,3 --output OUTSIDE.csv

The same counts, box and first places of the spheres. Rows of a program that is not installed say so.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

import asphalt_nscd as an
from asphalt_nscd.files.store import write_table
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.preparation import DENSITY

STEP, STEPS, FRICTION = 1e-5, 60_000, 0.2  # s, of soft spheres; 0.6 s in all
TEMPERATURE, FREQUENCY = 15.0, 10.0  # degC, Hz
LAW = {"Em_Pa": 24.3e9, "eta_m_Pa_s": 3.71e9, "Ek_Pa": 48.4e9, "eta_k_Pa_s": 0.773e9}  # Table 3
WIDER = 2.0  # base of the beam over its head
MASSES = {"mass_kg": 0.021, "mobile_mass_kg": 0.008}
Box = tuple[float, float, float]


def poured_by_liggghts(
    diameters: np.ndarray, counts: np.ndarray, box: Box, seed: int, folder: Path
) -> an.Packing:
    """diameters (k,) [m], counts (k,): Hertz contacts of 10 MPa; the last snapshot of a dump."""
    position, radius = random_lattice(diameters, counts, box, np.random.default_rng(seed))
    atoms = np.column_stack([2.0 * radius, np.full(radius.size, DENSITY), position])
    sizes = "".join(f"0 {size} {axis}lo {axis}hi\n" for axis, size in zip("xyz", box, strict=True))
    rows = "".join(f"{n} 1 " + " ".join(f"{x:.17g}" for x in row) + "\n" for n, row in enumerate(atoms, 1))
    (folder / "spheres.data").write_text(
        f"spheres\n\n{len(atoms)} atoms\n1 atom types\n\n{sizes}\nAtoms\n\n{rows}"
    )
    script = (
        Path(__file__)
        .with_name("pour.liggghts")
        .read_text()
        .format(x=box[0], y=box[1], z=box[2], friction=FRICTION, step=STEP, steps=STEPS)
    )
    dump = f"dump pile all custom {STEPS // 2} pile.liggghts id type x y z radius\n"
    (folder / "in.pour").write_text(script.replace("run ", dump + "run "))
    subprocess.run(["liggghts", "-in", "in.pour"], cwd=folder, check=True, capture_output=True)
    return an.read_packing(folder / "pile.liggghts")


def row(packing: an.Packing, area: str) -> dict[str, object]:
    """A beam as long and as thick as the packing, bent at one frequency."""
    length, width = (1e3 * packing.box_m[:2]).tolist()
    shape = {"b_mm": length / 6.0, "B_mm": WIDER * length / 6.0, "e_mm": width, "h_mm": length, **MASSES}
    law = an.Law.burgers(**LAW, temperature_C=TEMPERATURE)
    beam = an.specimen(packing, shape, area=area)
    test = an.bend(beam, law, FREQUENCY, TEMPERATURE)
    own = test.attributes
    return {
        "bonds": area,
        "solid_fraction": packing.attributes["solid_fraction"],
        "coordination": packing.attributes["coordination"],
        "spheres_in_beam": beam.radius_m.size,
        "E_GPa": test.E_MPa / 1e3,
        "E_over_law": test.E_MPa / own["E_law_MPa"],
        "phase_deg": test.phase_deg,
        "phase_law_deg": own["phase_law_deg"],
        "remark": "",
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("counts")
    parser.add_argument("--box", required=True, help="length, width, height [m]")
    parser.add_argument("--seeds", required=True)
    parser.add_argument("--output", required=True)
    told = parser.parse_args()
    diameters, counts = read_counts(told.counts)
    length, width, height = (float(size) for size in told.box.split(","))
    box = length, width, height
    rows: list[dict[str, object]] = []
    for seed in (int(one) for one in told.seeds.split(",")):
        pours = {
            "this program": lambda _, seed=seed: an.pour(
                told.counts, box, seed=seed, vibration=an.Vibration(duration=0.0)
            )
        }
        if shutil.which("liggghts"):
            pours["LIGGGHTS"] = lambda folder, seed=seed: poured_by_liggghts(
                diameters, counts, box, seed, folder
            )
        else:
            rows.append({"poured_by": "LIGGGHTS", "seed": seed, "remark": "absent: no program liggghts"})
        for name, pour in pours.items():
            with tempfile.TemporaryDirectory() as folder:
                packing = pour(Path(folder))
            rows += [{"poured_by": name, "seed": seed, **row(packing, area)} for area in ("facets", "paper")]
    table = pd.DataFrame(rows).sort_values(["bonds", "poured_by", "seed"]) if rows else pd.DataFrame()
    write_table(told.output, table)


if __name__ == "__main__":
    main()
