"""Specimens side by side: does one of them leave the curve of the others, and where?"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.diagnosis.written import read_causality, read_diagnosis
from asphalt_nscd.reporting.figures import numbers, style

MOST_LISTED = 10  # specimens in the legend
POINT: dict[str, Any] = {"ls": "", "ms": 4.0, "mew": 0.9}
SHIFTED = "reduced frequency (Hz), at {}"
UNSHIFTED = "frequency (Hz); no law common to all temperatures"


@style.journal
def draw(causality: list[Path], diagnosis: list[Path]) -> Figure:
    """(a) Black diagram, (b, c) |E*| and phase against reduced frequency; a colour and a marker for each
    specimen.

    Parameters
    ----------
    causality : list of path
        causality.csv.
    diagnosis : list of path
        diagnosis.json.

    Returns
    -------
    Figure
        In the size of a journal column.
    """
    content, tests = read_diagnosis(diagnosis), read_causality(causality)
    shift, axis = _shift(content)
    tests["reduced_Hz"] = tests["frequency_Hz"] * 10.0 ** tests["temperature_C"].map(shift).fillna(0.0)
    tests["E_GPa"] = tests["E_MPa"] / 1e3
    names = list(tests["specimen"].unique())
    figure, (black, modulus, phase) = style.new_figure(style.SINGLE, 190.0, rows=3)
    for name, (colour, marker) in zip(names, style.series(len(names)), strict=True):
        own = tests[tests["specimen"] == name]
        for axes, x, y in (
            (black, "phase_deg", "E_GPa"),
            (modulus, "reduced_Hz", "E_GPa"),
            (phase, "reduced_Hz", "phase_deg"),
        ):
            _points(axes, own[x], own[y], own["reasons"].ne(""), colour, marker)
    for axes in (black, modulus):
        axes.set_yscale("log")
        style.plain_log_axis(axes.yaxis)
        axes.set_ylabel("|E*| (GPa)")
    black.set_xlabel("phase angle (°)")
    for axes in (modulus, phase):
        if shift:
            axes.set_xscale("log")
        else:
            style.frequency_axis(axes, tests["frequency_Hz"])
        axes.set_xlabel(axis)
    curves = "master curve" if shift else "isotherms"
    phase.set_ylabel("phase angle (°)")
    style.letter(black, "a", "Black diagram")
    style.letter(modulus, "b", f"{curves} of |E*|")
    style.letter(phase, "c", f"{curves} of the phase")
    figure.legend(
        handles=_keys(names, bool(tests["reasons"].ne("").any())),
        loc="outside upper left",
        ncols=3,
        borderpad=0.1,
        columnspacing=1.2,
        handlelength=1.0,
        title=f"{content['origin']} data",
        title_fontsize=7.0,
        alignment="left",
    )
    return figure


def _shift(content: dict) -> tuple[dict[float, float], str]:
    """Decimal logarithm of the shift by temperature, and what the axis is then called."""
    rung = next((rung for rung in content["ladder"] if "log10_shift" in rung), None)
    if rung is None:
        return {}, UNSHIFTED
    shift = {float(t): value for t, value in rung["log10_shift"].items()}
    return shift, SHIFTED.format(numbers.celsius(min(shift, key=lambda t: abs(shift[t]))))


def _points(axes: Axes, x: pd.Series, y: pd.Series, suspect: pd.Series, colour: object, marker: str) -> None:
    for rows, face, above in ((~suspect, colour, 2), (suspect, "white", 3)):
        axes.plot(x[rows], y[rows], marker=marker, color=colour, markerfacecolor=face, zorder=above, **POINT)


def _keys(names: list[str], suspects: bool) -> list[Line2D]:
    looks = list(zip(names, style.series(len(names)), strict=True))[:MOST_LISTED]
    keys = [
        Line2D([], [], marker=marker, color=colour, label=name, **POINT) for name, (colour, marker) in looks
    ]
    if len(names) > MOST_LISTED:
        keys.append(Line2D([], [], ls="", label=f"and {len(names) - MOST_LISTED} more"))
    if suspects:
        keys.append(
            Line2D(
                [], [], marker="o", color=style.INK, markerfacecolor="white", label="hollow: suspect", **POINT
            )
        )
    return keys
