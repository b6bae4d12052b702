"""Two pages to hand on: the answer with what is to be reported, and the corrected tests with the curve of the mix."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.words.brief import rows
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.figures.style import journal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PDF = "report.pdf"
A4 = (8.27, 11.69)  # inches
CHARACTERS = 96  # in a line
LINES = 62  # on the first page
SIZE = 9.0  # points


def write_handout(folder: Path, title: str) -> Path:
    """Write report.pdf from diagnosis.json, corrected.csv, reported.csv and master_curve.csv of a folder.

    The file holds no time of day, so that the same diagnosis gives the same bytes.
    """
    from matplotlib.backends.backend_pdf import PdfPages

    content = read_diagnosis([folder / "diagnosis.json"])
    tables = {name: pd.read_csv(folder / f"{name}.csv") for name in ("corrected", "reported", "master_curve")}
    # Without the time of day, so that the same diagnosis gives the same file.
    said = {"Title": title, "Creator": "asphalt-nscd", "CreationDate": None}
    with atomic_path(folder / PDF) as path, PdfPages(path, metadata=said) as pdf:
        for figure in (_answer(content, title), _curves(tables, content)):
            pdf.savefig(figure)
    return folder / PDF


@journal
def _answer(content: dict[str, Any], title: str) -> Figure:
    """The answer in words, as the command line gives it, below what standards ask for."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=A4)
    lines = [*textwrap.wrap(title, CHARACTERS), "", *_asked_for(content["reported"]), ""]
    for label, sentences in rows(content):
        for n, sentence in enumerate(sentences):
            # 16 characters at the left are for the label.
            wrapped = textwrap.wrap(sentence, CHARACTERS - 16) or [""]
            lines += [f"{label if n == k == 0 else '':<16}{line}" for k, line in enumerate(wrapped)]
    if len(lines) > LINES:
        lines = [*lines[: LINES - 2], "", "More in diagnosis.html."]
    made = content["provenance"]
    commit = made["git_commit"][:10]
    lines += [
        "",
        f"asphalt-nscd, commit {commit}, tests from {made['measurements']}; +- is the 95 % interval.",
    ]
    for n, line in enumerate(lines):
        figure.text(
            0.08,
            0.95 - n * 0.0142,
            line,
            family="monospace",
            size=SIZE if n else SIZE + 2,
            weight="bold" if n == 0 else None,
        )
    return figure


def _asked_for(value: dict[str, Any]) -> list[str]:
    there = "" if value["within_the_tests"] else "; extrapolated, no test was made near it"
    return [
        f"|E*|(15 degC, 10 Hz) = {value['E_MPa']:.0f} MPa, 95 % interval {value['E_low_MPa']:.0f} to "
        f"{value['E_high_MPa']:.0f} MPa{there}",
        f"phase(15 degC, 10 Hz) = {value['phase_deg']:.1f} deg, 95 % interval {value['phase_low_deg']:.1f} to "
        f"{value['phase_high_deg']:.1f} deg (of the mix, after the corrections)",
    ]


def law_in_words(content: dict[str, Any]) -> str:
    """Parameters of law.json with their 95 % intervals, as a sentence; empty where there is no law."""
    if "law_parameters" not in content:
        return ""
    (title,) = (one["title"] for one in content["laws"] if one["taken"])
    said = ", ".join(
        f"{key} = {one['value']:.4g}"
        + (" ({:.4g} to {:.4g})".format(*one["interval_95"]) if one["interval_95"] else "")
        for key, one in content["law_parameters"].items()
    )
    return f"law.json, {title}, parameters and 95 % intervals: {said}."


