"""Several mixes beside each other: who is stiffer, and whether the tests can tell."""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import openpyxl
import pandas as pd
import pytest
from click.testing import CliRunner

import asphalt_nscd as an
from asphalt_nscd.api.comparison import Comparison
from asphalt_nscd.cli.compare import command
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

pytestmark = pytest.mark.slow

GLASSY = {"soft": 24e9, "stiff <b>": 36e9, "soft too": 24.1e9}


def modulus(glassy, f, t):
    law = HuetSayegh(60e6, glassy, k=0.21, h=0.6, delta=2.3, tau=0.15, shift=WLF(18.0, 150.0, 15.0))
    return complex(law.complex_modulus(2 * np.pi * f, t))


@pytest.fixture(scope="module")
def mixes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mixes")
    random = np.random.default_rng(3)
    for name, glassy in GLASSY.items():
        rows = []
        for specimen in "AB":
            level = random.normal(0.0, 0.03)
            for t, f in product((4.0, 20.0, 35.0), (0.1, 1.0, 10.0, 25.0)):
                star = modulus(glassy, f, t)
                size = abs(star) * 1e-6 * np.exp(level + random.normal(0.0, 0.01))
                rows.append((specimen, t, f, size, np.degrees(np.angle(star)) + random.normal(0.0, 0.2)))
        names = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
        pd.DataFrame(rows, columns=names).to_csv(folder / f"{name}.csv", index=False)
    return [folder / f"{name}.csv" for name in GLASSY]


OPTIONS = ["--measured-in", "tension-compression", "--draws", "500"]


@pytest.fixture(scope="module")
def compared(mixes, tmp_path_factory):
    """What the command says of the three, and the folder that it writes."""
    folder = tmp_path_factory.mktemp("compared")
    arguments = [*map(str, mixes), *OPTIONS, "--same-machine", "--output", str(folder)]
    result = CliRunner().invoke(command, arguments, catch_exceptions=False)
    assert result.exit_code == 0
    return result.output, folder


def test_mixes_are_ranked_with_what_the_tests_leave_open(compared):
    said, folder = compared
    lines = said.splitlines()
    assert "stiff <b>" in lines[0] and lines[0].split()[0] == "1"
    assert [line.split()[0] for line in lines[1:3]] == [
        "2-3",
        "2-3",
    ]  # 0.4 % apart, of specimens that differ by 3 %
    assert any(line.startswith("Nothing common to the campaigns") for line in lines)
    assert any(line.endswith("would mostly stay unseen.") for line in lines)
    assert pd.read_csv(folder / "machine.csv").empty
    book = openpyxl.load_workbook(folder / "comparison.xlsx")
    assert book.sheetnames == ["Ranking", "Conditions", "Differences", "Curves at 15 degC", "Machine"]
    header, first, *_ = book["Ranking"].iter_rows(values_only=True)
    row = dict(zip(header, first))
    true = abs(modulus(GLASSY["stiff <b>"], 10.0, 15.0)) * 1e-6
    assert row["E_low_MPa"] < true < row["E_high_MPa"] and row["rank_high"] == 1
    page = (folder / "comparison.html").read_text(encoding="utf-8")
    assert "stiff <b>" not in page and "stiff &lt;b&gt;" in page and f"{row['E_MPa']:.0f}" in page
    assert "<h2>The machine</h2><p>Nothing common to the campaigns" in page
    svg = page[page.index("<svg") : page.index("</svg>") + 6]
    assert ElementTree.fromstring(svg).tag.endswith("svg")
    for name in GLASSY:
        names = {path.name for path in (folder / name).iterdir()}
        assert names > {"diagnosis.html", "report.pdf", "corrected.xlsx", "corrected.csv", "law.json"}


def test_differences_hold_the_truth_and_stand_only_where_both_were_tested(compared):
    table = pd.read_excel(compared[1] / "comparison.xlsx", sheet_name="Differences", engine="openpyxl")
    assert set(table["temperature_C"]) == {15.0, 20.0}  # the warmest tests are at 35 degC
    for row in table.itertuples():
        true = abs(modulus(GLASSY[row.mix], row.frequency_Hz, row.temperature_C))
        true = 100.0 * (true / abs(modulus(GLASSY[row.than], row.frequency_Hz, row.temperature_C)) - 1.0)
        assert row.stiffer_low_percent < true < row.stiffer_high_percent
        assert row.told_apart == (row.mix == "stiff <b>")


