"""One HTML file that needs no network: the first page, then all figures and tables with their captions."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from docutils.core import publish_parts
from jinja2 import Environment, StrictUndefined

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.reporting.pages.style import STYLE


@dataclass(frozen=True)
class Entry:
    """A figure (PNG) or a table (the HTML page made of it), in a part of the report."""

    part: str
    path: Path

    @property
    def name(self) -> str:
        return self.path.stem


def assemble(study: str, page: Mapping[str, Any], entries: Iterable[Entry], captions: Path) -> str:
    """HTML of the report. captions: folder with a reStructuredText file for each entry, its first line in bold."""
    parts: dict[str, list[dict[str, Any]]] = {}
    for entry in entries:
        parts.setdefault(entry.part, []).append(_shown(entry, captions / f"{entry.name}.rst"))
    ordered = {
        part.partition(" ")[2]: sorted(shown, key=lambda one: one["order"])
        for part, shown in sorted(parts.items())
    }
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    template = environment.from_string(
        (files("asphalt_nscd.reporting.pages") / "report.html").read_text(encoding="utf-8")
    )
    return template.render(study=study, style=STYLE, page=page, parts=ordered)


def _shown(entry: Entry, caption: Path) -> dict[str, Any]:
    if not caption.is_file() or not entry.path.is_file():
        raise InputError(
            f"{entry.path if caption.is_file() else caption}: no such file; make it or check the path."
        )
    title, _, text = caption.read_text(encoding="utf-8").partition("\n")
    title = title.strip("*").replace("\\", "")
    content: dict[str, Any] = {
        "name": entry.name,
        "title": title,
        "caption": _html(text),
        "order": _order(title),
    }
    if entry.path.suffix == ".png":
        return content | {"png": b64encode(entry.path.read_bytes()).decode()}
    whole = entry.path.read_text(encoding="utf-8")
    return content | {"body": whole.partition("<body>")[2].partition("</body>")[0]}


def _html(text: str) -> str:
    settings = {"file_insertion_enabled": False, "raw_enabled": False, "report_level": 5}
    return publish_parts(text, writer="html5", settings_overrides=settings)["body"]


def _order(title: str) -> tuple[int, str]:
    """Figures by their number, and the rest behind them."""
    number = title.removeprefix("Fig. ").partition(":")[0]
    return (int(number), title) if number.isdigit() else (100, title)
