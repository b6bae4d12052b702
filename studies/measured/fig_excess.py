"""The excess phase of measured mixes by temperature, and its parts one on another: two populations."""

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.cli import run_script
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.save import save_figure

TITLES = {"ncat": "nine states, NCAT Test Track", "mixes50": "25 mixes, NCHRP 1-40D"}
PARTS = {"reading": style.ORANGE, "contacts": style.BLUE, "softening": style.GREY}


@style.journal
def draw(excess: Path, budget: Path) -> Figure:
    """Draw (a) the NCAT states and (b) the 25 mixes: each mix, mean with its standard error, and the parts."""
    points, means = pd.read_csv(excess), pd.read_csv(budget)
    figure, panels = style.new_figure(style.WIDE, 70.0, columns=2)
    for axes, panel, (population, title) in zip(panels, "ab", TITLES.items(), strict=True):
        _panel(axes, points[points["population"] == population], means[means["population"] == population])
        axes.set_xlabel("temperature (°C)")
        style.letter(axes, panel, title)
    panels[0].set_ylabel("phase above what |E*| requires (°)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=3, borderpad=0.1)
    return figure


def _panel(axes: Axes, points: pd.DataFrame, means: pd.DataFrame) -> None:
    mixes = points.groupby(["mix", "temperature_C"])["isotherm_deg"].first().reset_index()
    axes.axhline(0.0, color=style.GREY, lw=0.5, zorder=0)
    axes.plot(
        mixes["temperature_C"], mixes["isotherm_deg"], "o", ms=2.0, color=style.GREY, alpha=0.6, label="a mix"
    )
    several = means[means["mixes"] > 2]
    look: dict[str, Any] = {"color": style.INK, "marker": "o", "lw": 0.8, "label": "mean, its standard error"}
    axes.errorbar(several["temperature_C"], several["measured_deg"], several["standard_error_deg"], **look)
    below = 0.0 * several["reading_deg"]
    for name, color in PARTS.items():
        above = below + several[f"{name}_deg"]
        axes.fill_between(several["temperature_C"], below, above, color=color, alpha=0.5, lw=0.0, label=name)
        below = above


def run(job: Any) -> None:
    """From the files of the rule to its figure."""
    save_figure(draw(job.input.excess, job.input.budget), job.output[0].removesuffix(".pdf"))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
