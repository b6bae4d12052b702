"""`make check`: a changed digit is found and named, what belongs to a run is not."""

from __future__ import annotations

import json
import runpy
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PUBLISHED = ROOT / "results/published/paper"
CHECK = runpy.run_path(str(ROOT / "tools/check.py"))
first_difference = CHECK["first_difference"]


def test_changed_digit_is_named(tmp_path):
    text = (PUBLISHED / "table4.csv").read_text()
    (tmp_path / "table4.csv").write_text(text.replace("27.7", "27.8"))
    said = first_difference(tmp_path / "table4.csv", PUBLISHED / "table4.csv", CHECK["REDONE"]["table4.csv"])
    assert said.endswith("table4.csv: mre_phase_published_percent in line 2 is 27.8, made again 27.7")
    content = json.loads((PUBLISHED / "diagnosis/law.json").read_text())
    key = next(key for key, value in content.items() if isinstance(value, float) and value)
    (tmp_path / "law.json").write_text(json.dumps(content | {key: content[key] * 1.01}))
    assert f"law.json: {key} is " in first_difference(
        tmp_path / "law.json", PUBLISHED / "diagnosis/law.json", 1e-3
    )


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("a,b\n1,x\n", "a,b\n1.0000001,x\n", None),
        ("a,b\n1,\n", "a,b\n1,\n", None),
        ("a,b\n1,x\n", "a,b\n1,y\n", "b in line 2 is x, made again y"),
        ("a,b\n1,x\n", "a,b\n1,x\n2,x\n", "a in line 3 is nothing, made again 2"),
        ("a,b\n1,x\n", "a\n1\n", "b in line 2 is x, made again nothing"),
        ("a\n1\n", "a\n-1\n", "a in line 2 is 1.0, made again -1.0"),
    ],
)
def test_tables_number_by_number(tmp_path, before, after, said):
    (tmp_path / "a.csv").write_text(before)
    (tmp_path / "b.csv").write_text(after)
    found = first_difference(tmp_path / "a.csv", tmp_path / "b.csv", 1e-6)
    assert found is None if said is None else said in found
    assert "was not made again" in first_difference(tmp_path / "a.csv", tmp_path / "gone.csv", 1e-6)


@pytest.fixture
def copy(tmp_path):
    return shutil.copytree(PUBLISHED.parent, tmp_path / "published")


def test_checksums_hold_and_one_digit_breaks_them(copy):
    assert CHECK["_checksums"](copy) == []
    table = copy / "paper/simulations.csv"
    text = table.read_text()
    digit = max(text.rfind(digit) for digit in "12345678")
    table.write_text(text[:digit] + str(int(text[digit]) + 1) + text[digit + 1 :])
    (copy / "paper/table2.csv").unlink()
    found = CHECK["_checksums"](copy)
    assert len(found) == 2 and "simulations.csv: is not the file that was published" in found[0]
    assert "table2.csv: is missing" in found[1]
    (copy / "paper/SHA256SUMS").unlink()
    assert CHECK["_checksums"](copy) == [f"{copy / 'paper/SHA256SUMS'}: is missing"]


def test_a_folder_that_is_gone_and_one_too_many_are_named(copy):
    shutil.rmtree(copy / "faults")
    (copy / "notes.txt").touch()
    stray, gone = CHECK["_checksums"](copy)
    assert stray.startswith(f"{copy / 'notes.txt'}: is not one of attack, benchmark, calls")
    assert gone == f"{copy / 'faults/SHA256SUMS'}: is missing"
