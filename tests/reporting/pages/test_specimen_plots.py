"""Specimens side by side: a point for each test, hollow where it is suspect; a map for each specimen."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pandas as pd
import pytest
from reporting.figures.tiny_results import Results

from asphalt_nscd.reporting.pages.specimen_plots import NONE, charts


@pytest.fixture
def results(tmp_path):
    return Results(tmp_path)


def made(results, **changes):
    found = charts(causality=results.causality(), diagnosis=results.diagnosis(**changes)["diagnosis"])
    return {chart.name: chart for chart in found}


def titles(svg, kind):
    return [
        one.find("title").text
        for one in ElementTree.fromstring(svg).iter(kind)
        if one.find("title") is not None
    ]


def test_every_test_is_a_point_of_its_specimen_and_suspects_are_hollow(results):
    chart = made(results)["specimens"]
    table = pd.read_csv(results.causality()[0], dtype={"specimen": str}, keep_default_na=False)
    assert [key[0] for key in chart.keys] == list(table["specimen"].unique()) and chart.of == "Specimens"
    for plot in chart.plots:
        points = list(ElementTree.fromstring(plot).iter("circle"))
        assert len(points) == len(table)
        hollow = [one for one in points if one.get("class") == "test"]
        assert {"suspect" in one.find("title").text for one in hollow} == {True}
        assert len(hollow) == (table["reasons"] != "").sum() > 0


def test_the_map_says_what_is_off_and_marks_what_is_not_used(results):
    chart = made(results)["causality"]
    table = pd.read_csv(results.causality()[0], dtype={"specimen": str}, keep_default_na=False)
    judged = table[table["phase_required_deg"] != ""]
    assert sum(len(titles(plot, "g")) for plot in chart.plots) == len(
        judged.drop_duplicates(["specimen", "temperature_C", "frequency_Hz"])
    )
    row = judged[(judged["reasons"] != "") & (judged["used"] == 0)].iloc[0]
    off = row["phase_deg"] - float(row["phase_required_deg"])
    [words] = [
        text
        for plot in chart.plots
        for text in titles(plot, "g")
        if f"specimen {row['specimen']}, {row['temperature_C']:g} °C, {row['frequency_Hz']:g} Hz" in text
    ]
    said = float(re.search(r"; (\S+)° from what", words).group(1).replace("\N{MINUS SIGN}", "-"))
    assert said == pytest.approx(off, abs=0.5) and (said > 0.0) == (off > 0.0)
    assert "suspect, not used" in words
    cells = [
        g
        for plot in chart.plots
        for g in ElementTree.fromstring(plot).iter("g")
        if g.findtext("title") == words
    ]
    assert cells[0].findtext("text") == f"+{off:.1f}" and cells[0].find("rect").get("fill") == "var(--more)"


def test_a_table_too_small_to_be_judged_says_so(results):
    paths = results.causality()
    table = pd.read_csv(paths[0]).assign(phase_required_deg=None, std_error_deg=None)
    table.to_csv(paths[0], index=False)
    found = {c.name: c for c in charts(paths, results.diagnosis()["diagnosis"])}
    assert found["causality"].plots == () and found["causality"].caption == NONE
    assert len(found["specimens"].plots) == 3
