"""Tests of several files or sheets: which hold the same tests, and which of two is the later one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from math import exp, log
from pathlib import Path
from statistics import median

import numpy as np

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted, specimen_named
from asphalt_nscd.table_import.cells import Block
from asphalt_nscd.table_import.dates import later
from asphalt_nscd.table_import.names import file_label, one_of_another, specimen_of, spelling
from asphalt_nscd.table_import.targets import FAR
from asphalt_nscd.table_import.understand import ParsedTable

_FIGURES = 4  # digits in which two files that hold the same tests agree
_RETEST = log(1.5)  # of |E*|, median over frequencies; specimens of a mix differ by a tenth or so
_LEAST = 2  # frequencies for that: of one, the retest may be the mend
_MISLABELLED = log(1.3)  # of |E*|, by which specimens of a mix hardly differ
_NEARER = 0.5  # of that, at the other temperature
Test = tuple[str, ...]  # specimen, temperature, frequency and what else tells tests apart


@dataclass(frozen=True)
class Part:
    """Tests of one file or sheet, or of one block of an export."""

    path: Path
    read: ParsedTable
    block: Block

    @property
    def source(self) -> str:
        """What sentences call the file or the sheet."""
        return self.read.table.path.name

    @property
    def place(self) -> tuple[Path, str]:
        """File and sheet."""
        return self.path, self.source

    @cached_property
    def specimens(self) -> list[str]:
        """The specimen of each test."""
        return self.read.table.text("specimen")

    @cached_property
    def values(self) -> set[Test]:
        """Frequency, modulus and phase of each test, by which two files with the same tests are known."""
        return set(self._compared(("frequency_Hz", "E_MPa", "phase_deg", "record", "F0_N"), _FIGURES))

    @cached_property
    def tests(self) -> list[Test]:
        """For each test the cells that tell it from others."""
        # A retest has the same target; its readings are a few tenths off.
        target = "nominal_temperature_C" in self.read.table.columns
        temperature = "nominal_temperature_C" if target else "temperature_C"
        names = ("specimen", temperature, "frequency_Hz", "replicate", "amplitude_m", "order", "cycles")
        return self._compared(names, 9)

    def _compared(self, names: tuple[str, ...], figures: int) -> list[Test]:
        columns = self.read.table.columns
        given = [columns[name] for name in names if name in columns]
        texts = (
            [one if isinstance(one, str) else f"{one:.{figures}g}" for one in values] for values in given
        )
        return list(zip(*texts, strict=True))


def drop_copies(parts: list[Part], notes: list[str]) -> list[Part]:
    """Parts without those whose every test another file holds under any specimen name; appends to `notes`."""
    kept: list[Part] = []
    for part in parts:
        # Blocks of one file may hold equal numbers; only another file or sheet is a copy.
        holders = [one for one in kept if one.place != part.place and part.values & one.values]
        if holders and part.values <= set().union(*(one.values for one in holders)):
            sources, name = sorted({one.source for one in holders}), part.specimens[0]
            others = {spelling(one.specimens[0]): one.specimens[0] for one in holders}
            named = ", ".join(sources[:3]) + " and others" * (len(sources) > 3)
            note = f"skipped {part.source} (holds the same tests as {named})"
            if all(one.block.exported for one in (part, *holders)) and spelling(name) not in others:
                note += (
                    f": identical results under two specimens, {name} and {min(others.values())}: one export was "
                    "saved twice; export the missing one"
                )
            notes.append(note)
        else:
            kept.append(part)
    return kept


def unify_spelling(parts: list[Part], notes: list[str]) -> list[Part]:
    """Parts with one name for a specimen that exports spell differently, `Mix-A`, `mix a`; appends to `notes`."""
    first: dict[str, str] = {}
    others: dict[str, list[str]] = {}
    kept = []
    for part in parts:
        names = part.specimens
        one = [first.setdefault(spelling(name), name) for name in names] if part.block.exported else names
        if one != names:
            others.setdefault(one[0], []).append(names[0])
            table = replace(part.read.table, columns=part.read.table.columns | {"specimen": one})
            part = replace(part, read=replace(part.read, table=table))
        kept.append(part)
    for name, spelt in others.items():
        notes.append(f"{', '.join(dict.fromkeys(spelt))} taken for specimen {name}, spelt otherwise")
    return kept


def drop_repeated(parts: list[Part], notes: list[str]) -> list[Part]:
    """Parts without a test given twice: that of the later date, or marked as repeated, is kept; appends to `notes`."""
    # First of all: a file three times softer replaced the right one, because its date was later.
    _require_specimens_of_names(parts)
    _require_alike(parts)
    taken: dict[Test, int] = {}
    dropped: dict[tuple[int, int], list[Test]] = {}  # by the part that lost and the one that won
    for place, part in enumerate(parts):
        for test in part.tests:
            other = taken.setdefault(test, place)
            if parts[other].place == part.place:
                continue
            worse, better = (other, place) if _is_later(parts[other], part, test) else (place, other)
            dropped.setdefault((worse, better), []).append(test)
            taken[test] = better
    kept = []
    for place, part in enumerate(parts):
        lost = {test for (worse, _), tests in dropped.items() if worse == place for test in tests}
        rows = [n for n, test in enumerate(part.tests) if test not in lost]
        if rows:
            kept.append(replace(part, read=replace(part.read, table=rows_of(part.read.table, rows))))
    sources, used = ({part.place for part in some} for some in (parts, kept))
    if unused := len(sources - used):
        verb, each = ("is", "it") if unused == 1 else ("are", "each")
        notes.append(
            f"{unused} of {counted(len(sources), 'file')} {verb} not used: {each} was tested again later"
        )
    notes += [_repeated(parts[worse], parts[better], tests) for (worse, better), tests in dropped.items()]
    return kept


def _require_specimens_of_names(parts: list[Part]) -> None:
    """Refuse exports of one test whose names say several specimens of a series, each with its temperature."""
    of_test: dict[Test, list[Part]] = {}
    for part in parts:
        for test in set(part.tests) if part.block.exported else ():
            of_test.setdefault(test, []).append(part)
    named: dict[str, set[str]] = {}
    for (specimen, *_), several in of_test.items():
        told = [specimen_of(file_label(part.path.stem), None) for part in several]
        names = {name.specimen for name in told if name.temperature is not None}
        alike = any(spelling(name) == spelling(specimen) for name in names)
        if not alike and any(one_of_another(one, other) for one, other in combinations(names, 2)):
            named.setdefault(specimen, set()).update(names)
    for specimen, names in named.items():
        files = {part.path.name for part in parts if specimen in part.specimens}
        *firsts, last = sorted(names)
        raise InputError(
            f"{min(files)} and {len(files) - 1} more: the file names say {', '.join(firsts)} and {last}, and the "
            f"header says {specimen} in all; correct the Identification, or leave it empty."
        )


def _require_alike(parts: list[Part]) -> None:
    """Refuse two files that give one specimen at one temperature moduli too far apart for a retest."""
    sweeps: dict[Test, dict[int, dict[Test, float]]] = {}
    for place, part in enumerate(parts):
        # Forces and displacements have no modulus yet, and are not compared.
        for test, modulus in zip(part.tests, part.read.table.numbers_or_nan("E_MPa"), strict=True):
            if modulus > 0.0:
                sweeps.setdefault(test[:2], {}).setdefault(place, {})[test[2:]] = float(modulus)
    for (specimen, temperature), held in sweeps.items():
        for one, other in combinations(held, 2):
            first, second = parts[one], parts[other]
            common = held[one].keys() & held[other].keys()
            if len(common) < _LEAST or first.place == second.place:
                continue
            _require_one_specimen(first, second, specimen, temperature)
            ratio = median(log(held[other][test] / held[one][test]) for test in common)
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
    if others[0] == others[1] or not (first.block.exported and second.block.exported):
        return
    (wrong, name), right = ((first, names[0]), second) if others[0] else ((second, names[1]), first)
    raise InputError(
        f"{wrong.source} and {right.source} both hold {specimen_named(specimen)} at {temperature} degC, but the first "
        f"is called {name}: correct the specimen in its header, or the name of the file."
    )


def _is_later(first: Part, second: Part, test: Test) -> bool:
    """Whether of two parts with one test the second is to be used: by its date, else by the operator's mark."""
    # The machine's date before the operator's mark, which the older file may bear.
    after = later(first.block.tested, second.block.tested)
    if after is not None:
        return after
    if first.block.repeated == second.block.repeated:
        specimen, temperature, frequency, *_ = test
        both = first.block.tested and second.block.tested
        dates = "their dates do not tell" if both else "no date in both tells"
        raise InputError(
            f"{first.source} and {second.source} both hold {specimen_named(specimen)} at {temperature} degC, "
            f"{frequency} Hz, and {dates} which was tested later. The choice is yours: leave one of them out, "
            "end the specimen's name in the later one with 'Repeated', or, if they are two specimens, rename one."
        )
    return second.block.repeated


