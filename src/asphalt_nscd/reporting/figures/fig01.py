"""Fig. 1: the simulated specimen, and its test."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle

from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.geometry import read_shape
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.measurements.tension import Cylinder
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.reporting.figures import beam, cylinder, style

RECEDING = np.array([0.5, 0.3])  # how a length across the specimen shows in (a)
BENT = 0.13  # deflection of the head in (b), of the height
FACES = {"front": "#d9dde2", "side": "#b4bcc6", "head": "#eceef1"}
ARROW = {"arrowstyle": "<->", "lw": 0.5, "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 5.0}


@style.journal
def draw(study: list[Path]) -> Figure:
    """Draw (a) the dimensions and (b) the scheme of the test of a study's simulated specimen."""
    content = read_json(only_file(study, "study"))
    geometry = read_shape(content["specimens"]["geometry"])
    figure, (left, right) = style.new_figure(
        style.WIDE, 88.0, columns=2, gridspec_kw={"width_ratios": (1.0, 1.5)}
    )
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_ylim(-0.13 * geometry.h, 1.2 * geometry.h)
    amplitude = content["test"]["amplitude_m"]
    if isinstance(geometry, Cylinder):
        cylinder.dimensions(left, geometry)
        cylinder.scheme(right, geometry, amplitude)
    elif isinstance(geometry, Beam):
        beam.dimensions(left, geometry)
        beam.scheme(right, geometry, amplitude)
    else:
        assert isinstance(geometry, Geometry)
        _dimensions(left, geometry)
        _test(right, geometry, amplitude)
    style.letter(left, "a", "dimensions")
    style.letter(right, "b", "two-point bending" if geometry.test == "bending" else geometry.test)
    return figure


def _front(geometry: Geometry) -> np.ndarray:
    """Corners of the front face [m], foot first, counter-clockwise."""
    b, B, h = geometry.b, geometry.B, geometry.h
    return np.array([[-B / 2, 0.0], [B / 2, 0.0], [b / 2, h], [-b / 2, h]])


def _dimensions(axes: Axes, geometry: Geometry) -> None:
    front, back = _front(geometry), geometry.e * RECEDING
    faces = {
        "front": front,
        "side": np.array([front[1], front[1] + back, front[2] + back, front[2]]),
        "head": np.array([front[3], front[2], front[2] + back, front[3] + back]),
    }
    for name, corners in faces.items():
        axes.add_patch(
            Polygon(corners, facecolor=FACES[name], edgecolor=style.INK, lw=0.8, joinstyle="round")
        )
    down, aside = np.array([0.0, -0.035 * geometry.h]), np.array([0.03 * geometry.h, 0.0])
    _dimension(axes, front[0] + down, front[1] + down, ("B", geometry.B), (0.0, -7.0))
    _dimension(axes, front[3] + back - down, front[2] + back - down, ("b", geometry.b), (0.0, 7.0))
    _dimension(axes, front[1] + aside, front[1] + back + aside, ("e", geometry.e), (28.0, -5.0))
    foot = np.array([front[0, 0], 0.0]) - aside
    _dimension(axes, foot, foot + [0.0, geometry.h], ("h", geometry.h), (-7.0, 0.0), rotation=90.0)
    axes.set_xlim(front[0, 0] - 6.0 * aside[0], front[1, 0] + back[0] + 9.0 * aside[0])


def _dimension(
    axes: Axes,
    start: np.ndarray,
    end: np.ndarray,
    measure: tuple[str, float],
    offset: tuple[float, float],
    rotation: float = 0.0,
) -> None:
    axes.annotate("", tuple(start), xytext=tuple(end), arrowprops=ARROW, annotation_clip=False)
    axes.annotate(
        f"${measure[0]}$ = {1e3 * measure[1]:g} mm",
        tuple((start + end) / 2.0),
        xytext=offset,
        rotation=rotation,
        textcoords="offset points",
        ha="center",
        va="center",
        annotation_clip=False,
    )


def _test(axes: Axes, geometry: Geometry, amplitude: float) -> None:
    h, b, B = geometry.h, geometry.b, geometry.B
    z = np.linspace(0.0, h, 60)
    half, bent = 0.5 * (B - (B - b) * z / h), BENT * h * geometry.line(z)
    axes.add_patch(Polygon(_front(geometry), facecolor=FACES["front"], edgecolor=style.INK, lw=0.8))
    axes.plot(
        np.concatenate([bent - half, (bent + half)[::-1]]),
        np.concatenate([z, z[::-1]]),
        color=style.BLUE,
        lw=0.8,
        ls=style.DASHES[1],
    )

    ground = Rectangle((-0.8 * B, -0.05 * h), 1.6 * B, 0.05 * h, facecolor="white", hatch="//////", lw=0.0)
    ground.set_edgecolor(style.GREY)
    axes.add_patch(ground)
    axes.plot([-0.8 * B, 0.8 * B], [0.0, 0.0], color=style.INK, lw=1.2)

    plate, pin = 0.03 * h, 0.018 * h  # thickness, radius
    axes.add_patch(
        Rectangle((-0.65 * b, h), 1.3 * b, plate, facecolor=style.GREY, edgecolor=style.INK, lw=0.6)
    )
    centre = np.array([0.0, h + plate + pin])
    axes.add_patch(Circle(tuple(centre), pin, facecolor="white", edgecolor=style.INK, lw=0.8))
    for side in (-1.0, 1.0):
        tip = centre + [side * 0.22 * h, 0.0]
        axes.annotate(
            "",
            tuple(tip),
            xytext=tuple(centre + [side * 1.5 * pin, 0.0]),
            arrowprops={"arrowstyle": "->", "lw": 0.9},
        )
    axes.text(
        0.0, centre[1] + 2.0 * pin, rf"$z = A\,\sin\,\omega t$,  $A$ = {1e6 * amplitude:g} µm", ha="center"
    )
    right = 0.36 * h
    for level, text in (
        (1.0 + (plate + pin) / h, "head: driven in translation,\nfree to rotate"),
        (0.88, f"mobile mass $m$ = {geometry.mobile_mass:g} kg"),
        (0.5, f"specimen $M$ = {geometry.mass:g} kg"),
        (0.0, "foot: clamped"),
    ):
        axes.text(right, level * h, text, va="center")
    axes.set_xlim(-0.3 * h, right + 0.60 * h)
