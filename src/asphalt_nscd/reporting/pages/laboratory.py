"""The page of a diagnosis beside its files; the sentences of its answer stand in `diagnosis/words/brief.py`."""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.pages.diagnosis_page import render, sections

PAGE = "diagnosis.html"


def write_page(folder: Path, title: str) -> Path:
    """Write diagnosis.html from the files of a diagnosis; it links limits.csv and law.json where they are."""
    diagnosis, residuals, causality = (
        folder / name for name in ("diagnosis.json", "residuals.csv", "causality.csv")
    )
    others = (folder / name for name in ("limits.csv", "law.json"))
    links = [path.name for path in (residuals, causality, *filter(Path.is_file, others), diagnosis)]
    curve = list(filter(Path.is_file, [folder / "master_curve.csv"]))
    content = render(sections([diagnosis], [residuals], [causality], curve=curve), title, links)
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE
