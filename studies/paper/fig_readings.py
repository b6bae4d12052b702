"""Two readings of the paper that fail: Table 3 in Pa as printed, and a head that cannot rotate."""

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.tables import isotherm_rows, read_tests
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.save import save_figure

LOOKS = {
    "used": {"color": style.INK, "marker": "o", "zorder": 3},
    "pascal": {"color": style.ORANGE, "marker": "^", "zorder": 2},
    "blocked": {"color": style.BLUE, "marker": "s", "ms": 6.0, "markerfacecolor": "none", "zorder": 4},
}


@style.journal
def draw(readings: list[Path], simulations: list[Path]) -> Figure:
    """Draw (a) |E*| over that of the law, (b) phase, with the phase of the law as a line."""
    other = read_tests(readings, texts=["head", "law_source"])
    other["reading"] = "blocked"
    other.loc[other["law_source"] == "pascal", "reading"] = "pascal"
    used = read_tests(simulations, texts=["law_source"])
    # The same sample alone, so that no packing is part of the difference.
    used = used[used["specimen"].isin(other["specimen"])]
    if used.empty:
        raise InputError("no simulation of the specimen of the readings; simulate it.")
    cases = {"used": isotherm_rows(used, other["temperature_C"].iloc[0])}
    cases |= dict(iter(other.groupby("reading")))
    law = "Table 3 in kPa" if set(used["law_source"]) == {"published"} else "fitted law"
    names = {"used": f"{law}, head free", "pascal": "Table 3 in Pa, head free"}
    names["blocked"] = f"{law}, head blocked"
    figure, (left, right) = style.new_figure(style.WIDE, 70.0, columns=2)
    for name, rows in cases.items():
        look = LOOKS[name] | {"label": names[name]}
        _points(left, look, rows, rows["E_MPa"] / rows["E_law_MPa"])
        _points(right, look, rows, rows["phase_deg"])
    used = cases["used"].sort_values("frequency_Hz")
    line = {"color": style.GREY, "lw": 0.8, "zorder": 1, "label": "Burgers law, either unit"}
    right.plot(used["frequency_Hz"], used["phase_law_deg"], **line)
    left.axhline(1.0, color=style.GREY, lw=0.5, zorder=0)
    left.set_yscale("log")
    style.plain_log_axis(left.yaxis)
    left.set_ylabel("|E*| simulated / law")
    right.set_ylabel("phase angle (°)")
    for axes, panel in ((left, "a"), (right, "b")):
        style.frequency_axis(axes, used["frequency_Hz"])
        style.letter(axes, panel)
    figure.legend(*right.get_legend_handles_labels(), loc="outside upper left", ncols=2, borderpad=0.1)
    return figure


def _points(axes: Axes, look: dict[str, Any], rows: pd.DataFrame, values: pd.Series) -> None:
    order = rows["frequency_Hz"].argsort()
    axes.plot(rows["frequency_Hz"].iloc[order], values.iloc[order], lw=0.6, **look)


def run(job: Any) -> None:
    """From the files of the rule to its figure."""
    save_figure(draw(job.input.readings, job.input.simulations), job.output[0].removesuffix(".pdf"))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
