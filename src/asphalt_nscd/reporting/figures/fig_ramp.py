"""A specimen pulled to failure: its curve, its broken bonds, and where the work goes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from asphalt_nscd.bending.ramp import RAMP
from asphalt_nscd.files.store import load
from asphalt_nscd.reporting.figures import panels, style
from asphalt_nscd.reporting.figures.spheres import side_view

PARTS = ("springs", "fracture", "dashpots", "numerical")  # of the account


@style.journal
def draw(ramp: list[Path]) -> Figure:
    """Draw (a) force and (b) broken bonds against displacement, (c) the work of the first, (d) where bonds broke."""
    runs = [load(path, RAMP).arrays for path in ramp]
    figure, (curve, bonds, work, place) = style.new_figure(
        style.WIDE, 55.0, columns=4, width_ratios=(1.0, 1.0, 1.0, 0.5)
    )
    for arrays, colour, dash in zip(runs, (style.BLUE, style.ORANGE), ("-", "--"), strict=False):
        moved = 1e6 * arrays["displacement_m"]
        curve.plot(moved, arrays["force_N"], color=colour, ls=dash, label=f"{moved.size} steps")
        bonds.step(moved, arrays["broken_bonds"], where="post", color=colour, ls=dash)
    first = runs[0]
    panels.account(
        work, 1e6 * first["displacement_m"], {name: 1e3 * first[f"energy_{name}_J"] for name in PARTS}
    )
    for axes, label in ((curve, "force (N)"), (bonds, "broken bonds"), (work, "energy (mJ)")):
        axes.set(xlabel="displacement (µm)", ylabel=label)
    curve.legend()
    radius = first["frames/radius_m"]
    side_view(place, first["frames/position_m"], radius, np.full((radius.size, 3), 0.85))
    broken = 1e3 * first["frames/point_m"][first["broken"]]
    place.plot(broken[:, 0], broken[:, 2], ".", ms=1.5, color=style.ORANGE)
    place.set_aspect("equal")
    for axes, letter, words in zip(
        (curve, bonds, work, place), "abcd", ("force", "bonds", "work", "breaks"), strict=True
    ):
        style.letter(axes, letter, words)
    return figure
