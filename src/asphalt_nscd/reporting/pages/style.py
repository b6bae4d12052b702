"""A table as a page of its own, readable in the report and offline."""

from __future__ import annotations

from html import escape
from importlib.resources import files
from itertools import takewhile
from pathlib import Path

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from asphalt_nscd.files.errors import InputError


def _own(name: str) -> str:
    return (files("asphalt_nscd.reporting.pages") / name).read_text(encoding="utf-8")


STYLE, SCRIPT = _own("page.css"), _own("page.js")
# A page of one table scrolls inside it, so that the head of the table stays in sight.
_ALONE = "@media screen { .wide { max-height: 92vh; overflow: auto; } }"
LONG = 40  # characters of a cell that must not be squeezed into a word a line


def worded(cell: str) -> Markup:
    """The class of a cell that holds a sentence; nothing for a short one."""
    return Markup(' class="words"') if len(cell) > LONG else Markup("")


def environment() -> Environment:
    """The templates of this folder."""
    made = Environment(
        loader=PackageLoader("asphalt_nscd.reporting", "pages"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters["worded"] = worded
    return made


def page(table: str | Path, title: str) -> str:
    """The CSV table as one self-contained HTML page, its leading comments above it, numbers to six digits."""
    try:
        with Path(table).open(encoding="utf-8") as file:
            notes = [
                line[1:].strip("\n").removeprefix(" ") for line in takewhile(lambda x: x[0] == "#", file)
            ]
        # A specimen called 01 is not 1.
        frame = pd.read_csv(table, dtype={"specimen": str}, skiprows=len(notes))
    except FileNotFoundError:
        raise InputError(f"{table}: no such file; check the path.") from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise InputError(f"{table}: not a CSV table ({error}); make it again.") from None
    head = "".join(f'<th scope="col">{escape(str(name))}</th>' for name in frame)
    rows = "\n".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in frame.itertuples(index=False))
    said = "".join(f'<p class="note">{escape(note)}</p>' for note in _sentences(notes))
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{STYLE}{_ALONE}</style>'
        f"<script>{SCRIPT}</script></head>\n<body>{said}"
        # What scrolls must be reached by the keyboard, and have a name that a screen reader can say.
        f'<div class="wide" tabindex="0" role="region" aria-label="{escape(title)}"><table>'
        f"<caption>{escape(title)}</caption>\n"
        f"<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n</tbody></table></div></body></html>\n"
    )


def _sentences(notes: list[str]) -> list[str]:
    """Comment lines as sentences: an indented line goes on with the one above it."""
    joined: list[str] = []
    for note in notes:
        if note.startswith(" ") and joined:
            joined[-1] += f" {note.strip()}"
        else:
            joined.append(note)
    return joined


def _cell(value: object) -> str:
    if isinstance(value, str):
        return f"<td{worded(value)}>{escape(value)}</td>"
    text = "" if pd.isna(value) else f"{value:d}" if isinstance(value, int) else f"{value:.6g}"
    return f'<td class="number">{text}</td>'
