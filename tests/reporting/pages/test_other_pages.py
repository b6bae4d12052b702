"""Parts of pages by hand: cells of several mixes, of a law, of the first page; tests without a phase on their curve."""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from reporting.figures.tiny_results import band_of

from asphalt_nscd.diagnosis.words.sentences import estimate
from asphalt_nscd.reporting.pages import comparison, diagnosis_page, first_page, handout, stiffness_page
from asphalt_nscd.reporting.settings import Heading

BOUNDS = {"E_MPa": 9000.4, "E_low_MPa": 8000.0, "E_high_MPa": 10000.0, "phase_deg": 20.0}
BOUNDS |= {"phase_low_deg": 19.0, "phase_high_deg": 21.5, "temperature_C": 15.0, "frequency_Hz": 10.0}


@pytest.fixture
def table():
    """The stiffest stands alone, two others are not told apart."""
    rows = [
        {"mix": "a/b", "test": "bending", "rank_low": 1, "rank_high": 1, "causes": "channel delay"},
        {"mix": "c", "test": "unknown", "rank_low": 2, "rank_high": 3, "causes": ""},
        {"mix": "d <b>", "test": "bending", "rank_low": 2, "rank_high": 3, "causes": ""},
    ]
    own = {
        "tests": 24,
        "check_first": 6,
        "left_out": 1,
        "possible_causes": "temperature bias at 40 degC (68 %)",
    }
    return pd.DataFrame(rows).assign(**BOUNDS, **own)


def written(path, table, apart=True):
    curve = pd.concat([pd.DataFrame(BOUNDS, [0, 1]).assign(mix=mix, frequency_Hz=[1, 9]) for mix in "ac"])
    where = [
        table.assign(temperature_C=t, asked_for=word) for t, word in ((15.0, "stiffness"), (30.0, "creep"))
    ]
    off = {"mix": "c", "than": "a/b", "stiffer_percent": -12.4, "stiffer_low_percent": -29.0}
    off |= {"temperature_C": 15.0, "frequency_Hz": 10.0, "stiffer_high_percent": -0.3, "told_apart": apart}
    comparison.write_page(path, table, curve, (pd.concat(where), pd.DataFrame([off])), "One\nTwo")
    return path.read_text(encoding="utf-8")


def rows_of(page):
    return [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row) for row in re.findall(r"<tr>(.*?)</tr>", page)]


def test_mixes_stand_with_rank_interval_and_causes(tmp_path, table):
    page = written(tmp_path / "page.html", table)
    rows = {row[0]: row[1:] for row in rows_of(page) if len(row) == len(comparison.HEAD)}
    ends = ["9000", "8000 to 10000", "20.0", "19.0 to 21.5", "24", "6", "1"]
    possible = "temperature bias at 40 °C (68 %)"
    assert rows['<a href="a-b/diagnosis.html">a/b</a>'] == ["bending", "1", *ends, "channel delay", possible]
    assert rows['<a href="c/diagnosis.html">c</a>'] == ["not said", "2 to 3", *ends, "none", possible]
    assert "Stiffest at 15 °C and 10 Hz: a/b, 9000 MPa (95 % interval 8000 to 10000)." in page
    assert "<h2>The machine</h2><p>One</p><p>Two</p>" in page and "Mixes at 15 °C" in page
    both = table.assign(rank_low=[1, 1, 2])
    said = "Stiffest at 15 °C and 10 Hz: one of a/b and c, which these tests do not tell apart."
    assert said in written(tmp_path / "page.html", both)


def test_conditions_and_differences_stand_by_what_is_asked_for(tmp_path, table):
    page = written(tmp_path / "page.html", table)
    rows = rows_of(page)
    assert ["mix", "15 °C, 10 Hz: stiffness", "30 °C, 10 Hz: creep"] in rows
    assert ["c", "9000 (8000 to 10000)", "9000 (8000 to 10000)"] in rows
    off = "−12 % (−29 to +0)"
    assert ["c over a/b", f"<b>{off}</b>"] in rows
    assert ["c over a/b", off] in rows_of(written(tmp_path / "page.html", table, apart=False))


def test_tests_without_a_phase_lie_on_their_curve(tmp_path, monkeypatch):
    """|E*| of 100 f^0.3 MPa at 20 degC, at 0 degC as at hundred times the frequency."""
    figures = []
    monkeypatch.setattr(stiffness_page, "inline", lambda figure, label: figures.append(figure) or "")
    size = 100.0 * np.array([0.1, 1e4]) ** 0.3
    curve = {"temperature_C": 20.0, "frequency_Hz": [0.1, 1e4], "E_MPa": size}
    curve |= {"E_low_MPa": 0.9 * size, "E_high_MPa": 1.1 * size}
    pd.DataFrame(curve).to_csv(tmp_path / "master_curve.csv", index=False)
    rows = [
        ("01", at, at + 0.4, f, f * by, 100 * (f * by) ** 0.3, -1.26)
        for at, by in ((0.0, 100.0), (20.0, 1.0))
        for f in (1.0, 10.0)
    ]
    names = ["specimen", "isotherm_C", "temperature_C", "frequency_Hz", "reduced_frequency_Hz", "E_MPa"]
    pd.DataFrame(rows, columns=[*names, "residual_percent"]).to_csv(
        tmp_path / "stiffness_residuals.csv", index=False
    )
    html = stiffness_page.write_page(tmp_path, "title", [("Law", "At 4 degC.")]).read_text(encoding="utf-8")
    assert '<th scope="row">Law</th><td class="words">At 4 °C.</td>' in html
    (axes,) = figures[0].axes
    np.testing.assert_allclose(axes.lines[0].get_data(), [[0.1, 1e4], 1e-3 * size])
    np.testing.assert_allclose(band_of(axes), [[0.1, 1e4], 0.9e-3 * size, 1.1e-3 * size])
    for points, own in zip(axes.collections[1:], (rows[:2], rows[2:]), strict=True):
        np.testing.assert_allclose(points.get_offsets(), [(row[4], 1e-3 * row[5]) for row in own])
    told = axes.collections[1].get_urls()[0]
    assert told == "01|0|1§specimen 01, 0.4 °C, 1 Hz: |E*| 398.1 MPa, -1.3 % off the curve"
    assert axes.get_xlabel() == "reduced frequency (Hz), at 20 °C" and axes.get_ylabel() == "|E*| (GPa)"
    assert [text.get_text() for text in figures[0].legends[1].get_texts()] == ["0 °C", "20 °C"]


