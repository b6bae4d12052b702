"""Plots of a page: matplotlib's, where every test is a point that says what it is, in its place."""

from __future__ import annotations

import json
import re
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from reporting.figures.tiny_results import Results

from asphalt_nscd.files.store import write_table
from asphalt_nscd.reporting.pages.charts import NONE, charts

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def results(tmp_path):
    return Results(tmp_path)


def made(results, **changes):
    """Residuals and causality of the same tests, 4 degC of the latter nearest to the isotherm of 0."""
    return charts(**results.diagnosis(**changes), causality=results.causality())


def told(svg):
    """Title of each point, place (n, 2) of its middle, its fill and its key."""
    points = [g for g in ElementTree.fromstring(svg).iter(f"{SVG}g") if "data-test" in g.attrib]
    marks = [next(one for one in g.iter() if "style" in one.attrib) for g in points]
    return [g.findtext(f"{SVG}title") for g in points], np.array([_middle(one) for one in marks]), marks


def _middle(mark):
    if mark.tag == f"{SVG}use":
        return float(mark.get("x")), float(mark.get("y"))
    corners = np.array([[float(x) for x in pair] for pair in re.findall(r"[ML] (\S+) (\S+)", mark.get("d"))])
    return (corners.min(axis=0) + corners.max(axis=0)) / 2.0


def test_points_lie_where_their_values_are_and_hollow_ones_are_suspect(results):
    chart = made(results)["specimens"]
    table = pd.read_csv(results.causality()[0], keep_default_na=False)
    titles, at, marks = told(chart.plots[0])
    assert len(titles) == len(set(titles)) == len(table)
    numbers = np.array(
        [[float(x) for x in re.search(r"\|E\*\| (\S+) MPa, phase (\S+)°", t).groups()] for t in titles]
    )
    across, up = np.polyfit(numbers[:, 1], at[:, 0], 1), np.polyfit(np.log(numbers[:, 0]), at[:, 1], 1)
    assert across[0] > 0.0 > up[0]  # to the right with the phase, upwards with |E*|
    assert np.abs(np.polyval(across, numbers[:, 1]) - at[:, 0]).max() < 1.0
    assert np.abs(np.polyval(up, np.log(numbers[:, 0])) - at[:, 1]).max() < 1.0
    hollow = ["fill: #ffffff" in mark.get("style") for mark in marks]
    assert (
        hollow == ["; left out: " in t or "; doubtful: " in t for t in titles]
        and sum(hollow) == (table["reasons"] != "").sum()
    )


def test_the_law_and_its_band_stand_among_the_tests_on_frequency_times_shift_factor(results, tmp_path):
    values = {"E_MPa": 1e3, "phase_deg": 20.0}
    curve = {"temperature_C": 20.0, "frequency_Hz": np.geomspace(0.1, 2000.0, 20)}
    for name, value in values.items():
        stem, unit = name.split("_")
        curve |= {name: value, f"{stem}_low_{unit}": 0.9 * value, f"{stem}_high_{unit}": 1.1 * value}
        curve[f"law_{name}"] = 0.5 * value
    write_table(tmp_path / "curve.csv", pd.DataFrame(curve))
    chart = charts(**results.diagnosis(), causality=results.causality(), curve=[tmp_path / "curve.csv"])[
        "law"
    ]
    assert chart.title == "Master curve" and all(plot.count("FillBetween") == 1 for plot in chart.plots)
    # The line is the mix, of which the reported values are, and the law is dashed beside it.
    assert all("the mix, 95 % band" in plot and "law of few parameters" in plot for plot in chart.plots)
    titles, at, _ = told(chart.plots[0])
    cold, warm = ([x for t, (x, _) in zip(titles, at) if f", {c} °C, 1 Hz" in t][0] for c in (4, 21))
    one, ten = ([x for t, (x, _) in zip(titles, at) if f", 21 °C, {f} Hz" in t][0] for f in (1, 10))
    assert (cold - warm) / (ten - one) == pytest.approx(2.0, rel=0.01)  # decades of the shift
    assert "reduced frequency (Hz), at 20 °C" in chart.plots[0]


def test_without_a_common_law_there_are_isotherms_only(results):
    found = made(results, ladder=[])
    law = found["law"]
    assert law.title == "Isotherms" and "reduced" not in law.plots[0] and "no shift factors" in law.caption
    # Of a decade and a bit the axis bears more than one number.
    assert all(f">{n}</text>" in law.plots[1] for n in (0.1, 1, 10))
    assert "reduced" not in found["specimens"].plots[1] and "the Black diagram." in found["specimens"].caption


