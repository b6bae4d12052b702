"""What is done for the page, each piece in a process of its own that can be stopped: files read, tests diagnosed."""

from __future__ import annotations

import multiprocessing
import os
import sys
import threading
import time
import traceback
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import ON_PAGE

if TYPE_CHECKING:
    from asphalt_nscd.table_import.cells import Cells

MOST_MEMORY = 4 * 2**30  # bytes of addresses
SECONDS_TO_READ = 180.0  # of a machine with other work
SECONDS_TO_DIAGNOSE = 900.0
ROWS_SHOWN = 6
TOO_LONG = "this took too long; give the table of results of one campaign alone."
WORDLESS = "the process ended without a word, perhaps for want of memory."
BROKEN = "this could not be done, and the fault is ours; the terminal of `asphalt-nscd serve` says where."


@dataclass(frozen=True)
class Choices:
    """What the user said beside the files: kind of test, columns by what they hold, law, head of report.pdf."""

    measured_in: str | None = None
    columns: Mapping[str, str] | None = None
    law: str = "2s2p1d"
    heading: Mapping[str, str] = field(default_factory=dict)


class Job:
    """One piece of work in a process of its own; `state` is running, done, failed or cancelled."""

    def __init__(
        self, task: str, paths: Sequence[Path], choices: Choices, output: Path | None, seconds: float
    ) -> None:
        # Spawned: the server has threads, and a fork would copy their locks as they stand.
        here, there = multiprocessing.get_context("spawn").Pipe(duplex=False)
        self._pipe = here
        self._process = multiprocessing.get_context("spawn").Process(
            target=_run, args=(there, task, list(paths), choices, output), daemon=True
        )
        self._until = time.monotonic() + seconds
        self.state, self.stage, self.share = "running", "start", 0.0
        self.result: dict[str, Any] = {}
        # Each request has a thread: two that look at once would wait for one word.
        self._lock = threading.RLock()
        self._process.start()
        # While we hold this end too, the pipe would not end when the process does.
        there.close()

    def look(self, wait: float = 0.0) -> str:
        """Take what the process said, waiting `wait` [s]; returns running, done, failed or cancelled."""
        with self._lock:
            late = time.monotonic() > self._until
            while self.state == "running" and self._pipe.poll(0.0 if late else wait):
                try:
                    kind, content = self._pipe.recv()
                except EOFError:
                    self.stop("failed", WORDLESS)
                    break
                if kind == "progress":
                    self.stage, self.share = content
                else:
                    self.state, self.result = kind, content
                    self._process.join(5.0)
            if self.state == "running" and late:
                self.stop("failed", TOO_LONG)
            return self.state

    def finish(self) -> None:
        """Wait for the end."""
        while self.look(0.2) == "running":
            pass

    def stop(self, state: str = "cancelled", why: str = "") -> None:
        """End a job, if it is running, in `state`; `why` is a sentence for the page."""
        with self._lock:
            if self.state == "running":
                self._process.kill()
                self._process.join(5.0)
                self.state, self.result = state, {"error": why}


def _run(pipe: Connection, task: str, paths: list[Path], choices: Choices, output: Path | None) -> None:
    """Do a task in the new process, and send its result or one sentence through the pipe."""
    threading.Thread(target=_end_with_the_server, daemon=True).start()
    # For libraries that load later; numpy came with this module, and looked at those of the server.
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"
    os.environ[ON_PAGE] = "1"
    if sys.platform == "linux":
        import resource

        # Of addresses, for Linux does not heed a limit on resident memory.
        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    try:
        if output is None:
            content = read_tables(paths, choices)
        else:
            work = {"diagnose": _diagnosed, "compare": _compared}[task]
            content = work(paths, choices, output, lambda *said: pipe.send(("progress", said)))
        pipe.send(("done", content))
    except InputError as error:
        pipe.send(("failed", {"error": _shorten_paths(str(error), paths), "columns": _columns(paths)}))
    except MemoryError:
        pipe.send(("failed", {"error": "the file needs too much memory; give the table of results alone."}))
    except Exception:
        traceback.print_exc()
        pipe.send(("failed", {"error": BROKEN}))


