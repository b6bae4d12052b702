"""How bonds carry the law: |E*| of a specimen over that of the law, against its size and its solid fraction."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures import style

SHOWN = {"paper": "Eqs. (30)-(33)", "facets": "facets, $k_t = k_n$"}


@style.journal
def draw(mapping: list[Path]) -> Figure:
    """Draw one point for each packing and mapping, from the table of `benchmarks/mapping.py`.

    Of the facets it shows those with equal stiffnesses, which the package forms unless told otherwise.
    """
    table = pd.concat([pd.read_csv(path) for path in mapping], ignore_index=True)
    table = table[(table["mapping"] == "paper") | (table["kt_over_kn"] == 1.0)]
    often = table["spheres"].mode().iloc[-1]  # the number that was packed most often
    figure, (size, density) = style.new_figure(style.WIDE, 60.0, columns=2, sharey=True)
    looks = zip(SHOWN.items(), ((style.ORANGE, "s"), (style.BLUE, "o")), strict=True)
    for (name, label), (colour, marker) in looks:
        rows = table[table["mapping"] == name]
        look = {"ls": "", "marker": marker, "color": colour, "markerfacecolor": "none", "label": label}
        size.plot(rows["spheres_in_specimen"], rows["E_over_law"], **look)
        full = rows[rows["spheres"] == often]
        density.plot(full["solid_fraction"], full["E_over_law"], **look)
    for axes, letter, words in ((size, "a", "all packings"), (density, "b", f"{often} spheres poured")):
        axes.axhline(1.0, color=style.GREY, lw=0.5, zorder=0)
        axes.margins(0.12)
        style.letter(axes, letter, words)
    size.set_xscale("log")
    style.plain_log_axis(size.xaxis)
    size.set_xlabel("spheres in the specimen")
    size.set_ylabel("|E*| simulated / law")
    size.legend(loc="best")
    density.set_xlabel("solid fraction of the deposit")
    return figure
