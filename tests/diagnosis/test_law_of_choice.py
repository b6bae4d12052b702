"""`--law`: four forms compared on the same tests, and one interval wherever the law is shown."""

from __future__ import annotations

import json
import re

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner
from openpyxl import load_workbook

import asphalt_nscd as an
from asphalt_nscd.cli.diagnose import command
from asphalt_nscd.diagnosis.words.answer import Words
from asphalt_nscd.diagnosis.written import three_digits
from asphalt_nscd.reporting.pages.diagnosis_page import PARAMETERS

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Of the tutorial's exports, with the sigmoid asked for."""
    out = tmp_path_factory.mktemp("law")
    told = CliRunner().invoke(
        command,
        ["data/tutorial/exports", "--law", "sigmoid", "--draws", "500", "--output", str(out)],
    )
    assert told.exit_code == 0, told.output
    assert "a sigmoid master curve" in told.output.replace("\n                ", " ")
    return out


@pytest.fixture(scope="module")
def content(folder):
    return json.loads((folder / "diagnosis.json").read_text())


def test_all_four_are_compared_and_the_one_asked_for_is_written(folder, content):
    laws = {one["law"]: one for one in content["laws"]}
    assert list(laws) == ["2s2p1d", "huet-sayegh", "sigmoid", "cam"]
    assert [name for name, one in laws.items() if one["taken"]] == ["sigmoid"]
    assert content["law_misses"]["mre_E_percent"] == laws["sigmoid"]["mre_E_percent"]
    # The exports are drawn from a 2S2P1D law: no other fits as well, and it has the most parameters.
    for name in ("huet-sayegh", "sigmoid", "cam"):
        assert laws[name]["mre_phase_percent"] > laws["2s2p1d"]["mre_phase_percent"]
    assert laws["2s2p1d"]["parameters"] == 9 and laws["sigmoid"]["parameters"] == 6
    apart = [note for note in content["notes"] if "The two laws differ" in note]
    assert len(apart) == 1 and apart[0].endswith(" No sigmoid law fits these tests better.")
    law = an.Law.read(folder / "law.json")
    assert law.kind == "sigmoid"
    curve = pd.read_csv(folder / "master_curve.csv")
    star = law.complex_modulus(curve["frequency_Hz"], curve["temperature_C"])
    assert curve["law_E_MPa"].to_numpy() == pytest.approx(np.abs(star) * 1e-6, rel=1e-9)
    assert (curve["law_E_low_MPa"] < curve["law_E_MPa"]).all()


def test_intervals_of_the_law_are_the_same_everywhere(folder, content):
    """law.json, diagnosis.json, page, both workbooks, PDF."""
    law = json.loads((folder / "law.json").read_text())
    page = (folder / "diagnosis.html").read_text()
    book = load_workbook(folder / "corrected.xlsx")
    sheet = {row[0]: row[1:4] for row in book["Law"].iter_rows(min_row=2, values_only=True)}
    an.export(folder / "law.json", folder / "law.xlsx", "xlsx")
    rows = load_workbook(folder / "law.xlsx")["Law"].iter_rows(values_only=True)
    exported = {row[0]: row[3:5] for row in rows}
    assert len(content["law_parameters"]) == 6
    for key, one in content["law_parameters"].items():
        low, high = one["interval_95"]
        assert [low, high] == law["interval_95"][key] and low < one["value"] == law[key] < high
        assert sheet[key] == pytest.approx((one["value"], low, high))
        assert exported[key] == pytest.approx((low, high))
        factor = PARAMETERS.get(key, (key, 1.0, ""))[1]
        assert f"{three_digits(factor * low)} to {three_digits(factor * high)}" in page


def test_intervals_of_causes_and_shift_are_those_of_the_page(content):
    words = Words(content)
    said = [*words("causes"), *words("law_of_the_mix")]
    numbers = [
        (float(value.replace(" ", "")), float(half))
        for value, half in re.findall(r"(-?[\d.]+) \+- ([\d.]+)", " ".join(said))
    ]
    found = []
    for rung in content["ladder"]:
        for one in rung["parameters"].values():
            if "interval_95" in one:
                low, high = one["interval_95"]
                scale = 1e3 if one["unit"] == "s" else 1.0
                found.append((scale * one["value"], scale * 0.5 * (high - low)))
                assert low < one["value"] < high
    assert len(found) == len(numbers) == 3  # the delay, C1 and C2
    for pair in numbers:
        assert any(pair == pytest.approx(other, rel=0.06) for other in found), (pair, found)


def test_reported_values_are_the_same_in_json_table_workbook_and_curve(folder, content):
    said = content["reported"]
    table = pd.read_csv(folder / "reported.csv").iloc[0]
    book = load_workbook(folder / "corrected.xlsx")["Mix"]
    head, row = (list(cells) for cells in list(book.iter_rows(max_row=2, values_only=True)))
    for name in ("E_MPa", "E_low_MPa", "E_high_MPa", "phase_deg", "phase_low_deg", "phase_high_deg"):
        assert said[name] == pytest.approx(table[name], rel=1e-9)
        assert said[name] == pytest.approx(row[head.index(name)], rel=1e-9)
