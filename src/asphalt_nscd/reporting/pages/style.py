"""How pages look: style, script, templates; and a table as a page of its own."""

from __future__ import annotations

import re
from importlib.resources import files
from itertools import takewhile
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup, escape

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.templates import template


def _own(name: str) -> str:
    return (files("asphalt_nscd.reporting.pages") / name).read_text(encoding="utf-8")


STYLE, SCRIPT = _own("page.css"), _own("page.js")
LONG = 40  # characters of a cell that must not be squeezed into a word a line


OPTION = re.compile(r"--[a-z][a-z-]*")
CELSIUS, DEGREES, MINUS = (
    re.compile(r"\bdegC\b"),
    re.compile(r"(?<=\d) deg\b"),
    # Not behind a letter, digit or bracket, where a hyphen is one: EN 12697-26.
    re.compile(r"(?<![\w.)])-(?=\d)"),
)


def typeset(cell: object) -> str:
    """A sentence of the terminal as it is printed: 4 degC -> 4 °C, 7.1 deg -> 7.1°, +- -> ±, a true minus.

    A number has six digits; what is none is empty.
    """
    if isinstance(cell, int | float):
        return "" if pd.isna(cell) else f"{cell:d}" if isinstance(cell, int) else f"{cell:.6g}"
    if isinstance(cell, Markup):  # of our own, with signs of its own
        return cell
    text = DEGREES.sub("°", CELSIUS.sub("°C", str(cell)).replace("+-", "±"))
    return MINUS.sub("\N{MINUS SIGN}", text)


def unbroken(cell: object) -> Markup:
    """A cell typeset for a page, where an option of the command line stays in one line."""
    return Markup(OPTION.sub(r'<span class="option">\g<0></span>', str(escape(typeset(cell)))))  # noqa: S704  escaped


def worded(cell: object) -> Markup:
    """The class of a cell that holds a number or a sentence; nothing for a short one."""
    if isinstance(cell, int | float):
        return Markup(' class="number"')
    sentence = isinstance(cell, str) and len(cell) > LONG and not isinstance(cell, Markup)
    return Markup(' class="words"' if sentence else "")


def filled(name: str, **content: Any) -> str:
    """HTML of a template of this folder, with the style and the script of all pages."""
    made = template(f"reporting/pages/{name}", {"worded": worded, "typeset": unbroken})
    return made.render(style=STYLE, script=SCRIPT, **content)


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
    rows = frame.itertuples(index=False)
    return filled("table_page.html", title=title, notes=_sentences(notes), head=list(frame), rows=rows)


def _sentences(notes: list[str]) -> list[str]:
    """Comment lines as sentences: an indented line goes on with the one above it."""
    joined: list[str] = []
    for note in notes:
        if note.startswith(" ") and joined:
            joined[-1] += f" {note.strip()}"
        else:
            joined.append(note)
    return joined
