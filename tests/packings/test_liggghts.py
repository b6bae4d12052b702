"""Spheres poured by LIGGGHTS go in, are bonded and bent: |E*| of the beam beside that of spheres poured here."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pandas as pd
import pytest
from forks import forked

ROOT = Path(__file__).parents[2]


def compared(folder: Path) -> pd.DataFrame:
    """The table of benchmarks/outside.py for 480 spheres."""
    (folder / "counts.csv").write_text("diameter_mm,count\n5,180\n6,300\n")
    arguments = ["counts.csv", "--box", "0.1,0.02,0.12", "--seeds", "0", "--output", "table.csv"]
    done = forked("outside:main", arguments, folder, {**os.environ, "PYTHONPATH": str(ROOT / "benchmarks")})
    assert done.returncode == 0, done.stderr
    return pd.read_csv(folder / "table.csv")


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("liggghts") is None, reason="LIGGGHTS is not installed; Debian has it")
def test_a_pile_of_liggghts_is_bonded_and_bent(tmp_path):
    rows = compared(tmp_path).set_index(["poured_by", "bonds"])
    assert len(rows) == 4
    assert (rows["phase_deg"] - rows["phase_law_deg"]).abs().max() < 0.1
    ratio, solid = rows["E_over_law"], rows["solid_fraction"]
    assert ratio["LIGGGHTS", "facets"] == pytest.approx(ratio["this program", "facets"], rel=0.02)
    assert ratio["this program", "facets"] == pytest.approx(1.0, abs=0.05)
    assert solid["LIGGGHTS", "facets"] == pytest.approx(solid["this program", "facets"], rel=0.03)
