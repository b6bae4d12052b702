"""A user who does what a refusal asks, word for word, and no more."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from layouts.laboratory import Laboratory, Sheets

SAID = r'--column (\S+?)="([^"]*)"((?: or --column \S+="[^"]*")*)'
KEYS = {"E": "e", "phase": "p", "temperature": "t", "frequency": "f"}


def changed(sheets: Sheets, change: Callable[[Any], Any]) -> Sheets:
    """Sheets with another in place of each cell."""
    return {name: [[change(cell) for cell in row] for row in rows] for name, rows in sheets.items()}


@dataclass
class User:
    """A laboratory, what its file holds and what it should, and the options that it says."""

    lab: Laboratory
    sheets: Sheets
    right: Sheets
    columns: dict[str, str] = field(default_factory=dict)
    mix: str | None = None

    def obey(self, sentence: str) -> bool:
        """Do what a sentence asks; False if it asks nothing that can be done."""
        for pattern, act in ACTS:
            if (found := re.search(pattern, sentence)) and act(self, found) is not False:
                return True
        return False

    def change(self, change: Callable[[Any], Any]) -> None:
        """Put another in place of each cell."""
        self.sheets = changed(self.sheets, change)

    def restore(self, wrong: str) -> None:
        """Write the right number into the cells that hold this text."""
        for name, rows in self.sheets.items():
            for row, right in zip(rows, self.right.get(name, []), strict=False):
                whole = [*right, *row[len(right) :]]
                row[:] = [b if str(a) == wrong else a for a, b in zip(row, whole, strict=False)]

    def say(self, sentence: str) -> None:
        """Say each `--column`, with the user's own name and unit for NAME, or the one of several that is right."""
        for key, one, more in re.findall(SAID, sentence):
            stem = key.rpartition("_")[0]
            own = self.lab.bare.get(KEYS.get(stem, ""), self.lab.specimen)
            offered = [one, *re.findall(r'="([^"]*)"', more)]
            if one == "NAME":
                unit = {"e": self.lab.unit.replace("²", "2"), "p": "rad" if self.lab.radians else "deg", "f": "Hz",
                    "t": "F" if self.lab.fahrenheit else "C"}[KEYS[stem]]  # fmt: skip
                self.columns[f"{stem}_{unit}"] = own
            else:
                self.columns[key] = own if own in offered else one


def _with_units(user: User, found: re.Match[str]) -> None:
    user.change(lambda cell: user.lab.name["e"] if cell == user.lab.bare["e"] else cell)


def _other_unit(user: User, found: re.Match[str]) -> None:
    wrong = "MPa" if user.lab.unit == "GPa" else "GPa"
    user.change(lambda cell: cell.replace(wrong, user.lab.unit) if isinstance(cell, str) else cell)


def _grouped(user: User, found: re.Match[str]) -> None:
    """All numbers that are texts, not the first alone."""
    cells = {cell for rows in user.sheets.values() for row in rows for cell in row if isinstance(cell, str)}
    for text in cells:
        if re.fullmatch(r"\d+,\d{3}", text):
            user.restore(text)


def _turned(user: User, found: re.Match[str]) -> None:
    user.sheets = {name: [list(row) for row in zip(*rows, strict=True)] for name, rows in user.sheets.items()}


def _numbers(user: User, found: re.Match[str]) -> None:
    for rows in user.sheets.values():
        place = rows[0].index(found[1])
        rows[0][place] = found[1].removeprefix("log ")
        for row in rows[1:]:
            row[place] = 10.0 ** row[place]


def _first_alone(user: User, found: re.Match[str]) -> None:
    user.sheets = {name: [row[:-1] for row in rows] for name, rows in user.sheets.items()}


def _with_specimens(user: User, found: re.Match[str]) -> None:
    names = [s for s, _, _ in user.lab.tests.values]
    for name, rows in user.sheets.items():
        named = [[s, *row] for s, row in zip(names, rows[1:], strict=False)]
        user.sheets[name] = [["specimen", *rows[0]], *named]


def _line_above(user: User, found: re.Match[str]) -> bool:
    """If all tests are at one temperature."""
    ((_, t, _), *_) = user.lab.tests.values
    if any(other != t for _, other, _ in user.lab.tests.values):
        return False
    line = f"T = {user.lab.t(t)} {user.lab.units['t']}"
    user.sheets = {name: [[line], *rows] for name, rows in user.sheets.items()}
    return True


def _word_of_specimens(user: User, found: re.Match[str]) -> None:
    user.change(lambda cell: "Specimen" if cell == user.lab.specimen else cell)


def _exchanged(user: User, found: re.Match[str]) -> None:
    """The names of two columns that were swapped."""
    two = {user.lab.name["e"]: user.lab.name["p"], user.lab.name["p"]: user.lab.name["e"]}
    user.change(lambda cell: two.get(cell, cell))


def _renamed(user: User, found: re.Match[str]) -> None:
    """Each specimen with such a name, from its first letter or digit on."""
    user.change(lambda cell: re.sub(r"^[\W_]+", "", cell) if cell in user.lab.tests.specimens else cell)


ACTS: tuple[tuple[str, Callable[[User, re.Match[str]], Any]], ...] = (
    (r'--only-mix "([^"]+)"', lambda user, found: setattr(user, "mix", found[1])),
    (r"a line 'T = 20 °C' above the names", _line_above),
    (r"add a column specimen\.$", _with_specimens),
    (r"write it after the name, as in", _with_units),
    (r"'([^']+)' is not a number; write a number", lambda user, found: user.restore(found[1])),
    (r"is text; enter it as a number|write it without separators|without separators", _grouped),
    (r"must begin with a letter or digit .*; rename it", _renamed),
    (r"turn the table so that each test has a row", _turned),
    (r"column '([^']+)' holds logarithms; give the numbers themselves", _numbers),
    (r"appears twice; remove one", _first_alone),
    (r"Write it into the name of the column|write the unit \S+ into|multiply|is the unit", _other_unit),
    (r"exchange the two names|are as moduli; write|names of \|E\*\| and phase exchanged", _exchanged),
    (r"name the specimens above their matrices, as in `Specimen \| A`", _word_of_specimens),
    (r"--column (\S+?)=", lambda user, found: user.say(found.string)),
)  # fmt: skip
