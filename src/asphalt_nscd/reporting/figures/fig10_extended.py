"""Fig. 10 twice: the phase simulated with the paper's Burgers laws, and with the law the diagnosis names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.tables import only_file, origin_of, read_measured, read_tests
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.isotherms import panel
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.rheology.spectrum_io import read_spectrum

COLUMN = "phase_deg"


@style.journal
def draw(
    simulations: list[Path], extended: list[Path], measured: list[Path], laws: list[Path], common: list[Path]
) -> Figure:
    """Draw simulated means and those they are held against, with standard deviations, (a) before and (b) after.

    `simulations` is simulations.csv of the study and `extended` the table of the extended simulation; `laws` are the
    Burgers laws of (a), one for each temperature, and `common` the law of all temperatures in (b).
    """
    burgers = {read_json(path)["temperature_C"]: read_law(path).complex_modulus for path in laws}
    spectrum = read_spectrum(only_file(common, "common"))
    before, after, data = read_tests(simulations), read_tests(extended), read_measured(measured)
    temperatures = sorted(set(before["temperature_C"]) | set(after["temperature_C"]))
    frequencies = np.unique(np.concatenate([before["frequency_Hz"], after["frequency_Hz"]]))
    figure, panels = style.new_figure(style.SINGLE, 165.0, rows=2, sharex=True, sharey=True)
    # t=t keeps each temperature; without it all would have the last one of the loop.
    of_all: dict[float, Callable[..., np.ndarray]] = {
        t: lambda omega, t=t: spectrum.complex_modulus(omega, t) for t in temperatures
    }
    told = ("a Burgers law for each temperature", "one law, with what the diagnosis named")
    for axes, name, words, tests, lines in zip(
        panels, "ab", told, (before, after), (burgers, of_all), strict=True
    ):
        panel(axes, COLUMN, (tests, data), temperatures, frequencies, lines)
        style.letter(axes, name, words)
        # A shared axis takes the labels off the upper panel.
        axes.tick_params(labelbottom=True)
    panels[0].set_ylim(bottom=min(0.0, panels[0].get_ylim()[0]))
    point: dict[str, Any] = {"ls": "", "marker": "o", "color": style.INK}
    keys = [
        Line2D([], [], **point, markerfacecolor="white", label=origin_of(data)),
        Line2D([], [], **point, label="simulated"),
        Line2D([], [], color=style.INK, lw=0.7, label="law of the bonds"),
    ]
    style.isotherm_legends(figure, keys, temperatures)
    return figure