def _end_with_the_server() -> None:
    """End this process when the server ends: one that was killed cannot stop its jobs."""
    server = multiprocessing.parent_process()
    if server is not None:
        server.join()
        os._exit(1)


def read_tables(paths: Sequence[Path], choices: Choices) -> dict[str, Any]:
    """How the files were read, as JSON values: sentences, first tests, what each of the user's columns is taken for."""
    from asphalt_nscd.table_import.campaign import read_campaign
    from asphalt_nscd.table_import.frames import frame_of

    campaign, form = read_campaign(paths, None, choices.columns, choices.measured_in)
    table = frame_of(campaign)
    shown = [name for name in table.columns if (table[name].notna() & (table[name] != "")).any()]
    return {
        "form": form,
        "test_type": campaign.test_type,
        "stated": dict(campaign.stated),
        "notes": [_shorten_paths(note, paths) for note in campaign.notes],
        "tests": len(campaign.table.lines),
        "specimens": list(table["specimen"].unique()),
        "header": shown,
        "rows": [
            [_rounded(value) for value in row]
            for row in table[shown].head(ROWS_SHOWN).itertuples(index=False, name=None)
        ],
        "columns": _columns(paths),
    }


def _columns(paths: Sequence[Path]) -> list[dict[str, str]]:
    """Each column of the files, by its name, with the quantity and the unit it is taken for and its first cells."""
    from asphalt_nscd.table_import.cells import read_sheets
    from asphalt_nscd.table_import.melt import headings_of
    from asphalt_nscd.table_import.unknown_names import unknown_names

    found: dict[str, dict[str, str]] = {}
    for path in paths:
        tables, unknown = [], {}
        with suppress(InputError):
            unknown = unknown_names(read_sheets(path))
            tables = _tables(path)
        for cells in tables:
            for n, heading in enumerate(headings_of(cells)):
                column = heading.column
                sample = list(dict.fromkeys(row[n] for _, row in cells.rows if row[n]))[:3]
                if column is None and not sample:
                    continue
                unit = "" if column is None else column.unit or _missing_unit(column.quantity)
                quantity = "" if column is None else column.quantity
                shown = found.setdefault(cells.header[n], _column(cells.header[n], quantity, unit, sample))
                # Columns of several specimens may have one name.
                conditions = (shown["condition"], *heading.at.values())
                shown["condition"] = ", ".join(dict.fromkeys(filter(None, conditions)))
        # Of a layout that cannot be told before they are known.
        for name in (name for names in unknown.values() for name in names):
            if not any(header.startswith(name) for header in found):
                found[name] = _column(name, "", "", [])
    return list(found.values())[:60]


def _column(name: str, quantity: str, unit: str, sample: list[str]) -> dict[str, str]:
    return {"name": name, "quantity": quantity, "unit": unit, "condition": "", "cells": ", ".join(sample)}


def _tables(path: Path) -> list[Cells]:
    """The tables of a file: its matrices as one, else each sheet but those of means of others."""
    from asphalt_nscd.table_import import matrices
    from asphalt_nscd.table_import.cells import read_sheets
    from asphalt_nscd.table_import.header_lines import tabulated
    from asphalt_nscd.table_import.melt import holds_means
    from asphalt_nscd.table_import.rows_of_tests import is_computed_sheet

    sheets = read_sheets(path)
    if matrices.matches(sheets):
        return [block.cells for block in matrices.read(sheets, {})]
    tables = [(str(sheet.name), tabulated(path, sheet.rows, [])) for sheet in sheets]
    own = [cells for name, cells in tables if not is_computed_sheet(name, cells) and not holds_means(cells)]
    return own or [cells for _, cells in tables]


