"""Panels of a forecast: grading, what its parts amplify, modulus and phase, what each input moves."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from asphalt_nscd.forecasting.forecast import Forecast
from asphalt_nscd.forecasting.written import PARTS, amplification, composition
from asphalt_nscd.reporting.figures import style

TITLES = {"hirsch": "Hirsch", "witczak": "Witczak 1-40D", "differential": "volumes alone"}


@style.journal
def parts(found: Forecast) -> Figure:
    """The grading, the volumes, and how much volumes, contacts and dry skeleton amplify the modulus of the binder."""
    figure, axes = style.new_figure(style.WIDE, 58.0, columns=3)
    grading = found.recipe.grading
    axes[0].plot(1e3 * grading.sieve, 100.0 * grading.passing, "-o", color=style.INK, ms=2.5)
    axes[0].set_xscale("log")
    axes[0].set_xlabel("sieve (mm)")
    axes[0].set_ylabel("passing (%)")
    volumes = composition(found.recipe)
    axes[1].barh(list(volumes), [100.0 * share for share in volumes.values()], color=style.BLUE)
    axes[1].set_xlabel("volume of the mix (%)")
    binder = np.geomspace(1e3, 1e9, 40)
    for dash, name in zip(style.DASHES, PARTS, strict=False):
        axes[2].plot(
            1e-6 * binder, amplification(found, name, binder), color=style.INK, ls=dash, lw=1.0, label=name
        )
    axes[2].set_xscale("log")
    axes[2].set_yscale("log")
    axes[2].set_xlabel("|E*| of the binder (MPa)")
    axes[2].set_ylabel("mix over binder")
    figure.legend(*axes[2].get_legend_handles_labels(), loc="outside upper right", ncols=3)
    for panel, axis in zip("abc", axes, strict=True):
        style.letter(axis, panel)
    return figure


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
        axis.plot(x, frame[name], color=style.BLUE, lw=1.6, label="forecast")
        for dash, (rival, title) in zip(style.DASHES[1:], TITLES.items(), strict=False):
            if f"{rival}_{name}" in others:
                axis.plot(x, others[f"{rival}_{name}"], color=style.GREY, ls=dash, lw=0.8, label=title)
        axis.set_xscale("log")
        axis.set_xlabel(_reduced(found))
    axes[2].plot(frame["phase_deg"], frame["E_MPa"], color=style.BLUE, lw=1.6)
    for dash, rival in zip(style.DASHES[1:], TITLES, strict=False):
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
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
    for panel, axis in zip("abc", axes, strict=True):
        style.letter(axis, panel)
    return figure


def _reduced(found: Forecast) -> str:
    if not found.recipe.shifted:
        return "frequency (Hz)"
    low, high = found.recipe.temperature.min(), found.recipe.temperature.max()
    reference = found.recipe.binder.shift.reference_temperature
    return f"reduced frequency (Hz)\n{low:g} to {high:g} °C, at {reference:.3g} °C"


@style.journal
def inputs(recipe: Mapping[str, float], model: Mapping[str, float]) -> Figure:
    """What moves |E*|, up or down: numbers of the recipe, the strongest on top, and below them those of the model."""
    figure, axes = style.new_figure(style.SINGLE, 10.0 + 7.0 * (len(recipe) + len(model)))
    for moved, color, label in ((model, style.GREY, "the model"), (recipe, style.BLUE, "the recipe")):
        words = sorted(moved, key=lambda one: abs(moved[one]))
        axes.barh(words, [moved[one] for one in words], color=color, label=label)
    axes.axvline(0.0, color=style.INK, lw=0.6)
    axes.set_xlabel("mean change of |E*| (%)")
    axes.legend()
    return figure
