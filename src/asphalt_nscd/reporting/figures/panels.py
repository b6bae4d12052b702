"""What figures and pages draw alike: points that say which test they are, lines with bands, maps of conditions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib
import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from asphalt_nscd.reporting.figures import numbers, style

COLOURS = "RdBu_r"
BANDS = 5  # steps of 1, 2, 5, ... on either side of zero
MOST_NUMBERED = 8  # columns of a map whose cells have room for a number
MOST_LABELS = 8
QUANTITIES = {"E": ("E{}_MPa", 1e-3, "|E*| (GPa)"), "phase": ("phase{}_deg", 1.0, "phase angle (°)")}
MARKS = {"not used": "x", "doubtful": "o", "quality": "^"}  # in the corner of a cell


def points(axes: Axes, x: Any, y: Any, look: tuple[Any, str], rows: pd.DataFrame) -> None:
    """Draw tests; `rows` may have filled (bool), and words, which an SVG for a page says of each point."""
    colour, marker = look
    filled = rows["filled"] if "filled" in rows else np.zeros(len(rows), bool)
    faces = [colour if full else "white" for full in filled]
    made = axes.scatter(x, y, s=15, marker=marker, edgecolors=[colour], facecolors=faces, lw=0.8, zorder=3)
    made.set_urls(list(rows.get("words", [])))


def line(
    axes: Axes, x: str, quantity: str, rows: pd.DataFrame, colour: Any, end: str = "", **look: Any
) -> None:
    """Draw `quantity` of QUANTITIES, whose columns have `end` behind their name, and its band if it has one."""
    column, scale, _ = QUANTITIES[quantity]
    middle = column.format(end)
    low, high = (column.format(f"{end}_{side}") for side in ("low", "high"))
    if low in rows:
        axes.fill_between(rows[x], scale * rows[low], scale * rows[high], color=colour, alpha=0.18, lw=0.0)
    axes.plot(rows[x], scale * rows[middle], color=colour, **{"lw": 1.0, "zorder": 2} | look)


def account(axes: Axes, x: np.ndarray, energies: Mapping[str, np.ndarray]) -> None:
    """Draw four parts of an account of energy over `x`; the last, what the scheme takes, dashed."""
    looks = ((style.BLUE, "-"), (style.ORANGE, "-"), (style.INK, "-"), (style.GREY, "--"))
    for (name, energy), (colour, dash) in zip(energies.items(), looks, strict=True):
        axes.plot(x, energy, color=colour, ls=dash, label=name)
    axes.legend()


def quantity_axis(axes: Axes, quantity: str) -> None:
    """Name the vertical axis of `quantity`; |E*| has a logarithmic one."""
    axes.set_ylabel(QUANTITIES[quantity][2])
    if quantity == "E":
        axes.set_yscale("log")
        style.plain_log_axis(axes.yaxis)


def reduced_axis(axes: Axes, label: str) -> None:
    """Make the frequency axis logarithmic, with 1, 2, 5, ... where decades alone would be a number or two."""
    style.reduced_axis(axes, label)
    low, high = axes.get_xlim()
    if high < 100.0 * low:
        style.plain_log_axis(axes.xaxis)


def isotherm_looks(isotherms: Sequence[float]) -> dict[float, tuple[Any, str]]:
    """Colour and marker of each isotherm [degC], dark to light in many hues, which a dark page's inversion keeps."""
    shades = colormaps["cubehelix"](np.linspace(0.15, 0.7, max(len(isotherms), 2)))
    return {at: (tuple(shades[n]), style.MARKERS[n % len(style.MARKERS)]) for n, at in enumerate(isotherms)}


