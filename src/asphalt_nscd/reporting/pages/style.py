"""A table as a page of its own, readable in the report and offline."""

from __future__ import annotations

from html import escape
from itertools import takewhile
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.errors import InputError

STYLE = """
body { font: 14px/1.4 system-ui, sans-serif; margin: 1.5em; color: #111; background: #fff; }
table { border-collapse: collapse; }
caption { text-align: left; font-weight: bold; padding-bottom: .6em; }
pre { max-width: 70em; white-space: pre-wrap; color: #444; }
th, td { padding: .25em .7em; border-bottom: 1px solid #ddd; text-align: left; }
td { vertical-align: top; max-width: 34em; }
th { position: sticky; top: 0; background: #fff; border-bottom: 2px solid #111; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr:hover td { background: #f2f2f2; }
"""


def page(table: str | Path, title: str) -> str:
    """The CSV table as one HTML page; numbers to six digits, empty cells empty.

    Comment lines at its beginning stand above it.
    """
    try:
        with Path(table).open(encoding="utf-8") as file:
            notes = [
                line[1:].strip("\n").removeprefix(" ") for line in takewhile(lambda x: x[0] == "#", file)
            ]
        frame = pd.read_csv(table, dtype={"specimen": str}, skiprows=len(notes))
    except FileNotFoundError:
        raise InputError(f"{table}: no such file; check the path.") from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise InputError(f"{table}: not a CSV table ({error}); make it again.") from None
    head = "".join(f"<th>{escape(str(name))}</th>" for name in frame)
    rows = "\n".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in frame.itertuples(index=False))
    said = f"<pre>{escape(chr(10).join(notes))}</pre>" if notes else ""
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f"<style>{STYLE}</style></head>\n<body>{said}<table><caption>{escape(title)}</caption>\n"
        f"<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n</tbody></table></body></html>\n"
    )


def _cell(value: object) -> str:
    if isinstance(value, str):
        return f"<td>{escape(value)}</td>"
    text = "" if pd.isna(value) else f"{value:d}" if isinstance(value, int) else f"{value:.6g}"
    return f'<td class="number">{text}</td>'