def test_mixes_of_one_file_are_compared_by_their_names(mixes, tmp_path):
    names = ["soft", "AC 16 50/70"]
    frames = [pd.read_csv(path).assign(mix=name) for path, name in zip(mixes, names)]
    pd.concat(frames).to_csv(tmp_path / "book.csv", index=False)
    options = [part for name in names for part in ("--only-mix", name)]
    options += [*OPTIONS, "--output", str(tmp_path / "out")]
    result = CliRunner().invoke(command, [str(tmp_path / "book.csv"), *options], catch_exceptions=False)
    assert result.exit_code == 0
    assert "At 15 degC, 10 Hz AC 16 50/70 has +" in result.output
    page = (tmp_path / "out/comparison.html").read_text(encoding="utf-8")
    assert 'href="AC%2016%2050-70/diagnosis.html">AC 16 50/70</a>' in page
    assert (tmp_path / "out/AC 16 50-70/report.pdf").is_file()


def test_a_folder_with_a_point_in_its_name_keeps_all_of_it(mixes, tmp_path):
    for name, path in zip(("AC 5.2", "AC 5.4"), mixes, strict=False):
        (tmp_path / name).mkdir()
        (tmp_path / name / "tests.csv").write_text(path.read_text())
    found = an.compare(
        [tmp_path / "AC 5.2", tmp_path / "AC 5.4"],
        measured_in="tension-compression",
        draws=an.Draws(number=500),
    )
    assert list(found.diagnoses) == ["AC 5.2", "AC 5.4"]


def test_a_file_called_as_a_named_mix_does_not_take_its_place(mixes, tmp_path):
    frames = [pd.read_csv(path).assign(mix=name) for path, name in zip(mixes, ("A", "soft"), strict=False)]
    pd.concat(frames).to_csv(tmp_path / "book.csv", index=False)
    options = ["--only-mix", "A", "--only-mix", "soft", *OPTIONS, "--output", str(tmp_path / "out")]
    with pytest.raises(an.InputError, match="soft.csv: two mixes are called soft; rename one"):
        CliRunner().invoke(
            command, [str(tmp_path / "book.csv"), str(mixes[0]), *options], catch_exceptions=False
        )


def test_a_possible_cause_is_not_shown_as_a_certain_one():
    rung = {"cause": "channel_delay", "where": None, "established": True, "probability": 0.97}
    ladder = [
        rung,
        rung | {"cause": "temperature_bias", "where": 40.0, "established": False, "probability": 0.68},
    ]
    reported = {
        "temperature_C": 15.0,
        "frequency_Hz": 10.0,
        "E_MPa": 9e3,
        "E_low_MPa": 8e3,
        "E_high_MPa": 1e4,
    }
    reported |= {"phase_deg": 20.0, "phase_low_deg": 19.0, "phase_high_deg": 21.0}
    one = SimpleNamespace(
        content={
            "ladder": ladder,
            "reported": reported,
            "reading": {"test_type": "bending"},
            "tests": 24,
            "trust": {"check": 6, "not_used": 1},
        },
        verdict="identified",
    )
    table = Comparison({"mix": one, "other": one}).table
    assert list(table)[:4] == ["mix", "rank_low", "rank_high", "test"] and (table["rank_high"] == 2).all()
    assert table[["check_first", "left_out"]].to_numpy().tolist() == [[6, 1]] * 2
    assert table["causes"].tolist() == ["channel delay"] * 2
    assert table["possible_causes"].tolist() == ["temperature bias at 40 degC (68 %)"] * 2


def test_what_is_no_comparison_is_refused(mixes, tmp_path):
    with pytest.raises(an.InputError, match="one mix is no comparison"):
        an.compare(mixes[:1])
    with pytest.raises(an.InputError, match="two mixes are called soft"):
        an.compare([mixes[0], mixes[0]])
    (tmp_path / "copy.csv").write_text(mixes[0].read_text())
    with pytest.raises(an.InputError, match="soft and copy hold the same 24 tests; leave one of them out"):
        an.compare([mixes[0], mixes[1], tmp_path / "copy.csv"], measured_in="tension-compression")
    (tmp_path / "bad.csv").write_text("a,b\n1,2\n")
    with pytest.raises(an.InputError, match="mix bad: "):
        an.compare([tmp_path / "bad.csv", mixes[0]])