def _rounded(value: str | float) -> str:
    """A number to six digits, as a first look needs it; text as it is."""
    if isinstance(value, str):
        return value
    return f"{value:.6g}" if np.isfinite(value) else ""


def _missing_unit(quantity: str) -> str:
    """What the page shows for the unit that a column does not say; empty where the quantity has none."""
    from asphalt_nscd.table_import.quantities import MEASURED

    return "not said" if quantity in MEASURED and MEASURED[quantity][1] else ""


def _shorten_paths(text: str, paths: Sequence[Path]) -> str:
    """A sentence with the names of the files alone."""
    for path in paths:
        text = text.replace(str(path), path.name)
        text = text.replace(f"{path.parent}{os.sep}", "")
    return text


def _diagnosed(paths: Sequence[Path], choices: Choices, output: Path, progress: Any) -> dict[str, Any]:
    """Diagnose, and write everything into the folder: what the first screen says, and the names of the files."""
    from asphalt_nscd.api.diagnosis import diagnose
    from asphalt_nscd.api.written import write_all
    from asphalt_nscd.diagnosis.record.stiffness_only import fit_stiffness, has_no_phase
    from asphalt_nscd.diagnosis.settings import Known
    from asphalt_nscd.reporting.pages import diagnosis_page, stiffness_page
    from asphalt_nscd.reporting.settings import Heading

    title = f"Diagnosis of {', '.join(path.name for path in paths)}"
    campaign = _campaign(paths, choices)
    if has_no_phase(campaign):
        curve = fit_stiffness(campaign)
        curve.write(output)
        stiffness_page.write_page(output, title, curve.rows)
        return {"reported": curve.reported, "page": diagnosis_page.PAGE, "files": _names(output)}
    diagnosis = diagnose(
        campaign,
        measured_in=choices.measured_in,
        known=Known(law=choices.law),
        progress=lambda stage, done, total: progress(stage, 0.9 * done / total),
    )
    progress("Write", 0.95)
    write_all(diagnosis.outcome, output, title, Heading(**choices.heading))
    _export(output)
    reported = diagnosis.content["reported"]
    return {"reported": reported, "page": diagnosis_page.PAGE, "files": _names(output)}


def _campaign(paths: Sequence[Path], choices: Choices) -> Any:
    from asphalt_nscd.api.tables import campaign_in

    return campaign_in(list(paths), None, choices.columns, choices.measured_in)


def _export(output: Path) -> None:
    """The law for each program, beside the other files; one that cannot be met is left out."""
    from asphalt_nscd.exports.export import export_law
    from asphalt_nscd.exports.formats import FORMATS, format_of
    from asphalt_nscd.exports.law import read_law_file
    from asphalt_nscd.exports.settings import ExportSettings

    if not (output / "law.json").is_file():
        return
    law = read_law_file(output / "law.json")
    for form in FORMATS:
        with suppress(InputError):
            export_law(law, ExportSettings(), form, output / f"law_{form}{format_of(form).ENDINGS[0]}")


def _compared(paths: Sequence[Path], choices: Choices, output: Path, progress: Any) -> dict[str, Any]:
    """Two mixes, whose files lie in two folders, beside each other; columns that were chosen are those of the first."""
    from asphalt_nscd.api.comparison import compare

    mixes: dict[str, Any] = {}
    for folder in dict.fromkeys(path.parent for path in paths):
        own = [path for path in paths if path.parent == folder]
        name = own[0].stem if own[0].stem not in mixes else f"{own[0].stem} (2)"
        mixes[name] = own if mixes else _campaign(own, choices)
    made = compare(
        mixes,
        measured_in=choices.measured_in,
        law=choices.law,
        progress=lambda stage, done, total: progress(stage, 0.9 * done / total),
    )
    page, *_ = made.write(output)
    return {"page": page, "files": _names(output)}


def _names(folder: Path) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
