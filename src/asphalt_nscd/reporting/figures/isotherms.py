"""Isotherms of |E*| and phase: measurement, simulation and Burgers law (Figs. 9 and 10)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.tables import averages, origin_of, read_measured, read_tests
from asphalt_nscd.measurements.twopoint import norm_and_phase
from asphalt_nscd.reporting.figures import numbers, style
from asphalt_nscd.rheology.laws_io import read_law

Modulus = Callable[[np.ndarray], np.ndarray]
AXIS = {"E_MPa": "|E*| (GPa)", "phase_deg": "phase angle (°)"}
SHOWN_PER_UNIT = {"E_MPa": 1e-3, "phase_deg": 1.0}
APART = 1.025  # factor on the frequency, so that measured and simulated points do not hide each other


def figure_of(column: str) -> Callable[..., Figure]:
    """The function that draws isotherms of `column`, "E_MPa" or "phase_deg": means over samples, laws as lines."""

    @style.journal
    def draw(simulations: list[Path], measured: list[Path], laws: list[Path]) -> Figure:
        tests, data = read_tests(simulations), read_measured(measured)
        burgers = {read_json(path)["temperature_C"]: read_law(path).complex_modulus for path in laws}
        temperatures = sorted(tests["temperature_C"].unique())
        figure, axes = style.new_figure(style.SINGLE, 92.0)
        shown = data[data["temperature_C"].isin(temperatures)]
        frequencies = np.unique(np.concatenate([tests["frequency_Hz"], shown["frequency_Hz"]]))
        panel(axes, column, (tests, data), temperatures, frequencies, burgers)
        if column == "E_MPa":
            axes.set_yscale("log")
            style.plain_log_axis(axes.yaxis)
        else:
            # From zero, unless a phase is below it.
            axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
        handles = keys(shown, tests, bool(burgers))
        figure.legend(handles=handles, loc="outside upper left", ncols=1, borderpad=0.1, labelspacing=0.3)
        last = averages(tests).sort_values("frequency_Hz").groupby("temperature_C")[column].last()
        ends = [last[t] * SHOWN_PER_UNIT[column] for t in temperatures]
        colours = [colour for colour, _ in style.series(len(temperatures))]
        names = [numbers.celsius(t) for t in temperatures]
        style.label_ends(axes, tests["frequency_Hz"].max() * APART, ends, names, colours)
        return figure

    return draw


def panel(
    axes: Axes,
    column: str,
    tables: tuple[pd.DataFrame, pd.DataFrame],
    temperatures: list[float],
    frequencies: np.ndarray,
    laws: Mapping[float, Modulus],
) -> None:
    """Draw isotherms: means of simulated and of measured tests (`tables`) with their spread; laws by temperature."""
    simulated, reference = map(averages, tables)
    for temperature, (colour, marker) in zip(temperatures, style.series(len(temperatures)), strict=True):
        points = simulated[simulated["temperature_C"] == temperature]
        known = reference[reference["temperature_C"] == temperature]
        if temperature in laws:
            law_line(axes, column, laws[temperature], (frequencies[0], frequencies[-1]), colour)
        error_bars(axes, column, known, 1.0 / APART, marker, colour, filled=False)
        error_bars(axes, column, points, APART, marker, colour, filled=True)
    style.frequency_axis(axes, frequencies)
    axes.set_ylabel(AXIS[column])


def law_line(
    axes: Axes, column: str, modulus: Modulus, limits: tuple[float, float], colour: Any, **look: Any
) -> None:
    """Draw `column` ("E_MPa" or "phase_deg") of a law, E* [Pa] of omega, as a line between two frequencies [Hz]."""
    frequency = np.geomspace(*limits, 200)
    norm, phase = norm_and_phase(modulus(2.0 * np.pi * frequency))
    values = {"E_MPa": norm / 1e6, "phase_deg": np.degrees(phase)}[column]
    axes.plot(frequency, values * SHOWN_PER_UNIT[column], color=colour, **{"lw": 0.7, "zorder": 1} | look)


def error_bars(
    axes: Axes, column: str, points: pd.DataFrame, shift: float, marker: str, colour: Any, filled: bool
) -> None:
    """Draw means with standard deviations; the bars are left out where there is one value only.

    `column` is "E_MPa" or "phase_deg"; `points` come from `measurements.tables.averages`; `shift` is a factor on the
    frequency, for points side by side.
    """
    spread = points[f"{column}_sd"] * SHOWN_PER_UNIT[column]
    axes.errorbar(
        points["frequency_Hz"] * shift,
        points[column] * SHOWN_PER_UNIT[column],
        yerr=None if spread.isna().all() else spread.fillna(0.0),
        fmt=marker,
        color=colour,
        markerfacecolor=colour if filled else "white",
        elinewidth=0.6,
        zorder=3 if filled else 2,
    )


def keys(measured: pd.DataFrame, tests: pd.DataFrame, law: bool) -> list[Line2D]:
    """Legend: what open and filled markers and lines are."""
    point: dict[str, Any] = {"ls": "", "marker": "o", "color": style.INK}
    handles = [Line2D([], [], **point, label=_legend_text("simulated", tests, "sample"))]
    if not measured.empty:
        origin = _legend_text(origin_of(measured), measured, "specimen")
        handles.insert(0, Line2D([], [], **point, markerfacecolor="white", label=origin))
    if law:
        handles.append(Line2D([], [], color=style.INK, lw=0.7, label="Burgers law of the bonds"))
    return handles


def _legend_text(what: str, frame: pd.DataFrame, unit: str) -> str:
    count = frame["specimen"].nunique()
    return f"{what}, one {unit}" if count == 1 else f"{what}, mean ± s.d. of {count} {unit}s"
