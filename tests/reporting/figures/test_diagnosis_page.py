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


def test_causes_stand_with_size_unit_chance_and_gains(page):
    html = page()
    assert "<p>The free master curve, fitted together with a loose clamp of specimen 2, misses " in html
    assert '<th scope="row">Data</th><td class="words"><p>All 12 tests can be used.</p></td>' in html
    assert "<p>Loose clamp of specimen 2, 3.00 ± 0.39 1/TPa.</p>" in html
    assert (
        "<b>loose clamp of specimen 2: 3.00 ± 0.39 1/TPa</b>. Established, with a probability of 97 %: the chance "
        "that scatter alone" in html
    )
    assert "compliance 3.00 ± 0.39 1/TPa" in html and "<td>below 1e-06</td>" in html
    assert "<td>fitted</td><td>8 → 2</td>" in html
    assert "<td>each frequency predicted from the others</td><td>8 → 2</td>" in html
    assert "each temperature predicted" not in html
    assert "<li>loose clamp (specimen 2): c.</li>" in html


def test_what_could_not_be_seen_stands_beside(page):
    html = page()
    assert "<td>channel delay</td><td>0.03 ms</td>" in html
    assert '<td>loose clamp</td><td class="words">0.9 1/TPa (specimen 1); 0.8 1/TPa (specimen 2)</td>' in html
    assert "<td>temperature bias</td><td>0.9 K (0 °C); 0.3 K (20 °C)</td>" in html
    assert "<td>damage</td><td>the order of the tests</td>" in html
    assert "<li>loose clamp of all specimens – relaxation spectrum</li>" in html


@pytest.mark.parametrize(
    ("origin", "sentence"),
    [
        ("reconstructed", "rests on reconstructed data"),
        ("measured", "they are taken for measurements"),
        ("synthetic", "The data are synthetic"),
        (
            "mixed: measured, reconstructed",
            "they are taken for measurements. This diagnosis rests on reconstructed data",
        ),
        ("borrowed", "The data are borrowed."),
    ],
)
def test_origin_is_said(page, origin, sentence):
    html = page(origin=origin)
    assert sentence in html
    assert ("rests on reconstructed data" in html) == ("reconstructed" in origin)


def test_published_table_stands_beside_reconstructed_data_only(page, tmp_path):
    table = pd.DataFrame({
        "temperature_C": [0.0], "compared_with": ["reconstructed"], "mre_E_published_percent": [1.33],
        "mre_E_simulated_percent": [12.52], "mre_E_law_percent": [2.8], "mre_phase_published_percent": [9.75],
        "mre_phase_simulated_percent": [12.12], "mre_phase_law_percent": [12.1],
    })  # fmt: skip
    table.to_csv(path := tmp_path / "table4.csv", index=False)
    row = "<td>0 °C</td><td>1.33</td><td>12.5</td><td>9.75</td><td>12.1</td>"
    assert row in page([path]) and "no check of the simulation" in page([path])
    assert "no check of the simulation" not in page([path], origin="measured")
    table.drop(columns=[name for name in table if "published" in name]).to_csv(path, index=False)
    assert "no check of the simulation" not in page([path])


def test_what_stays_unexplained_is_said(page):
    miss = {
        "specimen": None,
        "temperature_C": 20.0,
        "frequency_Hz": 3.0,
        "residual_E_percent": -15.13,
        "residual_phase_deg": -2.77,
        "z": 6.94,
    }
    left = {"pattern": "20 degC, slope", "p_value": 1e-9, "z": 11.7}
    html = page(
        verdict="unexplained_structure",
        largest_pattern_left=left,
        unexplained=[miss, {**miss, "specimen": "2"}],
        withdrawn=["secondary_process"],
    )
    assert " by 2 % in |E*| and 2 % in the phase, more than scatter within specimens can explain." in html
    assert "<li>20 °C, slope: 11.7 times its standard error</li>" in html
    assert "<td>20 °C</td><td>3</td><td>−15.1</td><td>−2.77</td><td>6.94</td><td>mean</td>" in html
    assert "<td>specimen 2, set aside</td>" in html
    assert "Considered but not named" in html and "secondary process" in html
    assert "Nothing beyond scatter" not in html and "Nothing beyond scatter" in page()


