"""How pages look: style, script, templates; and a table as a page of its own."""

from __future__ import annotations

import re
from html import escape
from importlib.resources import files
from itertools import takewhile
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from asphalt_nscd.diagnosis.words.sentences import capital
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted, joined, three_digits


def _own(name: str) -> str:
    return (files("asphalt_nscd.reporting.pages") / name).read_text(encoding="utf-8")


STYLE, SCRIPT = _own("page.css"), _own("page.js")
# A page of one table scrolls inside it, so that the head of the table stays in sight.
_ALONE = "@media screen { .wide { max-height: 92vh; overflow: auto; } }"
LONG = 40  # characters of a cell that must not be squeezed into a word a line


CELSIUS, DEGREES, MINUS = (
    re.compile(r"\bdegC\b"),
    re.compile(r"(?<=\d) deg\b"),
    # Not behind a letter, digit or bracket, where a hyphen is one: EN 12697-26.
    re.compile(r"(?<![\w.)])-(?=\d)"),
)


def typeset(text: str) -> str:
    """A sentence of the terminal as it is printed: 4 degC -> 4 °C, 7.1 deg -> 7.1°, +- -> ±, a true minus."""
    if isinstance(text, Markup):  # of our own, with signs of its own
        return text
    text = DEGREES.sub("°", CELSIUS.sub("°C", text).replace("+-", "±"))
    return MINUS.sub("\N{MINUS SIGN}", text)


def worded(cell: str) -> Markup:
    """The class of a cell that holds a sentence; nothing for a short one."""
    return Markup(' class="words"') if len(cell) > LONG and not isinstance(cell, Markup) else Markup("")


def environment() -> Environment:
    """The templates of this folder."""
    made = Environment(
        loader=PackageLoader("asphalt_nscd.reporting", "pages"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters |= {"worded": worded, "typeset": typeset, "counted": counted, "joined": joined}
    made.filters |= {"capital": capital, "three_digits": three_digits}
    return made


def filled(template: str, **content: Any) -> str:
    """HTML of a template of this folder, with the style and the script of all pages."""
    return environment().get_template(template).render(style=STYLE, script=SCRIPT, **content)


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
