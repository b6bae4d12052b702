"""A cylinder and its test in tension-compression, for Fig. 1."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.patches import Ellipse, Rectangle

from asphalt_nscd.measurements.tension import Cylinder
from asphalt_nscd.reporting.figures import style

TILT = 0.22  # height over width of the ends as drawn
STRETCH = 0.06  # of the head in the scheme, of the height
FACE, END = "#d9dde2", "#eceef1"


def dimensions(axes: Axes, shape: Cylinder) -> None:
    """The cylinder with its diameter and height."""
    d, h = shape.d, shape.h
    axes.add_patch(Ellipse((0.0, 0.0), d, TILT * d, facecolor=FACE, edgecolor=style.INK, lw=0.8))
    axes.add_patch(Rectangle((-d / 2, 0.0), d, h, facecolor=FACE, lw=0.0))
    for side in (-d / 2, d / 2):
        axes.plot([side, side], [0.0, h], color=style.INK, lw=0.8)
    axes.add_patch(Ellipse((0.0, h), d, TILT * d, facecolor=END, edgecolor=style.INK, lw=0.8))
    axes.text(0.0, h, f"$d$ = {1e3 * d:g} mm", ha="center", va="center")
    axes.text(-0.62 * d, h / 2, f"$h$ = {1e3 * h:g} mm", ha="center", va="center", rotation=90.0)
    axes.set_xlim(-0.8 * d, 0.8 * d)


def scheme(axes: Axes, shape: Cylinder, amplitude: float) -> None:
    """Between a plate at rest and one that is driven along the axis."""
    d, h = shape.d, shape.h
    plate = 0.05 * h
    axes.add_patch(Rectangle((-d / 2, 0.0), d, h, facecolor=FACE, edgecolor=style.INK, lw=0.8))
    ground = Rectangle((-0.7 * d, -plate), 1.4 * d, plate, facecolor="white", hatch="//////", lw=0.0)
    ground.set_edgecolor(style.GREY)
    axes.add_patch(ground)
    axes.plot([-0.7 * d, 0.7 * d], [0.0, 0.0], color=style.INK, lw=1.2)
    axes.add_patch(
        Rectangle((-0.6 * d, h), 1.2 * d, plate, facecolor=style.GREY, edgecolor=style.INK, lw=0.6)
    )
    moved = (1.0 + STRETCH) * h
    axes.plot(
        [-d / 2, -d / 2, d / 2, d / 2], [0.0, moved, moved, 0.0], color=style.BLUE, lw=0.8, ls=style.DASHES[1]
    )
    axes.annotate(
        "", (0.0, h + 4 * plate), xytext=(0.0, h + plate), arrowprops={"arrowstyle": "<->", "lw": 0.9}
    )
    drive = rf"$z = A\,\sin\,\omega t$,  $A$ = {1e6 * amplitude:g} µm"
    for level, text in (
        (h + 3 * plate, drive),
        (0.9 * h, f"upper plate: driven,\nmobile mass $m$ = {shape.mobile_mass:g} kg"),
        (0.5 * h, f"specimen $M$ = {shape.mass:g} kg"),
        (0.0, "lower plate: fixed"),
    ):
        axes.text(0.8 * d, level, text, va="center")
    axes.set_xlim(-0.8 * d, 2.4 * d)