@journal
def _curves(tables: dict[str, pd.DataFrame], content: dict[str, Any]) -> Figure:
    """Corrected tests on the curve of the mix with its 95 % band, Black diagram, and the grid of AASHTO R 84."""
    from matplotlib.figure import Figure

    tests, curve = tables["corrected"], tables["master_curve"]
    used = tests[tests["status"] == "used"]
    figure = Figure(figsize=A4)
    grid = figure.add_gridspec(
        3, 2, height_ratios=(1.0, 1.0, 0.9), left=0.11, right=0.96, top=0.95, bottom=0.06, hspace=0.32
    )
    across = f"frequency at {curve['temperature_C'].iloc[0]:g} °C [Hz]"
    for place, name, label, scale in (
        (grid[0, :], "E", "|E*| [MPa]", "log"),
        (grid[1, 0], "phase", "phase [°]", "linear"),
    ):
        unit = "MPa" if name == "E" else "deg"
        axes = figure.add_subplot(place)
        axes.fill_between(
            curve["frequency_Hz"],
            curve[f"{name}_low_{unit}"],
            curve[f"{name}_high_{unit}"],
            color="0.8",
            label="95 %",
        )
        axes.plot(curve["frequency_Hz"], curve[f"{name}_{unit}"], color="black", linewidth=0.8, label="mix")
        if f"law_{name}_{unit}" in curve:
            of_law = [f"law_{name}_{part}{unit}" for part in ("", "low_", "high_")]
            for column, said, style in zip(
                of_law, ("law.json", "its 95 %", ""), ("--", ":", ":"), strict=True
            ):
                if column in curve:
                    axes.plot(
                        curve["frequency_Hz"],
                        curve[column],
                        style,
                        color="C3",
                        linewidth=0.7,
                        label=said or None,
                    )
        # Readings of an isotherm differ by tenths, and share one entry of the legend.
        for temperature, those in used.groupby(used["temperature_C"].round()):
            axes.plot(
                those["reduced_frequency_Hz"],
                those[f"{name}_{unit}"],
                ".",
                markersize=4,
                label=f"{temperature:g} °C",
            )
        axes.set(xscale="log", yscale=scale, xlabel=across, ylabel=label)
        if name == "E":
            axes.legend(ncols=2, fontsize=7, frameon=False)
    black = figure.add_subplot(grid[1, 1])
    black.plot(used["phase_deg"], used["E_MPa"], ".", markersize=4, color="C0")
    black.plot(curve["phase_deg"], curve["E_MPa"], color="black", linewidth=0.8)
    black.set(yscale="log", xlabel="phase [°]", ylabel="|E*| [MPa]")
    # Its first row, at 15 degC and 10 Hz, stands on the page before.
    _grid_of_values(figure.add_subplot(grid[2, :]), tables["reported"].iloc[1:])
    for n, line in enumerate(textwrap.wrap(law_in_words(content), 130)):
        figure.text(0.06, 0.055 - 0.013 * n, line, size=7)
    return figure


def _grid_of_values(axes: Any, table: pd.DataFrame) -> None:
    """|E*| and phase over temperature and frequency; those beyond the tests in grey."""
    axes.set_axis_off()
    axes.set_title(
        "|E*| [MPa] and phase [°] of the mix (AASHTO R 84); grey: extrapolated", fontsize=9, loc="left"
    )
    temperatures = table["temperature_C"].unique()
    frequencies = table["frequency_Hz"].unique()
    texts, colours = [], []
    for f in frequencies:
        of = table[table["frequency_Hz"] == f]
        texts.append([f"{e:.0f} +- {np.sqrt(high / low) - 1:.0%}; {p:.1f}" for e, low, high, p in
                      zip(of["E_MPa"], of["E_low_MPa"], of["E_high_MPa"], of["phase_deg"], strict=True)])  # fmt: skip
        colours.append(["black" if there else "0.6" for there in of["within_the_tests"]])
    made = axes.table(
        texts,
        rowLabels=[f"{f:g} Hz" for f in frequencies],
        colLabels=[f"{t:g} °C" for t in temperatures],
        loc="upper center",
    )
    made.auto_set_font_size(False)
    made.set_fontsize(7)
    for (row, column), cell in made.get_celld().items():
        cell.set_linewidth(0.3)
        if row and column >= 0:
            cell.get_text().set_color(colours[row - 1][column])
