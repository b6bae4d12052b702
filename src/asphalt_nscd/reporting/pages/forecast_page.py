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
from asphalt_nscd.reporting.figures.save import figure_bytes
from asphalt_nscd.reporting.pages.style import STYLE, environment

PAGE = "forecast.html"


def write_page(found: Forecast, folder: Path) -> Path:
    """Write forecast.html, with its figures in it, beside the tables and the law that it links; returns its path."""
    said, points = written.summary(found), written.points(found)
    moved = {name: size["E_percent"] for name, size in said["inputs"].items()}
    content = (
        environment()
        .get_template("forecast_page.html")
        .render(
            title=f"Forecast of {found.recipe.name}",
            style=STYLE,
            answer=_answer(found, said),
            curves=_png(forecast_panels.curves(found, points, written.rival_points(found))),
            parts=_png(forecast_panels.parts(found)),
            inputs=_png(forecast_panels.inputs(list(moved), list(moved.values()))),
            limit=f"Most is moved by {said['largest']}: |E*| by {moved[said['largest']]:.0f} %.",
            links=written.names(found),
        )
    )
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE


def _answer(found: Forecast, said: dict) -> list[str]:
    frame = written.points(found)
    # One point for the first line: that of the middle modulus.
    middle = frame.iloc[int(np.argsort(frame["E_MPa"].to_numpy())[len(frame) // 2])]
    volumes = ", ".join(f"{share:.1f} % {name}" for name, share in said["volume_percent"].items())
    return [
        f"|E*| = {middle.E_MPa:.0f} MPa ({middle.E_low_MPa:.0f} to {middle.E_high_MPa:.0f}) and phase "
        f"{middle.phase_deg:.1f}° ({middle.phase_low_deg:.1f} to {middle.phase_high_deg:.1f}) at "
        f"{middle.frequency_Hz:.3g} Hz and {middle.temperature_C:g} °C. {found.recipe.caveat} forecast.csv has all "
        f"{len(frame)} points.",
        f"By volume: {volumes}.",
    ]


def _png(figure: Figure) -> str:
    return b64encode(figure_bytes(figure, "png")).decode()
