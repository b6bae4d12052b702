"""Files that are refused, for words of languages that the reader does not know or for slips, and their mends tried."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from layouts.families import FAMILIES, LATER_FAMILIES, Family, long, two_mixes
from layouts.files import save, sheets_of
from layouts.laboratory import LANGUAGES, Laboratory, Rows, Sheets, Tests, words_of
from layouts.mends import User, changed
from layouts.score import outcome

FOREIGN, LATER = words_of("foreign"), words_of("later")
MOST_STEPS = 4  # refusals of one file that are obeyed, one after the other


class Refused(NamedTuple):
    """A file that was refused: what came of obeying, and the sentences."""

    slip: str
    family: str
    language: str
    result: str
    steps: int
    sentences: str


def refusals(number: int, first: int, folder: Path) -> pd.DataFrame:
    """A row for each of so many refused files, drawn until there are enough; every second has words of LATER."""
    rows: list[Refused] = []
    seed = first
    while len(rows) < number:
        rows += filter(None, [obeyed(seed, folder, LATER, [*LATER_FAMILIES, *FAMILIES])])
        seed += 1
    return pd.DataFrame(rows)


def obeyed(
    seed: int,
    folder: Path,
    languages: Mapping[str, list[list[str]]] = FOREIGN,
    families: Sequence[Family] = FAMILIES,
) -> Refused | None:
    """What came of a file as its refusals were obeyed; None if it was read at once."""
    kind = "foreign words" if seed % 2 else SLIPS[seed // 2 % len(SLIPS)]
    lab, again = (Laboratory(seed, languages if seed % 2 else LANGUAGES) for _ in range(2))
    family, sheets = sheets_of(lab, seed // 2, families) if seed % 2 else slip(kind, lab, seed)
    right = sheets if seed % 2 else sheets_of(again, seed)[1]
    user = User(lab, sheets, right)
    said: list[str] = []
    while len(said) <= MOST_STEPS:
        path = save(folder, f"refused_{seed}_{len(said)}", user.sheets, lab)
        result, why = outcome(path, lab.tests, user.mix, user.columns)
        if result != "refused" or not user.obey(why):
            break
        said.append(why.replace(f"{folder}/", ""))
    if result != "read":
        said.append(why.replace(f"{folder}/", ""))
    return Refused(kind, family, lab.language, result, len(said), " | ".join(said)) if said else None


def slip(kind: str, lab: Laboratory, seed: int) -> tuple[str, Sheets]:
    """A family and its sheets with a slip in them."""
    if kind == "two mixes":
        return "two_mixes", two_mixes(lab)
    if kind in OF_LONG:
        ((name, rows),) = long(lab).items()
        return "long", {name: OF_LONG[kind](lab, rows)}
    family, sheets = sheets_of(lab, seed)
    moduli = {lab.e(e) for e, _ in lab.tests.values.values()}
    thousands = {value for value in moduli if value > 1000}
    modulus, phase = lab.name["e"], lab.name["p"]
    other = "MPa" if lab.unit == "GPa" else "GPa"
    change = {
        "modulus without unit": lambda cell: lab.bare["e"] if cell == modulus else cell,
        "names swapped": lambda cell: {modulus: phase, phase: modulus}.get(cell, cell),
        "other unit than said": lambda cell: cell.replace(lab.unit, other) if isinstance(cell, str) else cell,
        "thousands": lambda cell: f"{cell:,}" if cell in thousands else cell,
        "word in place of a number": lambda cell: "defekt" if cell == max(moduli) else cell,
    }[kind]
    return family, changed(sheets, change)


def _one_temperature(lab: Laboratory, rows: Rows) -> Rows:
    """Without its column; the tests at the others are left out."""
    t = lab.temperatures[-1]
    lab.tests = Tests({key: value for key, value in lab.tests.values.items() if key[1] == t})
    return [[row[0], *row[2:]] for row in (rows[0], *(row for row in rows[1:] if row[1] == lab.t(t)))]


def _logarithms(lab: Laboratory, rows: Rows) -> Rows:
    cells = [f"log {rows[0][3]}", *(round(float(np.log10(row[3])), 4) for row in rows[1:])]
    return [[*row[:3], cell, *row[4:]] for row, cell in zip(rows, cells, strict=True)]


def _twice(lab: Laboratory, rows: Rows) -> Rows:
    """A second column of this name, with other values."""
    return [[*rows[0], rows[0][3]], *([*row, round(1.07 * row[3], 3)] for row in rows[1:])]


OF_LONG: dict[str, Callable[[Laboratory, Rows], Rows]] = {
    "specimens without name": lambda lab, rows: [row[1:] for row in rows],
    "turned": lambda lab, rows: [list(row) for row in zip(*rows, strict=True)],
    "logarithms": _logarithms,
    "one temperature unsaid": _one_temperature,
    "modulus twice": _twice,
}
SLIPS = (
    "modulus without unit", "word in place of a number", "thousands", "names swapped", "other unit than said",
    "two mixes", *OF_LONG,
)  # fmt: skip