def _repeated(worse: Part, better: Part, tests: list[Test]) -> str:
    """A note on tests given twice: which part is taken instead of which, and why."""
    specimen, temperature, *_ = tests[0]
    share = f" for {len(tests)} of its {len(worse.tests)} tests" * (len(tests) < len(worse.tests))
    taken = f"{better.source} is taken instead of {worse.source}{share}: "
    if later(worse.block.tested, better.block.tested) is None:
        return f"{taken}the test was repeated"
    marked = worse.block.repeated > better.block.repeated
    return (
        f"{taken}{specimen} at {temperature} degC was tested again later, {better.block.tested} and not "
        f"{worse.block.tested}{f', although {worse.source} is marked as repeated' * marked}; leave {better.source} "
        "out to use the other"
    )


def rows_of(table: Table, rows: list[int]) -> Table:
    """A table of these rows alone, counted from 0."""
    columns = {
        name: values[rows] if isinstance(values, np.ndarray) else [values[row] for row in rows]
        for name, values in table.columns.items()
    }
    files = None if table.files is None else [table.files[row] for row in rows]
    return Table(table.path, columns, [table.lines[row] for row in rows], files)


def refuse_mislabelled(parts: Sequence[Part]) -> None:
    """Refuse an export whose moduli belong to the temperature that was not taken for it."""
    for part in parts:
        own = list(_tests(part))
        if not part.block.contested or not own:
            continue
        others = [one for one in parts if set(one.specimens).isdisjoint(part.specimens)]
        taken, contested = own[0][0], float(part.block.contested)
        off, other = _apart(part, others, taken), _apart(part, others, contested)
        if (
            off is not None
            and other is not None
            and abs(off) > _MISLABELLED
            and abs(other) < _NEARER * abs(off)
        ):
            raise InputError(
                f"{part.path}: its name and its header say {contested:g} and {taken:g} degC, and the measured "
                f"temperature speaks for {taken:g} degC; but |E*| is {exp(off):.2f} times that of the other specimens "
                f"at {taken:g} degC and {exp(other):.2f} times at {contested:g} degC: correct header, readings or name."
            )


def _tests(part: Part) -> Iterator[tuple[float, float, float]]:
    """Temperature [degC], frequency [Hz] and ln |E*| of each test."""
    table = part.read.table
    target = "nominal_temperature_C" if "nominal_temperature_C" in table.columns else "temperature_C"
    columns = (table.numbers_or_nan(name) for name in (target, "frequency_Hz", "E_MPa"))
    yield from ((t, f, log(modulus)) for t, f, modulus in zip(*columns, strict=True) if modulus > 0.0)


def _apart(part: Part, others: Sequence[Part], at: float) -> float | None:
    """Median ln |E*| of a part over that of the others at a temperature; None if they were not tested there."""
    known: dict[float, list[float]] = {}
    for one in others:
        for t, f, modulus in _tests(one):
            if abs(t - at) <= FAR:
                known.setdefault(f, []).append(modulus)
    apart = [modulus - median(known[f]) for _, f, modulus in _tests(part) if f in known]
    # The median: one odd frequency decides nothing.
    return median(apart) if apart else None
