"""The page of a forecast beside its files."""

from __future__ import annotations

from base64 import b64encode
from pathlib import Path

from matplotlib.figure import Figure

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.forecasting import written
from asphalt_nscd.forecasting.forecast import Forecast
from asphalt_nscd.reporting.figures import forecast_panels
from asphalt_nscd.reporting.figures.save import figure_bytes
from asphalt_nscd.reporting.pages.style import filled

PAGE = "forecast.html"


def write_page(found: Forecast, folder: Path) -> Path:
    """Write forecast.html, with its figures in it, beside the tables and the law that it links; returns its path."""
    said, points = written.summary(found), written.points(found)
    recipe, model = (
        {words: size["E_percent"] for words, size in said[kind].items()}
        for kind in ("inputs", "of_the_model")
    )
    content = filled(
        "forecast_page.html",
        title=f"Forecast of {found.recipe.name}",
        answer=written.answer(found),
        curves=_png(forecast_panels.curves(found, points, written.rival_points(found))),
        parts=_png(forecast_panels.parts(found)),
        inputs=_png(forecast_panels.inputs(recipe, model)),
        links=written.names(found),
    )
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE


def _png(figure: Figure) -> str:
    return b64encode(figure_bytes(figure, "png")).decode()
