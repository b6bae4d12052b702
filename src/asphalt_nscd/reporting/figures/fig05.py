"""Fig. 5: the preparation of a sample, from loose spheres to the bonded specimen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from asphalt_nscd.files.store import Record, load
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.section import draw_section
from asphalt_nscd.reporting.figures.spheres import View, picture

# On paper, mm.
HEIGHT, TALL, EDGE, GUTTER, TITLE = 113.0, 102.0, 1.0, 7.0, 9.0
SECTION = 25.0  # least height left for the section below the two layers, which are thick for a cylinder
LEGEND = 17.0  # width of the column that says which shade is which size
# No file keeps more than 250 dots an inch: at 508, drawing and saving took 7.1 CPU s in place of 3.6.
PIXELS = 12.0  # per mm: 300 dots an inch
VIEW = View(azimuth=-18.0, elevation=12.0)


@style.journal
def draw(deposit: list[Path], specimen: list[Path]) -> Figure:
    """Draw a sample (a) as lattice, (b) poured, (c) vibrated, (d) as specimen, (e) in section with its bonds."""
    poured = load(only_file(deposit, "deposit"), "deposit")
    cut = load(only_file(specimen, "specimen"), "specimen")
    # Shades go by the sizes poured, since those of the specimen were shrunk.
    radius, sizes = poured.arrays["radius"], np.unique(poured.arrays["radius"])
    shades, cut_shades = _shades(radius, sizes), _shades(_poured_radius(cut), sizes)
    lattice, loose, dense = (poured.arrays[n] for n in ("initial_position", "poured_position", "position"))
    trimmed = cut.arrays["position"], cut.arrays["radius"]

    # One scale for the lattice, another for the layers and the specimen, as large as fits.
    small = TALL / _span(lattice, radius)[1]
    upright, layer = _span(*trimmed), _span(dense, radius)
    room = style.WIDE - 2.0 * EDGE - 2.0 * GUTTER - small * _span(lattice, radius)[0]
    stacked = _span(loose, radius)[1] + layer[1]
    large = min(TALL / upright[1], room / (upright[0] + layer[0]), (TALL - 2.0 * TITLE - SECTION) / stacked)

    figure = Figure(figsize=(style.WIDE * style.MM, HEIGHT * style.MM))
    left = EDGE + small * _span(lattice, radius)[0] + GUTTER
    right = style.WIDE - EDGE - large * upright[0]
    top = HEIGHT - TITLE
    axes = _scene(figure, (lattice, radius, shades), small, EDGE, HEIGHT - TITLE - TALL)
    _box(axes, poured.arrays["box"])
    _title(figure, "a", "lattice", EDGE, top)
    heights = poured.attributes["poured_layer_height_m"], poured.attributes["layer_height_m"]
    for name, text, position, height in zip(
        "bc", ("poured", "vibrated"), (loose, dense), heights, strict=True
    ):
        tall = large * _span(position, radius)[1]
        _scene(figure, (position, radius, shades), large, left, top - tall)
        _title(figure, name, f"{text}, {1e3 * height:.1f} mm high", left, top)
        top -= tall + TITLE
    bottom = HEIGHT - TITLE - TALL
    _scene(figure, (*trimmed, cut_shades), large, right, bottom)
    _title(figure, "d", "specimen", right, bottom + large * upright[1])
    _title(figure, "e", "section, with bonds", left, top)
    axes = _axes(figure, left, bottom, right - GUTTER - LEGEND - left, top - bottom)
    draw_section(axes, cut, cut_shades)
    # Beside the title too, for in a small study the section is low.
    _sizes(_axes(figure, right - GUTTER - LEGEND, bottom, LEGEND, top + TITLE - 1.0 - bottom), sizes, large)
    return figure


def _poured_radius(specimen: Record) -> NDArray[np.float64]:
    return specimen.arrays["radius"] / (1.0 - specimen.attributes["volume_reduction"]) ** (1.0 / 3.0)


def _shades(radius: NDArray[np.float64], sizes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colour of each sphere by its size: light small ones, dark large ones."""
    colours = colormaps["YlGnBu"](np.linspace(0.08, 0.92, sizes.size))[:, :3]
    return colours[np.abs(radius[:, None] - sizes).argmin(axis=1)]


def _span(position: NDArray[np.float64], radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Width and height of a scene in the view's plane [m]."""
    seen = VIEW.project(position)[:, :2]
    return (seen + radius[:, None]).max(axis=0) - (seen - radius[:, None]).min(axis=0)


def _axes(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes without frame at a place on paper [mm]."""
    axes = figure.add_axes((left / style.WIDE, bottom / HEIGHT, width / style.WIDE, height / HEIGHT))
    axes.set_axis_off()
    return axes


def _scene(
    figure: Figure,
    spheres: tuple[np.ndarray, np.ndarray, np.ndarray],
    scale: float,
    left: float,
    bottom: float,
) -> Axes:
    """Spheres (position, radius, colour) at `scale` [mm on paper per m]; axes in the view's plane [m]."""
    image, extent = picture(*spheres, VIEW, scale * PIXELS)
    width, height = (scale * (extent[n + 1] - extent[n]) for n in (0, 2))
    axes = _axes(figure, left, bottom, width, height)
    axes.imshow(image, extent=extent, aspect="auto", interpolation="antialiased")
    return axes


def _box(axes: Axes, size: NDArray[np.float64]) -> None:
    """The twelve edges of the box that the spheres start in."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size
    seen = VIEW.project(corners)[:, :2]
    for n in range(8):
        for step in (1, 2, 4):
            if not n & step:
                axes.plot(
                    *seen[[n, n + step]].T,
                    color=style.INK,
                    lw=0.35,
                    clip_on=False,
                    scalex=False,
                    scaley=False,
                )


def _title(figure: Figure, name: str, text: str, left: float, bottom: float) -> None:
    figure.text(
        left / style.WIDE, (bottom + 2.0) / HEIGHT, rf"$\bf{{{name}}}$  {text}", fontsize=8.0, va="bottom"
    )


def _sizes(axes: Axes, sizes: NDArray[np.float64], scale: float) -> None:
    """Spheres of each size as in (b) to (d), with their diameters."""
    axes.set_xlim(0.0, LEGEND)
    tall = axes.get_position().height * HEIGHT
    axes.set_ylim(0.0, tall)
    axes.text(0.0, tall - 2.0, "diameter", fontsize=7.0, va="top")
    widest = scale * sizes.max()
    rows = np.linspace(
        tall - 5.0 - widest, max(widest, tall - 5.0 - widest - 3.9 * (sizes.size - 1)), sizes.size
    )
    for y, size in zip(rows, sizes[::-1], strict=True):
        colour = _shades(np.array([size]), sizes)[0]
        axes.add_patch(Circle((widest + 0.2, y), scale * size, facecolor=colour, edgecolor=style.INK, lw=0.3))
        axes.text(2.0 * widest + 1.0, y, f"{2e3 * size:g} mm", va="center", fontsize=7.0)
