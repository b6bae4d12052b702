"""Data that say little, or are wrong: a clear sentence or a diagnosis that states its limits, no wrong name."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from drawn.design import factorial, scattered

from asphalt_nscd.diagnosis.causes import CATALOGUE as NAMEABLE
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.record.report import diagnosis_content
from asphalt_nscd.diagnosis.run import conclude
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.diagnosis.simulation.simulated import read_specimen
from asphalt_nscd.files.errors import InputError

pytestmark = pytest.mark.slow

NO_REPLICATE = "No condition was repeated on another specimen"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def diagnosed(table):
    table.to_csv("measured.csv", index=False)
    observed, _ = read_observations("measured.csv", PAPER_GEOMETRY)
    found = diagnosis_content(diagnose(replace(observed, test_type="bending")), read_specimen())
    return found, {(rung["cause"], rung["where"]) for rung in found["ladder"]} - {
        ("relaxation_spectrum", None)
    }


@pytest.fixture(scope="module")
def full():
    return scattered(5, factorial())


SMALL = {
    "one specimen": {"specimens": "A"},
    "one temperature": {"temperatures": (15.0,)},
    "two frequencies": {"frequencies": (3.0, 40.0)},
    "one specimen, two frequencies": {"specimens": "A", "frequencies": (3.0, 40.0)},
    "one specimen, one temperature": {"specimens": "A", "temperatures": (15.0,)},
    "four tests": {"specimens": "AB", "temperatures": (15.0,), "frequencies": (3.0, 40.0)},
}


@pytest.mark.parametrize("design", SMALL.values(), ids=SMALL)
def test_small_designs_name_nothing_that_is_not_there(design):
    table = scattered(1, factorial(**design))
    found, named = diagnosed(table)
    assert named == set() and found["verdict"] != "unexplained_structure"
    assert found["detection_limits"]
    for cause in NAMEABLE:  # none is beyond what is physical
        most = max(abs(cause.parameters[0].low), abs(cause.parameters[0].high))
        assert found["detection_limits"].get(cause.name, {"value": 0.0})["value"] <= most
    if design.get("specimens") or len(table) < 9:
        assert any(NO_REPLICATE in note for note in found["notes"])


@pytest.mark.parametrize("name", ["one specimen", "two frequencies", "four tests"])
def test_small_designs_find_what_is_there_or_nothing(name):
    table = scattered(1, factorial(**SMALL[name]))
    late = table.assign(phase_deg=table["phase_deg"] + 360.0 * 3e-4 * table["frequency_Hz"])
    assert diagnosed(late)[1] <= {("channel_delay", None)}


def test_on_one_temperature_a_name_is_the_likeliest_and_never_sure():
    """A gain over the logarithm of the frequency, which the catalogue lacks, passes for an offset of the phase."""
    table = scattered(5, factorial(temperatures=(15.0,)))
    gain = 1.0 + 0.04 * np.log10(table["frequency_Hz"])
    found, named = diagnosed(table.assign(E_MPa=table["E_MPa"] * gain))
    assert named and found["verdict"] == "unexplained_structure"
    assert any("not established" in note and "temperatures" in note for note in found["notes"])


def test_one_specimen_makes_no_sure_name():
    """A part in phase with E*, the same in all tests, passes for friction at the guide."""
    for seed in (1, 2):
        table = scattered(seed, factorial(specimens="A"))
        found, named = diagnosed(table.assign(E_MPa=table["E_MPa"] + 60.0))
        assert not named or found["verdict"] == "unexplained_structure"
        assert not named or any("nothing was repeated" in note for note in found["notes"])


def test_without_a_common_law_the_mix_is_still_reported_and_said_to_be_less_certain(tmp_path):
    table = scattered(1, factorial(frequencies=(3.0, 40.0)))
    table["phase_deg"] += 5.0
    table.to_csv(tmp_path / "measured.csv", index=False)
    conclude(tmp_path / "measured.csv", PAPER_GEOMETRY).written(tmp_path)
    content = json.loads((tmp_path / "diagnosis.json").read_text(encoding="utf-8"))
    named = {rung["cause"] for rung in content["ladder"]} - {"relaxation_spectrum"}
    assert not named and content["verdict"] == "unexplained_structure"
    assert any("less certain than it says" in note for note in content["notes"])
    near = table[(table["temperature_C"] == 15.0) & (table["frequency_Hz"] == 40.0)]["E_MPa"].mean()
    assert 0.5 * near < content["reported"]["E_MPa"] < near


def test_an_outlier_is_set_aside_and_not_named(full):
    table = full.copy()
    table.loc[37, "phase_deg"] += 20.0
    found, named = diagnosed(table)
    assert named == set() and found["verdict"] == "explained"


def copied(table):
    first = table[table["specimen"] == "A"]
    return pd.concat([first, first.assign(specimen="E"), table[table["specimen"] == "B"]])


WRONG = {  # wrong cells are refused where the table is read: tests/measurements/test_reduction.py
    "copies": (copied, "A and E .* 30 conditions"),
    "three tests": (lambda t: t.head(3), "at least 4"),
    "one frequency": (lambda t: t[t["frequency_Hz"] == 10.0], "at least 4"),
    "the same everywhere": (lambda t: t.assign(E_MPa=1e4, phase_deg=10.0), "copies"),
}


@pytest.mark.parametrize(("spoil", "sentence"), WRONG.values(), ids=WRONG)
def test_wrong_tables_are_refused_in_a_sentence(full, spoil, sentence):
    with pytest.raises(InputError, match=sentence):
        diagnosed(spoil(full.copy()))


def test_one_modulus_for_all_temperatures_gets_no_name(full):
    table = full[full["specimen"] == "A"].assign(E_MPa=1e4, phase_deg=10.0)
    assert diagnosed(table)[1] == set()
