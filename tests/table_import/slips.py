"""Tables and exports with slips that laboratories make, and how they are read."""

from __future__ import annotations

from pathlib import Path

import openpyxl
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.campaign import read_campaign

EXPORTS = Path(__file__).parents[2] / "data/tutorial/exports"
HEADER = ["specimen", "T (°C)", "f (Hz)", "E (MPa)", "phi (°)"]
ROWS = [
    [s, t, f, 9000 + 100 * f - 50 * t + k, 20.5] for k, s in enumerate("AB") for t in (4, 21) for f in (10, 1)
]


def read(folder, rows, name="t.csv", **chosen):
    path = folder / name
    if name.endswith(".xlsx"):
        workbook(path, **(rows if isinstance(rows, dict) else {"results": rows}))
    else:
        lines = [",".join("" if cell is None else str(cell) for cell in row) for row in rows]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return read_campaign([path], chosen=chosen)[0]


def workbook(path, **sheets):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


def plain(table):
    """Columns as lists: texts, and numbers to ten digits, None where a cell is empty."""
    return {
        name: [
            one if isinstance(one, str) else None if one != one else float(f"{one:.10g}") for one in values
        ]
        for name, values in table.columns.items()
    }


def columns(campaign, *names):
    return [plain(campaign.table)[name] for name in names]


def said(campaign, *parts):
    return [note for note in campaign.notes if all(part in note for part in parts)]


def refused(call, *given, names=(), **more):
    """In one line, which holds the names."""
    with pytest.raises(InputError) as error:
        call(*given, **more)
    text = str(error.value)
    assert "\n" not in text
    assert all(name in text for name in names), text


def as_is(folder):
    return plain(read(folder, [HEADER, *ROWS]).table)


EXPORT = """\
Target test temperature,4
Identification,Mix-{}
{}
,25 Hz,{} Hz,1 Hz
Dynamic modulus (MPa),9100,{},5000
Phase angle (Degrees),12.5,13.25,19
"""


def exports(folder, **files):
    for name, text in files.items():
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")
    return read_campaign([folder])[0]
