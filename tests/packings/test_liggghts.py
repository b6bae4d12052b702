"""Spheres poured by LIGGGHTS go in, are bonded and bent: |E*| of the beam beside that of spheres poured here."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import asphalt_nscd as an
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.preparation import DENSITY

ROOT = Path(__file__).parents[2]
BOX = (0.1, 0.02, 0.12)  # m
SHAPE = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
STEP, STEPS = 1e-5, 50_000  # s, half a second


def poured_by_liggghts(folder: Path) -> Path:
    """The last snapshot of a pile; input as in benchmarks/."""
    position, radius = random_lattice(
        np.array([5e-3, 6e-3]), np.array([100, 200]), BOX, np.random.default_rng(0)
    )
    atoms = np.column_stack([2.0 * radius, np.full(radius.size, DENSITY), position])
    sizes = "".join(f"0 {size} {axis}lo {axis}hi\n" for axis, size in zip("xyz", BOX))
    rows = "".join(f"{n} 1 " + " ".join(f"{x:.17g}" for x in row) + "\n" for n, row in enumerate(atoms, 1))
    (folder / "spheres.data").write_text(
        f"spheres\n\n{len(atoms)} atoms\n1 atom types\n\n{sizes}\nAtoms\n\n{rows}"
    )
    script = (ROOT / "benchmarks/pour.liggghts").read_text().format(
        x=BOX[0], y=BOX[1], z=BOX[2], friction=0.2, step=STEP, steps=STEPS
    )  # fmt: skip
    dump = f"dump pile all custom {STEPS // 2} pile.liggghts id type x y z radius\n"
    (folder / "in.pour").write_text(script.replace("run ", dump + "run "))
    subprocess.run(["liggghts", "-in", "in.pour"], cwd=folder, check=True, capture_output=True)
    return folder / "pile.liggghts"


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("liggghts") is None, reason="LIGGGHTS is not installed; Debian has it")
def test_a_pile_of_liggghts_is_bonded_and_bent(tmp_path):
    theirs = an.read_packing(poured_by_liggghts(tmp_path))
    ours = an.pour({5.0: 100, 6.0: 200}, BOX, vibration=an.Vibration(duration=0.0))
    assert "the last of 3 snapshots" in theirs.notes[0] and theirs.radius_m.size == 300
    assert np.allclose(theirs.box_m[:2], BOX[:2], atol=3e-4)  # from wall to wall, which soft spheres dent
    law = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    ratio = {}
    for name, packing in (("LIGGGHTS", theirs), ("ours", ours)):
        # Soft spheres stand out of rigid walls by their overlap.
        room = {"h_mm": 1e3 * packing.box_m[0], "e_mm": 1e3 * packing.box_m[1]}
        test = an.bend(an.specimen(packing, SHAPE | room, area="facets"), law, 10.0, 15.0)
        ratio[name] = test.E_MPa / test.attributes["E_law_MPa"]
        print(name, packing, test, ratio[name])
        assert test.phase_deg == pytest.approx(test.attributes["phase_law_deg"], abs=0.3)
    assert ratio["LIGGGHTS"] == pytest.approx(ratio["ours"], rel=0.05)
    assert ratio["ours"] == pytest.approx(1.0, abs=0.1)
