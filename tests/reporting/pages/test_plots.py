"""Plots of a page: every test is a point that says what it is, in its place."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from reporting.figures.tiny_results import Results

from asphalt_nscd.reporting.pages.plots import charts


@pytest.fixture
def results(tmp_path):
    return Results(tmp_path)


def made(results, **changes):
    return {chart.name: chart for chart in charts(**results.diagnosis(**changes))}


def circles(svg):
    """Title and place (n, 2) of each test."""
    found = [c for c in ElementTree.fromstring(svg).iter("circle")]
    return [c.find("title").text for c in found], np.array(
        [[float(c.get(k)) for k in ("cx", "cy")] for c in found]
    )


def test_each_test_says_specimen_temperature_frequency_and_what_is_left(results):
    black = made(results)["black"]
    titles, _ = circles(black.plots[0])
    assert len(titles) == 12 and len(set(titles)) == 12
    table = pd.read_csv(results.folder / "residuals.csv")
    row = table[
        (table["specimen"] == 2) & (table["temperature_C"] == 20.0) & (table["frequency_Hz"] == 3.0)
    ].iloc[0]
    assert (
        f"specimen 2, 20 °C, 3 Hz: |E*| {float(f'{row.E_MPa:.3g}'):.10g} MPa, phase {row.phase_deg:.1f}°; "
        "measured less modelled +1.0 %, +0.0°" in titles
    )
    assert [key[0] for key in black.keys] == ["0 °C", "20 °C"]


def test_points_lie_where_their_values_are(results):
    titles, at = circles(made(results)["black"].plots[0])
    numbers = np.array(
        [[float(x) for x in re.search(r"\|E\*\| (\S+) MPa, phase (\S+)°", t).groups()] for t in titles]
    )
    across, up = np.polyfit(numbers[:, 1], at[:, 0], 1), np.polyfit(np.log(numbers[:, 0]), at[:, 1], 1)
    assert across[0] > 0.0 > up[0]  # to the right with the phase, upwards with |E*|
    assert np.abs(np.polyval(across, numbers[:, 1]) - at[:, 0]).max() < 1.0
    assert np.abs(np.polyval(up, np.log(numbers[:, 0])) - at[:, 1]).max() < 1.0


def test_master_curve_shifts_cold_tests_to_high_frequency(results):
    master = made(results)["master"]
    titles, at = circles(master.plots[0])
    cold, warm = ([x for t, (x, _) in zip(titles, at) if f", {c} °C, 3 Hz" in t][0] for c in (0, 20))
    one, ten = ([x for t, (x, _) in zip(titles, at) if f", 20 °C, {f} Hz" in t][0] for f in (3, 10))
    assert (cold - warm) / (ten - one) == pytest.approx(2.0 / np.log10(10.0 / 3.0), rel=0.02)
    assert master.title == "Master curve" and "reduced frequency (Hz), at 20 °C" in master.plots[0]


def test_without_a_common_law_there_are_isotherms_only(results):
    master = made(results, ladder=[])["master"]
    assert master.title == "Isotherms" and "reduced" not in master.plots[0]
    assert "no shift factors" in master.caption


def test_tests_near_an_isotherm_belong_to_it_and_keep_their_temperature(results):
    given = results.diagnosis()
    table = pd.read_csv(given["residuals"][0])
    table["temperature_C"] += np.where(table.index == 0, 0.2, 0.0)
    table.to_csv(given["residuals"][0], index=False)
    found = {chart.name: chart for chart in charts(**given)}
    assert "specimen 1, 0.2 °C, 3 Hz" in found["master"].plots[0] and "nan" not in found["master"].plots[0]
    assert len(found["black"].keys) == 2
    assert found["residuals"].plots[0].count("<title>") == 6


def test_cells_of_the_map_have_the_sign_and_the_size_of_the_residual(results):
    before, after = (ElementTree.fromstring(svg) for svg in made(results)["residuals"].plots[:2])
    strength = {}
    for svg, when in ((before, "before"), (after, "after")):
        for cell in svg.iter("g"):
            if "20 °C, 3 Hz" in (cell.findtext("title") or ""):
                strength[when] = float(cell.find("rect").get("fill-opacity"))
                assert "more" in cell.find("rect").get("fill")
    assert strength["before"] == pytest.approx(20.0 * strength["after"], rel=0.15)
    words = next(c.find("title").text for c in before.iter("g") if "20 °C, 3 Hz" in c.find("title").text)
    assert words.endswith("before, mean +20 %; specimens: 1 +20, 2 +20")
