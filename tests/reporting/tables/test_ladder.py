"""The table of rungs against hand calculation; its first rung is Table 4."""

from __future__ import annotations

import json

import numpy as np
import pytest

from asphalt_nscd.reporting.tables import fracture, ladder, table4

HEADER = (
    "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg,E_law_MPa,phase_law_deg,"
    "broken_bonds,bonds,largest_utilisation\n"
)


@pytest.fixture
def data(tmp_path):
    """Measured 100 MPa and 20 deg at 0 degC, 50 and 40 at 20 degC. The law has 98 and 51."""
    tests = {
        "simulations": "s1,0,3,110,21,98,22,3,90,0.5\ns2,0,3,110,21,98,22,0,90,0.8\ns1,20,3,56,41,51,42,0,90,0.2\n",
        "facets": "s1,0,3,98,21,98,22,1,60,1.4\ns2,0,3,98,21,98,22,4,80,1.1\ns1,20,3,51,41,51,42,0,60,0.1\n",
        "extended": "s1,0,3,100.5,20,100,20,0,60,0.4\ns1,20,3,50,40,50,40,0,60,0.1\n",
    }
    for name, rows in tests.items():
        (tmp_path / f"{name}.csv").write_text(HEADER + rows)
    (tmp_path / "measured.csv").write_text(
        "specimen,temperature_C,frequency_Hz,origin,E_MPa,phase_deg\n1,0,3,reconstructed,100,20\n1,20,3,measured,50,40\n"
    )
    left_out = {"0": {name: {"before": 9.0, "after": 1.5} for name in table4.ERRORS}}
    gain = {"in_sample": {}, "held_out": {"leave_one_isotherm_out": {"averages_by_temperature": left_out}}}
    spectrum = {"cause": "relaxation_spectrum", "where": None, "parameters": {}, "gain": gain}
    delay = {
        "cause": "channel_delay",
        "where": None,
        "parameters": {"delay": {"value": 1e-4}},
        "taken_off": True,
    }
    bonds = {"cause": "bond_mapping", "where": None, "parameters": {}}
    content = {"scatter": {"modulus_percent": 1.0, "phase_deg": 0.4}, "ladder": [bonds, spectrum, delay]}
    (tmp_path / "diagnosis.json").write_text(json.dumps(content))
    kinds = {name: [tmp_path / f"{name}.csv"] for name in (*tests, "measured")}
    return kinds | {"diagnosis": [tmp_path / "diagnosis.json"]}


def test_rungs_by_hand(data):
    table = ladder.make(**data).set_index(["rung", "temperature_C"])
    assert list(dict.fromkeys(table.index.get_level_values(0))) == [
        "as in the paper",
        "facets",
        "spectrum, channel delay",
    ]
    assert table.loc[("as in the paper", 0), "mre_E_percent"] == pytest.approx(10.0)
    assert table.loc[("facets", 0), "mre_E_percent"] == pytest.approx(2.0)
    assert table.loc[("spectrum, channel delay", 0), "mre_E_percent"] == pytest.approx(0.5)
    assert table.loc[("facets", 20), "mre_E_law_percent"] == pytest.approx(2.0)
    assert table.loc[("spectrum, channel delay", 20), "mre_phase_law_percent"] == pytest.approx(0.0)
    held = table["mre_E_held_out_percent"]
    assert held[("spectrum, channel delay", 0)] == 1.5 and held.notna().sum() == 1
    assert table.loc[("facets", 20), "scatter_phase_percent"] == pytest.approx(1.0)
    assert list(table["compared_with"]) == 3 * ["reconstructed", "measured"]


def test_before_is_what_table_4_shows(data):
    paper = ladder.make(**data).query("rung == 'as in the paper'").set_index("temperature_C")
    shown = table4.make(data["simulations"], data["measured"]).set_index("temperature_C")
    for quantity in ("E", "phase"):
        for kind, name in (("", "_simulated"), ("_law", "_law")):
            ours = paper[f"mre_{quantity}{kind}_percent"]
            assert np.array_equal(ours, shown[f"mre_{quantity}{name}_percent"])


def test_a_study_with_facets_begins_with_them(data):
    del data["facets"]
    assert list(ladder.make(**data)["rung"].unique()) == ["facets", "spectrum, channel delay"]
    del data["extended"]
    assert list(ladder.make(**data)["rung"].unique()) == ["facets"]


def test_the_likeliest_reading_is_a_rung_below_the_paper_as_we_read_it(data):
    table = ladder.make(**data, likely=data["facets"]).set_index(["rung", "temperature_C"])
    assert list(dict.fromkeys(table.index.get_level_values(0)))[:2] == ["likeliest", "as in the paper"]
    assert table.loc[("likeliest", 0), "mre_E_percent"] == pytest.approx(2.0)


def test_fracture_is_counted_for_each_mapping(data):
    table = fracture.make(data["simulations"], data["facets"]).set_index(["mapping", "temperature_C"])
    assert table.loc[("paper", 0), ["tests", "tests_with_broken_bonds", "broken_bonds"]].tolist() == [2, 1, 3]
    assert table.loc[("facets", 0), ["broken_bonds", "most_broken_bonds", "bonds_mean"]].tolist() == [
        5,
        4,
        70,
    ]
    assert np.isnan(table.loc[("facets", 0), "largest_utilisation"])
    assert table.loc[("paper", 0), "largest_utilisation"] == 0.8
    assert table.loc[("facets", 20), "tests_with_broken_bonds"] == 0
