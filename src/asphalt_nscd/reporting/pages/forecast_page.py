"""The page of a forecast beside its files."""

from __future__ import annotations

from base64 import b64encode
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.forecasting import written
from asphalt_nscd.forecasting.forecast import Forecast
from asphalt_nscd.reporting.figures import forecast_panels
from asphalt_nscd.reporting.figures.save import as_bytes
from asphalt_nscd.reporting.pages.style import STYLE, environment

PAGE = "forecast.html"
HEAD = (
    "level",
    "grains (mm)",
    "grains (% of volume)",
    "grains touch",
    "grains in the network",
    "times as stiff as its matrix, binder at 1 MPa",
    "at 100 MPa",
)


def write_page(found: Forecast, folder: Path) -> Path:
    """Write forecast.html, with its figures in it, beside the tables and the law that it links; returns its path."""
    said, points = written.summary(found), written.points(found)
    doubts = {name: size["E_percent"] for name, size in said["doubts"].items()}
    content = (
        environment()
        .get_template("forecast_page.html")
        .render(
            title=f"Forecast of {found.recipe.name}",
            style=STYLE,
            answer=_answer(found, said),
            caution=found.caution,
            curves=_png(forecast_panels.curves(found, points, written.rival_points(found))),
            levels=_png(forecast_panels.levels(found)),
            doubts=_png(forecast_panels.doubts(list(doubts), list(doubts.values()))),
            head=HEAD,
            rows=[_row(level) for level in said["levels"]],
            limit=(
                f"The largest single doubt is {said['largest_doubt']}: it changes |E*| by "
                f"{doubts[said['largest_doubt']]:.0f} %. All doubts together are the band of the figure, "
                "which is no confidence interval."
            ),
            links=[written.TABLE, written.RIVAL_TABLE, written.LAW, written.SUMMARY],
        )
    )
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE


def _answer(found: Forecast, said: dict) -> list[str]:
    frame = written.points(found)
    # One point for the first line: that of the middle modulus.
    middle = frame.iloc[int(np.argsort(frame["E_MPa"].to_numpy())[len(frame) // 2])]
    return [
        f"|E*| = {middle.E_MPa:.0f} MPa ({middle.E_low_MPa:.0f} to {middle.E_high_MPa:.0f}) and phase "
        f"{middle.phase_deg:.1f}° ({middle.phase_low_deg:.1f} to {middle.phase_high_deg:.1f}) at "
        f"{middle.frequency_Hz:.3g} Hz and {middle.temperature_C:g} °C. {found.recipe.caveat} forecast.csv has all "
        f"{len(frame)} points.",
        f"By volume: {said['aggregate_volume_percent']:.1f} % aggregate, {said['binder_volume_percent']:.1f} % binder, "
        f"{said['air_voids_percent']:.1f} % air. The binder coats the grains {said['film_thickness_um']:.1f} µm thick.",
    ]


def _row(level: dict) -> list[str]:
    low, high = level["grains_mm"]
    amplified = level["amplification"]
    return [
        level["name"],
        f"{low:.3g} to {high:.3g}",
        f"{100 * level['volume_fraction']:.1f}",
        "yes" if level["grains_touch"] else "no",
        str(level["grains_in_network"]),
        f"{amplified['1 MPa']:.1f}",
        f"{amplified['100 MPa']:.1f}",
    ]


def _png(figure: Figure) -> str:
    return b64encode(as_bytes(figure, "png")).decode()
