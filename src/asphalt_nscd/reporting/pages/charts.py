"""Plots of a page: matplotlib's, inline, where every test says what it is."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from zlib import crc32

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from asphalt_nscd.diagnosis.content.doubts import LEFT_OUT
from asphalt_nscd.diagnosis.criteria import NOTABLE
from asphalt_nscd.diagnosis.written import (
    BEFORE_AFTER,
    RESIDUALS,
    conditions,
    read_causality,
    read_diagnosis,
    read_residuals,
    three_digits,
)
from asphalt_nscd.files.words import capital, counted, specimen_named
from asphalt_nscd.reporting.figures import fig_black, fig_master, fig_residual_map, panels, style
from asphalt_nscd.reporting.figures.numbers import celsius, minus
from asphalt_nscd.reporting.figures.save import figure_bytes

ElementTree.register_namespace("", "http://www.w3.org/2000/svg")
SVG, LINK = "{http://www.w3.org/2000/svg}", "{http://www.w3.org/1999/xlink}href"
BETWEEN = "§"  # the key by which charts find a test, and what is said of it
WIDTH, HEIGHT = 88.0, 66.0  # mm
HINT = (
    "Point at a test, tap it, or step through the tests with the arrow keys; Home, End and Escape work too."
)
BURGERS = "a Burgers law fitted to each temperature by itself"
NONE = "No isotherm has the four tests needed to compare modulus and phase."


@dataclass(frozen=True)
class Chart:
    """Plots that belong together, as SVG, and what they show."""

    name: str
    title: str
    caption: str
    plots: Sequence[str]
    hint: str = HINT


def charts(
    residuals: Sequence[Path],
    causality: Sequence[Path],
    diagnosis: Sequence[Path],
    curve: Sequence[Path] = (),
    corrected: Sequence[Path] = (),
) -> dict[str, Chart]:
    """By name: "law" (master curve), "specimens" (Black diagram), "causality" and "residuals" (maps)."""
    content, used = read_diagnosis(diagnosis), read_residuals(residuals)
    tests = every_test(causality, content)
    stated = content["reading"]["isotherms_C"]
    used = used.assign(isotherm_C=panels.isotherm_of(used["temperature_C"], stated))
    means = conditions(used.assign(temperature_C=used["isotherm_C"]), content["scatter"])
    master = fig_master.master(tests, used, content, curve, corrected)
    after = master.tests[["E_MPa", "phase_deg"]].to_numpy()
    words = [_words(row, own) for row, own in zip(tests.to_dict("records"), after, strict=True)]
    master = replace(master, tests=master.tests.assign(words=words))
    before = "the first simulation of the study" if "campaign" in content["numerics"] else BURGERS
    made = [
        _law(master),
        _specimens(master, means),
        _causality(master, content["scatter"]["phase_deg"]),
        _residuals(used, means, content["scatter"], before),
    ]
    return {chart.name: chart for chart in made}


def every_test(causality: Sequence[Path], content: Mapping[str, Any]) -> pd.DataFrame:
    """Tests by isotherm_C, frequency_Hz and specimen, as `read_causality` has them; filled: nothing is against it."""
    tests = read_causality(causality)
    at = panels.isotherm_of(tests["temperature_C"], content["reading"]["isotherms_C"])
    tests = tests.assign(isotherm_C=at, filled=tests["reasons"] == "")
    return tests.sort_values(["isotherm_C", "frequency_Hz", "specimen"])


def page_figure(width: float, height: float) -> tuple[Figure, Any]:
    """A figure [mm] whose letters can be read on a telephone; within `style.journal`."""
    for name in ("axes.labelsize", "legend.fontsize", "xtick.labelsize", "ytick.labelsize"):
        matplotlib.rcParams[name] = 8.5
    matplotlib.rcParams["font.size"] = 12.0  # of which the numbers of a map have 0.7
    return style.new_figure(width, height)


def curves(frames: dict[str, pd.DataFrame], label: str) -> list[str]:
    """|E*| and phase of each named curve over its column frequency_Hz, with bands, as SVG; `label` is of their axis."""
    return [_curve(frames, label, quantity) for quantity in panels.QUANTITIES]


@style.journal
def _curve(frames: dict[str, pd.DataFrame], label: str, quantity: str) -> str:
    figure, axes = page_figure(WIDTH, 1.3 * HEIGHT)
    for n, ((name, rows), (colour, marker)) in enumerate(
        zip(frames.items(), style.kinds(len(frames)), strict=True)
    ):
        look: dict[str, Any] = {
            "marker": marker,
            "markevery": (n % 5, 10),
            "markerfacecolor": "white",
            "label": name,
        }
        panels.line(axes, "frequency_Hz", quantity, rows, colour, **look)
    panels.reduced_axis(axes, label)
    panels.quantity_axis(axes, quantity)
    _legend(figure, axes.get_legend_handles_labels()[0])
    return inline(figure, f"{panels.QUANTITIES[quantity][2]} of {counted(len(frames), 'curve')}")


def _legend(figure: Figure, handles: Sequence[Any]) -> None:
    """Above the axes, in as many columns as their names leave room for."""
    columns = max(1, min(4, 44 // (4 + max(len(handle.get_label()) for handle in handles))))
    tight = {"borderpad": 0.1, "labelspacing": 0.3, "columnspacing": 1.0, "handlelength": 1.2}
    figure.legend(handles=handles, loc="outside upper left", ncols=columns, **tight)


@style.journal
def _law(master: fig_master.Master) -> Chart:
    """Master curves of |E*| and phase with their caption."""
    plots = []
    for quantity, name in (("E", "|E*|"), ("phase", "phase angle")):
        figure, axes = page_figure(WIDTH, HEIGHT)
        master.panel(axes, quantity)
        panels.isotherm_legends(figure, master.keys("test"), master.isotherms)
        plots.append(inline(figure, f"{name}, {counted(len(master.tests), 'test')}"))
    caption = f"{capital(master.points)}."
    if master.mix is not None:
        caption += (
            " The mix: without established causes, the mean with possible ones and without; reported.csv has its"
            " values, and its band holds what scatter, specimens and causes leave open."
        )
    if master.law is not None:
        caption += " The law of few parameters is law.json, fitted to the same tests for other programs."
    if not master.shift:
        caption += " No law common to all temperatures was taken, so there are no shift factors."
    return Chart("law", "Master curve" if master.shift else "Isotherms", caption, plots)


@style.journal
def _specimens(master: fig_master.Master, means: pd.DataFrame) -> Chart:
    """The Black diagram and |E*| over reduced frequency, points marked by specimen."""
    tests, mix = master.tests.assign(group=master.tests["specimen"]), master.mix
    names = list(tests["specimen"].unique())
    looks = dict(zip(names, style.kinds(len(names)), strict=True))

    def black(axes: Any) -> None:
        fig_black.black(axes, tests, means, looks, fig_black.AFTER if mix is None else {})
        if mix is not None:
            axes.plot(mix["phase_deg"], mix["E_MPa"] * 1e-3, color=style.INK, lw=1.0, zorder=2)

    plots = []
    for title, draw in (
        ("Black diagram", black),
        ("|E*|", lambda axes: _draw_specimens(axes, master, looks)),
    ):
        figure, axes = page_figure(WIDTH, HEIGHT)
        draw(axes)
        _legend(figure, [panels.key(name, look, filled=True) for name, look in looks.items()])
        plots.append(inline(figure, f"{title}, {counted(len(tests), 'test')}"))
    where = "both diagrams" if master.shift else "the Black diagram"
    line = "modelled with all named causes, an isotherm each" if mix is None else "the mix"
    caption = (
        f"{capital(master.points)}. Those of one material should lie on one curve in {where}. Hollow points: not "
        f"simply used. Line in the Black diagram: {line}."
    )
    other = "master curve" if master.shift else "isotherms"
    return Chart("specimens", f"Specimens: Black diagram and {other}", caption, plots)


def _draw_specimens(axes: Any, master: fig_master.Master, looks: dict[str, tuple[Any, str]]) -> None:
    """Draw |E*| over reduced frequency, specimens by their `looks`."""
    for name, rows in master.tests.groupby("specimen"):
        panels.points(axes, rows["reduced_Hz"], rows["E_MPa"] * 1e-3, looks[str(name)], rows)
    panels.reduced_axis(axes, master.axis)
    panels.quantity_axis(axes, "E")


@style.journal
def _causality(master: fig_master.Master, scatter: float) -> Chart:
    """A map for each specimen of how far phases lie from those required; `scatter` is that of one phase [deg]."""
    tests = master.tests
    error = np.hypot(tests["std_error_deg"], scatter)
    excess = (tests["phase_deg"] - tests["phase_required_deg"]) / error
    tests = tests.assign(value=excess).dropna(subset="value")
    plots = []
    for name, own in tests.groupby("specimen", sort=False):
        # Amplitudes share a cell, which shows the worst.
        worst = own.sort_values("value", key=abs).drop_duplicates(
            ["temperature_C", "frequency_Hz"], keep="last"
        )
        worst = worst.sort_values(["temperature_C", "frequency_Hz"]).assign(framed=False)
        figure, axes = page_figure(WIDTH, 22.0 + 7.0 * worst["isotherm_C"].nunique())
        panels.cells(axes, worst, panels.standard_errors())
        marks = [_marks(row) for row in worst.to_dict("records")]
        panels.marked(axes, worst.assign(marks=marks))
        axes.set(xlabel="frequency (Hz)", ylabel="temperature (°C)")
        axes.set_title(capital(specimen_named(str(name))), loc="left", fontsize=9.0)
        plots.append(inline(figure, f"{specimen_named(str(name))}, {counted(len(worst), 'test')}"))
    caption = (
        f"{capital(master.points)}, in standard errors, those of one test and of the required phase, which is little "
        "known at the ends of an isotherm: beyond 3 it is hardly chance; point at a cell for the degrees. The required "
        "phase is computed from |E*| alone. The list of doubtful tests uses the phases at the other frequencies too, "
        "so its numbers differ. Cross: left out. Ring: doubtful or held back. Triangle: a quality limit is exceeded."
    )
    title = "Phase less the phase that |E*| requires, over its standard error"
    return Chart("causality", title, caption if plots else NONE, plots)


def _marks(row: Mapping[str, Any]) -> list[str]:
    suspect = [] if not row["reasons"] else ["not used" if row["status"] == LEFT_OUT else "doubtful"]
    return suspect + ["quality"] * bool(row["quality_flag"])


@style.journal
def _residuals(tests: pd.DataFrame, means: pd.DataFrame, scatter: Mapping[str, Any], before: str) -> Chart:
    """Maps of the residuals of |E*| and phase, before and after; `before` says what was modelled before."""
    plots = []
    for quantity, (name, unit) in {"E": ("|E*|", "%"), "phase": ("phase", "°")}.items():
        for when in BEFORE_AFTER:
            column = RESIDUALS[quantity].format(when)
            figure, axes = page_figure(WIDTH, 45.0)
            words = [_condition(row, tests, (name, unit, column, when)) for row in means.to_dict("records")]
            fig_residual_map.panel(axes, means.assign(words=words), quantity, when, scatter)
            axes.set(xlabel="frequency (Hz)", ylabel="temperature (°C)")
            axes.set_title(f"{name}, {when} ({unit})", loc="left", fontsize=9.0)
            plots.append(inline(figure, f"{name} {when}, {counted(len(means), 'condition')}"))
    frame = f"A frame: beyond {NOTABLE:g} standard deviations of replicates."
    caption = (
        f"Measured less modelled, means over specimens. Before: {before}. After: one law with all named causes, where "
        f"there are any. {frame}"
    )
    return Chart("residuals", "Residual map", caption, plots, HINT.replace("test", "condition"))


def _condition(row: Mapping[str, Any], tests: pd.DataFrame, shown: tuple[str, str, str, str]) -> str:
    """What a cell says: the mean residual and each specimen's; `shown` is name, unit, column and before or after."""
    name, unit, column, when = shown
    own = tests[
        (tests["isotherm_C"] == row["temperature_C"]) & (tests["frequency_Hz"] == row["frequency_Hz"])
    ]
    each = ", ".join(
        f"{one} {panels.rounded(off, '+')}" for one, off in zip(own["specimen"], own[column], strict=True)
    )
    return said(
        ("", row["temperature_C"], row["frequency_Hz"]),
        f"{celsius(row['temperature_C'])}, {row['frequency_Hz']:g} Hz: {name} measured less modelled {when}, mean "
        f"{panels.rounded(row[column], '+')} {unit}; specimens: {each}",
    )


