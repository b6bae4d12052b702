"""The excess phase of measured mixes by temperature, and what each mechanism predicts of it: two populations."""

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.cli import run_script
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.save import save_figure

TITLES = {"ncat": "nine states, NCAT Test Track", "mixes50": "25 mixes, NCHRP 1-40D"}
# `weak_films` are contacts once more, in place of the others
PREDICTED = {
    "reading": ("reading", style.ORANGE, "-"),
    "contacts": ("contacts, films stiff in shear", style.BLUE, "-"),
    "weak_films": ("contacts, films weak in shear", style.BLUE, style.DASHES[1]),
    "softening": ("softening", style.GREY, style.DASHES[2]),
}


@style.journal
def draw(excess: Path, budget: Path) -> Figure:
    """Draw (a) the NCAT states and (b) the 25 mixes: each mix, mean with its standard error, and predictions."""
    points, means = pd.read_csv(excess), pd.read_csv(budget)
    figure, panels = style.new_figure(style.WIDE, 75.0, columns=2)
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
        mixes["temperature_C"], mixes["isotherm_deg"], "o", ms=2.0, color=style.PALE, label="measured: a mix"
    )
    several = means[means["mixes"] > 2]
    look: dict[str, Any] = {"color": style.INK, "fmt": "o", "lw": 0.8, "zorder": 3, "label": "measured: mean"}
    axes.errorbar(several["temperature_C"], several["measured_deg"], several["standard_error_deg"], **look)
    for name, (label, color, dashes) in PREDICTED.items():
        axes.plot(
            several["temperature_C"], several[f"{name}_deg"], color=color, linestyle=dashes, label=label
        )


def run(job: Any) -> None:
    """From the files of the rule to its figure."""
    save_figure(draw(job.input.excess, job.input.budget), job.output[0].removesuffix(".pdf"))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
