"""What could not have been seen: the least amplitude of each cause that is found, beside what was found."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from asphalt_nscd.diagnosis.criteria import CONFIDENCE
from asphalt_nscd.diagnosis.written import read_diagnosis, shown, three_digits
from asphalt_nscd.files.words import specimen_named
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.numbers import celsius

ROW, FRAME = 4.2, 11.0  # mm of a bar, and of the rest of its cause's panel
NONE = "No cause of the catalogue could have shown in these data."


@style.journal
def draw(diagnosis: list[Path]) -> Figure:
    """Draw one panel for each cause, in its own unit, with one bar for each place where it may sit."""
    content = read_diagnosis(diagnosis)
    limits = content["detection_limits"]
    if not limits:
        figure, axes = style.new_figure(style.SINGLE, 30.0)
        axes.set_axis_off()
        axes.text(0.5, 0.5, NONE, ha="center", va="center", transform=axes.transAxes)
        return figure
    found = {
        (rung["cause"], "" if rung["where"] is None else str(rung["where"])): _amplitude(rung)
        for rung in content["ladder"]
    }  # "" stands for all tests; an isotherm may be at 0.0
    bars = {cause: limit.get("places", {"": limit["value"]}) for cause, limit in limits.items()}
    sizes = [len(rows) * ROW + FRAME for rows in bars.values()]
    figure, panels = style.new_figure(
        style.SINGLE, sum(sizes) + 12.0, rows=len(bars), squeeze=False, gridspec_kw={"height_ratios": sizes}
    )
    for axes, (cause, rows) in zip(panels[:, 0], bars.items(), strict=True):
        _panel(axes, cause, rows, limits[cause]["unit"], found)
        names = (
            specimen_named
            if limits[cause].get("confined_to") == "specimen"
            else lambda at: celsius(float(at))
        )
        axes.set_yticks(range(len(rows)), [place and names(place) for place in rows])
    keys: list[Artist] = [Patch(color=style.PALE, label="not seen: below the detection limit (95 %)")]
    if any(cause in limits for cause, _ in found):
        keys.append(Line2D([], [], marker="D", color=style.ORANGE, label="found, with its 95 % interval"))
    figure.legend(
        handles=keys,
        loc="outside upper left",
        title=f"{content['origin']} data",
        title_fontsize=7.0,
        alignment="left",
        borderpad=0.1,
    )
    return figure


def _panel(axes: Axes, cause: str, rows: dict[str, float], unit: str, found: dict) -> None:
    """Draw the limits of a cause by place, in its unit; `found` has amplitude and error by cause and place."""
    for row, (place, value) in enumerate(rows.items()):
        size, name = shown(value, unit)
        axes.barh(row, size, color=style.PALE, height=0.7)
        axes.text(size, row, f" {three_digits(size)}", va="center", fontsize=6.0)
        if (cause, place) in found:
            estimate, error = (shown(part, unit)[0] for part in found[cause, place])
            axes.errorbar(
                # A limit is of the size, whatever the sign.
                abs(estimate),
                row,
                xerr=CONFIDENCE * error,
                fmt="D",
                color=style.ORANGE,
                markeredgecolor=style.INK,
                zorder=3,
            )
    axes.set_ylim(len(rows) - 0.4, -0.6)  # the first place on top
    axes.set_xlim(left=0.0)
    axes.margins(x=0.12)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.tick_params(axis="y", length=0.0)
    title = cause.replace("_", " ") + (f" ({name})" if name else "")
    axes.set_title(title, loc="left", fontsize=8.0, pad=2.0)


def _amplitude(rung: Mapping[str, Any]) -> tuple[float, float]:
    """Amplitude of a cause and its standard error."""
    estimate = next(iter(rung["parameters"].values()))
    return estimate["value"], estimate["std_error"] or 0.0
