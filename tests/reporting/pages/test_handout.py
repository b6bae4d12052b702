"""report.pdf is opened: its pages say who tested what, the moduli with their intervals, what was left out and why."""

from __future__ import annotations

import json
import re
import shutil

import pandas as pd
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure
from pypdf import PdfReader

from asphalt_nscd.cli.diagnose import command
from asphalt_nscd.reporting.pages import handout
from asphalt_nscd.reporting.pages.handout import write_handout
from asphalt_nscd.reporting.settings import Heading

pytestmark = pytest.mark.slow
STATED = {"project": "Ring road, lot 3", "mix": "AC 16", "operator": "A. Tester", "date": "28 November 2026"}
STATED |= {"standard": "AASHTO T 378"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Of the tutorial's exports, in which one test is left out."""
    out = tmp_path_factory.mktemp("report")
    options = [part for name, text in STATED.items() for part in (f"--{name}", text)]
    told = CliRunner().invoke(
        command, ["data/tutorial/exports", "--draws", "500", "--output", str(out), *options]
    )
    assert told.exit_code == 0, told.output
    return out


@pytest.fixture(scope="module")
def pages(folder):
    return PdfReader(folder / "report.pdf").pages


@pytest.fixture(scope="module")
def text(pages):
    return re.sub(r"\s+", " ", " ".join(page.extract_text() for page in pages))


def test_the_head_says_what_the_laboratory_stated(folder, pages, text):
    first = pages[0].extract_text()
    for name, said in STATED.items():
        assert f"{name.capitalize()} {said}" in re.sub(r"\s+", " ", first)
    assert all(f"{n} of {len(pages)}" in page.extract_text() for n, page in enumerate(pages, 1))
    assert len(pages) <= 4 and len(pages[0].images) == 2


def test_moduli_stand_with_their_intervals(folder, text):
    table = pd.read_csv(folder / "reported.csv")
    first = table.iloc[0]
    assert f"= {first.E_MPa:.0f} MPa ({first.E_low_MPa:.0f} to {first.E_high_MPa:.0f})" in text
    tested = table[table["asked_by"] == "the tests"]
    assert len(tested) > 10 and tested["within_the_tests"].all()
    for row in tested.itertuples():
        assert f"{row.E_MPa:.0f} {row.E_low_MPa:.0f} to {row.E_high_MPa:.0f} {row.phase_deg:.1f}°" in text


def test_what_was_left_out_stands_with_its_reason(folder, text):
    table = pd.read_csv(folder / "corrected.csv", keep_default_na=False)
    row = table[table["status"] == "left out"].iloc[0]
    assert f"{row.specimen} {row.nominal_temperature_C:g} °C {row.frequency_Hz:g} Hz left out" in text
    assert row.reasons.partition(" ")[0] in text


def test_each_specimen_stands_as_measured_and_what_is_not_simply_used_is_marked(folder, text):
    table, marks = (
        pd.read_csv(folder / "corrected.csv", keep_default_na=False),
        {"used": "", "left out": " X"},
    )
    for row in table.itertuples():
        mark = marks.get(row.status, " ?")
        assert f"{row.recorded_E_MPa:.0f} {row.recorded_phase_deg:.1f}°{mark}" in text


def test_doubtful_tests_among_those_used_are_told(folder, tmp_path):
    content = json.loads((folder / "diagnosis.json").read_text())
    content["trust"] |= {"use": 20, "check": 5, "held_back": 2}
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    (tmp_path / "diagnosis.json").write_text(json.dumps(content))
    made = PdfReader(write_handout(tmp_path, "t")).pages[0].extract_text()
    assert "They rest on 23 tests, 3 of them doubtful." in re.sub(r"\s+", " ", made)


def test_nothing_of_the_terminal_stands_in_it(pages, text):
    assert not re.search(r"degC|\+-|--[a-z]|\.csv|\.json", text)
    fonts = {
        str(font.get_object()["/BaseFont"]) for page in pages for font in page["/Resources"]["/Font"].values()
    }
    assert fonts and not any("Mono" in name for name in fonts)


def test_the_same_diagnosis_gives_the_same_bytes(folder, text):
    before = (folder / "report.pdf").read_bytes()
    strain = re.search(r"Strain (\d+ to \d+ microstrain, as recorded)", text)[1]  # of the exports
    write_handout(folder, "Diagnosis of exports", Heading(**STATED, strain=strain))
    assert (folder / "report.pdf").read_bytes() == before


def test_figures_stand_beside_each_other_within_the_page(monkeypatch):
    paper, placed = handout._Report("A report", "us"), []
    monkeypatch.setattr(paper, "image", lambda picture, x, y, w: placed.append((x, x + w)))
    monkeypatch.setattr(handout, "figure_bytes", lambda figure, kind: b"")
    paper.add_page()
    paper.picture(*[Figure(figsize=(4.0, 3.0)) for _ in range(3)])
    ends = [paper.l_margin, *(end for pair in placed for end in pair), paper.l_margin + paper.epw]
    assert len(placed) == 3 and ends == sorted(ends)
