"""Figures as files: PDF and SVG for print, PNG for the screen, byte for byte reproducible."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.figures.style import RC

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Dates and random identifiers would make every run look different.
_METADATA = {"pdf": {"CreationDate": None}, "png": {"Software": None}, "svg": {"Date": None}}
PNG_DPI = 250


def save_figure(figure: Figure, stem: str | Path) -> None:
    """Write stem.pdf, stem.png and stem.svg, in the size that the figure was drawn in."""
    for kind in _METADATA:
        with atomic_path(f"{stem}.{kind}") as path:
            path.write_bytes(figure_bytes(figure, kind))


def figure_bytes(figure: Figure, kind: str, **settings: str) -> bytes:
    """The figure as a "pdf", "png" or "svg" file: the same bytes whenever it is made; `settings` of matplotlib."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # a user's matplotlibrc must not show
        matplotlib.rcParams.update(RC | {"svg.hashsalt": "asphalt-nscd"} | settings)
        content = BytesIO()  # matplotlib's own files complain again, at length, when they are closed
        figure.savefig(content, format=kind, dpi=PNG_DPI, metadata=_METADATA[kind])
        return content.getvalue()