def test_rivals_and_text_from_the_table_are_shown_as_text(page):
    html = page()
    assert "Fits no better" not in html
    ladder = [
        {
            **SURE,
            "cause": "loose_clamp",
            "where": "<b>",
            "p_value": 0.004,
            "as_good": ["loose_clamp @ <i>", "temperature_bias @ -10.0"],
            "sentence": "s",
            "confirmed_by": "c",
            "gain": {"in_sample": GAIN, "held_out": {}},
            "parameters": {"compliance": {"value": 3e-12, "std_error": None, "unit": "1/Pa"}},
        }
    ]
    html = page(ladder=ladder)
    assert (
        "Fits no better than loose clamp (specimen &lt;i&gt;), temperature bias (−10 °C): these tests do not say which."
        in html
    )
    assert (
        "Not certain: loose clamp of specimen &lt;i&gt; or temperature bias at −10 °C fits as well; these "
        "tests do not say which." in html
    )
    assert "loose clamp (specimen &lt;b&gt;)" in html and "<td>0.004</td>" in html


def test_without_replicates_nothing_is_called_right_or_established(page, results):
    alone = {"modulus_percent": 1.0, "phase_deg": 0.5, "specimens_percent": 3.0, "from_replicates": False}
    alone["air_voids"] = None
    assert "and what changes from one mounting to the next. Everything" in page()
    html = page(verdict="nothing_to_explain", ladder=[], tested=False, scatter=alone)
    assert (
        "cannot judge a law: nothing was found, but the scatter from test to test is not known. Test" in html
        and "fits these tests" not in html
    )
    assert (
        "is taken as 1 % of |E*| and 0.5° as far as a smooth law can tell, for nothing was repeated." in html
    )
    made = json.loads(results.diagnosis()["diagnosis"][0].read_text())["provenance"]
    stated = page(scatter=alone, provenance=made | {"scatter_stated": [0.01, 0.5]})
    assert "is taken as 1 % of |E*| and 0.5°, as was stated." in stated
    ladder = json.loads(results.diagnosis()["diagnosis"][0].read_text())["ladder"]
    unsure = [rung | {"established": False} for rung in ladder]
    html = page(verdict="unexplained_structure", ladder=unsure)
    assert '<th scope="row">Possible fault</th><td class="words"><p>Loose clamp of specimen 2, ' in html
    assert "Not certain: only 2 temperatures were tested, and certainty takes 4." in html


SURE = {
    "as_good": [],
    "established": True,
    "taken_off": 1.0,
    "hangs_on": [],
    "doubts": [],
    "probability": 0.97,
}
SURE |= {"evidence": "", "log10_shift": {}}
GAIN = {
    **dict.fromkeys(
        ("mre_E_percent", "mre_phase_percent", "rms_over_scatter"), {"before": 2.0, "after": 1.0}
    ),
    "averages_by_temperature": {
        "0": dict.fromkeys(("mre_E_percent", "mre_phase_percent"), {"before": 2.0, "after": 1.0})
    },
}


def test_without_a_cause_nothing_is_explained(page):
    html = page(verdict="nothing_to_explain", ladder=[])
    assert "nothing is left to explain" in html and "No cause is named." in html


