"""The page of a diagnosis beside its files, with figures drawn for it."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.figures import fig_causality_map, fig_residual_map, fig_specimens
from asphalt_nscd.reporting.figures.save import as_bytes
from asphalt_nscd.reporting.pages.diagnosis_page import render, sections

PAGE = "diagnosis.html"


def write_page(folder: Path, title: str) -> Path:
    """Write diagnosis.html from diagnosis.json, residuals.csv and causality.csv of a folder; its path."""
    diagnosis, residuals, causality = (
        [folder / name] for name in ("diagnosis.json", "residuals.csv", "causality.csv")
    )
    figures = {
        "map": fig_residual_map.draw(residuals=residuals, diagnosis=diagnosis),
        "specimens": fig_specimens.draw(causality=causality, diagnosis=diagnosis),
        "causality": fig_causality_map.draw(causality=causality, diagnosis=diagnosis),
    }
    with TemporaryDirectory() as temporary:
        pictures = {}
        for name, figure in figures.items():
            (picture := Path(temporary, f"{name}.png")).write_bytes(as_bytes(figure, "png"))
            pictures[name] = [picture]
        content = render(sections(diagnosis, **pictures), title)
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE
