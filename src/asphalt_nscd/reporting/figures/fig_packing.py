"""How the packing carries the law: |E*| over that of the law against the solid fraction of the layer."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.tables import read_tests
from asphalt_nscd.reporting.figures import style


@style.journal
def draw(packing: list[Path]) -> Figure:
    """Draw one point for each deposit, labelled with its coefficient of friction; open where bonds are facets."""
    # Tables of a study without facets lack the column.
    both = all("mapping" in read_csv(path).columns for path in packing)
    tests = read_tests(packing, numbers=["friction", "solid_fraction"], texts=["mapping"] if both else [])
    tests["facets"] = tests["mapping"] == "facets" if both else False
    tests["ratio"] = tests["E_MPa"] / tests["E_law_MPa"]
    figure, axes = style.new_figure(style.SINGLE, 60.0)
    axes.axhline(1.0, color=style.GREY, lw=0.5, zorder=0)
    frictions = sorted(tests["friction"].unique())
    for friction, (colour, marker) in zip(frictions, style.series(len(frictions)), strict=True):
        for facets, points in tests[tests["friction"] == friction].groupby("facets"):
            axes.plot(
                points["solid_fraction"],
                points["ratio"],
                ls="",
                marker=marker,
                ms=5.0,
                color=colour,
                markerfacecolor="white" if facets else colour,
                label=None if facets else f"{friction:g}",
            )
    axes.margins(0.12)
    axes.set_xlabel("solid fraction of the deposit")
    axes.set_ylabel("|E*| simulated / law")
    keys, _ = axes.get_legend_handles_labels()
    if tests["facets"].any():
        bare: dict[str, Any] = {"ls": "", "marker": "o", "ms": 5.0, "color": style.INK}
        keys += [
            Line2D([], [], **bare, label="areas of Eqs. (30)-(33)"),
            Line2D([], [], **bare, markerfacecolor="white", label="facets"),
        ]
    axes.legend(handles=keys, title="friction while pouring", title_fontsize=7.0, loc="best")
    return figure
