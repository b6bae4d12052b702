"""Whether probabilities mean what they say."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures import style


@style.journal
def reliability(table: pd.DataFrame) -> Figure:
    """Share of names that are right against the probability stated for them, with 95 % intervals."""
    bins = table[table["mean_stated"].notna() & ~table["stated"].isin(("established", "possible"))]
    stated, right = 100.0 * bins["mean_stated"], 100.0 * bins["rate"]
    reach = np.abs(100.0 * bins[["low", "high"]].to_numpy().T - right.to_numpy())
    figure, axes = style.new_figure(style.SINGLE, 80.0)
    ends = np.array([10.0 * np.floor(stated.min() / 10.0), 100.0])
    axes.plot(ends, ends, color=style.INK, linewidth=0.6, label="right as often as stated")
    axes.fill_between(
        ends, ends - 5.0, ends + 5.0, color=style.INK, alpha=0.12, linewidth=0.0, label="within 5 points"
    )
    axes.errorbar(stated, right, yerr=reach, fmt="o", color=style.BLUE, label="found, with its 95 % interval")
    for x, y, n in zip(stated, 100.0 * bins["low"], bins["n"], strict=True):
        # at the lower end of its interval, where no other point is
        axes.annotate(f"{n}", (x, y), (3, 1), textcoords="offset points", fontsize=6.0)
    axes.set_xlim(ends[0], 102.0)
    axes.set_ylim(0.0, 102.0)
    axes.set_xlabel("probability stated for a name (%)")
    axes.set_ylabel("share of these names that are right (%)")
    axes.legend(loc="lower right")
    return figure
