"""What Jupyter shows: figures without pyplot, and objects as small tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SCREEN_DPI = 160  # figures have the size of a journal column, 90 mm


def sheet(title: str, rows: Mapping[str, str], notes: Sequence[str] = ()) -> str:
    """An object as HTML.

    Parameters
    ----------
    title : str
        Its heading.
    rows : mapping of str to str
        By the name of each quantity, its value and unit.
    notes : sequence of str
        Sentences to unfold.

    Returns
    -------
    str
        A table; all text is escaped.
    """
    cells = "".join(
        f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows.items()
    )
    items = "".join(f"<li>{escape(note)}</li>" for note in notes)
    folded = f"<details><summary>Notes</summary><ul>{items}</ul></details>" if notes else ""
    return f"<p><b>{escape(title)}</b></p><table><tbody>{cells}</tbody></table>{folded}"


def shown_in_notebooks(figure: Figure) -> Figure:
    """Let Jupyter show a figure without pyplot.

    Parameters
    ----------
    figure : Figure
        Is changed.

    Returns
    -------
    Figure
        The same figure.
    """

    def png() -> bytes:
        content = BytesIO()
        figure.savefig(content, format="png", dpi=SCREEN_DPI)
        return content.getvalue()

    # Jupyter draws pyplot's figures by itself, but pyplot keeps each in memory until it is closed.
    figure._repr_png_ = png  # type: ignore[attr-defined]
    return figure
