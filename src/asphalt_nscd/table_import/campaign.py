"""What a laboratory has, one file, several or a folder, as the one table of a campaign."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.csvinput import Table, Values
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import require_readable
from asphalt_nscd.files.words import choice, counted
from asphalt_nscd.measurements.campaign import Campaign, nominal_temperatures
from asphalt_nscd.measurements.kinds import UNKNOWN
from asphalt_nscd.measurements.slips import FACTORS, unit_in_question
from asphalt_nscd.table_import.cells import NotTests, Row, Sheet, UnreadNames, read_sheets
from asphalt_nscd.table_import.computed import computed_specimens
from asphalt_nscd.table_import.layouts import Layout, layout_of
from asphalt_nscd.table_import.quantities import QUALITY
from asphalt_nscd.table_import.several_files import (
    Part,
    drop_copies,
    drop_repeated,
    refuse_mislabelled,
    rows_of,
    unify_spelling,
)
from asphalt_nscd.table_import.shear import is_shear
from asphalt_nscd.table_import.skipped_files import SkippedFile, common_mend, listed, refused
from asphalt_nscd.table_import.targets import FAR
from asphalt_nscd.table_import.understand import (
    FURTHER,
    MAY_BE_ABSENT,
    TEXTS,
    names_force_or_modulus,
    understand,
)
from asphalt_nscd.table_import.unknown_names import named, with_names
from asphalt_nscd.table_import.words import WORDS

TEXT_FILES = (".txt", ".dat")  # which may hold running text
SAVE_AS = "save it as CSV or XLSX."
TABLES = (".csv", ".tsv", *TEXT_FILES, ".xlsx", ".xlsm", ".xlsb", ".xls", ".ods")
MOST_FILES = 500
MOST_LINES = 15  # from the top of a file, in which a title stands
_MEASURED = ("temperature_C", "nominal_temperature_C", "E_MPa", "phase_deg")


class _Wanted(NamedTuple):
    """What the user named: the only sheet, columns by what they hold, the only mix."""

    sheet: str | None
    columns: Mapping[str, str]
    mix: str | None


IN_THE_MENU = "choose it in the menu"


def read_campaign(
    paths: Sequence[Path],
    sheet: str | None = None,
    chosen: Mapping[str, str] | None = None,
    test_type: str | None = None,
    mix: str | None = None,
) -> tuple[Campaign, str]:
    """The campaign that files and folders hold together, and its form; `test_type` None takes what the files say.

    The form is that of `ParsedTable`. `chosen` names columns by what they hold; `mix` is the only one to read of a
    column of mixes.
    """
    wanted = _Wanted(sheet, chosen or {}, mix)
    notes: list[str] = []
    parts: list[Part] = []
    without_tests: list[str] = []
    for path in paths:
        if path.is_dir():
            found, said = _folder(path, notes, wanted)
            without_tests += [said] if said else []
        else:
            found = _file(path, notes, wanted)
        parts += found
    # Exports first: a table that was made from them is then the copy, and their quality columns stay.
    parts = drop_copies(sorted(parts, key=lambda part: not part.block.exported), notes)
    parts = unify_spelling(parts, notes)
    refuse_mislabelled(parts)
    _require_named_specimens(paths, parts)
    parts = drop_repeated(parts, notes)
    without_tests += dict.fromkeys(part.read.without_phase for part in parts if part.read.without_phase)
    lines = [cells for path in dict.fromkeys(part.path for part in parts) for cells in _first_lines(path)]
    stated = {"mix": _one_mix(parts)} | _stated(lines)
    forms = sorted({part.read.form for part in parts})
    if len(forms) > 1:
        raise InputError(
            f"{_called(paths)}: the files hold {' and '.join(forms)}; give those of one form together."
        )
    kind = test_type or _told_kind(parts, lines, forms[0], notes)
    table = _measured(_joined(paths, parts, notes), notes)
    _require_unit(paths, parts, table)
    strains = table.numbers_or_nan("microstrain")
    if (known := strains[np.isfinite(strains)]).size:
        ends = dict.fromkeys(f"{end:.4g}" for end in (known.min(), known.max()))
        stated["strain"] = f"{' to '.join(ends)} microstrain, as recorded"
    specimens = list(dict.fromkeys(table.text("specimen")))
    notes.append(
        f"{counted(len(specimens), 'specimen')}: {', '.join(specimens[:12])}{', ...' if len(specimens) > 12 else ''}"
    )
    files = tuple(dict.fromkeys(part.path for part in parts))
    notes = [*_said(parts), *notes]
    return Campaign(table, files, kind, tuple(notes), tuple(without_tests), stated), forms[0]


def _told_kind(parts: Sequence[Part], lines: Sequence[list[str]], form: str, notes: list[str]) -> str:
    """The kind of test: axial of exports, bending of forces, else the one that `lines` name; `notes` get the reason."""
    if any(part.block.exported for part in parts):
        way = choice("say --measured-in bending", IN_THE_MENU)
        notes.append(f"a machine export (AMPT, UTM) is taken as an axial test; for bending {way}")
        return "tension-compression"
    if form in ("peaks", "records"):
        notes.append("forces and displacements are taken as of two-point bending")
        return "bending"
    text = " ".join(cell for cells in lines for cell in cells)
    kinds = [kind for kind, pattern in WORDS["scheme"].items() if re.search(pattern, text, re.IGNORECASE)]
    if len(kinds) == 1:
        kind = kinds[0]
        way = choice("say --measured-in", IN_THE_MENU)
        notes.append(f"taken as {kind}, for the file names such a test; else {way}")
        return kind
    way = choice("say --measured-in bending or tension-compression", IN_THE_MENU)
    notes.append(f"which test gave the moduli is not said; {way}")
    # No guess: taken for bending, an AMPT's cylinder was told of guide friction and of a loose clamp.
    return UNKNOWN


def _stated(lines: Sequence[list[str]]) -> dict[str, str]:
    """What the first lines of files say for the head of a report, where all that say it agree."""
    found: dict[str, set[str]] = {}
    for cells in lines:
        if standard := re.search(WORDS["head"]["standard"], " ".join(cells), re.IGNORECASE):
            found.setdefault("standard", set()).add(standard[0])
        filled = [cell for cell in cells if cell]
        pair = re.split(r"\s*[:=]\s*", filled[0], maxsplit=1) if len(filled) == 1 else filled
        for name in WORDS["head"] if len(pair) == 2 else ():
            if re.fullmatch(WORDS["head"][name], pair[0].rstrip(" :="), re.IGNORECASE):
                found.setdefault(name, set()).add(pair[1].removesuffix(" 00:00:00"))
    return {name: texts.pop() for name, texts in found.items() if len(texts) == 1}


def _first_lines(path: Path) -> list[list[str]]:
    """Cells of the lines in which a title stands, of all sheets; none of a file that cannot be read."""
    try:
        return [cells for sheet in read_sheets(path) for _, cells in sheet.rows[:MOST_LINES]]
    # Why it cannot be read is said where it is read.
    except InputError:
        return []


def _require_named_specimens(paths: Sequence[Path], parts: Sequence[Part]) -> None:
    """Refuse exports that name no specimen and have one temperature a file, not one in all: are they one specimen?"""
    if not parts or not all(part.block.unnamed for part in parts):
        return
    specimens = {part.specimens[0] for part in parts}
    files = {part.path for part in parts}
    at = [_isotherm(part.read.table) for part in parts]
    # At one temperature files 1, 2, 3 may be specimens; each at its own they are isotherms of one.
    several = np.ptp(np.concatenate(at)) > FAR
    if len(specimens) == len(parts) == len(files) and several and all(np.ptp(t) < FAR for t in at):
        raise InputError(
            f"{_called(paths)}: {len(files)} files, {len(specimens)} specimens, each at one temperature only: write "
            "the specimen into Identification, or into the names of the files as in K10_21C."
        )


def _require_unit(paths: Sequence[Path], parts: Sequence[Part], table: Table) -> None:
    """Refuse moduli in another unit than MPa that are impossible in it and fit in MPa."""
    units = {part.read.modulus_unit for part in parts}
    unit = units.pop() if len(units) == 1 else ""
    if unit not in FACTORS or "phase_deg" not in table.columns:
        return
    names = ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg")
    tests = pd.DataFrame({name: table.numbers(name) for name in names}).assign(
        specimen=table.text("specimen")
    )
    tests["temperature_C"] = nominal_temperatures(table, tests["temperature_C"].to_numpy(float))
    positive = (tests["frequency_Hz"] > 0.0).all() and (tests["E_MPa"] > 0.0).all()
    if positive and (question := unit_in_question(tests, unit)):
        raise InputError(f"{_called(paths)}: {question} Write it into the name of the column.")


def _isotherm(table: Table) -> NDArray[np.float64]:
    """Target temperatures (n,) [degC], or where the table has none those measured."""
    return table.numbers_or_nan(
        "nominal_temperature_C" if "nominal_temperature_C" in table.columns else "temperature_C"
    )


def _one_mix(parts: Sequence[Part]) -> str:
    """The mix that all files are of; empty where none names it, refused where they name several."""
    mixes = {part.read.mix: part.source for part in parts if part.read.mix}
    if len(mixes) > 1:
        named = ", ".join(f"{mix} in {source}" for mix, source in list(mixes.items())[:4])
        raise InputError(
            f"{len(mixes)} mixes are given together ({named}), and a diagnosis is of one mix; give the files of one."
        )
    return next(iter(mixes), "")


def _file(path: Path, notes: list[str], wanted: _Wanted) -> list[Part]:
    """Tests of a file; of several sheets each that holds tests, the others named in the notes."""
    require_readable(path, "check the path")
    return _told_names(path, read_sheets(path, wanted.sheet), notes, wanted)


def _told_names(path: Path, sheets: list[Sheet], notes: list[str], wanted: _Wanted) -> list[Part]:
    """Tests of sheets; where names are not known, those that the user said what they hold are replaced by ours."""
    try:
        return _parts_of_sheets(path, sheets, notes, wanted)
    except UnreadNames as error:
        if ours := named(sheets, wanted.columns):
            return _told_names(path, ours, notes, wanted._replace(columns={}))
        raise with_names(error, path, sheets) from None


def _parts_of_sheets(path: Path, sheets: Sequence[Sheet], notes: list[str], wanted: _Wanted) -> list[Part]:
    """Tests of all sheets by one layout, or else of each sheet by its own; those without tests go into `notes`."""
    if layout := layout_of(sheets):
        return _parts_of_layout(path, layout, sheets, wanted)
    parts: list[Part] = []
    skipped: list[SkippedFile] = []
    for one in sheets:
        try:
            layout = layout_of([one])
            parts += _parts_of_layout(path, layout, [one], wanted) if layout else []
        except InputError as error:
            # It was meant to hold tests: passed over with a note, a test was lost and nobody saw it.
            if not isinstance(error, NotTests) and _names_tests(one.rows):
                raise
            skipped.append(refused(f"sheet {one.name} of {path.name}", error, one.path))
    if not parts:
        own = [replace(one, name=one.name.removesuffix(f" of {path.name}")) for one in skipped]
        raise NotTests(
            f"{path}: no sheet holds tests; it has {listed(own)}; "
            f"{common_mend(skipped) or 'give a table of moduli.'}"
        )
    if not all(part.block.means for part in parts):
        skipped += [SkippedFile(part.source, "means of other sheets") for part in parts if part.block.means]
        parts = [part for part in parts if not part.block.means]
    read = list(dict.fromkeys(part.source.rpartition(", sheet ")[2] for part in parts))
    way = choice("; --sheet takes one alone", "")
    notes.append(f"{counted(len(read), 'sheet')} of {path.name} read: {', '.join(read)}{way}")
    notes += [f"skipped {listed([one])}" for one in skipped]
    return parts


def _parts_of_layout(path: Path, layout: Layout, sheets: Sequence[Sheet], wanted: _Wanted) -> list[Part]:
    """A part for each block that `layout` reads; refuses a shear modulus, unless the user named the columns."""
    blocks = layout.read(sheets, wanted.columns)
    shear = next((name for block in blocks for name in block.cells.header if is_shear(name)), "")
    if shear and not wanted.columns:
        raise InputError(
            f"{path}: column {shear!r} is of a shear modulus, as binders have; give |E*| of the mix here. A recipe of "
            "`asphalt-nscd forecast` takes this file, as binder: {table: FILE}."
        )
    return [Part(path, understand(block.cells, wanted.columns, wanted.mix), block) for block in blocks]


def _folder(folder: Path, notes: list[str], wanted: _Wanted) -> tuple[list[Part], str]:
    """Tests of the files in a folder, and a sentence on those that hold none, which the notes name too."""
    # `~$NAME` is what Excel keeps beside an open workbook.
    inside = [path for path in folder.iterdir() if not path.name.startswith((".", "~$"))]
    # By stem, so that an original is read before its copy, `K10.csv` before `K10 - Copy.csv`.
    inside.sort(key=lambda path: (path.stem, path.suffix))
    if len(inside) > MOST_FILES:
        raise InputError(f"{folder}: more than {MOST_FILES} files; give the folder of one campaign.")
    parts: list[Part] = []
    others: list[SkippedFile] = []
    empty: list[SkippedFile] = []
    for path in inside:
        if path.is_dir():
            others.append(SkippedFile(path.name, "a folder; name it too if it belongs to the campaign"))
        elif path.suffix.lower() not in TABLES:
            table = _holds_tests(path, wanted.sheet)
            known = SkippedFile(path.name, "neither text nor workbook", SAVE_AS)
            (empty if table else others).append(known)
        else:
            try:
                parts += _file(path, notes, wanted)
            except InputError as error:
                text, none = path.suffix.lower() in TEXT_FILES, isinstance(error, NotTests)
                if not none and _holds_tests(path, wanted.sheet, unreadable=not text):
                    raise
                (others if none and text else empty).append(refused(path.name, error, path))
    if not parts:
        held = f"; it holds {listed([*empty, *others])}" if empty or others else ""
        mend = common_mend(empty) or "give the machine's exports or a table of moduli."
        if not empty and any(path.is_dir() for path in inside):
            mend = "give the folders in it by their own names."
        raise InputError(f"{folder}: no file with tests{held}; {mend}")
    notes += [f"skipped {listed([one])}" for one in (*others, *empty)]
    files = len({part.path for part in parts}) + len(empty)
    return parts, f"{len(empty)} of {files} files gave no test: {listed(empty)}." if empty else ""


def _holds_tests(path: Path, sheet: str | None, unreadable: bool = False) -> bool:
    """Whether a cell of a file names a modulus or a force with its unit; `unreadable` if the file cannot be read."""
    try:
        return any(_names_tests(one.rows) for one in read_sheets(path, sheet))
    except InputError:
        return unreadable


def _names_tests(rows: list[Row]) -> bool:
    return any(names_force_or_modulus(cell) for _, cells in rows for cell in cells)


def _joined(paths: Sequence[Path], parts: list[Part], notes: list[str]) -> Table:
    """One table of all parts; what only some of them give is empty in the others, or left out if it must be whole."""
    first = parts[0].read.table
    if len(parts) == 1:
        return first
    if parts[0].read.form == "records":
        raise InputError(f"{_called(paths)}: records are read from one table only; join the tables.")
    tables = [part.read.table for part in parts]
    names = list(dict.fromkeys(name for table in tables for name in table.columns))
    columns: dict[str, Values] = {}
    for name in names:
        whole = all(name in table.columns for table in tables)
        if not whole and name in ("replicate", *FURTHER) and name != "nominal_temperature_C":
            notes.append(f"{name} left out, because not every file gives it")
        elif name in TEXTS:
            # Only what is not measured needs to say so.
            missing = "measured" if name == "origin" else ""
            given = (table.columns.get(name, [missing] * len(table.lines)) for table in tables)
            columns[name] = [text for texts in given for text in texts]
        else:
            columns[name] = np.concatenate([table.numbers_or_nan(name) for table in tables])
    files = [part.read.table.path for part in parts for _ in part.read.table.lines]
    return Table(Path(_called(paths)), columns, [line for table in tables for line in table.lines], files)


def _measured(table: Table, notes: list[str]) -> Table:
    """The table without specimens that equal a mean or a deviation of the others."""
    if not (computed := computed_specimens(table)):
        return table
    notes.append(
        f"left out, means and deviations of the other specimens by their numbers: {', '.join(computed)}"
    )
    return rows_of(table, [row for row, name in enumerate(table.text("specimen")) if name not in computed])


def _called(paths: Sequence[Path]) -> str:
    return str(paths[0]) if len(paths) == 1 else ", ".join(path.name for path in paths)


def _sources(part: Part) -> list[str]:
    """Sentences: which of the user's columns became which of ours; of an export in one."""
    sources = {name: column.source for name, column in part.read.read.items()}
    if not part.block.exported:
        return [f"{name} from column {source}" for name, source in sources.items()]
    measured = ", ".join(f"{name} from {sources[name]}" for name in _MEASURED if name in sources)
    kept = ", ".join(name for name in MAY_BE_ABSENT if name in sources)
    quality = "" if any(name in sources for name in QUALITY) else "; no quality columns"
    return [f"machine export: {measured}" + (f"; also kept: {kept}" if kept else "") + quality]


def _said(parts: list[Part]) -> list[str]:
    """How the files were read: what is true of all files is said once."""
    by_note: dict[str, list[str]] = {}
    for part in parts:
        for note in (*part.read.notes, *_sources(part)):
            files = by_note.setdefault(note, [])
            if part.source not in files:
                files.append(part.source)
    count = len({(part.path, part.source) for part in parts})
    out = []
    for note, files in by_note.items():
        if len(files) == count:
            out.append(note)
        else:
            named = ", ".join(files[:3]) + (f" and {len(files) - 3} more" if len(files) > 3 else "")
            out.append(f"{named}: {note}")
    return out
