"""What a laboratory has, one file, several or a folder, as the one table of a campaign."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import require_readable
from asphalt_nscd.measurements.campaign import Campaign
from asphalt_nscd.table_import.cells import NotTests, as_cells, read_rows
from asphalt_nscd.table_import.exports import blocks
from asphalt_nscd.table_import.understand import (
    FURTHER,
    MAY_BE_ABSENT,
    Understood,
    names_force_or_modulus,
    understand,
)

TABLES = (".csv", ".tsv", ".txt", ".dat", ".xlsx", ".xlsm")
MOST_FILES = 500
_FIGURES = 4  # digits in which two files that hold the same tests agree
_MEASURED = ("temperature_C", "nominal_temperature_C", "E_MPa", "phase_deg")


@dataclass(frozen=True)
class _Part:
    """Tests of one file, or of one block of an export."""

    path: Path
    read: Understood
    exported: bool
    repeated: bool = False

    @property
    def values(self) -> set[tuple[str, ...]]:
        """Frequency, modulus and phase of each test, by which two files with the same tests are known."""
        columns = self.read.table.columns
        names = [name for name in ("frequency_Hz", "E_MPa", "phase_deg", "record", "F0_N") if name in columns]
        return {tuple(map(_short, test)) for test in zip(*(columns[name] for name in names), strict=True)}


def read_campaign(
    paths: Sequence[Path], sheet: str | None = None, chosen: Mapping[str, str] | None = None,
    test_type: str | None = None,
) -> tuple[Campaign, str]:  # fmt: skip
    """The campaign that files and folders hold together, and its form, a key of `reduction.FORMS`.

    sheet, chosen: see `read_rows` and `understand`. test_type: the kind of test; None takes
    tension-compression for machine exports and bending for everything else.
    """
    notes: list[str] = []
    parts: list[_Part] = []
    for path in paths:
        parts += _folder(path, notes, sheet, chosen) if path.is_dir() else _file(path, sheet, chosen)
    parts = _without_copies(sorted(parts, key=lambda part: not part.exported), notes)
    parts = _without_repeated(parts, notes)
    forms = sorted({part.read.form for part in parts})
    if len(forms) > 1:
        raise InputError(
            f"{_called(paths)}: the files hold {' and '.join(forms)}; give those of one form together."
        )
    exported = any(part.exported for part in parts)
    if test_type is None and exported:
        notes.append(
            "a machine export (AMPT, UTM) is taken as tension-compression; say --measured-in if it is not"
        )
    kind = test_type or ("tension-compression" if exported else "bending")
    table = _joined(paths, parts, notes)
    specimens = list(dict.fromkeys(table.columns["specimen"]))
    notes.append(
        f"{len(specimens)} specimens: {', '.join(specimens[:12])}{', ...' if len(specimens) > 12 else ''}"
    )
    files = tuple(dict.fromkeys(part.path for part in parts))
    return Campaign(table, files, kind, (*_said(parts), *notes)), forms[0]


def _file(path: Path, sheet: str | None, chosen: Mapping[str, str] | None) -> list[_Part]:
    require_readable(path, "check the path")
    rows, notes = read_rows(path, sheet)
    exported = blocks(path, rows, notes)
    if exported:
        return [_Part(path, understand(one.cells, chosen), True, one.repeated) for one in exported]
    return [_Part(path, understand(as_cells(path, rows, notes), chosen), False)]


def _folder(
    folder: Path, notes: list[str], sheet: str | None, chosen: Mapping[str, str] | None
) -> list[_Part]:
    """Tests of the files in a folder; a file that holds none is passed over, with the reason in the notes."""
    inside = sorted(path for path in folder.iterdir() if not path.name.startswith((".", "~$")))
    if len(inside) > MOST_FILES:
        raise InputError(f"{folder}: more than {MOST_FILES} files; give the folder of one campaign.")
    parts: list[_Part] = []
    skipped: list[str] = []
    for path in inside:
        if path.is_dir():
            skipped.append(f"{path.name} (a folder; name it too if it belongs to the campaign)")
        elif path.suffix.lower() not in TABLES:
            skipped.append(f"{path.name} (neither CSV, TSV, TXT nor XLSX)")
        else:
            try:
                parts += _file(path, sheet, chosen)
            except InputError as error:
                if not isinstance(error, NotTests) and _meant(path, sheet):
                    raise
                reason = str(error).removeprefix(f"{path}: ").partition(" (found:")[0].partition("; ")[0]
                skipped.append(f"{path.name} ({reason})")
    if not parts:
        held = "; it holds " + ", ".join(skipped) if skipped else ""
        raise InputError(
            f"{folder}: no file with tests{held}; give the machine's exports or a table of moduli."
        )
    notes += [f"skipped {one}" for one in skipped]
    return parts


def _meant(path: Path, sheet: str | None) -> bool:
    """Whether a file that is refused was meant to hold tests: some cell names a modulus or a force with its unit.

    A CSV or XLSX file that cannot even be opened may hold tests; running text may not.
    """
    try:
        rows, _ = read_rows(path, sheet)
    except InputError:
        return path.suffix.lower() not in (".txt", ".dat")
    return any(names_force_or_modulus(cell) for _, cells in rows for cell in cells)


def _without_copies(parts: list[_Part], notes: list[str]) -> list[_Part]:
    """Parts without those whose every test another file holds already, whatever it calls the specimens."""
    kept: list[_Part] = []
    for part in parts:
        others = [one for one in kept if one.path != part.path]
        holders = [one for one in others if part.values & one.values]
        if holders and part.values <= set().union(*(one.values for one in holders)):
            names = ", ".join(sorted({one.path.name for one in holders})[:3])
            more = "" if len({one.path for one in holders}) <= 3 else " and others"
            notes.append(f"skipped {part.path.name} (holds the same tests as {names}{more})")
        else:
            kept.append(part)
    return kept


def _without_repeated(parts: list[_Part], notes: list[str]) -> list[_Part]:
    """Parts in which no two files give one test: of two exports, that which the operator marked as repeated."""
    taken: dict[tuple[str, ...], _Part] = {}
    replaced: list[_Part] = []
    for part in parts:
        for test in _tests(part):
            other = taken.setdefault(test, part)
            if other is part or other in replaced or part in replaced or other.path == part.path:
                continue
            if part.repeated == other.repeated:
                specimen, temperature, frequency, *_ = test
                raise InputError(
                    f"{other.path.name} and {part.path.name} both hold specimen {specimen} at {temperature} degC, "
                    f"{frequency} Hz; give one of them, or rename the specimen in one."
                )
            worse, better = (other, part) if part.repeated else (part, other)
            replaced.append(worse)
            notes.append(f"{better.path.name} is taken instead of {worse.path.name}: the test was repeated")
            taken.update(dict.fromkeys(_tests(better), better))
    return [part for part in parts if part not in replaced]


def _tests(part: _Part) -> list[tuple[str, ...]]:
    columns = part.read.table.columns
    temperature = "nominal_temperature_C" if "nominal_temperature_C" in columns else "temperature_C"
    names = ["specimen", temperature, "frequency_Hz", "replicate", "amplitude_m", "order", "cycles"]
    present = [name for name in names if name in columns]
    return list(zip(*([_short(text, 9) for text in columns[name]] for name in present), strict=True))


def _short(text: str, figures: int = _FIGURES) -> str:
    """A number to so many digits; other text as it is."""
    try:
        return f"{float(text):.{figures}g}"
    except ValueError:
        return text


def _joined(paths: Sequence[Path], parts: list[_Part], notes: list[str]) -> Table:
    """One table of all parts; what only some of them give is empty in the others, or left out if it must be whole."""
    first = parts[0].read.table
    if len(parts) == 1:
        return first
    if parts[0].read.form == "records":
        raise InputError(f"{_called(paths)}: records are read from one table only; join the tables.")
    tables = [part.read.table for part in parts]
    names = list(dict.fromkeys(name for table in tables for name in table.columns))
    columns: dict[str, list[str]] = {}
    for name in names:
        whole = all(name in table.columns for table in tables)
        if not whole and name in ("replicate", *FURTHER) and name != "nominal_temperature_C":
            notes.append(f"{name} left out, because not every file gives it")
            continue
        columns[name] = [text for table in tables for text in table.columns.get(name, _missing(name, table))]
    files = [part.path for part in parts for _ in part.read.table.lines]
    return Table(Path(_called(paths)), columns, [line for table in tables for line in table.lines], files)


def _missing(name: str, table: Table) -> list[str]:
    if name == "origin":
        return ["measured"] * len(table.lines)
    return [""] * len(table.lines)


def _called(paths: Sequence[Path]) -> str:
    return str(paths[0]) if len(paths) == 1 else ", ".join(path.name for path in paths)


def _sources(part: _Part) -> list[str]:
    """Which of the user's columns became which of ours; an export's in one sentence."""
    sources = part.read.sources
    if not part.exported:
        return [f"{name} from column {source}" for name, source in sources.items()]
    measured = ", ".join(f"{name} from {sources[name]}" for name in _MEASURED if name in sources)
    kept = ", ".join(name for name in MAY_BE_ABSENT if name in sources)
    return [f"machine export: {measured}" + (f"; kept for judging the tests: {kept}" if kept else "")]


def _said(parts: list[_Part]) -> list[str]:
    """How the files were read: what is true of all files is said once."""
    by_note: dict[str, list[str]] = {}
    for part in parts:
        for note in (*part.read.notes, *_sources(part)):
            files = by_note.setdefault(note, [])
            if part.path.name not in files:
                files.append(part.path.name)
    count = len({part.path for part in parts})
    out = []
    for note, files in by_note.items():
        if len(files) == count:
            out.append(note)
        else:
            named = ", ".join(files[:3]) + (f" and {len(files) - 3} more" if len(files) > 3 else "")
            out.append(f"{named}: {note}")
    return out
