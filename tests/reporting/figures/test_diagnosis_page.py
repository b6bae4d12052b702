"""The page of a diagnosis says what diagnosis.json says, and never more."""

import json
import re

import pandas as pd
import pytest

from asphalt_nscd.reporting.pages.diagnosis_page import render, sections


@pytest.fixture
def page(results):
    def make(table4=(), ladder_table=(), **changes):
        found = results.diagnosis(**changes) | {"causality": results.causality()}
        html = render(sections(**found, table4=table4, ladder=ladder_table), "A diagnosis")
        return re.sub(r"\s+", " ", re.sub(r"<(style|script)>.*</\1>", "", html, flags=re.DOTALL))

    return make


@pytest.fixture
def made(results):
    return json.loads(results.diagnosis()["diagnosis"][0].read_text())


def test_causes_stand_with_size_unit_chance_and_gains(page):
    html = page()
    assert '<th scope="row">Data</th><td class="words"><p>All 12 tests can be used.</p></td>' in html
    assert "<p>Loose clamp of specimen 2, 3.00 ± 0.39 1/TPa.</p>" in html
    assert "Loose clamp of specimen 2: 3.00 ± 0.39 1/TPa. Established, with a probability of 97 %" in html
    assert "<td>compliance 3.00 ± 0.39 1/TPa</td><td>below 1e-06</td><td>fitted</td><td>8 → 2</td>" in html
    assert "<td>8 → 2</td>" in html.partition("each frequency predicted from the others</td>")[2][:30]
    assert "each temperature predicted" not in html


def test_what_could_not_be_seen_stands_beside(page):
    html = page(not_testable=[{"cause": "temperature_bias @ -6.0", "needs": "other tests"}])
    assert "<td>channel delay</td><td>0.03 ms</td>" in html
    assert "0.9 1/TPa of specimen 1 and 0.8 1/TPa of specimen 2</td>" in html
    assert "0.9 K at 0 °C and 0.3 K at 20 °C" in html
    assert "<td>temperature bias at \N{MINUS SIGN}6 °C</td><td>other tests</td>" in html
    assert "<li>loose clamp of all specimens – relaxation spectrum</li>" in html


def test_published_table_stands_beside_reconstructed_data_only(page, tmp_path):
    table = pd.DataFrame({
        "temperature_C": [0.0], "compared_with": ["reconstructed"], "mre_E_published_percent": [1.33],
        "mre_E_simulated_percent": [12.52], "mre_E_law_percent": [2.8], "mre_phase_published_percent": [9.75],
        "mre_phase_simulated_percent": [12.12], "mre_phase_law_percent": [12.1],
    })  # fmt: skip
    table.to_csv(path := tmp_path / "table4.csv", index=False)
    row = "<td>0 °C</td><td>1.33</td><td>12.5</td><td>9.75</td><td>12.1</td>"
    assert row in page([path]) and row not in page([path], origin="measured")
    table.drop(columns=[name for name in table if "published" in name]).to_csv(path, index=False)
    assert "no check of the simulation" not in page([path])


def test_what_stays_unexplained_is_said(page):
    miss = {
        "specimen": None, "temperature_C": 20.0, "frequency_Hz": 3.0, "residual_E_percent": -15.13,
        "residual_phase_deg": -2.77, "z": 6.94,
    }  # fmt: skip
    html = page(
        verdict="unexplained_structure",
        largest_pattern_left={"pattern": "20 degC, slope", "p_value": 1e-9, "z": 11.7},
        unexplained=[miss, {**miss, "specimen": "2"}],
        withdrawn=["secondary_process"],
    )
    assert "<p>20 °C, slope: 11.7 times its standard error.</p>" in html
    assert "<td>20 °C</td><td>3</td><td>−15.1</td><td>−2.77</td><td>6.94</td><td>mean</td>" in html
    assert "<td>specimen 2, set aside</td>" in html and "too unsure: secondary process." in html
    assert "Nothing beyond scatter" not in html and "Nothing beyond scatter" in page()


def test_rivals_and_text_from_the_table_are_shown_as_text(page, made):
    rung = made["ladder"][-1] | {"where": "<b>", "as_good": ["loose_clamp @ <i>", "temperature_bias @ -10.0"]}
    html = page(ladder=[rung])
    rivals = "loose clamp of specimen &lt;i&gt; or temperature bias at −10 °C fits as well"
    assert f"Not certain. L{rivals[1:]}; these tests do not say which." in html
    assert "loose clamp of specimen &lt;b&gt;" in html and "<i>" not in html


