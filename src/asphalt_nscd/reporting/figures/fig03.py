"""Fig. 3: the element between two spheres, with the stiffnesses that the core gives a bond."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import numbers, style
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.specimen.cutting import read_specimen

WIRE: dict[str, Any] = {"color": style.INK, "lw": 0.9, "solid_capstyle": "round", "clip_on": False}
MAXWELL, KELVIN, END = (0.0, 1.4, 2.8), 4.6, 5.0  # places along the element
HALF = 0.42  # of the distance between the branches of the Kelvin element


@style.journal
def draw(laws: list[Path], specimen: list[Path], study: list[Path]) -> Figure:
    """Draw (a) normal and (b) tangential components of the bond with the median area of a specimen."""
    path = only_file(laws, "laws")
    law, temperature = read_law(path), read_json(path)["temperature_C"]
    form = float(np.median(read_specimen(only_file(specimen, "specimen")).network.form))
    poisson = float(read_json(only_file(study, "study"))["specimens"]["bonds"]["poisson"])
    figure, panels = style.new_figure(style.WIDE, 62.0, rows=2)
    for axes, letter, words, index, share in zip(
        panels, "ab", ("normal", "tangential"), "nt", (1.0, 0.5 / (1.0 + poisson)), strict=True
    ):
        values = [
            form * share * value for value in (law.modulus_m, law.viscosity_m, law.modulus_k, law.viscosity_k)
        ]
        _element(axes, index, values)
        style.letter(axes, letter, f"{words}, {numbers.celsius(temperature)}")
    return figure


def _element(axes: Axes, index: str, values: list[float]) -> None:
    """Draw a Maxwell and a Kelvin element in series between two spheres, with K and C of `values` (4,)."""
    axes.set_axis_off()
    axes.set_aspect("equal")
    axes.set_xlim(-1.9, END + 1.9)
    axes.set_ylim(-0.95, 1.15)
    for x in (-1.1, END + 1.1):
        axes.add_patch(Circle((x, 0.0), 0.75, facecolor=style.PALE, edgecolor=style.INK, lw=0.8))
    _line(axes, [-0.35, 0.0], [0.0, 0.0])
    _spring(axes, MAXWELL[0], MAXWELL[1], 0.0)
    _dashpot(axes, MAXWELL[1], MAXWELL[2], 0.0)
    start, stop = MAXWELL[2] + 0.2, KELVIN
    _line(axes, [MAXWELL[2], start], [0.0, 0.0])
    for x in (start, stop):
        _line(axes, [x, x], [-HALF, HALF])
    _spring(axes, start, stop, HALF)
    _dashpot(axes, start, stop, -HALF)
    _line(axes, [stop, END + 0.35], [0.0, 0.0])
    middles = [(MAXWELL[0] + MAXWELL[1]) / 2.0, (MAXWELL[1] + MAXWELL[2]) / 2.0, (start + stop) / 2.0]
    names = ("K", "C", "K", "C")
    parts, units = ("m", "m", "k", "k"), ("N/m", "N s/m") * 2
    places = [
        (middles[0], 0.3),
        (middles[1] - 0.55, -0.3),
        (middles[2], HALF + 0.25),
        (middles[2], -HALF - 0.25),
    ]
    for name, part, value, unit, (x, y) in zip(names, parts, values, units, places, strict=True):
        text = f"${name}_{{{part}}}^{{{index}}}$ = {numbers.power(value)} {unit}"
        axes.text(x, y, text, ha="center", va="bottom" if y > 0 else "top", fontsize=6.5)


def _line(axes: Axes, x: list[float], y: list[float]) -> None:
    axes.plot(x, y, **WIRE)


def _spring(axes: Axes, start: float, stop: float, y: float) -> None:
    length = stop - start
    x = start + length * np.array([0.0, 0.2, *np.linspace(0.25, 0.75, 8), 0.8, 1.0])
    up = np.array([0.0, 0.0, *([0.13, -0.13] * 4), 0.0, 0.0])
    axes.plot(x, y + up, **WIRE)


def _dashpot(axes: Axes, start: float, stop: float, y: float) -> None:
    low, high = start + 0.35 * (stop - start), start + 0.7 * (stop - start)
    _line(axes, [start, low], [y, y])
    axes.plot([high, low, low, high], y + 0.16 * np.array([1.0, 1.0, -1.0, -1.0]), **WIRE)
    piston = 0.5 * (low + high)
    _line(axes, [piston, piston], [y - 0.1, y + 0.1])
    _line(axes, [piston, stop], [y, y])
