"""Figures that Jupyter shows without pyplot."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SCREEN_DPI = 160  # figures have the size of a journal column, 90 mm


def shown_in_notebooks(figure: Figure) -> Figure:
    """The figure, which Jupyter then shows without pyplot."""

    def png() -> bytes:
        content = BytesIO()
        figure.savefig(content, format="png", dpi=SCREEN_DPI)
        return content.getvalue()

    figure._repr_png_ = png  # type: ignore[attr-defined]
    return figure
