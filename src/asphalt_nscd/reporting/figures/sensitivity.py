"""One Burgers parameter changed: what becomes of |E*| and phase (Figs. 11-14)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.tables import (
    averages,
    isotherm_rows,
    only_file,
    origin_of,
    read_measured,
    read_tests,
)
from asphalt_nscd.reporting.figures import numbers, style
from asphalt_nscd.reporting.figures.isotherms import APART, AXIS, SHOWN_PER_UNIT, error_bars, law_line
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import read_law

FIELDS = {"Em": "modulus_m", "eta_m": "viscosity_m", "Ek": "modulus_k", "eta_k": "viscosity_k"}
SYMBOLS = {"Em": r"$E_m$", "eta_m": r"$\eta_m$", "Ek": r"$E_k$", "eta_k": r"$\eta_k$"}


def figure_of(parameter: str) -> Callable[..., Figure]:
    """The function that draws |E*| (a) and phase (b) against frequency for each factor on a parameter, and unchanged.

    `parameter` is "Em", "eta_m", "Ek" or "eta_k". Tests with it unchanged are those at the temperature of the one law.
    """

    @style.journal
    def draw(
        sensitivity: list[Path], simulations: list[Path], measured: list[Path], laws: list[Path]
    ) -> Figure:
        law_file = only_file(laws, "laws")
        temperature = read_json(law_file)["temperature_C"]
        changed = read_tests(sensitivity, numbers=["factor"], texts=["parameter"])
        changed = changed[changed["parameter"] == parameter]
        if changed.empty:
            raise InputError(f"no test with another {parameter} in the sensitivity table; simulate some.")
        base = isotherm_rows(read_tests(simulations), temperature).assign(factor=1.0)
        data = isotherm_rows(read_measured(measured), temperature)
        cases = {1.0: averages(base)} | {
            factor: averages(rows) for factor, rows in isotherm_rows(changed, temperature).groupby("factor")
        }
        limits = base["frequency_Hz"].min(), base["frequency_Hz"].max()
        figure, panels = style.new_figure(style.WIDE, 66.0, columns=2)
        for axes, panel, column in zip(panels, "ab", ("E_MPa", "phase_deg"), strict=True):
            ends, texts, colours = [], [], []
            error_bars(axes, column, averages(data), 1.0 / APART, "o", style.GREY, filled=False)
            for factor, (colour, marker) in zip(sorted(cases), style.series(len(cases)), strict=True):
                dash = "-" if factor == 1.0 else style.DASHES[1 if factor < 1.0 else 2]
                law_line(
                    axes,
                    column,
                    _scaled(read_law(law_file), parameter, factor).complex_modulus,
                    limits,
                    colour,
                    ls=dash,
                )
                error_bars(axes, column, cases[factor], APART, marker, colour, filled=True)
                ends.append(cases[factor][column].iloc[-1] * SHOWN_PER_UNIT[column])
                texts.append(SYMBOLS[parameter] if factor == 1.0 else _change(parameter, factor))
                colours.append(colour)
            style.frequency_axis(axes, base["frequency_Hz"])
            axes.set_ylabel(AXIS[column])
            axes.set_ylim(bottom=0.0)
            style.letter(axes, panel)
            style.label_ends(axes, limits[1] * APART, ends, texts, colours)
        _legend(figure, panels[0], origin_of(data), temperature)
        return figure

    return draw


def _legend(figure: Figure, axes: Axes, origin: str, temperature: float) -> None:
    point = axes.errorbar([], [], fmt="o", color=style.GREY, markerfacecolor="white")
    simulated = axes.errorbar([], [], fmt="s", color=style.INK)
    (line,) = axes.plot([], [], color=style.INK, lw=0.7)
    keys: list[Any] = [point, simulated, line]  # matplotlib takes containers of artists too
    figure.legend(
        keys,
        [f"{origin}, {numbers.celsius(temperature)}", "simulated", "Burgers law of the bonds"],
        loc="outside upper left",
        ncols=3,
        borderpad=0.1,
    )


def _scaled(law: Burgers, parameter: str, factor: float) -> Burgers:
    field = FIELDS[parameter]
    return replace(law, **{field: factor * getattr(law, field)})


def _change(parameter: str, factor: float) -> str:
    return f"{SYMBOLS[parameter]} {100.0 * (factor - 1.0):+g} %".replace("-", "\N{MINUS SIGN}")
