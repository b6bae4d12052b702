"""CSV tables from people: read strictly, refused with one sentence that says where and how to mend.

Column names carry their unit after the last underscore (`E_MPa`); the reader recognises the same
quantity under another unit or spelling and says which column it wants instead.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.files.errors import InputError, unreadable
from asphalt_nscd.files.paths import require_readable

_CONVERSIONS = {
    ("GPa", "MPa"): "multiply by 1000",
    ("kPa", "MPa"): "divide by 1000",
    ("Pa", "MPa"): "divide by 1e6",
    ("rad", "deg"): "multiply by 180/pi",
    ("mm", "m"): "divide by 1000",
    ("um", "m"): "divide by 1e6",
    ("m", "mm"): "multiply by 1000",
    ("cm", "mm"): "multiply by 10",
    ("kN", "N"): "multiply by 1000",
    ("g", "kg"): "divide by 1000",
    ("K", "C"): "subtract 273.15",
    ("ms", "s"): "divide by 1000",
    ("rad/s", "Hz"): "divide by 2 pi",
}
Values = (
    list[str] | NDArray[np.float64]
)  # of a column: texts as they stand, or numbers, NaN where a cell is empty
_AS_CSV = (
    "save it as UTF-8 CSV with commas and decimal points, or have `asphalt-nscd new-study` read it as it is"
)


@dataclass(frozen=True)
class Limits:
    """Closed range in which a value is plausible; `mend` says what to do about one that is not."""

    low: float
    high: float
    mend: str


@dataclass(frozen=True)
class Table:
    """Columns by name: texts of a CSV file, or numbers of a table that was understood.

    `lines` holds for each row its line number in the file, from 1; `files` the file of each row, where the table was
    put together from several.
    """

    path: Path
    columns: dict[str, Values]
    lines: list[int]
    files: list[Path] | None = None

    def error(self, row: int, problem: str) -> InputError:
        """What to raise for a row, from 0; it names file, line, the problem and its mend."""
        return InputError(f"{self.place(row)}: {problem}")

    def place(self, row: int) -> str:
        """File and line where a row stands, counted from 0."""
        return f"{self.path if self.files is None else self.files[row]}, line {self.lines[row]}"

    def require(self, names: Iterable[str]) -> None:
        """Refuse the table unless it has all the columns, and say what to rename or add."""
        names = list(names)
        for name in names:
            if name in self.columns:
                continue
            lookalike = self.lookalike(name, names)
            if lookalike is None:
                found = ", ".join(self.columns)
                raise InputError(f"{self.path}: column {name!r} is missing (found: {found}); add it.")
            unit = name.rpartition("_")[2]
            advice = _CONVERSIONS.get((_stem_and_unit(lookalike)[1], unit), f"give it in {unit}")
            raise InputError(f"{self.path}: column {lookalike!r} must be {name!r}; {advice} and rename it.")

    def lookalike(self, name: str, wanted: Iterable[str] = ()) -> str | None:
        """Column not `wanted` that holds a quantity under another unit or spelling; None if there is none."""
        stem = name.rpartition("_")[0] or name
        for column in self.columns:
            found = _stem_and_unit(column)[0]
            # One-letter symbols differ by case: e is a thickness, E a modulus.
            same = found == stem if len(stem) == 1 else found.casefold() == stem.casefold()
            if same and column not in wanted:
                return column
        return None

    def text(self, name: str) -> list[str]:
        """A column of text, one for each row; refuses an empty field, and one that a spreadsheet takes for a formula.

        The column goes into tables that are opened again in spreadsheets.
        """
        texts = [str(value) for value in self.columns[name]]
        for row, value in enumerate(texts):
            if not value:
                raise self.error(row, f"{name} is empty; fill it in or remove the line.")
            if value[0] in "=+-@":
                raise self.error(row, f"{name} {value!r} would be a formula in a spreadsheet; rename it.")
        return texts

    def numbers(self, name: str, limits: Limits | None = None) -> NDArray[np.float64]:
        """A column (n,) of finite numbers, all within `limits`."""
        values = np.array([self._number(name, row) for row in range(len(self.lines))])
        if limits is not None:
            outside = np.flatnonzero((values < limits.low) | (values > limits.high))
            if outside.size:
                row = int(outside[0])
                raise self.error(
                    row,
                    f"{name} = {values[row]:g} is outside {limits.low:g} to {limits.high:g}; {limits.mend}.",
                )
        return values

    def numbers_or_nan(self, name: str) -> NDArray[np.float64]:
        """A column (n,) that may be absent or have empty fields, which become NaN."""
        if name not in self.columns:
            return np.full(len(self.lines), np.nan)
        given = self.columns[name]
        if isinstance(given, np.ndarray):
            return given
        return np.array([self._number(name, row) if text else np.nan for row, text in enumerate(given)])

    def _number(self, name: str, row: int) -> float:
        """The finite number in a cell; InputError with its line for anything else."""
        value = self.columns[name][row]
        if isinstance(value, float) and math.isfinite(value):
            return value
        text = "" if value != value else str(value)
        try:
            value = plain_number(text)
        except ValueError:
            problem = f"{name} is empty" if not text else f"{name} = {text!r} is not a number"
            raise self.error(
                row, f"{problem}; write a number with a decimal point or remove the line."
            ) from None
        if not math.isfinite(value):
            raise self.error(row, f"{name} = {text} is not finite; write a number or remove the line.")
        return value


def read_csv(path: str | Path) -> Table:
    """Read a CSV file with one header line; blank lines and lines that begin with # are passed over."""
    path = Path(path)
    require_readable(path, "check the path")
    try:
        # Excel begins UTF-8 with a mark, which would become part of the first name.
        with path.open(newline="", encoding="utf-8-sig") as file:
            # A comment line becomes a blank one, so that line numbers stay those of the file.
            reader = csv.reader(("\n" if line.startswith("#") else line for line in file), strict=True)
            rows = [(reader.line_num, [field.strip() for field in row]) for row in reader]
    except (UnicodeDecodeError, csv.Error, OSError) as error:
        raise unreadable(path, f"cannot be read as CSV text ({error})", _AS_CSV) from None
    rows = [(line, fields) for line, fields in rows if any(fields)]
    if not rows:
        raise unreadable(path, "the file is empty", "give a header line and one line for each row")
    header = rows[0][1]
    # Excel writes semicolons where its decimals have commas.
    if len(header) == 1 and re.search("[;\t]", header[0]):
        raise InputError(f"{path}: columns are not separated by commas; {_AS_CSV}.")
    if len(set(header)) < len(header) or "" in header:
        raise InputError(
            f"{path}: a column name is empty or appears twice in the header; name each column once."
        )
    if len(rows) == 1:
        raise unreadable(path, "the table has a header but no rows", "add at least one")
    for line, fields in rows[1:]:
        if len(fields) != len(header):
            raise unreadable(
                path,
                f"line {line}: {len(fields)} fields under {len(header)} column names",
                "separate with commas and write decimals with a point",
            )
    columns: dict[str, Values] = {name: [row[i] for _, row in rows[1:]] for i, name in enumerate(header)}
    return Table(path, columns, [line for line, _ in rows[1:]])


def plain_number(text: str) -> float:
    """The number of a cell, finite or not; ValueError for none, or what only Python takes for one, such as `17_715`."""
    if "_" in text or not text.isascii():
        raise ValueError(f"{text!r} is not a number")
    return float(text)


def _stem_and_unit(column: str) -> tuple[str, str]:
    """Quantity and unit of a column name such as E_GPa, E (GPa), |E*| [GPa] or phase."""
    bracketed = re.fullmatch(r"(.*?)[\s_]*[(\[](.*)[)\]]", column)
    stem, unit = (
        bracketed.groups() if bracketed else (column.rpartition("_")[0] or column, column.rpartition("_")[2])
    )
    return re.sub(r"[|*\s]", "", stem), unit.strip()