def test_a_free_master_curve_has_shift_factors_where_no_rung_names_it_and_tests_less_what_is_established(
    results, tmp_path
):
    tests = pd.read_csv(results.causality()[0], dtype={"specimen": str})
    delay = 3.0 * tests["frequency_Hz"] / 25.0
    corrected = tests.assign(
        nominal_temperature_C=tests["temperature_C"],
        phase_deg=(tests["phase_deg"] - delay).where(tests["status"] != "left out"),
        reduced_frequency_Hz=tests["frequency_Hz"] * np.where(tests["temperature_C"] == 4.0, 100.0, 1.0),
        corrected_for="channel_delay",
    )
    write_table(tmp_path / "corrected.csv", corrected)
    found = charts(
        **results.diagnosis(
            ladder=[],
            reading=json.loads(results.diagnosis()["diagnosis"][0].read_text())["reading"]
            | {"isotherms_C": [4.0, 21.0]},
        ),
        causality=results.causality(),
        corrected=[tmp_path / "corrected.csv"],
    )
    law = found["law"]
    assert law.title == "Master curve" and "no shift factors" not in law.caption
    assert all(
        "Tests less the channel delay" in found[name].caption for name in ("law", "specimens", "causality")
    )
    assert all(
        "reduced frequency (Hz), at 21 °C" in plot for plot in (*law.plots, found["specimens"].plots[1])
    )
    titles, at, _ = told(law.plots[1])
    place = dict(zip(titles, at))
    cold, warm = (next(x for t, (x, _) in place.items() if f", {c} °C, 1 Hz" in t) for c in (4, 21))
    one, ten = (next(x for t, (x, _) in place.items() if f", 21 °C, {f} Hz" in t) for f in (1, 10))
    assert (cold - warm) / (ten - one) == pytest.approx(2.0, rel=0.01)
    # 20 deg less 3 deg at 25 Hz lie below 20 deg less 0.12 deg at 1 Hz.
    slow, fast = (
        next(y for t, (_, y) in place.items() if f"specimen 2, 21 °C, {f} Hz" in t) for f in (1, 25)
    )
    assert fast > slow
    assert any(", corrected |E*|" in t and "phase 17.0°" in t for t in titles)


def test_cells_say_the_residual_and_have_its_colour(results):
    before, after = made(results)["residuals"].plots[:2]
    words, _, marks = told(before)
    assert (
        len(words) == 6
        and "20 °C, 3 Hz: |E*| measured less modelled before, mean +20 %; specimens: 1 +20, 2 +20" in words
    )
    fill = [mark.get("style") for mark in marks]
    assert fill[words.index(next(w for w in words if "20 °C, 3 Hz" in w))] != fill[0]
    words, _, marks = told(after)  # 1 % at 20 degC and nothing at 0 degC
    assert len({mark.get("style") for mark in marks}) == 2 and "mean +1.0 %" in words[-1]


def test_the_map_of_a_specimen_says_what_is_off_and_marks_what_is_not_used(results):
    chart = made(results)["causality"]
    table = pd.read_csv(results.causality()[0], keep_default_na=False)
    row = table[(table["reasons"] != "") & (table["status"] == "left out")].iloc[0]
    [words] = [t for plot in chart.plots for t in told(plot)[0] if "; left out: " in t]
    said = float(re.search(r"; (\S+)° from what", words).group(1).replace("\N{MINUS SIGN}", "-"))
    assert said == pytest.approx(row["phase_deg"] - float(row["phase_required_deg"]), abs=0.05)
    assert len(chart.plots) == table["specimen"].nunique()
    # In the cell the excess over its error: of the required phase, and of one test (0.5 deg).
    off = row["phase_deg"] - float(row["phase_required_deg"])
    number = off / np.hypot(float(row["std_error_deg"]), 0.5)
    shown = f"{number:.{0 if abs(number) >= 9.95 else 1}f}".replace("-", "\N{MINUS SIGN}")
    assert any(words in plot and f">{shown}</text>" in plot for plot in chart.plots)


def test_a_table_too_small_to_be_judged_says_so(results):
    paths = results.causality()
    table = pd.read_csv(paths[0]).assign(phase_required_deg=None, std_error_deg=None)
    table.to_csv(paths[0], index=False)
    chart = charts(**results.diagnosis(), causality=paths)["causality"]
    assert not chart.plots and chart.caption == NONE


def test_no_name_of_an_element_is_given_twice(results):
    every = [plot for chart in made(results).values() for plot in chart.plots]
    names = [name for plot in every for name in re.findall(r' id="([^"]+)"', plot)]
    assert len(names) == len(set(names)) > 0
    for plot in every:
        assert set(re.findall(r'(?:url\(|href=")#([^)"]+)', plot)) <= set(re.findall(r' id="([^"]+)"', plot))
