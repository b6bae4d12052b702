"""Workbooks and text files as laboratories lay them out, with the tests that they hold. Knows nothing of the reader."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
from openpyxl.utils import get_column_letter

Grid = list[list[Any]]

MODULUS = {
    "MPa": (
        1.0,
        0,
        (
            "|E*| (MPa)",
            "E* [MPa]",
            "Dynamic modulus (MPa)",
            "Module complexe |E*| (MPa)",
            "Steifigkeit (MPa)",
        ),
    ),
    "GPa": (1e-3, 3, ("|E*| (GPa)", "E* [GPa]")),
    "ksi": (1 / 6.894757293, 1, ("|E*| (ksi)", "Dynamic Modulus, ksi")),
    "psi": (1e3 / 6.894757293, 0, ("E* (psi)", "Dynamic Modulus (psi)")),
}
PHASE = {
    "deg": (1.0, 2, ("Phase angle (°)", "phi (deg)", "δ (°)", "Angle de phase φ (°)", "Phasenwinkel (Grad)")),
    "rad": (np.pi / 180.0, 5, ("Phase (rad)", "delta (rad)")),
}
FREQUENCY = ("Frequency (Hz)", "f (Hz)", "Freq. (Hz)", "Fréquence (Hz)", "Frequenz (Hz)")
CELSIUS = ("Temperature (°C)", "T (°C)", "T° (°C)", "Temp (°C)", "Température (°C)", "Temperatur (°C)")
FAHRENHEIT = ("Temperature (°F)", "Temp, °F", "T (°F)")
LABELS = ("Spec. {n}", "Specimen {n}", "{letter}", "Core {n}", "Éprouvette {n}", "S{n}", "K1{n}")


@dataclass(frozen=True)
class Tests:
    """What a file holds: |E*| [MPa] and phase [deg] by specimen, temperature [degC] and frequency [Hz]."""

    values: dict[tuple[str, float, float], tuple[float, float]]
    with_phase: bool = True

    @property
    def specimens(self) -> list[str]:
        return list(dict.fromkeys(s for s, _, _ in self.values))

    @property
    def temperatures(self) -> list[float]:
        return list(dict.fromkeys(t for _, t, _ in self.values))

    @property
    def frequencies(self) -> list[float]:
        return list(dict.fromkeys(f for _, _, f in self.values))


@dataclass(frozen=True)
class Style:
    """How a laboratory writes: units, words, marks."""

    random: np.random.Generator
    modulus: str = "MPa"
    phase: str = "deg"
    fahrenheit: bool = False
    words: dict[str, str] = field(default_factory=dict)

    def e(self, value: float) -> float:
        factor, digits, _ = MODULUS[self.modulus]
        return round(factor * value, digits) if digits else int(round(factor * value))

    def p(self, value: float) -> float:
        factor, digits, _ = PHASE[self.phase]
        return round(factor * value, digits)

    def t(self, value: float) -> float:
        shown = round(1.8 * value + 32.0, 1) if self.fahrenheit else value
        return int(shown) if shown == int(shown) else shown

    @property
    def degree(self) -> str:
        return "F" if self.fahrenheit else "C"


def draw_tests(random: np.random.Generator, specimens: int, with_phase: bool = True) -> Tests:
    """Tests of a Huet-Sayegh mix with scatter, in the digits that laboratories write."""
    schemes = (
        ([4.0, 20.0, 35.0], [25.0, 10.0, 5.0, 1.0, 0.5, 0.1]),
        ([-10.0, 4.0, 21.0, 37.0, 54.0], [0.1, 0.5, 1.0, 5.0, 10.0, 25.0]),
        ([-10.0, 0.0, 10.0, 15.0, 20.0, 30.0], [1.0, 3.0, 10.0, 25.0, 30.0, 40.0]),
        ([0.0, 10.0, 20.0, 30.0], [0.3, 1.0, 3.0, 10.0]),
    )
    temperatures, frequencies = schemes[random.integers(len(schemes))]
    template = LABELS[random.integers(len(LABELS))]
    names = [template.format(n=n, letter="ABCDEF"[n - 1]) for n in range(1, specimens + 1)]
    level, values = random.uniform(28e3, 38e3), {}
    for name in names:
        own = random.normal(0.0, 0.05)
        for t, f in product(temperatures, frequencies):
            shift = np.exp(2.303 * -9.0 * (t - 15.0) / (110.0 + t - 15.0))
            reduced = 1j * 2.0 * np.pi * f * 0.15 * shift
            star = 50.0 + (level - 50.0) / (1.0 + 2.1 * reduced**-0.2 + reduced**-0.57)
            modulus = abs(star) * np.exp(own + random.normal(0.0, 0.01))
            phase = np.degrees(np.angle(star)) + random.normal(0.0, 0.15)
            values[name, t, f] = float(modulus), max(float(phase), 0.3)
    return Tests(values, with_phase)


def _pick(style: Style, what: str, options: tuple[str, ...]) -> str:
    """One of several ways to write, the same throughout a file."""
    return style.words.setdefault(what, options[style.random.integers(len(options))])


def _modulus(style: Style) -> str:
    return _pick(style, "E", MODULUS[style.modulus][2])


def _phase(style: Style) -> str:
    return _pick(style, "phase", PHASE[style.phase][2])


def _frequency(style: Style) -> str:
    return _pick(style, "f", FREQUENCY)


def _temperature(style: Style) -> str:
    return _pick(style, "T", FAHRENHEIT if style.fahrenheit else CELSIUS)


def _rows(tests: Tests, style: Style, merged: bool = False) -> list[tuple[Any, Any, float, float]]:
    """Temperature and frequency as written, and as meant; merged: the temperature only where it changes."""
    out = []
    for t in tests.temperatures:
        for n, f in enumerate(tests.frequencies):
            out.append((None if merged and n else style.t(t), f, t, f))
    return out


def _name_and_unit(heading: str, between: str) -> str:
    """`|E*| (MPa)` with something in front of its unit."""
    stem, bracket, unit = heading.partition(" (") if " (" in heading else heading.partition(" [")
    return f"{stem}{between}{bracket}{unit}" if bracket else f"{heading}{between}"


def replicates_below(tests: Tests, style: Style) -> dict[str, Grid]:
    """|E*| and phase merged over a column for each specimen."""
    names = tests.specimens
    blank = [None] * (len(names) - 1)
    head = [_temperature(style), _frequency(style), _modulus(style), *blank, _phase(style), *blank]
    grid: Grid = [head, [None, None, *names, *names]]
    if style.random.random() < 0.3:  # means beside the specimens
        head[2 + len(names) : 2 + len(names)] = [None]
        grid[1][2 + len(names) : 2 + len(names)] = ["Mean"]
        grid[0].append(None)
        grid[1].append("Mean")
    with_means = len(grid[1]) > 2 + 2 * len(names)
    for t_shown, f_shown, t, f in _rows(tests, style, merged=style.random.random() < 0.5):
        both = [tests.values[s, t, f] for s in names]
        row = [t_shown, f_shown, *(style.e(e) for e, _ in both)]
        row += [style.e(float(np.mean([e for e, _ in both])))] if with_means else []
        row += [style.p(p) for _, p in both]
        row += [style.p(float(np.mean([p for _, p in both])))] if with_means else []
        grid.append(row)
    return {"Results": grid}


def specimens_above(tests: Tests, style: Style) -> dict[str, Grid]:
    """A specimen merged over its |E*| and phase."""
    names = tests.specimens
    grid: Grid = [
        [None, None, *(cell for s in names for cell in (s, None))],
        [_temperature(style), _frequency(style), *[_modulus(style), _phase(style)] * len(names)],
    ]
    for t_shown, f_shown, t, f in _rows(tests, style, merged=True):
        both = [tests.values[s, t, f] for s in names]
        grid.append([t_shown, f_shown, *(cell for e, p in both for cell in (style.e(e), style.p(p)))])
    return {"E star": grid}


def flat(tests: Tests, style: Style) -> dict[str, Grid]:
    """`E* 1 (MPa)`: the number of the specimen in each name."""
    numbers = range(1, len(tests.specimens) + 1)
    gap = (" ", "_", "")[style.random.integers(3)] if _phase(style)[0] != "δ" else " "
    tests_named = {str(n): s for n, s in zip(numbers, tests.specimens, strict=True)}
    e = [_name_and_unit(_modulus(style), f"{gap}{n}") for n in numbers]
    p = [_name_and_unit(_phase(style), f"{gap}{n}") for n in numbers]
    grid: Grid = [[_temperature(style), _frequency(style), *e, *p]]
    for t_shown, f_shown, t, f in _rows(tests, style):
        both = [tests.values[s, t, f] for s in tests_named.values()]
        grid.append([t_shown, f_shown, *(style.e(e) for e, _ in both), *(style.p(p) for _, p in both)])
    return {"Sheet1": grid}


def conditions_in_names(tests: Tests, style: Style) -> dict[str, Grid]:
    """`E* at 4C (MPa)`: a column for each temperature."""
    links = (" at {}{}", " @ {}°{}", " {} °{}", " T={}°{}")
    link = _pick(style, "link", links)
    at = [link.format(style.t(t), style.degree) for t in tests.temperatures]
    head = ["Specimen", _frequency(style)]
    head += [_name_and_unit(_modulus(style), one) for one in at] + [
        _name_and_unit(_phase(style), one) for one in at
    ]
    grid: Grid = [head]
    for s, f in product(tests.specimens, tests.frequencies):
        both = [tests.values[s, t, f] for t in tests.temperatures]
        grid.append([s, f, *(style.e(e) for e, _ in both), *(style.p(p) for _, p in both)])
    return {"Results": grid}


def _matrix(
    tests: Tests, style: Style, specimen: str, which: int, corner: str | None, across: str = "f"
) -> Grid:
    """One quantity of one specimen over temperature and frequency."""
    show = style.e if which == 0 else style.p
    if across == "f":
        head: Grid = [[corner, *tests.frequencies]]
        return head + [
            [style.t(t), *(show(tests.values[specimen, t, f][which]) for f in tests.frequencies)]
            for t in tests.temperatures
        ]
    head = [[corner, *(style.t(t) for t in tests.temperatures)]]
    return head + [
        [f, *(show(tests.values[specimen, t, f][which]) for t in tests.temperatures)]
        for f in tests.frequencies
    ]


def _corner(style: Style, across: str) -> tuple[Grid, str | None]:
    """Lines above a matrix and its corner, which say what stands across and what down."""
    over, down = (
        (_frequency(style), _temperature(style))
        if across == "f"
        else (_temperature(style), _frequency(style))
    )
    kind = style.words.setdefault("corner", ("above", "both")[style.random.integers(2)])
    if kind == "above":
        return [[None, over]], down
    return [], f"{down} \\ {over}"


def matrices_below(tests: Tests, style: Style) -> dict[str, Grid]:
    """Temperature by frequency, |E*| above and the phase below, one specimen after the other."""
    across = _pick(style, "across", ("f", "T"))
    grid: Grid = []
    for s in tests.specimens:
        grid.append(["Specimen", s] if len(tests.specimens) > 1 else ["Project", "RD 7, lot 2"])
        for which, title in enumerate(
            (_modulus(style), _phase(style)) if tests.with_phase else (_modulus(style),)
        ):
            above, corner = _corner(style, across)
            grid += [[title], *above, *_matrix(tests, style, s, which, corner, across), [None]]
    return {"Master curve": grid}


def matrices_in_two_sheets(tests: Tests, style: Style) -> dict[str, Grid]:
    """|E*| on one sheet and the phase on another."""
    across = _pick(style, "across", ("f", "T"))
    above, corner = _corner(style, across)
    (s,) = tests.specimens
    return {
        name: [[title], *above, *_matrix(tests, style, s, which, corner, across)]
        for which, (name, title) in enumerate((("Modulus", _modulus(style)), ("Phase", _phase(style))))
    }


def matrices_beside(tests: Tests, style: Style) -> dict[str, Grid]:
    """Frequency down, the temperatures of |E*| and then those of the phase across."""
    (s,) = tests.specimens
    count = len(tests.temperatures)
    temperatures = [f"{style.t(t)} °{style.degree}" for t in tests.temperatures]
    blank = [None] * (count - 1)
    grid: Grid = [
        [None, _modulus(style), *blank, _phase(style), *blank],
        [_frequency(style), *temperatures, *temperatures],
    ]
    for f in tests.frequencies:
        both = [tests.values[s, t, f] for t in tests.temperatures]
        grid.append([f, *(style.e(e) for e, _ in both), *(style.p(p) for _, p in both)])
    return {"Isothermes": grid}


def long(tests: Tests, style: Style) -> dict[str, Grid]:
    """A row for each test."""
    grid: Grid = [["Specimen", _temperature(style), _frequency(style), _modulus(style), _phase(style)]]
    grid += [[s, style.t(t), f, style.e(e), style.p(p)] for (s, t, f), (e, p) in tests.values.items()]
    return {"Data": grid}


def long_parts(tests: Tests, style: Style) -> dict[str, Grid]:
    """E1 and E2, or |E*| and tan delta, in place of |E*| and phase."""
    unit = style.modulus
    style = replace(style, modulus=unit)
    kind = ("12", "prime", "words", "tan")[style.random.integers(4)]
    names = {
        "12": (f"E1 ({unit})", f"E2 ({unit})"),
        "prime": (f"E' ({unit})", f"E'' ({unit})"),
        "words": (f"Storage modulus ({unit})", f"Loss modulus ({unit})"),
        "tan": (_modulus(style), ("tan delta", "tan δ", "tan(phi)")[style.random.integers(3)]),
    }[kind]
    grid: Grid = [["Core", _temperature(style), _frequency(style), *names]]
    factor, digits, _ = MODULUS[unit]
    for (s, t, f), (e, p) in tests.values.items():
        star = factor * e * np.exp(1j * np.radians(p))
        two = (
            (round(abs(star), digits + 1), round(float(np.tan(np.radians(p))), 5))
            if kind == "tan"
            else (round(star.real, digits + 1), round(star.imag, digits + 1))
        )
        grid.append([s, style.t(t), f, *two])
    return {"DMA": grid}


def sheets_of_specimens(tests: Tests, style: Style) -> dict[str, Grid]:
    """A sheet for each specimen with lines above its names."""
    said = style.random.random() < 0.5
    sheets: dict[str, Grid] = {}
    for n, s in enumerate(tests.specimens, start=1):
        above: Grid = (
            [["Specimen", s], ["Air voids (%)", 5.1]] if said else [["Project", "A 13"], ["Operator", "me"]]
        )
        grid = [*above, [None], [_temperature(style), _frequency(style), _modulus(style), _phase(style)]]
        for t_shown, f_shown, t, f in _rows(tests, style, merged=True):
            e, p = tests.values[s, t, f]
            grid.append([t_shown, f_shown, style.e(e), style.p(p)])
        sheets[f"Sheet{n}" if said else s] = grid
    return sheets


def sections(tests: Tests, style: Style) -> dict[str, Grid]:
    """Specimens below each other, each under its own names."""
    grid: Grid = []
    for s in tests.specimens:
        grid += [["Specimen", s], [_temperature(style), _frequency(style), _modulus(style), _phase(style)]]
        for t_shown, f_shown, t, f in _rows(tests, style):
            e, p = tests.values[s, t, f]
            grid.append([t_shown, f_shown, style.e(e), style.p(p)])
        grid.append([None])
    return {"Results": grid}


@dataclass(frozen=True)
class Layout:
    """How tests are laid out; specimens: how many it takes."""

    make: Callable[[Tests, Style], dict[str, Grid]]
    specimens: tuple[int, int] = (2, 4)
    phase: bool = True


LAYOUTS = {
    "replicates below": Layout(replicates_below),
    "specimens above": Layout(specimens_above),
    "flat": Layout(flat),
    "conditions in names": Layout(conditions_in_names),
    "matrices below": Layout(matrices_below, (1, 3)),
    "matrices in two sheets": Layout(matrices_in_two_sheets, (1, 2)),
    "matrices beside": Layout(matrices_beside, (1, 2)),
    "matrix without phase": Layout(matrices_below, (1, 2), phase=False),
    "long": Layout(long),
    "parts": Layout(long_parts),
    "sheets of specimens": Layout(sheets_of_specimens),
    "sections": Layout(sections),
}


def draw(seed: int, folder: Path) -> tuple[str, Path, Tests]:
    """One file: its layout, its path and what it holds. The layouts take turns; all else is drawn."""
    random = np.random.default_rng([seed, 35])
    name = list(LAYOUTS)[seed % len(LAYOUTS)]
    layout = LAYOUTS[name]
    tests = draw_tests(random, int(random.integers(*layout.specimens)), layout.phase)
    american = random.random() < 0.25 or not layout.phase
    style = Style(
        random,
        modulus=str(random.choice(["ksi", "psi"] if american else ["MPa", "MPa", "GPa"])),
        phase="rad" if random.random() < 0.15 else "deg",
        fahrenheit=bool(american),
    )
    sheets = layout.make(tests, style)
    if random.random() < 0.4:
        titles = [
            [["Essai de module complexe NF EN 12697-26"], ["Enrobé : EME 2 0/14, liant 20/30"]],
            [["Complex modulus test, AASHTO T 378"], ["Mix", "SP 12.5 PG 64-22"], [None]],
            [["Steifigkeit nach TP Asphalt-StB"], [None]],
        ][random.integers(3)]
        sheets = {sheet: [*titles, *grid] for sheet, grid in sheets.items()}
    if random.random() < 0.3:
        sheets = {sheet: [*grid, [None], ["Checked by", "J. Doe"]] for sheet, grid in sheets.items()}
    text = len(sheets) == 1 and random.random() < 0.35
    path = folder / f"{seed:03d} {name}.{'csv' if text else 'xlsx'}"
    _write_text(path, next(iter(sheets.values())), random) if text else _write_workbook(path, sheets)
    return name, path, tests


def _write_text(path: Path, grid: Grid, random: np.random.Generator) -> None:
    """With semicolons and decimal commas, or with commas and points, as a spreadsheet saves it."""
    german = random.random() < 0.6
    mark = ";" if german else ","
    lines = []
    for row in grid:
        cells = ["" if cell is None else str(cell) for cell in row]
        cells = [
            cell.replace(".", ",") if german and isinstance(value, float) else cell
            for cell, value in zip(cells, row)
        ]
        lines.append(mark.join(f'"{cell}"' if mark in cell else cell for cell in cells))
    path.write_text(
        "\r\n".join(lines) + "\r\n", encoding="cp1252" if german and _latin(lines) else "utf-8-sig"
    )


def _latin(lines: list[str]) -> bool:
    try:
        "".join(lines).encode("cp1252")
    except UnicodeEncodeError:
        return False
    return True


def _write_workbook(path: Path, sheets: dict[str, Grid]) -> None:
    """With cells that are truly merged over the empty ones behind a text."""
    book = openpyxl.Workbook()
    book.remove(book.worksheets[0])
    for name, grid in sheets.items():
        sheet = book.create_sheet(name)
        for row in grid:
            sheet.append(row)
        sheet.column_dimensions[get_column_letter(1)].width = 20
    book.save(path)
