"""The measured tables that ship: whole, of the specimens that the volumetrics list, and read without a question."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest
import yaml

import asphalt_nscd as an

ROOT = Path(__file__).parents[2]
VOLUMETRICS = ROOT / "data/ncat/volumetrics.csv"
TABLES = sorted(path for path in VOLUMETRICS.parent.glob("*.csv") if path != VOLUMETRICS)


def test_the_paper_study_takes_all_nine_and_the_smoke_study_one():
    paths = [path.relative_to(ROOT).as_posix() for path in TABLES]
    studies = {
        name: yaml.safe_load((ROOT / f"config/{name}.yaml").read_text()) for name in ("paper", "smoke")
    }
    assert len(paths) == 9 and studies["paper"]["tables_beside"]["tables"] == paths
    assert set(studies["smoke"]["tables_beside"]["tables"]) < set(paths)


@pytest.mark.parametrize("path", TABLES, ids=lambda path: path.stem)
def test_a_table_is_read_as_it_stands(path):
    raw, read = pd.read_csv(path), an.read(path, measured_in="tension-compression")
    listed = pd.read_csv(VOLUMETRICS)
    mix = listed[listed["mix"] == path.stem.replace("_", " ")]
    assert set(raw["specimen"]) == set(mix["specimen_id"]) and len(mix) == 3
    assert len(read) == len(raw) in (27, 30)
    assert read.attrs["test_type"] == "tension-compression"
    keys = ["specimen", "temperature_C", "frequency_Hz"]
    both = raw.merge(read, on=keys, suffixes=("", "_read"))
    assert len(both) == len(raw)
    assert (both["E_MPa"] == both["E_MPa_read"]).all() and (both["phase_deg"] == both["phase_deg_read"]).all()


def test_the_one_law_gains_where_the_results_say():
    table = pd.read_csv(ROOT / "results/published/paper/families.csv", index_col="data")
    for quantity in ("E", "phase"):
        assert (table[f"mre_{quantity}_law_percent"] < table[f"mre_{quantity}_burgers_percent"]).all()
    results = " ".join((ROOT / "docs/results.md").read_text(encoding="utf-8").split())
    mean = pd.read_csv(ROOT / "results/published/measured/means.csv", index_col="rung").round(1)
    burgers, law = mean.loc["burgers"], mean.loc["one_law"]
    assert (
        f"miss {burgers.E_percent} % of |E\\*| and {burgers.phase_percent} % of the phase, "
        f"the one law {law.E_percent} and {law.phase_percent} %" in results
    )


def test_the_readme_s_example_tells_the_specimen_that_differs_and_proves_nothing():
    diagnosis = an.diagnose(ROOT / "data/ncat/N1-1_RH.csv", measured_in="tension-compression")
    said = str(diagnosis)
    assert re.search(r"Unexplained +Beyond scatter[^.]*\.\d % in \|E\*\| of specimen 7A", said)
    assert "none could be proved" in said


def test_moduli_were_turned_from_ksi_to_mpa():
    """One cell of the workbook, in ksi, against the table."""
    table = pd.read_csv(
        ROOT / "data/ncat/N1-1_RH.csv", index_col=["specimen", "temperature_C", "frequency_Hz"]
    )
    psi = 4.4482216152605 / 0.0254**2  # Pa, from the pound-force and the inch
    assert table.loc[("6B", 4, 0.1), "E_MPa"] == pytest.approx(1238.33220712938e3 * psi * 1e-6, rel=1e-6)