def test_parts_of_the_report_to_hand_on():
    """How many tests the values rest on, cells of the result, and what was tested."""
    assert handout._resting_on({"use": 20, "check": 5, "held_back": 2}).endswith(
        "on 23 tests, 3 of them doubtful."
    )
    assert handout._resting_on({"use": 20, "check": 2, "held_back": 2}) == ""
    row = SimpleNamespace(**BOUNDS, within_the_tests=True)
    assert handout._interval(row) == "9000\n8000 to 10000\n20.0 deg (19.0 to 21.5)"
    row.within_the_tests = False
    assert handout._interval(row).startswith("9000 *\n")
    row.E_MPa = np.nan
    assert handout._interval(row) == "not known"
    reading = {"test_type": "bending", "isotherms_C": [-10.0, 4.5], "specimens": ["A", "B"]}
    content = {"reading": reading, "tests": 11, "trust": {"not_used": 2}}
    voids = {"lowest_percent": 4.0, "highest_percent": 6.5}
    told = dict(handout._tested(content | {"scatter": {"air_voids": voids}}, Heading(mix="AC 16")))
    assert told.pop("Kind of test").startswith("Two-point bending")
    assert told == {
        "Mix": "AC 16", "Specimens": "A, B", "Air voids": "4 to 6.5 %", "Temperatures": "-10, 4.5 degC", "Tests": "13",
    }  # fmt: skip


def test_a_law_stands_in_units_of_use():
    parameters = {
        "E_glassy_Pa": {"value": 3.14159e10, "interval_95": [2e10, 4e10], "determined": True},
        "E_static_Pa": {"value": 1.5e8, "interval_95": None, "determined": False},
        "activation_energy_J_mol": {"value": 2e5, "interval_95": None, "determined": True},
        "k": {"value": 0.25, "interval_95": None, "determined": True},
    }
    laws = [
        {"title": "CAM", "taken": False, "parameters": 5, "mre_E_percent": 3.0, "off_phase_deg": 1.234},
        {"title": "2S2P1D", "taken": True, "parameters": 9, "mre_E_percent": 1.0, "off_phase_deg": np.nan},
    ]
    made = diagnosis_page.law({"law_parameters": parameters, "laws": laws})
    assert made["title"] == "2S2P1D"
    assert made["laws"] == [["CAM", "5", "3", "1.23"], ["2S2P1D, in law.json", "9", "1", ""]]
    assert made["parameters"] == [
        ["E glassy", "31.4", "20 to 40", "GPa", "yes"],
        ["E static", "150", "", "MPa", "no"],
        ["activation energy", "200", "", "kJ/mol", "yes"],
        ["k", "0.25", "", "", "yes"],
    ]
    assert diagnosis_page.law({"law_parameters": {}}) is None


def test_rows_of_a_rung_by_hand():
    """Sizes are widened as the scatter is, but not that of the bonds; errors are means over temperatures."""
    pair = {"before": 8.0, "after": 2.0}
    each = {
        t: {"mre_E_percent": pair | {"after": float(t)}, "mre_phase_percent": pair, "off_phase_deg": pair}
        for t in "123"
    }
    gain = {"averages_by_temperature": each, "rms_over_scatter": {"before": 3.0, "after": 1.0}}
    held = {"leave_one_isotherm_out": {"averages_by_temperature": each | {"9": each["3"]}}}
    one = {"value": 2.0, "std_error": 0.5, "unit": "1"}
    rung = {"cause": "x_y", "where": None, "parameters": {"a_b": one}, "p_value": 9e-7}
    rung["gain"] = {"in_sample": gain, "held_out": held}
    for cause, p, said in (
        ("x_y", 9e-7, "below 1e-06"),
        ("bond_mapping", 1.1e-6, "1e-06"),
        ("x_y", None, ""),
    ):
        first, second = diagnosis_page._rows(rung | {"cause": cause, "p_value": p}, 2.0)
        by = 1.0 if cause == "bond_mapping" else 2.0
        assert first[1:] == [f"a b {estimate(one, by)}", said, "fitted", "8 → 2", "8 → 2", "3 → 1"]
        assert second[3:] == [diagnosis_page.HELD_OUT["leave_one_isotherm_out"], "8 → 2.5", "8 → 2", ""]


def test_ranges_and_numbers_of_the_first_page():
    assert first_page._range(pd.Series([3.0, 12.345678])) == "3 to 12.35"
    assert first_page._range(pd.Series([4.0, 4.0])) == "4" and first_page._number(14160.4) == "14160"