def isotherm_legends(figure: Figure, keys: Sequence[Line2D], isotherms: Sequence[float]) -> None:
    """Above the axes: at the left what `keys` explain, at the right the point of each isotherm."""
    points = [key(numbers.celsius(at), look, filled=True) for at, look in isotherm_looks(isotherms).items()]
    tight = {"borderpad": 0.1, "labelspacing": 0.3, "columnspacing": 0.8}
    figure.legend(handles=keys, loc="outside upper left", **tight)
    figure.legend(
        handles=points, loc="outside upper right", ncols=-(-len(points) // 5), handlelength=1.0, **tight
    )


def key(words: str, look: tuple[Any, str], filled: bool = False) -> Line2D:
    """An entry of a legend for points."""
    colour, marker = look
    face = colour if filled else "white"
    return Line2D([], [], ls="", marker=marker, color=colour, markerfacecolor=face, ms=4.0, label=words)


def banded(largest: float) -> BoundaryNorm:
    """Bands 1, 2, 5, 10, ... about zero that reach the largest value."""
    steps = np.array([m * 10.0**e for e in range(-6, 6) for m in (1, 2, 5)])
    last = int(np.searchsorted(steps, largest))
    edges = steps[last - BANDS + 1 : last + 1]
    return BoundaryNorm(np.concatenate([-edges[::-1], edges]), colormaps[COLOURS].N)


def standard_errors() -> BoundaryNorm:
    """Bands 1, 2, 3, 5, 10 about zero: what chance does is pale on every table."""
    edges = np.array([1.0, 2.0, 3.0, 5.0, 10.0])
    return BoundaryNorm(np.concatenate([-edges[::-1], edges]), colormaps[COLOURS].N, clip=True)


def cells(axes: Axes, rows: pd.DataFrame, norm: BoundaryNorm) -> PatchCollection:
    """Draw a cell for each row of temperature_C, frequency_Hz, value, framed (bool) and, for a page, words."""
    temperatures, frequencies = (np.unique(rows[name]) for name in ("temperature_C", "frequency_Hz"))
    rows = rows.assign(
        i=np.searchsorted(temperatures, rows["temperature_C"]),
        k=np.searchsorted(frequencies, rows["frequency_Hz"]),
    ).dropna(subset="value")
    axes.set_facecolor(style.PALE)  # shows where nothing was tested
    squares = [Rectangle((row.k, row.i), 1.0, 1.0) for row in rows.itertuples()]
    image = PatchCollection(squares, cmap=COLOURS, norm=norm, edgecolors="white", linewidths=0.5)
    image.set_array(rows["value"].to_numpy())
    image.set_urls(list(rows.get("words", [])))
    axes.add_collection(image)
    axes.set(xlim=(0.0, len(frequencies)), ylim=(0.0, len(temperatures)))
    for row in rows.itertuples():
        if len(frequencies) <= MOST_NUMBERED:
            _number(axes, row, norm)
        if row.framed:
            axes.add_patch(
                Rectangle((row.k + 0.06, row.i + 0.06), 0.88, 0.88, fill=False, edgecolor=style.INK, lw=0.8)
            )
    for axis, values in ((axes.xaxis, frequencies), (axes.yaxis, temperatures)):
        every = -(-len(values) // MOST_LABELS)
        labels = [numbers.minus(f"{value:g}") for value in values]
        axis.set_ticks(np.arange(len(values))[::every] + 0.5, labels[::every])
        axis.set_tick_params(length=0.0)
    return image


def _number(axes: Axes, row: Any, norm: BoundaryNorm) -> None:
    red, green, blue, _ = colormaps[COLOURS](norm(row.value))
    # By the brightness of the cell, to which green adds most.
    colour = "white" if 0.3 * red + 0.6 * green + 0.1 * blue < 0.5 else style.INK
    number = rounded(row.value)
    size = 0.7 * matplotlib.rcParams["font.size"]
    axes.text(row.k + 0.5, row.i + 0.5, number, ha="center", va="center", fontsize=size, color=colour)


def rounded(value: float, sign: str = "") -> str:
    """A number with a true minus and two digits, without decimals from ten on; `sign` as in a format."""
    digits = 0 if abs(value) >= 9.95 else 1
    # + 0.0 makes a 0 of what is rounded to -0.
    return numbers.minus(f"{round(value, digits) + 0.0:{sign}.{digits}f}")


def marked(axes: Axes, rows: pd.DataFrame) -> None:
    """Put marks of MARKS into cells: `rows` has temperature_C, frequency_Hz and marks, a list of names."""
    temperatures, frequencies = (np.unique(rows[name]) for name in ("temperature_C", "frequency_Hz"))
    for row in rows.itertuples():
        i, k = (
            np.searchsorted(temperatures, row.temperature_C),
            np.searchsorted(frequencies, row.frequency_Hz),
        )
        for name in row.marks:
            place = 0.91 if name == "quality" else 0.09
            # On a patch of paper: seen on every colour, on light pages and dark.
            axes.plot(k + place, i + 0.84, marker="s", color="white", ms=5.0, mew=0.0)
            axes.plot(k + place, i + 0.84, marker=MARKS[name], color=style.INK, ms=3.0, mfc="none", mew=0.9)


def isotherm_of(temperature: pd.Series, stated: Sequence[float]) -> np.ndarray:
    """Isotherm (n,) of each test: the one of those `stated` [degC] that is nearest to its temperature (n,)."""
    nominal = np.array(sorted(stated))
    return nominal[np.abs(temperature.to_numpy()[:, None] - nominal).argmin(axis=1)]
