"""Where simulation and measurement differ: residuals over temperature and frequency, before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from asphalt_nscd.diagnosis.criteria import NOTABLE
from asphalt_nscd.diagnosis.written import BEFORE_AFTER, RESIDUALS, conditions, read_diagnosis, read_residuals
from asphalt_nscd.measurements.tables import averages, read_tests
from asphalt_nscd.reporting.figures import numbers, panels, style

ROWS = {
    "E": ("|E*| {} − simulated (%)", "modulus_percent"),
    "phase": ("phase {} − simulated (°)", "phase_deg"),
}


@style.journal
def draw(residuals: list[Path], diagnosis: list[Path], extended: Sequence[Path] = ()) -> Figure:
    """Draw one cell for each condition: |E*| above, phase below; each quantity has one scale for before and after.

    After are the tests that the study simulated again (`extended`), if it did, else what the diagnosis modelled.
    """
    content, tests = read_diagnosis(diagnosis), read_residuals(residuals)
    means = conditions(paired(tests, extended) if extended else tests, content["scatter"])
    figure, axes = style.new_figure(style.SINGLE, 112.0, rows=2, columns=2, sharex=True, sharey=True)
    letters = iter("abcd")
    for row, (quantity, (words, _)) in zip(axes, ROWS.items(), strict=True):
        for ax, when in zip(row, BEFORE_AFTER, strict=True):
            image = panel(ax, means, quantity, when, content["scatter"])
            style.letter(ax, next(letters), when)
        bar = figure.colorbar(
            image, ax=list(row), orientation="horizontal", fraction=0.06, aspect=40, pad=0.02
        )
        bar.set_label(words.format(content["origin"]))
        edges = image.norm.boundaries  # type: ignore[attr-defined]
        bar.ax.set_xticks(edges, [numbers.minus(f"{edge:g}") for edge in edges])
        bar.ax.tick_params(labelsize=6.0, length=1.5)
    for ax in axes[1]:
        ax.set_xlabel("frequency (Hz)")
        ax.tick_params(labelbottom=True)
    for ax in axes[:, 0]:
        ax.set_ylabel("temperature (°C)")
    marked = Patch(
        facecolor="none", edgecolor=style.INK, label=f"beyond {NOTABLE:g} standard deviations of replicates"
    )
    title = f"{content['origin']} data, means over specimens"
    figure.legend(
        handles=[marked],
        loc="outside upper left",
        title=title,
        title_fontsize=7.0,
        alignment="left",
        borderpad=0.1,
    )
    return figure


def paired(tests: pd.DataFrame, extended: Sequence[Path]) -> pd.DataFrame:
    """Residuals of which those `after` are against the mean of simulated samples: 100 ln of |E*| [%], phase [deg]."""
    simulated = averages(read_tests(extended))[["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]]
    both = tests.merge(
        simulated, on=["temperature_C", "frequency_Hz"], how="left", suffixes=("", "_simulated")
    )
    modulus, phase = both["E_MPa_simulated"], both["phase_deg_simulated"]
    off = {"E_after_MPa": modulus, "phase_after_deg": phase}
    off["residual_E_after_percent"] = 100.0 * np.log(both["E_MPa"] / modulus)
    off["residual_phase_after_deg"] = both["phase_deg"] - phase
    return both.assign(**off)


def panel(
    axes: Axes, means: pd.DataFrame, quantity: str, when: str, scatter: Mapping[str, Any]
) -> PatchCollection:
    """Draw residuals of "E" or "phase", "before" or "after", both on one scale; `means` as `conditions` gives it."""
    columns = [RESIDUALS[quantity].format(one) for one in BEFORE_AFTER]
    # Scatter alone must look pale.
    norm = panels.banded(max(float(means[columns].abs().max().max()), NOTABLE * scatter[ROWS[quantity][1]]))
    column = RESIDUALS[quantity].format(when)
    beyond = means[f"z_{column}"].abs() > NOTABLE
    return panels.cells(axes, means.assign(value=means[column], framed=beyond), norm)
