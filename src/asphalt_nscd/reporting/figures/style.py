"""How the figures look: sizes of a journal column, thin lines, series that differ in grey as in colour."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import matplotlib
import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter, NullLocator
from numpy.typing import ArrayLike
from scipy.optimize import isotonic_regression

from asphalt_nscd.reporting.figures import numbers

P = ParamSpec("P")
R = TypeVar("R")
SINGLE, WIDE = 90.0, 140.0  # mm, the widths of a journal's column and of a column and a half
MM = 1.0 / 25.4  # inch
RC: dict[Any, Any] = {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so that every machine draws the same
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "legend.fontsize": 7.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.minor.size": 1.5,
    "ytick.minor.size": 1.5,
    "lines.linewidth": 1.0,
    "lines.markersize": 4.0,
    "lines.markeredgewidth": 0.7,
    "errorbar.capsize": 1.5,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "axes.unicode_minus": True,
    # TrueType: many journals refuse the Type 3 fonts that Matplotlib embeds otherwise.
    "pdf.fonttype": 42,
    # Outlines, so that a viewer without the font shows the same.
    "svg.fonttype": "path",
}
INK, GREY, PALE = "#1a1a1a", "#7a7a7a", "#c8c8c8"
BLUE, ORANGE = "#20558a", "#d9822b"  # dark and light, apart in grey as well
MARKERS = ("o", "s", "^", "D", "v", "h", "<", ">", "p", "*")
DASHES = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5)), (0, (8, 2)))
MOST_LABELLED_FREQUENCIES = 8


def journal(draw: Callable[P, R]) -> Callable[P, R]:
    """The same function, drawing in this style, whatever the user's matplotlibrc says."""

    @wraps(draw)
    def styled(*arguments: P.args, **data: P.kwargs) -> R:
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(RC)
            return draw(*arguments, **data)

    return styled


class RepeatableLayout(ConstrainedLayoutEngine):
    """Constrained layout to a billionth of the figure.

    Its solver takes terms in the order of their addresses, so that its last bit differs from run to run, and SVG
    makes names of clip paths of all bits.
    """

    def execute(self, fig: Figure) -> Any:
        """Lay out, then round places so that all processors draw alike."""
        solved = super().execute(fig)
        for axes in fig.axes:
            if axes.get_in_layout():
                axes.set_position(np.round(axes.get_position(original=True).bounds, 9))
                axes.set_in_layout(True)  # set_position takes it out
        return solved


def new_figure(
    width: float, height: float, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Figure, Any]:
    """An empty figure and its axes; `width` and `height` in mm, `options` as `Figure.subplots` takes them."""
    figure = Figure(figsize=(width * MM, height * MM), layout=RepeatableLayout(w_pad=0.03, h_pad=0.03))
    return figure, figure.subplots(rows, columns, **options)


def letter(axes: Axes, text: str, explanation: str = "", pad: float = 5.0) -> None:
    """Write the panel letter above the axes, at its left, with a few words; `pad` is the distance above [points]."""
    axes.set_title(rf"$\bf{{{text}}}$  {explanation}".rstrip(), loc="left", fontsize=8.0, pad=pad)


def series(count: int) -> list[tuple[Any, str]]:
    """Colour and marker of each of `count` ordered series, dark to light."""
    # Not to its end, where it is a yellow that white paper swallows.
    shades = colormaps["plasma"](np.linspace(0.0, 0.76, max(count, 2)))[:count]
    return [(tuple(shade), MARKERS[n % len(MARKERS)]) for n, shade in enumerate(shades)]


def kinds(count: int) -> list[tuple[Any, str]]:
    """Colour and marker of each of `count` things without an order, as mixes and specimens."""
    hues = colormaps["tab10"].colors  # type: ignore[attr-defined]
    return [(hues[n % len(hues)], MARKERS[(n + n // len(hues)) % len(MARKERS)]) for n in range(count)]


def isotherm_legends(figure: Figure, keys: Sequence[Line2D], temperatures: Sequence[float]) -> None:
    """Above the axes: at the left what `keys` explain, at the right the point of each isotherm of `series`."""
    looks = zip(temperatures, series(len(temperatures)), strict=True)
    points = [
        Line2D([], [], ls="", marker=marker, color=colour, label=numbers.celsius(t))
        for t, (colour, marker) in looks
    ]
    tight = {"borderpad": 0.1, "labelspacing": 0.3, "columnspacing": 1.0}
    figure.legend(handles=keys, loc="outside upper left", **tight)
    figure.legend(
        handles=points, loc="outside upper right", ncols=-(-len(points) // 5), handlelength=1.0, **tight
    )


def frequency_axis(axes: Axes, frequencies: ArrayLike) -> None:
    """Make the frequency axis logarithmic, with the tested frequencies [Hz] as ticks where these are few."""
    tested = np.unique(np.asarray(frequencies, float))
    axes.set_xscale("log")
    axes.set_xlabel("frequency (Hz)")
    axes.set_xlim(tested[0] / 1.15, tested[-1] * 1.15)
    if tested.size <= MOST_LABELLED_FREQUENCIES:
        axes.xaxis.set_major_locator(FixedLocator(tested.tolist()))
        axes.xaxis.set_minor_locator(NullLocator())
    else:
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def reduced_axis(axes: Axes, label: str) -> None:
    """Make the frequency axis logarithmic over many decades, labelled 0.001, 0.1, ..., 1e5."""
    axes.set_xscale("log")
    axes.set_xlabel(label)
    figure = axes.get_figure(root=True)
    assert figure is not None
    most = max(3, int(figure.get_figwidth() / MM / 14.0))  # labels of 14 mm
    axes.xaxis.set_major_locator(matplotlib.ticker.LogLocator(numticks=most))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: numbers.plain(value)))
    axes.xaxis.set_minor_locator(NullLocator())


def plain_log_axis(axis: Any) -> None:
    """Logarithmic axis labelled 1, 2, 5, 10, ... instead of powers of ten."""
    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def label_ends(
    axes: Axes, x: float, ends: Sequence[float], texts: Sequence[str], colours: Sequence[Any]
) -> None:
    """Write each text at the right of its line's end, moved apart where they would overlap."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.draw_without_rendering()  # settles the size of the axes
    points = 72.0 / axes.figure.dpi
    at = np.array([axes.transData.transform((x, y))[1] for y in ends]) * points
    # 8.5 points are a line of this text with its room.
    for y, text, colour, shift in zip(ends, texts, colours, separate(at.tolist(), 8.5) - at, strict=True):
        axes.annotate(
            text,
            (x, y),
            xytext=(5.0, shift),
            textcoords="offset points",
            va="center",
            fontsize=7.0,
            color=colour,
            annotation_clip=False,
        )


def separate(places: Sequence[float], least: float) -> np.ndarray:
    """Places moved as little as possible, in the mean square, until neighbours are `least` apart; order is kept."""
    wanted, steps = np.asarray(places, float), least * np.arange(len(places))
    order, result = np.argsort(wanted, kind="stable"), np.empty_like(wanted)
    # Less the steps, "far enough apart" is "not falling", of which isotonic regression is the least-squares solution.
    result[order] = isotonic_regression(wanted[order] - steps).x + steps
    return result
