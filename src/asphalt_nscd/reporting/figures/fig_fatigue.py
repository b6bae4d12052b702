"""Fatigue of the samples: stiffness over cycles, the Wöhler line beside the published one, damage over the height."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.tables import fatigue


@style.journal
def draw(course: list[Path], profile: list[Path]) -> Figure:
    """Draw stiffness of each sample over cycles at the strain epsilon6, lives at three strains, damage over height.

    `course` and `profile` hold one file for each sample: the course of fatigue and the profile of damage.
    """
    figure, (falls, wohler, height) = style.new_figure(style.WIDE, 60.0, columns=3)
    lives, grows = fatigue.make(course), fatigue.factor(course)
    for path, beside, (colour, marker) in zip(course, profile, style.series(len(course)), strict=True):
        table, own = pd.read_csv(path), lives[lives["sample"] == path.stem]
        falls.plot(1e-6 * grows * table["cycles"], table["stiffness"], color=colour, lw=0.8, label=path.stem)
        look = {"ls": "", "marker": marker, "color": colour, "markerfacecolor": "none"}
        wohler.plot(own["cycles"], own["strain_1e-6"], **look)
        layers = pd.read_csv(beside)
        height.plot(layers["damage"], layers["height_share"], color=colour, lw=0.8)
    cycles = np.geomspace(5e4, 5e6, 2)
    line = 1e6 * fatigue.EPSILON6 * (cycles / fatigue.MILLION) ** fatigue.SLOPE
    wohler.plot(cycles, line, color=style.GREY, lw=0.8, label="published")
    for side in (-1.0, 1.0):
        wohler.plot(cycles * 10 ** (side * fatigue.SCATTER), line, color=style.GREY, lw=0.5, ls=":")
    wohler.set_xscale("log")
    wohler.set_yscale("log")
    style.plain_log_axis(wohler.yaxis)
    falls.set_xlabel("million cycles at 100·10⁻⁶")
    falls.set_ylabel("|E*| over the first")
    wohler.set_xlabel("cycles to half of |E*|")
    wohler.set_ylabel("strain (10⁻⁶)")
    height.set_xlabel("mean damage of bonds")
    height.set_ylabel("height over h")
    falls.legend(loc="best")
    wohler.legend(loc="best")
    for axes, letter in zip((falls, wohler, height), "abc", strict=True):
        style.letter(axes, letter)
    return figure
