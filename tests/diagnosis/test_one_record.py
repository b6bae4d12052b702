"""Read through as a laboratory would: every output tells the same of each test, and the first screen what to do."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import asphalt_nscd as an
from asphalt_nscd.diagnosis.words.answer import rows
from asphalt_nscd.exports.formats.xlsx import corrected_workbook
from asphalt_nscd.reporting.pages.diagnosis_page import write_page

ROOT = Path(__file__).parents[2]
TESTS = ["specimen", "temperature_C", "frequency_Hz"]
MIXES = {
    "N1-1_RH": "data/ncat/N1-1_RH.csv",
    "S6-1_RH": "data/ncat/S6-1_RH.csv",
    "tutorial": "data/tutorial/exports",
}


@pytest.fixture(scope="module")
def compared():
    return an.compare(
        {name: ROOT / path for name, path in MIXES.items()},
        measured_in="tension-compression",
        draws=an.Draws(500),
    )


@pytest.mark.parametrize("mix", MIXES)
def test_every_output_tells_the_same_of_each_test(compared, mix, tmp_path):
    diagnosis = compared.diagnoses[mix]
    diagnosis.write(tmp_path)
    corrected, causality = (
        pd.read_csv(tmp_path / f"{name}.csv", dtype={"specimen": str}) for name in ("corrected", "causality")
    )
    assert corrected["status"].tolist() == causality["status"].tolist()
    count = corrected["status"].value_counts().to_dict()
    used, out = count.get("used", 0), count.get("left out", 0)
    check = count.get("doubtful", 0) + count.get("held back", 0)
    trust = diagnosis.content["trust"]
    assert (trust["use"], trust["check"], trust["not_used"]) == (used, check, out)
    assert len(diagnosis.suspects) == check + out
    row = compared.table.set_index("mix").loc[mix]
    assert (row["check_first"], row["left_out"]) == (check, out)
    book = pd.read_excel(corrected_workbook(tmp_path), sheet_name=None, engine="openpyxl")
    assert len(book["Corrected"]) == used + check and len(book.get("Left out", ())) == out
    page = write_page(tmp_path, mix).read_text(encoding="utf-8")
    for status in ("doubtful", "held back", "left out"):
        assert len(re.findall(f"<td[^>]*>{status}</td>", page)) == count.get(status, 0), status
    (data,) = dict(rows(diagnosis.content))["Data"]
    numbers = list(map(int, re.findall(r"\d+", data)))
    assert numbers[0] == (len(corrected) if not check + out else used)


def test_what_is_only_possible_is_not_taken_off(compared):
    """An offset of 3.3 deg at some 80 % was once subtracted from S6-1_RH, with an interval that ignored its doubt."""
    outcome = compared.diagnoses["S6-1_RH"].outcome
    tests, grid = outcome.to_report["corrected"], outcome.to_report["reported"]
    assert (tests["phase_deg"] - tests["recorded_phase_deg"]).abs().max() < 1e-9
    shares = np.array([one["probability"] for one in outcome.content["averaged_over"]])
    assert shares.sum() == pytest.approx(1.0) and shares.size > 1
    rungs = [rung for rung in outcome.content["ladder"] if rung["probability"] is not None]
    for rung in rungs:
        held = [rung["cause"] in one["causes"] for one in outcome.content["averaged_over"]]
        assert rung["taken_off"] == pytest.approx(shares[held].sum())
    values, errors = outcome.mix.parts(2.0 * np.pi * np.array([10.0]), np.array([15.0]))
    phases, sizes = np.degrees(values.imag[:, 0]), np.degrees(errors.imag[:, 0])
    first = grid.iloc[0]
    assert first["phase_deg"] == pytest.approx(shares @ phases)
    likely = phases[shares > 0.05]
    assert first["phase_low_deg"] < likely.min() and likely.max() < first["phase_high_deg"]
    # The likeliest alone would be surer: the interval knows of the doubt.
    assert first["phase_high_deg"] - first["phase_low_deg"] > 1.1 * 2.0 * 1.96 * sizes[0]
    assert "%" in first["averaged_over"]
