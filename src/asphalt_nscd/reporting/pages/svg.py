"""Parts of plots for a page, as SVG of our own: each test carries a title that names it; colours follow the page.

matplotlib's SVG is ten times as large, and its colours are those of paper; a laboratory needs no matplotlib (95 MB).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
import pandas as pd

from asphalt_nscd.reporting.figures.numbers import celsius, minus

WIDTH, HEIGHT = 360, 250  # of one plot, in units of about a pixel on a telephone
LEFT, RIGHT, TOP, BOTTOM = 52, 8, 22, 40  # margins for labels
MOST_TICKS = 7
# Nine stops of Matplotlib's map, so that the page has the figures' colours without Matplotlib.
PLASMA = ("#0d0887", "#4c02a1", "#7e03a8", "#aa2395", "#cc4778", "#e66c5c", "#f89540", "#fdc527", "#f0f921")
MOST_NUMBERED = 8  # columns of a map whose cells have room for a number
STRONGEST = 0.85  # opacity of the largest value of a map
HINT = (
    "Point at a test, tap it, or step through the tests with the arrow keys; Home, End and Escape work too."
)


@dataclass(frozen=True)
class Chart:
    """Plots that belong together, as SVG, and what they show."""

    name: str
    title: str
    caption: str
    plots: tuple[str, ...]
    keys: Sequence[tuple[str, str, str]] = ()  # name of a series, its colour on a light and on a dark page
    of: str = "Isotherms"  # what the series are
    hint: str = HINT


@dataclass(frozen=True)
class Axis:
    """What stands on an axis: label, and values of a table; `end` "" for measured, "_after" for simulated."""

    label: str
    values: Callable[[pd.DataFrame, str], pd.Series]
    log: bool = False

    def place(self, values: Sequence[float] | np.ndarray) -> np.ndarray:
        """Places of values along the axis: their logarithms in decades where it is logarithmic, else as they are."""
        of = np.asarray(values, float)
        return np.log10(of) if self.log else of

    def ticks(self, low: float, high: float) -> list[tuple[float, str]]:
        """Place and label of each tick between two places."""
        if not self.log:
            decade = 10.0 ** np.floor(np.log10((high - low) / MOST_TICKS))
            step = next(
                n * decade for n in (1, 2, 2.5, 5, 10, 20) if (high - low) / (n * decade) <= MOST_TICKS - 1
            )
            places = step * np.arange(np.ceil(low / step), np.floor(high / step) + 1)
            return [(float(x), minus(f"{x + 0.0:.6g}")) for x in places]
        decades = 10.0 ** np.arange(np.floor(low), np.ceil(high) + 1)
        for steps in ((1.0, 2.0, 5.0), (1.0,)):
            inside = [float(x) for x in np.outer(decades, steps).ravel() if low <= np.log10(x) <= high]
            if len(inside) <= MOST_TICKS:
                break
        every = -(-len(inside) // MOST_TICKS) or 1
        return [(float(np.log10(x)), _power(x)) for x in inside[::every]]


MODULUS = Axis("|E*| (MPa)", lambda of, end: of[f"E{end}_MPa"], log=True)
PHASE = Axis("phase (°)", lambda of, end: of[f"phase{end}_deg"])


def _power(value: float) -> str:
    """1000 as it is; beyond four digits as a power of ten."""
    if 1e-3 <= value < 1e5:
        return f"{value:g}"
    return f"{value:.0e}".replace("e+0", "e").replace("e-0", "e\N{MINUS SIGN}").replace("e+", "e")


@dataclass(frozen=True)
class _Range:
    low: float
    high: float

    @classmethod
    def about(cls, places: np.ndarray) -> _Range:
        """All places, and a twentieth more at either end."""
        low, high = float(np.nanmin(places)), float(np.nanmax(places))
        # One value alone has no span to be drawn over.
        room = 0.05 * (high - low) or 0.5
        return cls(low - room, high + room)

    def coordinate(self, place: float | np.ndarray, start: float, end: float) -> np.ndarray:
        return start + (np.asarray(place) - self.low) / (self.high - self.low) * (end - start)


class Frame:
    """Axes that hold some tables, with grid and labels: `parts` of the SVG."""

    def __init__(self, x: Axis, y: Axis, tables: Sequence[tuple[pd.DataFrame, str]]) -> None:
        self.x, self.y = x, y
        self.across, self.up = (
            _Range.about(axis.place(np.concatenate([axis.values(table, end) for table, end in tables])))
            for axis in (x, y)
        )
        self.parts: list[str] = []
        for place, label in x.ticks(self.across.low, self.across.high):
            at = float(self.across.coordinate(place, LEFT, WIDTH - RIGHT))
            self.parts.append(f'<path class="grid" d="M{at:.1f} {TOP}V{HEIGHT - BOTTOM}"/>')
            # Centred, the last label would be cut off.
            at_edge = at > WIDTH - RIGHT - 3.0 * len(label)
            self.parts.append(text(at, HEIGHT - BOTTOM + 15, label, "end" if at_edge else "middle"))
        for place, label in y.ticks(self.up.low, self.up.high):
            at = float(self.up.coordinate(place, HEIGHT - BOTTOM, TOP))
            self.parts.append(f'<path class="grid" d="M{LEFT} {at:.1f}H{WIDTH - RIGHT}"/>')
            self.parts.append(text(LEFT - 5, at + 4, label, "end"))
        self.parts.append(f'<path class="axis" d="M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT}"/>')
        self.parts.append(text(0.5 * (LEFT + WIDTH - RIGHT), HEIGHT - 6, x.label))
        self.parts.append(text(2, 13, f"{y.label}", "start"))

    def points(self, table: pd.DataFrame, end: str = "") -> list[tuple[float, float]]:
        """x and y [px] of each row of a table that has the columns of both axes.

        `end` is the ending of their names: empty for what was measured, else "_after", "_low" or "_high".
        """
        columns = (
            self.across.coordinate(self.x.place(self.x.values(table, end)), LEFT, WIDTH - RIGHT),
            self.up.coordinate(self.y.place(self.y.values(table, end)), HEIGHT - BOTTOM, TOP),
        )
        return list(zip(*columns, strict=True))


def key(specimen: object, isotherm: float, frequency: float) -> str:
    """Key by which charts of a page find a test, or without a specimen all tests of a condition [degC, Hz]."""
    return f"{specimen}|{isotherm:g}|{frequency:.4g}"


def test(at: tuple[float, float], words: str, key: str, look: str = "test") -> str:
    """SVG circle centred `at` [px] that says which test it is.

    `words` are the hint that a browser shows and a screen reader says; `key` is what the function `key` gives; `look`
    is a class of the style.
    """
    return (
        # The title is the hint that a browser shows and what a screen reader says.
        f'<circle class="{look}" data-test="{escape(key)}" cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="4">'
        f"<title>{escape(words)}</title></circle>"
    )


@dataclass(frozen=True)
class Cell:
    """A value at an isotherm [degC] and a frequency [Hz], and what it says; mark: SVG of a square from 0 to 1."""

    temperature: float
    frequency: float
    value: float
    words: str
    specimen: str = ""  # the only one in it
    quiet: bool = False  # its number says little
    mark: str = ""


def cells(title: str, label: str, every: Sequence[Cell], largest: float) -> str:
    """SVG map over frequency [Hz] and temperature [degC], coloured by value as far as `largest`.

    `title` stands above the map, `label` is for those who hear it; cells are (temperature, frequency, value).
    """
    temperatures, frequencies = (
        sorted({getattr(cell, name) for cell in every}) for name in ("temperature", "frequency")
    )
    width = (WIDTH - LEFT - RIGHT) / len(frequencies)
    height = (HEIGHT - TOP - BOTTOM) / len(temperatures)
    apart = -(-len(frequencies) // MOST_NUMBERED), -(-len(temperatures) // MOST_NUMBERED)
    parts = [text(2, 13, title, "start")]
    parts += [
        text(LEFT + (k + 0.5) * width, HEIGHT - BOTTOM + 15, f"{frequency:g}")
        for k, frequency in enumerate(frequencies)
        if k % apart[0] == 0
    ]
    parts += [
        text(LEFT - 5, HEIGHT - BOTTOM - (i + 0.5) * height + 4, celsius(temperature), "end")
        for i, temperature in enumerate(temperatures)
        if i % apart[1] == 0
    ]
    parts.append(text(0.5 * (LEFT + WIDTH - RIGHT), HEIGHT - 6, "frequency (Hz)"))
    numbered = len(frequencies) <= MOST_NUMBERED and len(temperatures) <= 2 * MOST_NUMBERED
    for cell in every:
        left = LEFT + frequencies.index(cell.frequency) * width
        top = HEIGHT - BOTTOM - (temperatures.index(cell.temperature) + 1) * height
        strength = STRONGEST * min(abs(cell.value) / largest, 1.0)
        parts.append(
            f'<g data-test="{escape(key(cell.specimen, cell.temperature, cell.frequency))}">'
            f'<title>{escape(cell.words)}</title><rect class="cell" x="{left:.1f}" y="{top:.1f}" '
            f'width="{width:.1f}" height="{height:.1f}" fill="var(--{"more" if cell.value > 0.0 else "less"})" '
            f'fill-opacity="{strength:.2f}"/>'
        )
        if cell.mark:
            parts.append(
                f'<g transform="translate({left:.1f} {top:.1f}) scale({width:.1f} {height:.1f})">{cell.mark}</g>'
            )
        if numbered:
            look = ' class="quiet"' if cell.quiet else ""
            parts.append(text(left + 0.5 * width, top + 0.5 * height + 4, signed(cell.value), look=look))
        parts.append("</g>")
    return svg(label, parts)


def colours(count: int) -> list[tuple[str, str]]:
    """Colours (#rrggbb) of each series on a light and on a dark page, cold to warm, from plasma as in the figures."""
    light, dark = (np.linspace(*ends, max(count, 2))[:count] for ends in ((0.0, 0.7), (0.4, 1.0)))
    return [(_plasma(one), _plasma(other)) for one, other in zip(light, dark, strict=True)]


def _plasma(place: float) -> str:
    """Colour of the map of that name, straight between its ninths: from 0, dark blue, to 1, yellow."""
    at = place * (len(PLASMA) - 1)
    channels = zip(*(bytes.fromhex(one[1:]) for one in PLASMA), strict=True)
    return "#" + "".join(f"{round(np.interp(at, range(len(PLASMA)), one)):02x}" for one in channels)


def signed(value: float) -> str:
    """A number with its sign (a true minus) and two digits, without decimals from ten on."""
    digits = 0 if abs(value) >= 9.95 else 1
    return minus(f"{round(value, digits) + 0.0:+.{digits}f}")


def text(x: float, y: float, words: str, anchor: str = "middle", look: str = "") -> str:
    """SVG of words at a point [px]; markup in them is escaped.

    `anchor` is the part of the words that stands there: start, middle or end; `look` holds further attributes, with a
    space before them.
    """
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{look}>{escape(words)}</text>'


def svg(label: str, parts: Sequence[str]) -> str:
    """A chart of SVG elements, the first one lowest, with a label that a screen reader says."""
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="group" aria-roledescription="chart" tabindex="0" '
        f'aria-label="{escape(label)}">{"".join(parts)}</svg>'
    )
