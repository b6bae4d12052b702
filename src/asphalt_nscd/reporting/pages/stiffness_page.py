"""The page of tests without a phase: what was found, and the master curve with its band."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.figures import panels, style
from asphalt_nscd.reporting.figures.numbers import celsius
from asphalt_nscd.reporting.pages.charts import HEIGHT, WIDTH, Chart, inline, page_figure, said
from asphalt_nscd.reporting.pages.diagnosis_page import PAGE
from asphalt_nscd.reporting.pages.style import filled


def write_page(folder: Path, title: str, answer: list[tuple[str, str]]) -> Path:
    """Write the page beside stiffness_residuals.csv and master_curve.csv; `answer` has labels and sentences."""
    tests = pd.read_csv(folder / "stiffness_residuals.csv", dtype={"specimen": str})
    content = filled(
        "plain.html",
        title=title,
        charts=[_chart(tests, pd.read_csv(folder / "master_curve.csv"))],
        answer=answer,
    )
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE


@style.journal
def _chart(tests: pd.DataFrame, curve: pd.DataFrame) -> Chart:
    figure, axes = page_figure(WIDTH, HEIGHT)
    panels.line(axes, "frequency_Hz", "E", curve, style.INK)
    isotherms = sorted(tests["isotherm_C"].unique())
    for at, look in panels.isotherm_looks(isotherms).items():
        own = tests[tests["isotherm_C"] == at]
        words = [_words(row) for row in own.to_dict("records")]
        panels.points(axes, own["reduced_frequency_Hz"], own["E_MPa"] * 1e-3, look, own.assign(words=words))
    panels.reduced_axis(axes, f"reduced frequency (Hz), at {celsius(curve['temperature_C'].iloc[0])}")
    panels.quantity_axis(axes, "E")
    panels.isotherm_legends(figure, [panels.key("test", (style.INK, "o"))], isotherms)
    caption = "Points: tests. Line and band: the mix, 95 %."
    return Chart("stiffness", "Master curve of |E*|", caption, [inline(figure, f"|E*|, {len(tests)} tests")])


def _words(row: dict) -> str:
    return said(
        (row["specimen"], row["isotherm_C"], row["frequency_Hz"]),
        f"specimen {row['specimen']}, {celsius(row['temperature_C'])}, {row['frequency_Hz']:g} Hz: |E*| "
        f"{row['E_MPa']:.4g} MPa, {row['residual_percent']:+.1f} % off the curve",
    )
