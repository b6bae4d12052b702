"""Two readings of the paper that fail: Table 3 in Pa as printed, and a head that cannot rotate."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.errors import InputError
from asphalt_nscd.figures import style
from asphalt_nscd.results import at_temperature, read_tests

LOOKS = {
    "used": (style.INK, "o", "Table 3 in kPa, head free"),
    "pascal": (style.ORANGE, "^", "Table 3 in Pa, head free"),
    "blocked": (style.BLUE, "s", "Table 3 in kPa, head blocked"),
}


@style.journal
def draw(readings: list[Path], simulations: list[Path]) -> Figure:
    """(a) |E*| over that of the law, (b) phase, with the phase of the law as a line."""
    other = read_tests(readings, texts=["head", "law_source"])
    other["reading"] = "blocked"
    other.loc[other["law_source"] == "pascal", "reading"] = "pascal"
    used = read_tests(simulations)
    used = used[used["specimen"].isin(other["specimen"])]
    if used.empty:
        raise InputError("no simulation of the specimen of the readings; simulate it.")
    cases = {"used": at_temperature(used, other["temperature_C"].iloc[0])}
    cases |= dict(iter(other.groupby("reading")))
    figure, (left, right) = style.new_figure(style.WIDE, 70.0, columns=2)
    for name, rows in cases.items():
        _points(left, name, rows, rows["E_MPa"] / rows["E_law_MPa"])
        _points(right, name, rows, rows["phase_deg"])
    law = cases["used"].sort_values("frequency_Hz")
    right.plot(
        law["frequency_Hz"], law["phase_law_deg"], color=style.GREY, lw=0.8, label="Burgers law, either unit"
    )
    left.axhline(1.0, color=style.GREY, lw=0.5, zorder=0)
    left.set_yscale("log")
    style.plain_log_axis(left.yaxis)
    left.set_ylabel("|E*| simulated / law")
    right.set_ylabel("phase angle (°)")
    for axes, panel in ((left, "a"), (right, "b")):
        style.frequency_axis(axes, law["frequency_Hz"])
        style.letter(axes, panel)
    figure.legend(*right.get_legend_handles_labels(), loc="outside upper left", ncols=2, borderpad=0.1)
    return figure


def _points(axes: Axes, name: str, rows, values) -> None:
    colour, marker, label = LOOKS[name]
    order = rows["frequency_Hz"].argsort()
    axes.plot(
        rows["frequency_Hz"].iloc[order], values.iloc[order], color=colour, marker=marker, lw=0.6, label=label
    )