def test_without_replicates_nothing_is_called_right_or_established(page, made):
    alone = made["scatter"] | {"from_replicates": False}
    html = page(verdict="nothing_to_explain", ladder=[], tested=False, scatter=alone)
    assert "the scatter from test to test is not known. Test" in html and "fits these tests" not in html
    assert "is taken as 1 % of |E*| and 0.5° as far as a smooth law can tell" in html
    stated = page(scatter=alone, provenance=made["provenance"] | {"scatter_stated": [0.01, 0.5]})
    assert "is taken as 1 % of |E*| and 0.5°, as was stated." in stated
    unsure = [rung | {"established": False} for rung in made["ladder"]]
    html = page(verdict="unexplained_structure", ladder=unsure)
    assert '<th scope="row">Possible fault</th><td class="words"><p>Loose clamp of specimen 2, ' in html
    assert "Only 2 temperatures were tested, and certainty takes 4." in html


def test_what_a_laboratory_is_to_do_stands_on_the_page(page, made):
    order = {
        "text": "2.5 h: test specimens A and B at -6 degC, 25 Hz.", "act": "test specimens A and B at -6 degC",
        "purpose": "to see", "why": ["It shows as 7.1 deg."], "hours": 2.5, "nats": 3.0, "specimens": ["A", "B"],
        "temperature_C": -6.0, "frequencies_Hz": [25.0], "half_strain": False,
    }  # fmt: skip
    suspect = {
        "specimen": "A", "temperature_C": 4.0, "frequency_Hz": 25.0, "status": "left out",
        "decided_by": "its own isotherm", "reasons": ["phase 18.8 deg +- 1"],
    }  # fmt: skip
    html = page(
        origin="measured",
        instructions={"costs": "Counted: 2 h.", "orders": [order]},
        suspect_tests=[suspect],
        with_suspects={"verdict": "explained", "causes": [{"cause": "phase_offset", "where": None}]},
        trust=made["trust"] | {"not_used": 1},
    )
    assert "<p>1. 2.5 h: test specimens A and B at −6 °C, 25 Hz. It shows as 7.1°.</p>" in html
    assert "<p>12 of 13 tests can be used, 1 cannot.</p>" in html
    assert "<p>Specimen A, 4 °C, 25 Hz: phase 18.8° ± 1.</p>" in html
    assert "<p>1. Test specimens A and B at −6 °C, 25 Hz, to see (2.5 h).</p>" in html
    assert "would name a phase offset and no longer name a loose clamp of specimen 2." in html
    assert "Counted: 2 h." in html and "<td>phase 18.8° ± 1</td>" in html


def test_the_scatter_stands_as_coefficients_of_variation(page):
    own = {"between": {"E_percent": 12.14, "phase_deg": 1.914}, "within": None}
    html = page(repeatability={**own, "furthest": None, "by_isotherm": [{"temperature_C": -10.0, **own}]})
    assert "<td>−10 °C</td><td>12.1</td><td>1.91</td></tr>" in html
    assert "<p>Standard deviation between specimens: 12.1 % in |E*|, 1.9° in phase.</p>" in html


def test_bond_mapping_stands_first_with_its_evidence_and_without_a_chance(page, made):
    errors = {
        name: {"before": 10.2, "after": 2.0}
        for name in ("mre_E_percent", "mre_phase_percent", "off_phase_deg")
    }
    rung = made["ladder"][-1] | {
        "cause": "bond_mapping", "where": None, "p_value": None, "evidence": "1.056 to 1.109 of the law",
        "parameters": {"modulus_over_law": {"value": 1.09, "std_error": None, "unit": "1"}},
        "gain": {"in_sample": {"averages_by_temperature": {"0": errors}}, "held_out": {}},
    }  # fmt: skip
    html = page(ladder=[rung, *made["ladder"]])
    assert html.index("<td>bond mapping</td>") < html.index("<td>relaxation spectrum</td>")
    assert "Established: 1.056 to 1.109 of the law." in html
    assert "<td></td><td>fitted</td><td>10.2 → 2</td><td>10.2 → 2</td><td></td>" in html
    assert "facets for bonds, a relaxation spectrum and a loose clamp of specimen 2 the simulation" in html


def test_the_whole_way_stands_by_temperature(page, results):
    html = page()
    assert "run again with each rung" not in html and " by 2 % in |E*| and 2° in the phase," in html
    html = page(ladder_table=results.ladder())
    assert "the simulation misses by 0.6 % and 5 %" in html
    assert "<td>|E*|: as in the paper</td><td>10.2</td><td>12</td><td>11.1</td>" in html
    assert "<td>|E*|: the law&#39;s own, as in the paper</td><td>2.1</td>" in html
    assert "<td>phase: scatter of one test</td><td>4</td>" in html
