"""A sawn specimen that falls: where its pieces are, and where its energy goes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import panels, style
from asphalt_nscd.reporting.figures.spheres import side_view

SHOWN = 4  # instants: the start, the first impact, most of the motion gone, the end
PARTS = ("kinetic", "impact", "friction", "numerical")  # of the account


@style.journal
def draw(fall: list[Path]) -> Figure:
    """Draw (a)-(d) the pieces from the side, (e) where the energy of the fall goes, in shares of what it sets free."""
    arrays = load(only_file(fall, "fall"), "fall").arrays
    time, radius = arrays["time_s"], arrays["frames/radius_m"]
    figure, axes = style.new_figure(style.WIDE, 62.0, columns=SHOWN + 1, width_ratios=(1.0,) * SHOWN + (1.3,))
    start = arrays["frames/position_m"]
    landed = int(np.argmax(arrays["impact_J"] > 0.0))
    slow = int(np.flatnonzero(arrays["kinetic_J"] > 0.2 * arrays["kinetic_J"].max())[-1])
    shown = [0, landed, slow, len(time) - 1]
    colours = np.array([to_rgb(one) for one in (style.BLUE, style.ORANGE, style.INK)])
    every = start + arrays["frames/displacement_m"]
    limits = 1e3 * (every[..., 0] - radius).min(), 1e3 * (every[..., 0] + radius).max()
    for panel, k, name in zip(axes, shown, "abcd", strict=False):
        colour = colours[arrays["frames/fragment"][k] % len(colours)]
        side_view(panel, every[k], radius, colour)
        panel.axhline(0.0, color=style.GREY, lw=1.0)
        panel.set(xlim=limits, ylim=(-2.0, 1e3 * (every[0, :, 2] + radius).max()), aspect="equal")
        style.letter(panel, name, f"{1e3 * time[k]:.0f} ms")
    free = -arrays["load_J"][-1]
    panels.account(axes[-1], 1e3 * time, {name: 100.0 * arrays[f"{name}_J"] / free for name in PARTS})
    axes[-1].set(xlabel="time (ms)", ylabel="share of the energy (%)")
    style.letter(axes[-1], "e", "its energy")
    return figure
