"""Tests of several files or sheets: which hold the same tests, and which of two is the later one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from math import exp, log
from pathlib import Path
from statistics import median

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted, specimen_named
from asphalt_nscd.table_import.dates import later
from asphalt_nscd.table_import.names import file_label, one_of_another, specimen_of, spelling
from asphalt_nscd.table_import.understand import ParsedTable

_FIGURES = 4  # digits in which two files that hold the same tests agree
_RETEST = log(1.5)  # of |E*|, median over frequencies; specimens of a mix differ by a tenth or so
_LEAST = 2  # frequencies for that: of one, the retest may be the mend


@dataclass(frozen=True)
class Part:
    """Tests of one file or sheet, or of one block of an export; for `contested` and `unnamed` see `Block`."""

    path: Path
    read: ParsedTable
    exported: bool
    repeated: bool = False
    tested: str = ""
    contested: str = ""
    unnamed: bool = False
    means: bool = False

    @property
    def source(self) -> str:
        """What sentences call the file or the sheet."""
        return self.read.table.path.name

    @property
    def values(self) -> set[tuple[str, ...]]:
        """Frequency, modulus and phase of each test, by which two files with the same tests are known."""
        columns = self.read.table.columns
        names = [name for name in ("frequency_Hz", "E_MPa", "phase_deg", "record", "F0_N") if name in columns]
        return {tuple(map(_short, test)) for test in zip(*(columns[name] for name in names), strict=True)}


def drop_copies(parts: list[Part], notes: list[str]) -> list[Part]:
    """Parts without those whose every test another file holds under any specimen name; appends to `notes`."""
    kept: list[Part] = []
    for part in parts:
        # Blocks of one file may hold equal numbers; only another file or sheet is a copy.
        others = [one for one in kept if one.source != part.source or one.path != part.path]
        holders = [one for one in others if part.values & one.values]
        if holders and part.values <= set().union(*(one.values for one in holders)):
            names = ", ".join(sorted({one.source for one in holders})[:3])
            more = "" if len({one.source for one in holders}) <= 3 else " and others"
            notes.append(
                f"skipped {part.source} (holds the same tests as {names}{more})" + _saved_twice(part, holders)
            )
        else:
            kept.append(part)
    return kept


def _saved_twice(part: Part, holders: list[Part]) -> str:
    """What to add of a copy if all are exports and name two specimens."""
    name = part.read.table.columns["specimen"][0]
    others = {one.read.table.columns["specimen"][0] for one in holders}
    if not all(one.exported for one in (part, *holders)) or spelling(name) in map(spelling, others):
        return ""
    return (
        f": identical results under two specimens, {name} and {min(others)}: one export was saved twice; export the "
        "missing one"
    )


def unify_spelling(parts: list[Part], notes: list[str]) -> list[Part]:
    """Parts with one name for a specimen that exports spell differently, `Mix-A`, `mix a`; appends to `notes`."""
    first: dict[str, str] = {}
    others: dict[str, list[str]] = {}
    kept = []
    for part in parts:
        table = part.read.table
        names = table.columns["specimen"]
        one = [first.setdefault(spelling(name), name) for name in names] if part.exported else names
        if one != names:
            others.setdefault(one[0], []).append(names[0])
            table = replace(table, columns=table.columns | {"specimen": one})
        kept.append(part if one == names else replace(part, read=replace(part.read, table=table)))
    for name, spelt in others.items():
        notes.append(f"{', '.join(dict.fromkeys(spelt))} taken for specimen {name}, spelt otherwise")
    return kept


def drop_repeated(parts: list[Part], notes: list[str]) -> list[Part]:
    """Parts without a test given twice: that of the later date, or marked as repeated, is kept; appends to `notes`."""
    # First of all: a file three times softer replaced the right one, because its date was later.
    _require_specimens_of_names(parts)
    _require_alike(parts)
    taken: dict[tuple[str, ...], int] = {}
    dropped: dict[tuple[int, int], list[tuple[str, ...]]] = {}  # by the part that lost and the one that won
    for place, part in enumerate(parts):
        for test in _tests(part):
            other = taken.setdefault(test, place)
            if parts[other].source == part.source and parts[other].path == part.path:
                continue
            worse, better = (other, place) if _is_later(parts[other], part, test) else (place, other)
            dropped.setdefault((worse, better), []).append(test)
            taken[test] = better
    said = [
        _said_of_repeated(parts[worse], parts[better], tests) for (worse, better), tests in dropped.items()
    ]
    kept = []
    for place, part in enumerate(parts):
        lost = {test for (worse, _), tests in dropped.items() if worse == place for test in tests}
        rows = [n for n, test in enumerate(_tests(part)) if test not in lost]
        if rows:
            kept.append(part if not lost else replace(part, read=_only(part.read, rows)))
    sources, used = ({(part.path, part.source) for part in some} for some in (parts, kept))
    if unused := len(sources - used):
        verb, each = ("is", "it") if unused == 1 else ("are", "each")
        notes.append(
            f"{unused} of {counted(len(sources), 'file')} {verb} not used: {each} was tested again later"
        )
    notes += said
    return kept


def _require_specimens_of_names(parts: list[Part]) -> None:
    """Refuse exports of one test whose names say several specimens of a series, each with its temperature."""
    of_test: dict[tuple[str, ...], list[Part]] = {}
    for part in parts:
        for test in set(_tests(part)) if part.exported else ():
            of_test.setdefault(test, []).append(part)
    said: dict[str, dict[str, Part]] = {}
    for (specimen, *_), several in of_test.items():
        names = {}
        for part in several:
            name = specimen_of(file_label(part.path.stem), None)
            if name.temperature is not None:
                names[name.specimen] = part
        alike = any(spelling(name) == spelling(specimen) for name in names)
        if not alike and any(one_of_another(one, other) for one, other in combinations(names, 2)):
            said.setdefault(specimen, {}).update(names)
    for specimen, names in said.items():
        files = {part.path.name for part in parts if specimen in part.read.table.columns["specimen"]}
        first, *others = sorted(names)
        raise InputError(
            f"{min(files)} and {len(files) - 1} more: the file names say {', '.join([first, *others[:-1]])} and "
            f"{others[-1]}, and the header says {specimen} in all; correct the Identification, or leave it empty."
        )


def _require_alike(parts: list[Part]) -> None:
    """Refuse two files that give one specimen at one temperature moduli too far apart for a retest."""
    sweeps: dict[tuple[str, ...], dict[int, dict[tuple[str, ...], str]]] = {}
    for place, part in enumerate(parts):
        moduli = part.read.table.columns.get("E_MPa", [])
        # Forces and displacements have no modulus yet, and are not compared.
        for (specimen, temperature, *test), modulus in zip(_tests(part), moduli, strict=bool(moduli)):
            sweep = sweeps.setdefault((specimen, temperature), {}).setdefault(place, {})
            sweep[tuple(test)] = modulus
    for (specimen, temperature), held in sweeps.items():
        for one, other in combinations(held, 2):
            first, second = parts[one], parts[other]
            common = held[one].keys() & held[other].keys()
            if len(common) < _LEAST or (first.path, first.source) == (second.path, second.source):
                continue
            _require_one_specimen(first, second, specimen, temperature)
            ratio = median(_ratio(held[other][test], held[one][test]) for test in common)
            if abs(ratio) > _RETEST:
                raise InputError(
                    f"{second.source} and {first.source} both hold {specimen_named(specimen)} at {temperature} degC, "
                    f"but |E*| in the first is {exp(ratio):.2g} times that in the second, which is too far apart for a "
                    "retest: leave the wrong one out, or, if it is another specimen or temperature, correct the name "
                    "and the header of its file."
                )


def _require_one_specimen(first: Part, second: Part, specimen: str, temperature: str) -> None:
    """Refuse two files with one test if one of them is called after another specimen of the series."""
    names = [specimen_of(file_label(part.path.stem), None).specimen for part in (first, second)]
    others = [one_of_another(name, specimen) for name in names]
    if others[0] == others[1] or not (first.exported and second.exported):
        return
    (wrong, name), right = ((first, names[0]), second) if others[0] else ((second, names[1]), first)
    raise InputError(
        f"{wrong.source} and {right.source} both hold {specimen_named(specimen)} at {temperature} degC, but the first "
        f"is called {name}: correct the specimen in its header, or the name of the file."
    )


def _ratio(modulus: str, other: str) -> float:
    """ln of a ratio; 0 for what is refused further on."""
    try:
        return log(float(modulus) / float(other))
    except (ValueError, ZeroDivisionError):
        return 0.0


def _is_later(first: Part, second: Part, test: tuple[str, ...]) -> bool:
    """Whether of two parts with one test the second is to be used: by its date, else by the operator's mark."""
    # The machine's date before the operator's mark, which the older file may bear.
    after = later(first.tested, second.tested)
    if after is not None:
        return after
    if first.repeated == second.repeated:
        specimen, temperature, frequency, *_ = test
        dates = "their dates do not tell" if first.tested and second.tested else "no date in both tells"
        raise InputError(
            f"{first.source} and {second.source} both hold {specimen_named(specimen)} at {temperature} degC, "
            f"{frequency} Hz, and {dates} which was tested later. The choice is yours: leave one of them out, "
            "end the specimen's name in the later one with 'Repeated', or, if they are two specimens, rename one."
        )
    return second.repeated


def _said_of_repeated(worse: Part, better: Part, tests: list[tuple[str, ...]]) -> str:
    specimen, temperature, *_ = tests[0]
    share = "" if len(tests) == len(_tests(worse)) else f" for {len(tests)} of its {len(_tests(worse))} tests"
    said = f"{better.source} is taken instead of {worse.source}{share}: "
    if later(worse.tested, better.tested) is None:
        return f"{said}the test was repeated"
    marked = f", although {worse.source} is marked as repeated" if worse.repeated > better.repeated else ""
    return (
        f"{said}{specimen} at {temperature} degC was tested again later, {better.tested} and not {worse.tested}{marked}"
        f"; leave {better.source} out to use the other"
    )


def _only(read: ParsedTable, rows: list[int]) -> ParsedTable:
    table = read.table
    columns = {name: [values[row] for row in rows] for name, values in table.columns.items()}
    return replace(read, table=Table(table.path, columns, [table.lines[row] for row in rows]))


def _tests(part: Part) -> list[tuple[str, ...]]:
    columns = part.read.table.columns
    # A retest has the same target; its readings are a few tenths off.
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
