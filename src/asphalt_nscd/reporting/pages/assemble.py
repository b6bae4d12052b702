"""One HTML file that needs no network: the first page, then all figures and tables with their captions."""

from __future__ import annotations

import os
import re
from base64 import b64encode
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from docutils.core import publish_parts

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.reporting.pages.style import filled

COLUMN = 1000  # px, more than a journal's column of 90 mm has; a broader figure is not shrunk to a telephone


@dataclass(frozen=True)
class Entry:
    """A figure (PNG) or a table (the HTML page made of it); `sources` are files with its data.

    `part` of the report begins with a number that orders the parts, "0 Diagnosis".
    """

    part: str
    path: Path
    sources: list[Path] = field(default_factory=list)

    @property
    def name(self) -> str:
        """Name of the figure or table."""
        return self.path.stem


def assemble(
    study: str,
    page: Mapping[str, Any],
    entries: Iterable[Entry],
    captions: Iterable[Path],
    folder: Path = Path(),
) -> str:
    """The report as one HTML file.

    `page` is the first page; `captions` are reStructuredText files with the names of the entries, their first line in
    bold. `folder` is where the report will stand; from there links lead to the files behind figures and tables.
    """
    by_name = {path.stem: path for path in captions}
    parts: dict[str, list[dict[str, Any]]] = {}
    for entry in entries:
        parts.setdefault(entry.part, []).append(
            _shown(entry, by_name.get(entry.name, Path(f"{entry.name}.rst")), folder)
        )
    ordered = {
        part.partition(" ")[2]: sorted(shown, key=lambda one: one["order"])
        for part, shown in sorted(parts.items())
    }
    return filled("report.html", study=study, page=page, parts=ordered)


def _shown(entry: Entry, caption: Path, folder: Path) -> dict[str, Any]:
    """What the template shows of an entry: name, title, caption, links, and its picture or the body of its page."""
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
        # Relative, so that the links hold wherever the folder is copied to.
        "sources": [(path.name, Path(os.path.relpath(path, folder)).as_posix()) for path in entry.sources],
    }
    if entry.path.suffix == ".png":
        picture = entry.path.read_bytes()
        width = int.from_bytes(picture[16:20], "big")  # of the header of a PNG
        return content | {"png": b64encode(picture).decode(), "broad": width > COLUMN}
    whole = entry.path.read_text(encoding="utf-8")
    # A page of our own, with one body and its style apart.
    body = whole.partition("<body>")[2].partition("</body>")[0]
    # Below the heading of its part.
    return content | {"body": re.sub(r"(</?h)([12])\b", lambda tag: f"{tag[1]}{int(tag[2]) + 2}", body)}


def _html(text: str) -> str:
    # Captions may not read files or pass HTML through, and docutils may not print its complaints into the page.
    settings = {"file_insertion_enabled": False, "raw_enabled": False, "report_level": 5}
    return publish_parts(text, writer="html5", settings_overrides=settings)["body"]


def _order(title: str) -> tuple[int, str]:
    """Figures by their number, and the rest behind them."""
    number = title.removeprefix("Fig. ").partition(":")[0]
    return (int(number), title) if number.isdigit() else (100, title)
