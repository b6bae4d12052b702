"""The check of the whole chain: simulated modulus against the law put into the bonds, test by test."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.measurements.tables import read_tests
from asphalt_nscd.reporting.figures import numbers, style

GROUP = 0.8  # width of a sample's group of points, of 1


@style.journal
def draw(simulations: list[Path]) -> Figure:
    """Draw (a) |E*| over that of the law, (b) phase minus that of the law; open markers where bonds broke."""
    tests = read_tests(simulations, numbers=["broken_bonds"])
    tests["ratio"] = tests["E_MPa"] / tests["E_law_MPa"]
    tests["lead"] = tests["phase_deg"] - tests["phase_law_deg"]
    samples = sorted(tests["specimen"].unique())
    temperatures = sorted(tests["temperature_C"].unique())
    frequencies = sorted(tests["frequency_Hz"].unique())
    # Within the group of a sample: one run of points for each temperature, frequencies from left to right.
    run = GROUP / len(temperatures)
    tests["place"] = (
        tests["specimen"].map(samples.index)
        - GROUP / 2.0
        + run * tests["temperature_C"].map(temperatures.index)
        + run * (0.5 + tests["frequency_Hz"].map(frequencies.index)) / (len(frequencies) + 0.5)
    )
    looks = style.series(len(temperatures))
    figure, panels = style.new_figure(style.WIDE, 90.0, rows=2, sharex=True)
    for axes, panel, column in zip(panels, "ab", ("ratio", "lead"), strict=True):
        for temperature, (colour, marker) in zip(temperatures, looks, strict=True):
            rows = tests[tests["temperature_C"] == temperature].sort_values("frequency_Hz")
            for _, points in rows.groupby("specimen"):
                axes.plot(points["place"], points[column], color=colour, lw=0.5)
            for broken, points in rows.groupby(rows["broken_bonds"] > 0):
                axes.plot(
                    points["place"],
                    points[column],
                    ls="",
                    color=colour,
                    marker=marker,
                    ms=3.2,
                    markerfacecolor="white" if broken else colour,
                )
        style.letter(axes, panel)
    panels[0].axhline(1.0, color=style.GREY, lw=0.5, zorder=0)
    panels[1].axhline(0.0, color=style.GREY, lw=0.5, zorder=0)
    panels[0].set_ylabel("|E*| simulated / law")
    panels[1].set_ylabel("phase, simulated − law (°)")
    panels[1].set_xlabel(
        f"in each run of points {frequencies[0]:g} to {frequencies[-1]:g} Hz from left to right"
    )
    panels[1].set_xticks(range(len(samples)), [f"sample {name}" for name in samples])
    for axes in panels:
        axes.tick_params(axis="x", length=0.0)
    panels[1].set_xlim(-0.5, len(samples) - 0.5)
    point: dict[str, Any] = {"ls": "", "ms": 3.2}
    handles = [
        Line2D([], [], **point, marker=marker, color=colour, label=numbers.celsius(temperature))
        for temperature, (colour, marker) in zip(temperatures, looks, strict=True)
    ]
    if (tests["broken_bonds"] > 0).any():
        handles.append(
            Line2D(
                [], [], **point, marker="o", color=style.INK, markerfacecolor="white", label="bonds broken"
            )
        )
    figure.legend(handles=handles, loc="outside upper left", ncols=8, borderpad=0.1, handlelength=1.0)
    return figure