def test_what_a_laboratory_is_to_do_stands_on_the_page(page):
    order = {
        "text": "2.5 h: test specimens A and B at -6 degC, 25 Hz.",
        "act": "test specimens A and B at -6 degC",
        "purpose": "to see",
        "why": ["It shows as 7.1 deg."],
        "hours": 2.5,
        "nats": 3.0,
        "specimens": ["A", "B"],
        "temperature_C": -6.0,
        "frequencies_Hz": [25.0],
        "half_strain": False,
    }
    suspect = {
        "specimen": "A",
        "temperature_C": 4.0,
        "frequency_Hz": 25.0,
        "status": "left out",
        "decided_by": "its own isotherm",
        "reasons": ["phase 18.8 deg +- 1"],
    }
    other = {"verdict": "explained", "causes": [{"cause": "phase_offset", "where": None}]}
    html = page(
        origin="measured",
        instructions={"costs": "Counted: 2 h.", "orders": [order]},
        suspect_tests=[suspect],
        with_suspects=other,
        trust={
            "use": 12,
            "check": 0,
            "held_back": 0,
            "not_used": 1,
            "check_at_C": [],
            "check_of": [],
            "use_by_specimen": {},
        },
    )
    assert "<b>2.5 h: test specimens A and B at −6 °C, 25 Hz.</b> It shows as 7.1°." in html
    assert "<p>12 of 13 tests can be used, 1 cannot.</p>" in html
    assert "<p>Specimen A, 4 °C, 25 Hz: phase 18.8° ± 1.</p>" in html
    assert "<p>1. Test specimens A and B at −6 °C, 25 Hz, to see (2.5 h).</p>" in html
    assert (
        "If the tests left out were kept, the diagnosis would name a phase offset and no longer name a loose "
        "clamp" in html
    )
    assert "Counted: 2 h." in html
    assert "<td>phase 18.8° ± 1</td>" in html  # among the details too


def test_the_scatter_stands_as_coefficients_of_variation(page):
    own = {"between": {"E_percent": 12.14, "phase_deg": 1.914}, "within": None}
    found = {**own, "by_isotherm": [{"temperature_C": -10.0, **own}]}
    html = page(repeatability=found)
    assert "<td>−10 °C</td><td>12.1</td><td>1.91</td><td></td><td></td>" in html
    assert "<p>Standard deviation between specimens: 12.1 % in |E*|, 1.9° in phase.</p>" in html


def test_bond_mapping_stands_first_with_its_evidence_and_without_a_chance(page, results):
    made = json.loads(results.diagnosis()["diagnosis"][0].read_text())["ladder"]
    averages = {
        "0": {name: {"before": 10.2, "after": 2.0} for name in ("mre_E_percent", "mre_phase_percent")}
    }
    rung = {
        **SURE,
        "cause": "bond_mapping",
        "where": None,
        "p_value": None,
        "sentence": "areas do not fill",
        "evidence": "1.056 to 1.109 of the law",
        "confirmed_by": "packings",
        "parameters": {"modulus_over_law": {"value": 1.09, "std_error": None, "unit": "1"}},
        "gain": {"in_sample": {"averages_by_temperature": averages}, "held_out": {}},
    }
    html = page(ladder=[rung, *made])
    assert html.index("<b>bond mapping</b>") < html.index("<b>relaxation spectrum</b>")
    assert "Evidence: 1.056 to 1.109 of the law." in html
    assert "<td></td> <td>fitted</td><td>10.2 → 2</td><td>10.2 → 2</td><td></td>" in html
    assert (
        "with facets for bonds, a relaxation spectrum and a loose clamp of specimen 2 the simulation" in html
    )


def test_the_whole_way_stands_by_temperature(page, results):
    html = page()
    assert "run again with each rung" not in html
    assert " by 2 % in |E*| and 2 % in the phase," in html
    html = page(ladder_table=results.ladder())
    assert "the simulation misses by 0.6 % and 5 %" in html
    assert "<td>|E*|: as in the paper</td><td>10.2</td><td>12</td><td>11.1</td>" in html
    assert "<td>|E*|: facets</td><td>2</td><td>3</td><td>2.5</td>" in html
    assert "<td>|E*|: the law&#39;s own, as in the paper</td><td>2.1</td>" in html
    assert "<td>phase: scatter of one test</td><td>4</td>" in html


def test_an_isotherm_stands_with_its_unit_though_no_limit_is_known_there(page):
    needs = "other tests: in these, only an impossibly large one would show"
    html = page(not_testable=[{"cause": "temperature_bias @ -6.0", "needs": needs}])
    assert "temperature bias (\N{MINUS SIGN}6 °C)" in html