def _words(row: Mapping[str, Any], corrected: Sequence[float]) -> str:
    """What a test says; `corrected` are its |E*| [MPa] and phase [deg] less what is established."""
    words = (
        f"{specimen_named(str(row['specimen']))}, {celsius(row['temperature_C'])}, {row['frequency_Hz']:g} Hz: "
        f"{_modulus(row['E_MPa'], row['phase_deg'])}"
    )
    if (after := _modulus(*corrected)) not in words:
        words += f", corrected {after}"
    if pd.notna(row["phase_required_deg"]):
        off = panels.rounded(row["phase_deg"] - row["phase_required_deg"], "+")
        words += f"; {off}° from what |E*| alone requires (standard error {row['std_error_deg']:.1f}°)"
    if row["reasons"]:
        words += f"; {row['status']}: {row['reasons']}"
    return said((row["specimen"], row["isotherm_C"], row["frequency_Hz"]), words)


def _modulus(modulus: float, phase: float) -> str:
    return f"|E*| {three_digits(float(modulus))} MPa, phase {minus(f'{phase:.1f}')}°"


def said(test: tuple[object, float, float], words: str) -> str:
    """What a point says: `test` is (specimen, isotherm [degC], frequency [Hz]), without a specimen a condition."""
    specimen, isotherm, frequency = test
    return f"{specimen}|{isotherm:g}|{frequency:.4g}{BETWEEN}{words}"


