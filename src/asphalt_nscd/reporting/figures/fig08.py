"""Fig. 8: mean velocity of the spheres against height and time, during half a cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.geometry import shape_of
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import style

INSTANTS = {0.0: "0", 0.125: "T/8", 0.25: "T/4", 0.375: "3T/8", 0.5: "T/2"}
HEIGHTS = 5  # shown in (b)


@style.journal
def draw(test: list[Path], specimen: list[Path]) -> Figure:
    """Draw the mean velocity of the spheres along the drive (a) against height and (b) against time.

    Beside (a) stands the velocity of the beam or bar behind the form factor. A test by the harmonic method is refused,
    because it holds no velocities.
    """
    path = only_file(test, "test")
    record = load(path, "test")
    if "profile/velocity_m_s" not in record.arrays:
        raise InputError(f"{path}: holds no velocities; simulate it by a method other than harmonic.")
    shape = shape_of(load(only_file(specimen, "specimen"), "specimen").attributes)
    height, time, velocity = (
        record.arrays[f"profile/{name}"] for name in ("height_m", "time_s", "velocity_m_s")
    )
    filled = record.arrays["profile/spheres"] > 0
    height, velocity = 1e3 * height[filled], 1e3 * velocity[:, filled]  # mm, mm/s
    frequency = record.attributes["frequency_Hz"]
    # from the start of the last one, which comes up to a step early where steps do not divide a cycle
    cycles = frequency * time - np.floor(frequency * (time[0] + record.attributes["time_step_s"]))
    head = 2e3 * np.pi * frequency * record.attributes["amplitude_m"] * np.cos(2.0 * np.pi * cycles)

    figure, (left, right) = style.new_figure(style.WIDE, 76.0, columns=2)
    _profiles(left, shape, height, cycles, velocity, head)
    _histories(right, height, cycles, velocity)
    return figure


def _profiles(
    axes: Axes,
    shape: Shape,
    height: np.ndarray,
    cycles: np.ndarray,
    velocity: np.ndarray,
    head: np.ndarray,
) -> None:
    """Draw velocities (t, l) [mm/s] over height (l,) [mm] at INSTANTS, beside the line of theory times `head` (t,)."""
    fine = np.linspace(0.0, shape.h, 200)
    beam = shape.line(fine)
    for (instant, text), (colour, marker) in zip(INSTANTS.items(), style.series(len(INSTANTS)), strict=True):
        row = int(np.argmin(np.abs(cycles - instant)))
        axes.plot(head[row] * beam, 1e3 * fine, color=style.GREY, lw=0.6, zorder=1)
        axes.plot(velocity[row], height, ls="", marker=marker, ms=2.4, color=colour, mew=0.3)
        axes.annotate(
            text,
            (head[row] * beam.max(), 1e3 * fine[np.argmax(beam)]),
            xytext=(0.0, 4.0),
            ha="center",
            textcoords="offset points",
            fontsize=7.0,
            color=colour,
            annotation_clip=False,
        )
    axes.set_ylim(0.0, 1e3 * shape.h)
    axes.set_xlabel("mean velocity of the spheres (mm/s)")
    axes.set_ylabel("height above the foot (mm)")
    axes.legend(
        handles=[
            axes.plot([], [], ls="", marker="o", ms=2.4, color=style.INK, label="spheres")[0],
            axes.plot([], [], color=style.GREY, lw=0.6, label="beam theory")[0],
        ],
        loc="lower right",
        borderpad=0.1,
    )
    style.letter(axes, "a", "profiles at five instants", pad=15.0)


def _histories(axes: Axes, height: np.ndarray, cycles: np.ndarray, velocity: np.ndarray) -> None:
    """Draw velocities (t, l) [mm/s] of layers at five heights over half a cycle."""
    half = cycles <= 0.5 + 1e-9
    shares = np.linspace(0.2, 1.0, HEIGHTS)
    layers = [int(np.argmin(np.abs(height - share * height[-1]))) for share in shares]
    looks = style.series(HEIGHTS)
    for layer, (colour, _), dash in zip(layers, looks, style.DASHES, strict=True):
        axes.plot(cycles[half], velocity[half, layer], color=colour, ls=dash)
    axes.axhline(0.0, color=style.PALE, lw=0.5, zorder=0)
    axes.set_xlim(0.0, 0.5)
    axes.set_xlabel(r"time in the last cycle, $t/T$")
    axes.set_ylabel("mean velocity of the spheres (mm/s)")
    style.letter(axes, "b", "layers at five heights", pad=15.0)
    ends = [velocity[half, layer][-1] for layer in layers]
    texts = [f"{height[layer]:.0f} mm" for layer in layers]
    style.label_ends(axes, 0.5, ends, texts, [colour for colour, _ in looks])
