"""Force chains and velocity field: what a bending test does inside the specimen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import sparse

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, load
from asphalt_nscd.measurements.geometry import shape_of
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.spheres import View, picture

PULLED, PUSHED = style.ORANGE, style.BLUE
WIDTH = 0.11  # points of a line per mean force
SLICE = 0.12  # of the thickness on either side of the middle plane: bonds of which the chains are shown
TALL, PER_MM = 92.0, 20.0  # mm on paper, and pixels of one
BINS = np.linspace(0.0, 12.0, 61)  # of force over its mean
VIEW = View(azimuth=0.0, elevation=0.0)


@style.journal
def draw(model: list[Path], specimen: list[Path]) -> Figure:
    """Draw bonds (a) in tension, (b) in compression as thick as their force, (c) velocity, (d) how forces spread."""
    condensed, cut = (
        load(only_file(model, "model"), "model"),
        load(only_file(specimen, "specimen"), "specimen"),
    )
    if condensed.attributes["name"] != Path(specimen[0]).stem:
        raise InputError(
            f"{model[0]}: belongs to another specimen than {specimen[0]}; give a model and its specimen."
        )
    motion, force = slow_deflection(condensed)
    position, radius = cut.arrays["position"], cut.arrays["radius"]
    figure, (pulled, pushed, field, spread) = style.new_figure(
        style.WIDE, 104.0, columns=4, width_ratios=(1.0, 1.0, 1.0, 1.35)
    )
    _chains(pulled, cut, np.maximum(force, 0.0), PULLED)
    _chains(pushed, cut, np.maximum(-force, 0.0), PUSHED)
    _field(field, position, radius, motion[: radius.size])
    _distribution(spread, force)
    for axes, name, text in (
        (pulled, "a", "tension"),
        (pushed, "b", "compression"),
        (field, "c", "velocity"),
    ):
        style.letter(axes, name, text)
        axes.set_aspect("equal")
        axes.set_axis_off()
    style.letter(spread, "d", "how forces spread")
    return figure


def slow_deflection(model: Record) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Speed (n,) of the bodies over that of the head, and normal force (b,) of the bonds over its mean size.

    In a slow test every bond has the same law, so that forces share one pattern: that of the static
    deflection, the first column of the basis. Tension is positive.
    """
    shape = model.arrays["weight"].size, model.arrays["mass"].size
    operator = sparse.csr_matrix(
        tuple(model.arrays[f"operator/{name}"] for name in ("data", "indices", "indptr")), shape=shape
    )
    deflection = model.arrays["basis"][:, 0]
    # The first of the three components of a bond is normal.
    normal = (model.arrays["weight"] * (operator @ deflection))[::3]
    bodies = deflection[: 6 * (deflection.size // 6)].reshape(-1, 6)
    return np.linalg.norm(bodies[:, :3], axis=1), normal / np.abs(normal).mean()


def _chains(axes: Axes, specimen: Record, force: NDArray[np.float64], colour: str) -> None:
    """Bonds about the middle plane from centre to centre, the strongest on top."""
    position = 1e3 * specimen.arrays["position"][:, [0, 2]]
    first, second = specimen.arrays["network/first"], specimen.arrays["network/second"]
    near = np.abs(specimen.arrays["network/point"][:, 1]) < SLICE * shape_of(specimen.attributes).thickness
    shown = np.flatnonzero(near & (np.maximum(first, second) < len(position)) & (force > 0.0))
    shown = shown[np.argsort(force[shown])]
    ends = np.stack([position[first[shown]], position[second[shown]]], axis=1)
    # As pixels, since a vector file would hold each of these lines.
    axes.add_collection(
        LineCollection(
            list(ends), linewidths=WIDTH * force[shown], colors=colour, capstyle="round", rasterized=True
        )
    )
    axes.set_xlim(position[:, 0].min(), position[:, 0].max())
    axes.set_ylim(position[:, 1].min(), position[:, 1].max())


def _field(axes: Axes, position: np.ndarray, radius: np.ndarray, speed: np.ndarray) -> None:
    """Draw spheres (n, 3), (n,) [m] from the front, shaded by their speed (n,) over that of the head."""
    shades = ScalarMappable(Normalize(0.0, 1.0), colormaps["viridis"])
    resolution = PER_MM * TALL / np.ptp(position[:, 2])
    image, extent = picture(position, radius, shades.to_rgba(speed)[:, :3], VIEW, resolution)
    axes.imshow(
        image,
        extent=(1e3 * extent[0], 1e3 * extent[1], 1e3 * extent[2], 1e3 * extent[3]),
        interpolation="antialiased",
    )
    bar = axes.figure.colorbar(shades, ax=axes, location="bottom", shrink=0.9, aspect=14.0, pad=0.02)
    bar.set_label("over that of the head")


def _distribution(axes: Axes, force: NDArray[np.float64]) -> None:
    """Draw how many bonds bear a force (b,), over its mean, in tension and in compression."""
    for part, colour, dash, text in (
        (force[force > 0.0], PULLED, style.DASHES[0], "tension"),
        (-force[force < 0.0], PUSHED, style.DASHES[1], "compression"),
    ):
        share = np.histogram(part, BINS)[0] / (force.size * np.diff(BINS))
        # A logarithmic axis has no place for zero.
        axes.stairs(np.where(share > 0.0, share, np.nan), BINS, color=colour, ls=dash, label=text)
    axes.set_yscale("log")
    axes.set_xlim(BINS[0], BINS[-1])
    axes.set_xlabel("normal force over its mean")
    axes.set_ylabel("share of bonds, per unit")
    axes.legend(loc="upper right")
