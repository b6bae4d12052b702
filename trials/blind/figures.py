"""Figures of the campaign."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures import style

from .score import NOTHING

COLUMNS = 4


@style.journal
def efficiency(table: pd.DataFrame) -> Figure:
    """Share of effects found, and named, against amplitude over detection limit; one panel for each cause."""
    causes = list(table["cause"].unique())
    rows = -(-len(causes) // COLUMNS)
    figure, panels = style.new_figure(
        style.WIDE, 32.0 * rows + 12.0, rows, COLUMNS, sharex=True, sharey=True, squeeze=False
    )
    for axes, cause in zip(panels.flat, causes, strict=False):
        part = table[table["cause"] == cause]
        low_high = np.abs(part[["found_low", "found_high"]].to_numpy().T - part["found"].to_numpy())
        axes.errorbar(
            part["ratio"],
            part["found"],
            yerr=low_high,
            fmt="o-",
            color=style.BLUE,
            label="found, with its 95 % interval",
        )
        axes.plot(
            part["ratio"],
            part["found"] * part["named"],
            "D",
            ls=(0, (1.2, 1.2)),
            color=style.ORANGE,
            markersize=3.0,
            label="and named rightly",
            zorder=3,
        )
        axes.set_title(cause.replace("_", " "), loc="left", fontsize=7.0, pad=2.0)
        axes.set_ylim(0.0, 1.05)
        axes.set_xticks(part["ratio"])
    for axes in panels.flat[len(causes) :]:
        axes.set_axis_off()
    figure.supxlabel("amplitude over detection limit", fontsize=8.0)
    figure.supylabel("share of cases", fontsize=8.0)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles[::-1], labels[::-1], loc="outside upper left", ncols=2)
    return figure


@style.journal
def isolation(table: pd.DataFrame) -> Figure:
    """What was hidden against what came out, in per cent of the cases of a row."""
    counts = table.set_index("cause")
    order = [name for name in counts.index if name in counts.columns and name != NOTHING]
    rest = [name for name in counts.index if name not in order]
    columns = [*order, *(name for name in counts.columns if name not in order)]
    counts = counts.loc[[*order, *sorted(rest, key=NOTHING.__eq__)], columns]
    share = 100.0 * counts.to_numpy(float) / counts.to_numpy(float).sum(axis=1, keepdims=True)
    figure, axes = style.new_figure(style.WIDE, 5.0 * len(counts) + 38.0)
    axes.imshow(share, cmap="Greys", vmin=0.0, vmax=140.0, aspect="auto")
    for (i, j), value in np.ndenumerate(share):
        if value > 0.0:
            color = "white" if value > 50.0 else style.INK
            axes.text(j, i, f"{value:.0f}", ha="center", va="center", fontsize=6.0, color=color)
    axes.set_xticks(
        range(len(columns)), [name.replace("_", " ") for name in columns], rotation=60, ha="right"
    )
    axes.set_yticks(range(len(counts)), [name.replace("_", " ") for name in counts.index])
    axes.axhline(len(order) - 0.5, color=style.INK, linewidth=0.6)
    axes.tick_params(length=0.0)
    axes.set_xlabel("named, or how it ended (% of the row)")
    axes.set_ylabel("hidden")
    return figure
