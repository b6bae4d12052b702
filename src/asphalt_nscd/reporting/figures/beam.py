"""A prism and its test in four-point bending, for Fig. 1."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Rectangle

from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.reporting.figures import style

FACE, SIDE = "#d9dde2", "#eceef1"
BENT = 0.08  # deflection of the inner clamps in the scheme, of the span


def dimensions(axes: Axes, shape: Beam) -> None:
    """The prism, standing as it is cut, with span, depth and breadth."""
    span, depth = shape.h, shape.depth
    back = shape.breadth * np.array([0.5, 0.3])
    front = np.array([[-depth / 2, 0.0], [depth / 2, 0.0], [depth / 2, span], [-depth / 2, span]])
    for corners, colour in (
        (front, FACE),
        (np.array([front[1], front[1] + back, front[2] + back, front[2]]), SIDE),
        (np.array([front[3], front[2], front[2] + back, front[3] + back]), SIDE),
    ):
        axes.add_patch(Polygon(corners, facecolor=colour, edgecolor=style.INK, lw=0.8, joinstyle="round"))
    axes.text(-0.7 * depth, span / 2, f"$L$ = {1e3 * span:g} mm", ha="center", va="center", rotation=90.0)
    axes.text(0.0, -0.05 * span, f"$H$ = {1e3 * depth:g} mm", ha="center", va="center")
    axes.text(0.6 * depth + back[0], back[1] / 2, f"$B$ = {1e3 * shape.breadth:g} mm", va="center")
    axes.set_xlim(-1.2 * depth, 0.6 * depth + back[0] + 0.35 * span)


def scheme(axes: Axes, shape: Beam, amplitude: float) -> None:
    """Between clamps that rest and turn, and two that are driven together."""
    span, depth = shape.h, shape.depth
    z = np.linspace(0.0, span, 80)
    bent = BENT * span * shape.line(z)
    axes.add_patch(Rectangle((-depth / 2, 0.0), depth, span, facecolor=FACE, edgecolor=style.INK, lw=0.8))
    for side in (-depth / 2, depth / 2):
        axes.plot(bent + side, z, color=style.BLUE, lw=0.8, ls=style.DASHES[1])
    clamp = 0.04 * span
    for plate in shape.plates:
        rests = plate.share == 0.0
        patch = Rectangle((-0.8 * depth, plate.height - clamp / 2), 1.6 * depth, clamp, lw=0.6)
        patch.set(
            facecolor="none" if rests else style.GREY, edgecolor=style.INK, hatch="////" if rests else ""
        )
        axes.add_patch(patch)
        if not rests:
            tip, start = (0.8 * depth + 0.16 * span, plate.height), (0.8 * depth, plate.height)
            axes.annotate("", tip, xytext=start, arrowprops={"arrowstyle": "<->", "lw": 0.9})
    inner = shape.plates[1].height
    for level, text in (
        (span, "outer clamps: held,\nfree to turn"),
        (inner, r"inner clamps: $z = A\,\sin\,\omega t$," + f"\n$A$ = {1e6 * amplitude:.3g} µm"),
        (span / 2, f"mobile mass $m$ = {shape.mobile_mass:g} kg"),
        (span - inner, f"specimen $M$ = {shape.mass:g} kg"),
    ):
        axes.text(0.8 * depth + 0.2 * span, level, text, va="center")
    axes.set_xlim(-1.2 * depth, 0.8 * depth + 0.9 * span)
