"""Pages to hand on: the answer with what is to be reported, the grid of AASHTO R 84, and two figures of the study."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.words.brief import rows
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.figures import fig_black, fig_master
from asphalt_nscd.reporting.figures.style import journal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PDF = "report.pdf"
A4 = (8.27, 11.69)  # inches
CHARACTERS = 96  # in a line
LINES = 62  # on the first page
SIZE = 9.0  # points


def write_handout(folder: Path, title: str) -> Path:
    """Write report.pdf from diagnosis.json, residuals.csv and reported.csv of a folder.

    The file holds no time of day, so that the same diagnosis gives the same bytes.
    """
    from matplotlib.backends.backend_pdf import PdfPages

    diagnosis, residuals = [folder / "diagnosis.json"], [folder / "residuals.csv"]
    content = read_diagnosis(diagnosis)
    pages = [_answer(content, title), _values(pd.read_csv(folder / "reported.csv"), content)]
    pages += [drawn.draw(residuals, diagnosis) for drawn in (fig_master, fig_black)]
    # Without the time of day, so that the same diagnosis gives the same file.
    said = {"Title": title, "Creator": "asphalt-nscd", "CreationDate": None}
    with atomic_path(folder / PDF) as path, PdfPages(path, metadata=said) as pdf:
        for figure in pages:
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
def _values(table: pd.DataFrame, content: dict[str, Any]) -> Figure:
    """|E*| and phase over temperature and frequency, those beyond the tests in grey; parameters of the law."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=A4)
    axes = figure.add_axes((0.11, 0.55, 0.85, 0.38))
    axes.set_axis_off()
    axes.set_title(
        "|E*| [MPa] and phase [°] of the mix (AASHTO R 84); grey: extrapolated", fontsize=9, loc="left"
    )
    # Its first row, at 15 degC and 10 Hz, stands on the page before.
    grid = table.iloc[1:]
    temperatures, frequencies = grid["temperature_C"].unique(), grid["frequency_Hz"].unique()
    texts, colours = [], []
    for f in frequencies:
        of = grid[grid["frequency_Hz"] == f]
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
    for n, line in enumerate(textwrap.wrap(law_in_words(content), 120)):
        figure.text(0.11, 0.77 - 0.013 * n, line, size=7)
    return figure
