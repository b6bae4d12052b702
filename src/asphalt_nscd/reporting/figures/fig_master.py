"""Master curve: do tests at all temperatures lie on one law, and how well is it known?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.diagnosis.written import conditions, read_diagnosis, read_residuals
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.words import joined
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import numbers, panels, style

BESIDE: dict[str, Any] = {"lw": 0.9, "ls": (0, (4, 2))}  # how the law is drawn beside the mix


@dataclass(frozen=True)
class Master:
    """Tests and curves over reduced_Hz; `shift` is log10 of the factor by isotherm [degC], none without a common law.

    tests: specimen, isotherm_C, reduced_Hz, E_MPa, phase_deg, and filled and words for `panels.points`. mix: the same
    quantities of the mix with their 95 % bands, as reported.csv has them; law: of law.json, beside it; modelled: means
    of the fit, drawn by isotherm where there is no mix. corrected: causes that were taken off the tests.
    """

    tests: pd.DataFrame
    mix: pd.DataFrame | None
    law: pd.DataFrame | None
    modelled: pd.DataFrame
    shift: dict[float, float]
    corrected: tuple[str, ...] = ()

    @property
    def isotherms(self) -> list[float]:
        """The isotherms tested [degC]."""
        return sorted(self.tests["isotherm_C"].unique())

    @property
    def reference(self) -> float:
        """Temperature [degC] at which the factor is one."""
        return min(self.shift, key=lambda at: abs(self.shift[at]))

    def panel(self, axes: Axes, quantity: str) -> None:
        """Draw "E" or "phase" over reduced frequency: points, the mix with its band, and the law dashed."""
        column, scale, _ = panels.QUANTITIES[quantity]
        looks = panels.isotherm_looks(self.isotherms)
        for isotherm, rows in self.tests.groupby("isotherm_C"):
            panels.points(axes, rows["reduced_Hz"], scale * rows[column.format("")], looks[isotherm], rows)
        if self.law is not None:
            panels.line(axes, "reduced_Hz", quantity, self.law, style.GREY, **BESIDE)
        if self.mix is not None:
            panels.line(axes, "reduced_Hz", quantity, self.mix, style.INK)
        else:
            for isotherm, rows in self.modelled.groupby("isotherm_C"):
                panels.line(axes, "reduced_Hz", quantity, rows, looks[isotherm][0], "_after")
        panels.quantity_axis(axes, quantity)
        panels.reduced_axis(axes, self.axis)

    @property
    def points(self) -> str:
        """What the points show, in words."""
        return f"tests less the {joined(self.corrected)}" if self.corrected else "tests as they were measured"

    @property
    def axis(self) -> str:
        """What the frequency axis shows, in words."""
        return (
            f"reduced frequency (Hz), at {numbers.celsius(self.reference)}"
            if self.shift
            else "frequency (Hz)"
        )

    def keys(self, measured: str) -> list[Line2D]:
        """Entries of a legend: what was `measured`, what is hollow of it, and the line."""
        words = "modelled" if self.mix is None else "the mix, 95 % band"
        lines = [Line2D([], [], color=style.INK, lw=1.0, label=words)]
        if self.law is not None:
            lines.append(Line2D([], [], color=style.GREY, label="law of few parameters", **BESIDE))
        points = [panels.key(measured, (style.INK, "o"), filled="filled" in self.tests)]
        if "filled" in self.tests and not self.tests["filled"].all():
            points.append(panels.key("doubtful or left out", (style.INK, "o")))
        return [*points, *lines]


def master(
    tests: pd.DataFrame,
    residuals: pd.DataFrame,
    content: Mapping[str, Any],
    curve: Sequence[Path] = (),
    corrected: Sequence[Path] = (),
) -> Master:
    """The master curve of tests (specimen, temperature_C, frequency_Hz, E_MPa, phase_deg) of a diagnosis.

    `content` is that of diagnosis.json, `curve` may hold its master_curve.csv, and `corrected` its corrected.csv, whose
    rows are those of `tests`: what is established is then taken off them.
    """
    rung = next((one for one in content["ladder"] if one["log10_shift"]), None)
    shift = {float(t): value for t, value in rung["log10_shift"].items()} if rung else {}
    causes: list[str] = []
    if corrected:
        after = pd.read_csv(only_file(corrected, "corrected tests"))
        # The free master curve has a shift even where a law for each temperature fits as well.
        ratio = np.log10(after["reduced_frequency_Hz"] / after["frequency_Hz"])
        shift = ratio.groupby(after["nominal_temperature_C"]).median().to_dict()
        causes = [
            one.replace("_", " ") for one in " + ".join(after["corrected_for"].dropna().unique()).split(" + ")
        ]
        tests = tests.assign(**{name: after[name].fillna(tests[name]) for name in ("E_MPa", "phase_deg")})
    stated = shift or content["reading"]["isotherms_C"]
    nominal = [float(at) for at in stated]
    placed = [_reduced(one, nominal, shift) for one in (tests, residuals)]
    modelled = conditions(placed[1].assign(temperature_C=placed[1]["isotherm_C"]), content["scatter"])
    modelled = _reduced(modelled, nominal, shift).sort_values("frequency_Hz")
    mix, law = _curves(curve) if shift and curve else (None, None)
    return Master(placed[0], mix, law, modelled, shift, tuple(dict.fromkeys(filter(None, causes))))


def _reduced(tests: pd.DataFrame, nominal: list[float], shift: dict[float, float]) -> pd.DataFrame:
    """The tests with the nearest of `nominal` [degC] as isotherm_C, and their frequency shifted as reduced_Hz."""
    isotherm = panels.isotherm_of(tests["temperature_C"], nominal)
    factor = 10.0 ** np.array([shift.get(at, 0.0) for at in isotherm])
    return tests.assign(isotherm_C=isotherm, reduced_Hz=tests["frequency_Hz"] * factor)


def _curves(curve: Sequence[Path]) -> tuple[pd.DataFrame, pd.DataFrame | None]:
    """The free master curve with its band, which gives the reported values; the law of law.json, None without one."""
    table = read_csv(only_file(curve, "master curve"))
    numbers = [name for name in table.columns if name != "averaged_over"]
    # A band that is not known is empty.
    frame = pd.DataFrame({name: table.numbers_or_nan(name) for name in numbers}).dropna(axis=1, how="all")
    frame = frame.rename(columns={"frequency_Hz": "reduced_Hz"})
    own = {f"law_{name}": name for name in ("E_MPa", "phase_deg") if f"law_{name}" in frame}
    return frame, frame[["reduced_Hz", *own]].rename(columns=own) if own else None


@style.journal
def draw(residuals: list[Path], diagnosis: list[Path], curve: Sequence[Path] = ()) -> Figure:
    """Draw (a) |E*| and (b) phase over reduced frequency, and (c) shift factors, if one law holds everywhere."""
    content, tests = read_diagnosis(diagnosis), read_residuals(residuals)
    made = master(tests, tests, content, curve)
    heights = (1.0, 1.0, 0.5)[: 2 + bool(made.shift)]
    figure, axes = style.new_figure(
        style.SINGLE, 65.0 * sum(heights), rows=len(heights), height_ratios=heights
    )
    for ax, quantity, panel in zip(axes, panels.QUANTITIES, "ab", strict=False):
        made.panel(ax, quantity)
        style.letter(ax, panel, pad=3.0)
    if made.shift:
        for at, look in panels.isotherm_looks(made.isotherms).items():
            axes[2].plot(at, made.shift[at], color=look[0], marker=look[1], ls="")
        axes[2].set(xlabel="temperature (°C)", ylabel="log10 shift factor")
        style.letter(axes[2], "c", "shift factors", pad=3.0)
    panels.isotherm_legends(figure, made.keys(content["origin"]), made.isotherms)
    return figure