def inline(figure: Figure, label: str) -> str:
    """The figure as SVG for a page, with a `label` that a screen reader says; links of points become their titles."""
    for patch in (figure.patch, *(axes.patch for axes in figure.axes)):
        if patch.get_facecolor()[:3] == (1.0, 1.0, 1.0):
            patch.set_alpha(0.0)
    text = figure_bytes(figure, "svg", **{"svg.fonttype": "none"}).decode()
    # The page's own letters, and names that no other plot of the page has.
    text = re.sub(r"font-family: [^;\"]*;? ?", "", text)
    own = f"s{crc32(text.encode()):x}-"
    text = re.sub(r'(url\(|href=")#', rf"\1#{own}", text)
    root = ElementTree.fromstring(text)
    for name in ("metadata", "defs/{*}style/.."):
        for unwanted in root.findall(f"{{*}}{name}"):
            root.remove(unwanted)
    for element in root.iter():
        if element.tag == f"{SVG}a":
            _name(element)
        if LINK in element.attrib:
            element.set("href", element.attrib.pop(LINK))
        if "id" in element.attrib:
            element.set("id", own + element.attrib["id"])
    shown = {"role": "group", "aria-roledescription": "chart", "tabindex": "0", "aria-label": label}
    root.attrib = {"viewBox": root.attrib["viewBox"]} | shown
    return ElementTree.tostring(root, encoding="unicode")


def _name(link: ElementTree.Element) -> None:
    """Make of a point's link a group with a title."""
    test, _, words = link.attrib.pop(LINK).partition(BETWEEN)
    link.tag, link.attrib = f"{SVG}g", {"data-test": test}
    title = ElementTree.Element(f"{SVG}title")
    title.text = words
    link.insert(0, title)
