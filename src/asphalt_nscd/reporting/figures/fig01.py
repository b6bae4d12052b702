"""Fig. 1: the simulated specimen, and its test."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Polygon, Rectangle

from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.geometry import read_shape
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.measurements.tension import Cylinder
from asphalt_nscd.reporting.figures import style

RECEDING = np.array([0.5, 0.3])  # how a length across the specimen shows in (a)
BENT = 0.13  # deflection in (b), of the height
TILT = 0.22  # height over width of the ends of a cylinder
FRONT, SIDE, END = "#d9dde2", "#b4bcc6", "#eceef1"
LINE: dict[str, Any] = {"edgecolor": style.INK, "lw": 0.8, "joinstyle": "round"}


@dataclass(frozen=True)
class _Drawing:
    """A specimen from the front [m]: widths at foot and head, height, depth, and what is written and held in (b).

    lengths: symbol, value [m] and place (x, z), in widths of the foot and heights; said: level, in heights, and text.
    held: levels of plates that rest; driven: levels of those that move, along the axis if not `bends`.
    """

    widths: tuple[float, float]
    height: float
    depth: float
    lengths: list[tuple[str, float, float, float]]
    said: list[tuple[float, str]]
    held: list[float]
    driven: list[float]
    bends: bool = True


def _drawing(shape: Any, amplitude: float) -> _Drawing:
    """What to draw of a shape whose head, or inner clamps, move by `amplitude` [m]."""
    drive = rf"$z = A\,\sin\,\omega t$,  $A$ = {1e6 * amplitude:.3g} µm"
    mass = (0.5, f"specimen $M$ = {shape.mass:g} kg")
    moved = f"mobile mass $m$ = {shape.mobile_mass:g} kg"
    if isinstance(shape, Cylinder):
        lengths = [("d", shape.d, 0.0, 1.0), ("h", shape.h, -0.62, 0.5)]
        said = [(1.12, drive), (0.9, f"upper plate: driven,\n{moved}"), mass, (0.0, "lower plate: fixed")]
        return _Drawing((shape.d, shape.d), shape.h, 0.0, lengths, said, [0.0], [1.0], bends=False)
    if isinstance(shape, Beam):
        inner = shape.plates[1].height / shape.h
        lengths = [("L", shape.h, -0.8, 0.5), ("H", shape.depth, 0.0, -0.06), ("B", shape.breadth, 0.7, 0.05)]
        said = [
            (1.0, "outer clamps: held,\nfree to turn"),
            (inner, f"inner clamps: {drive}"),
            mass,
            (1.0 - inner, moved),
        ]
        widths = (shape.depth, shape.depth)
        driven = [inner, 1.0 - inner]
        return _Drawing(widths, shape.h, shape.breadth, lengths, said, [0.0, 1.0], driven)
    lengths = [("B", shape.B, 0.0, -0.06), ("b", shape.b, 0.0, 1.14), ("e", shape.e, 0.6, 0.02)]
    lengths.append(("h", shape.h, -0.65, 0.5))
    said = [(1.12, drive), (1.0, "head: driven in translation,\nfree to rotate"), (0.8, moved), mass]
    said.append((0.0, "foot: clamped"))
    return _Drawing((shape.B, shape.b), shape.h, shape.e, lengths, said, [0.0], [1.0])


@style.journal
def draw(study: list[Path]) -> Figure:
    """Draw (a) the dimensions and (b) the scheme of the test of a study's simulated specimen."""
    content = read_json(only_file(study, "study"))
    shape = read_shape(content["specimens"]["geometry"])
    made = _drawing(shape, content["test"]["amplitude_m"])
    figure, (left, right) = style.new_figure(
        style.WIDE, 88.0, columns=2, gridspec_kw={"width_ratios": (1.0, 1.5)}
    )
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_ylim(-0.13 * made.height, 1.2 * made.height)
    _solid(left, made)
    _scheme(right, made, shape)
    style.letter(left, "a", "dimensions")
    style.letter(right, "b", "two-point bending" if shape.test == "bending" else shape.test)
    return figure


def _front(made: _Drawing) -> np.ndarray:
    """Corners of the front face [m], foot first, counter-clockwise."""
    (foot, head), h = made.widths, made.height
    return np.array([[-foot / 2, 0.0], [foot / 2, 0.0], [head / 2, h], [-head / 2, h]])


def _solid(axes: Axes, made: _Drawing) -> None:
    """Draw the body with its lengths, as seen from the front and a little from the right and above."""
    front, back = _front(made), made.depth * RECEDING
    if made.depth:
        axes.add_patch(
            Polygon([front[1], front[1] + back, front[2] + back, front[2]], facecolor=SIDE, **LINE)
        )
        axes.add_patch(Polygon([front[3], front[2], front[2] + back, front[3] + back], facecolor=END, **LINE))
    axes.add_patch(Polygon(front, facecolor=FRONT, **LINE))
    if not made.depth:
        width = made.widths[0]
        for z, face in ((0.0, FRONT), (made.height, END)):
            axes.add_patch(
                Ellipse((0.0, z), width, TILT * width, facecolor=face, edgecolor=style.INK, lw=0.8)
            )
    for symbol, length, x, z in made.lengths:
        upright = 90.0 if x < 0.0 else 0.0
        place = (x * made.widths[0] + back[0] * (x > 0.0), z * made.height)
        words = f"${symbol}$ = {1e3 * length:g} mm"
        axes.text(*place, words, ha="left" if x > 0.0 else "center", va="center", rotation=upright)
    axes.set_xlim(
        -0.9 * made.widths[0], 0.7 * made.widths[0] + back[0] + 0.25 * made.height * bool(made.depth)
    )


def _scheme(axes: Axes, made: _Drawing, shape: Any) -> None:
    """Draw the specimen at rest, its outline as it is moved, the plates that hold and drive it, and the words."""
    h, front = made.height, _front(made)
    axes.add_patch(Polygon(front, facecolor=FRONT, **LINE))
    z = np.linspace(0.0, h, 80)
    half = 0.5 * np.interp(z, (0.0, h), made.widths)
    moved = BENT * h * shape.line(z) if made.bends else 0.0 * z
    stretched = z if made.bends else (1.0 + 0.5 * BENT) * z
    for side in (-1.0, 1.0):
        axes.plot(moved + side * half, stretched, color=style.BLUE, lw=0.8, ls=style.DASHES[1])
    width, thick = made.widths[0], 0.04 * h
    for level in (*made.held, *made.driven):
        driven = level in made.driven
        below = 1.0 if level == 0.0 else 0.0 if level == 1.0 else 0.5
        plate = Rectangle((-0.7 * width, level * h - below * thick), 1.4 * width, thick, lw=0.6)
        plate.set(
            facecolor=style.GREY if driven else "none", edgecolor=style.INK, hatch="" if driven else "////"
        )
        axes.add_patch(plate)
        if driven:
            along = np.array([0.16 * h, 0.0] if made.bends else [0.0, 0.1 * h])
            start = np.array([0.72 * width, level * h] if made.bends else [0.0, (level + 0.04) * h])
            axes.annotate(
                "", tuple(start + along), xytext=tuple(start), arrowprops={"arrowstyle": "<->", "lw": 0.9}
            )
    right = 0.75 * width + 0.2 * h
    for level, text in made.said:
        axes.text(right, level * h, text, va="center")
    axes.set_xlim(-0.8 * width, right + 0.65 * h)
