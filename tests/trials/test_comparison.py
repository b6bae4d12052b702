"""What compares two runs: one digit anywhere is found, what belongs to a run is not."""

from __future__ import annotations

import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from comparison import differences

from asphalt_nscd.reporting.pages.style import page

TEXTS = {
    "diagnosis/diagnosis.json": '{\n  "x": 0.125,\n  "git_commit": "%s"\n}\n',
    "pages/diagnosis.html": "<p>At 0.125, commit %s.</p>\n",
    "study.json": '{"a": 1, "b": 2}\n',
    "figures/fig01.svg": "<path d='M 0.125'/>\n",
    "provenance.json": '{"git_commit": "%s", "python": "3.11", "made_by": {"tests": {"%s": 1}}}\n',
}
TEST = Path("tests/s1.h5")


def _run(folder: Path, of_run: str) -> Path:
    for name, text in TEXTS.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text.replace("%s", of_run))
    (folder / "simulations.csv").write_text("E_MPa,phase_deg\n12.5,3\n11.5,4\n")
    (folder / "pages/simulations.html").write_text(page(folder / "simulations.csv", "All tests"))
    (folder / TEST).parent.mkdir()
    with h5py.File(folder / TEST, "w") as file:
        file["record/force"] = np.array([1.0, 0.125])
        file["record/force"].attrs["unit"] = "N"
        file["record"].attrs["steps"] = 3
        file.attrs["E_MPa"] = np.nan
        file.attrs["provenance"] = of_run
    for name in ("logs/a.log", "benchmarks/a.tsv", "timings.csv"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(of_run)
    return folder


@pytest.fixture
def runs(tmp_path):
    return _run(tmp_path / "here", "a" * 40), _run(tmp_path / "there", "c0ffee-dirty")


def test_what_belongs_to_a_run_makes_no_difference(runs):
    assert differences(*runs) == []


@pytest.mark.parametrize(
    ("name", "before", "after"),
    [
        ("diagnosis/diagnosis.json", "0.125", "0.126"),
        ("diagnosis/diagnosis.json", '"git_commit"', '"sha256"'),
        ("pages/diagnosis.html", "0.125", "0.126"),
        ("study.json", '"a": 1, "b": 2', '"b": 2, "a": 1'),
        ("simulations.csv", "12.5", "12.50"),
        ("simulations.csv", "4\n", "-4\n"),
        ("pages/simulations.html", "12.5", "12.6"),
        ("pages/simulations.html", "All tests", "All the tests"),
        ("figures/fig01.svg", "0.125", "0.126"),
        ("provenance.json", "3.11", "3.12"),
    ],
)
def test_one_digit_is_found(runs, name, before, after):
    text = (runs[1] / name).read_text()
    assert before in text
    (runs[1] / name).write_text(text.replace(before, after))
    assert differences(*runs) == [f"{name}: differs"]


@pytest.mark.parametrize(
    "change",
    [
        lambda file: file["record/force"].write_direct(np.array([1.0, np.nextafter(0.125, 1.0)])),
        lambda file: file["record/force"].write_direct(np.array([1.0, -0.125])),
        lambda file: file["record/force"].attrs.modify("unit", "kN"),
        lambda file: file["record"].attrs.modify("steps", 4),
        lambda file: file.attrs.modify("E_MPa", 1.0),
        lambda file: file.create_dataset("more", data=[0]),
    ],
)
def test_one_bit_of_an_array_or_attribute_is_found(runs, change):
    with h5py.File(runs[1] / TEST, "r+") as file:
        change(file)
    assert differences(*runs) == [f"{TEST}: differs"]


def test_what_is_missing_on_either_side_is_found(runs):
    (runs[0] / "study.json").unlink()
    shutil.rmtree(runs[1] / "figures")
    assert differences(*runs) == [
        f"figures/fig01.svg: no {runs[1]}/figures/fig01.svg",
        f"study.json: no {runs[0]}/study.json",
    ]
