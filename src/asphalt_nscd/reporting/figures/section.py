"""A plane cut through a specimen: the spheres that the plane meets, and the bonds between them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from numpy.typing import NDArray

from asphalt_nscd.files.store import Record
from asphalt_nscd.reporting.figures import style

WINDOW = 0.17  # width of the piece shown, of the specimen's height


def draw_section(axes: Axes, specimen: Record, colours: NDArray[np.float64]) -> None:
    """Draw a piece of the plane y = 0 about half the height, of the shape of the axes; `colours` (n, 3) of spheres."""
    position, radius = specimen.arrays["position"], specimen.arrays["radius"]
    box = axes.get_position()
    figure = axes.get_figure(root=True)
    assert figure is not None
    width, height = figure.get_size_inches()
    shape = box.height * height / (box.width * width)
    half = 0.5 * WINDOW * specimen.attributes["h"] * np.array([1.0, shape])
    centre = np.array([0.0, 0.5 * specimen.attributes["h"]])
    axes.set_xlim(centre[0] - half[0], centre[0] + half[0])
    axes.set_ylim(centre[1] - half[1], centre[1] + half[1])

    plane = position[:, [0, 2]]
    met = np.abs(position[:, 1]) < radius
    disc = np.sqrt(radius[met] ** 2 - position[met, 1] ** 2)
    axes.add_collection(
        EllipseCollection(
            2.0 * disc,
            2.0 * disc,
            np.zeros(disc.size),
            units="xy",
            offsets=plane[met],
            transOffset=axes.transData,
            facecolors=colours[met],
            edgecolors=style.INK,
            linewidths=0.25,
            zorder=2,
        )
    )
    # Under the discs, so that a bond shows where mastic would be: in the gap.
    first, second = specimen.arrays["network/first"], specimen.arrays["network/second"]
    spheres = (first < radius.size) & (second < radius.size)  # the others lead to a plate
    first, second = first[spheres], second[spheres]
    shown = met[first] & met[second]
    axes.add_collection(
        LineCollection(
            list(np.stack([plane[first[shown]], plane[second[shown]]], axis=1)),
            colors=style.INK,
            linewidths=0.4,
            zorder=1,
        )
    )
