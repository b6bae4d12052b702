"""Panels of a forecast: the grading cut into levels, cuts through packings with their films, modulus and phase."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from asphalt_nscd.forecasting.forecast import Forecast, LevelResult
from asphalt_nscd.forecasting.network import CONTACT
from asphalt_nscd.forecasting.packing import LARGEST, LevelPacking
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.specimen.trimming import layer_height

TITLES = {
    "mori_tanaka": "Mori–Tanaka",
    "self_consistent": "self-consistent",
    "hirsch": "Hirsch",
    "witczak": "Witczak (2006)",
}
WINDOW = 3.4  # largest grains, width of a cut


@style.journal
def levels(found: Forecast) -> Figure:
    """The grading, and a cut through the packing of each level at its own fraction."""
    figure, axes = style.new_figure(style.WIDE, 58.0, columns=1 + len(found.levels))
    grading_of(axes[0], found)
    for panel, axis, result in zip("bcdefg", axes[1:], found.levels, strict=False):
        cut_through(axis, found, result)
        style.letter(axis, panel, result.level.name)
    style.letter(axes[0], "a", "grading")
    return figure


def grading_of(axes: Axes, found: Forecast) -> None:
    """Passing against sieve, the sizes of each level shaded."""
    grading = found.recipe.grading
    axes.plot(1e3 * grading.sieve, 100.0 * grading.passing, "-o", color=style.INK, ms=2.5)
    lowest = 1e3 * min(found.levels[0].level.smallest, grading.sieve[0])
    edges = [lowest, *(1e3 * result.level.largest for result in found.levels)]
    for k, (low, high) in enumerate(zip(edges[:-1], edges[1:], strict=True)):
        axes.axvspan(low, high, color=style.PALE, alpha=0.25 + 0.2 * (k % 2), lw=0.0)
    axes.set_xscale("log")
    axes.set_xlabel("sieve (mm)")
    axes.set_ylabel("passing (%)")


def cut_through(axes: Axes, found: Forecast, result: LevelResult) -> None:
    """Grains that the middle plane meets, shrunk to the fraction of the level; films between those that touch."""
    packing, level = result.packing, result.level
    shrunk = (level.fraction / packing.solid_fraction) ** (1.0 / 3.0)
    middle, top = packing.box[1] / 2.0, layer_height(packing.position, packing.radius)
    half = WINDOW * LARGEST / 2.0
    centre = np.array([packing.box[0] / 2.0, top / 2.0])
    offset = packing.position[:, 1] - middle
    met = np.abs(offset) < packing.radius
    at, radius = packing.position[met][:, [0, 2]] - centre, packing.radius[met]
    seen = np.sqrt(np.maximum(radius**2 - offset[met] ** 2, 0.0)) * min(1.0, shrunk)
    for (x, z), r in zip(at, seen, strict=True):
        axes.add_patch(Circle((x, z), r, facecolor="#b9b2a6", edgecolor=style.INK, lw=0.3))
    if level.touching and found.settings.touching:
        axes.add_collection(
            LineCollection(_contacts(packing, met, centre), colors=style.ORANGE, linewidths=0.8)
        )
    axes.set_facecolor("#4a4a4a")
    axes.set_xlim(-half, half)
    axes.set_ylim(-half, half)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    unit = 1e3 * level.largest / LARGEST * 2.0 * half
    axes.set_xlabel(f"{unit:.2g} mm wide,\n{100 * level.fraction:.0f} % grains")


def _contacts(packing: LevelPacking, met: np.ndarray, centre: np.ndarray) -> list[np.ndarray]:
    """Lines between the centres of grains of the cut that touch."""
    index = np.flatnonzero(met)
    position, radius = packing.position[index], packing.radius[index]
    apart = np.linalg.norm(position[:, None] - position[None], axis=2) - radius[:, None] - radius
    i, j = np.nonzero(np.triu(apart < CONTACT * np.minimum(radius[:, None], radius), 1))
    flat = position[:, [0, 2]] - centre
    return [np.array([flat[a], flat[b]]) for a, b in zip(i, j, strict=True)]


@style.journal
def curves(
    found: Forecast, points: pd.DataFrame, rivals: pd.DataFrame, measured: pd.DataFrame | None = None
) -> Figure:
    """|E*| and phase against reduced frequency, and the Black diagram, with rivals and, if known, measurements."""
    figure, axes = style.new_figure(style.WIDE, 72.0, columns=3)
    reduced = points["frequency_Hz"] * found.recipe.binder.shift.factor(points["temperature_C"])
    # Points come by temperature; a line is drawn along the reduced frequency.
    order = np.argsort(reduced.to_numpy())
    x = reduced.to_numpy()[order]
    frame, others = points.iloc[order], rivals.iloc[order]
    for axis, name, low, high in (
        (axes[0], "E_MPa", "E_low_MPa", "E_high_MPa"),
        (axes[1], "phase_deg", "phase_low_deg", "phase_high_deg"),
    ):
        axis.fill_between(x, frame[low], frame[high], color=style.BLUE, alpha=0.18, lw=0.0)
        axis.plot(x, frame[name], color=style.BLUE, lw=1.6, label="forecast, nothing fitted")
        for dash, (rival, title) in zip(style.DASHES[1:], TITLES.items(), strict=True):
            if f"{rival}_{name}" in others:
                axis.plot(x, others[f"{rival}_{name}"], color=style.GREY, ls=dash, lw=0.8, label=title)
        axis.set_xscale("log")
        axis.set_xlabel(f"reduced frequency (Hz){_reference(found)}")
    axes[2].plot(frame["phase_deg"], frame["E_MPa"], color=style.BLUE, lw=1.6)
    for dash, rival in zip(style.DASHES[1:], TITLES, strict=True):
        if f"{rival}_phase_deg" in others:
            axes[2].plot(
                others[f"{rival}_phase_deg"], others[f"{rival}_E_MPa"], color=style.GREY, ls=dash, lw=0.8
            )
    if measured is not None:
        at = measured["frequency_Hz"] * found.recipe.binder.shift.factor(measured["temperature_C"])
        point = {"ls": "", "marker": "o", "ms": 2.8, "color": style.ORANGE}
        axes[0].plot(at, measured["E_MPa"], **point, label="measured")
        axes[1].plot(at, measured["phase_deg"], **point)
        axes[2].plot(measured["phase_deg"], measured["E_MPa"], **point)
    largest = 2.0 * frame["E_high_MPa"].max()
    for axis in (axes[0], axes[2]):
        axis.set_yscale("log")
        axis.set_ylim(max(1.0, 0.2 * frame["E_low_MPa"].min()), largest)
        axis.set_ylabel("|E*| (MPa)")
    axes[1].set_ylim(0.0, 90.0)
    axes[1].set_ylabel("phase angle (°)")
    axes[2].set_xlim(0.0, 90.0)
    axes[2].set_xlabel("phase angle (°)")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    for panel, axis in zip("abc", axes, strict=True):
        style.letter(axis, panel)
    return figure


def _reference(found: Forecast) -> str:
    shift = found.recipe.binder.shift
    return f", at {shift.reference_temperature:g} °C" if found.recipe.shifted else ""


@style.journal
def doubts(words: Sequence[str], percent: Sequence[float]) -> Figure:
    """What moves the answer most: bars, the longest on top."""
    figure, axes = style.new_figure(style.SINGLE, 10.0 + 7.0 * len(words))
    order = np.argsort(percent)
    axes.barh([words[k] for k in order], [percent[k] for k in order], color=style.BLUE)
    axes.set_xlabel("change of |E*| (%)")
    return figure
