"""Source files that a module depends on, read from its import statements."""

from __future__ import annotations

import ast
import atexit
import csv
import hashlib
import json
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from asphalt_nscd.files.store import atomic_path

PACKAGE = Path(__file__).resolve().parents[1]
TEMPLATES = "*.j2"
STUDIES = [Path("studies")]  # their folder; a workflow that is run from elsewhere knows where it stands


def source_files(*modules: str, without: Sequence[str] = ()) -> list[Path]:
    """Files of `modules` (dotted, relative to the package, or in studies) and of all they import from both, sorted.

    Imports inside functions count. A package's `__init__.py` counts only where it is itself imported. Modules and
    packages named in `without`, and what only they import, are left out. Templates in the folder of a file count.
    """
    found: set[Path] = set()
    outside = [PACKAGE.joinpath(*name.split(".")) for name in without]
    waiting = []
    for module in modules:
        parts = tuple(module.split("."))
        file = _file(parts if parts[0] == "studies" else ("asphalt_nscd", *parts))
        if file is None:
            raise ValueError(f"no module asphalt_nscd.{module}")
        waiting.append(file)
    while waiting:
        path = waiting.pop()
        if path not in found and not any(place in (path.with_suffix(""), *path.parents) for place in outside):
            found.add(path)
            waiting.extend(_read(path, path.stat().st_mtime_ns).imported)
    return sorted(
        found | {text for folder in {path.parent for path in found} for text in folder.glob(TEMPLATES)}
    )


def stamp(folder: str | Path, name: str, files: Sequence[Path]) -> Path:
    """A file that stands for the meaning of many source files, rewritten only when one of them changed.

    It holds a digest of what they mean (`meaning_of`); comments, docstrings and layout mean nothing. Snakemake looks at
    each input of each waiting job whenever a job ends, so one file is better than thirty.
    """
    return noted(Path(folder, name), meaning_of(files), files)


def meaning_of(files: Sequence[Path]) -> str:
    """A digest of what source files mean."""
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{_place(file)}\n{_read(file, file.stat().st_mtime_ns).meaning}\n".encode())
    return digest.hexdigest()


def stamp_of_row(folder: str | Path, table: str | Path, key: str, value: float) -> Path:
    """A stamp for the row of a CSV table in which column `key` is `value`: other rows do not count.

    Lines that begin with # do not count. A table that cannot be read, or has no such row, stands as a whole: whoever
    reads it says what is wrong. The file is named by the table and the value.
    """
    path = Path(table)
    text = path.read_text(encoding="utf-8-sig", errors="replace") if path.is_file() else ""
    rows = list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))
    content = text
    if rows and key in rows[0]:
        column = rows[0].index(key)
        found = [row for row in rows[1:] if len(row) > column and is_number(row[column], value)]
        content = repr((rows[0], found)) if found else text
    digest = hashlib.sha256(content.encode()).hexdigest()
    return noted(Path(folder, f"{path.stem}-{value:g}"), digest, [path] if path.is_file() else [])


def stamp_of_table(folder: str | Path, table: str | Path) -> Path:
    """A stamp for the content of a table, named by it."""
    path = Path(table)
    there = path.is_file()
    digest = hashlib.sha256(path.read_bytes() if there else b"").hexdigest()
    return noted(Path(folder, path.stem), digest, [path] if there else [])


def noted(path: Path, content: str, files: Sequence[Path] = ()) -> Path:
    """Write `content` to `path` unless it stands there; the path.

    Where nothing stood it is dated as the newest of `files`, if there are any: a lost stamp must not look like a
    change. Else it is dated now: files that were put in place of others keep their dates, and may be older than
    results.
    """
    lost = not path.is_file()
    if lost or path.read_text() != content:
        with atomic_path(path) as temporary:
            temporary.write_text(content)
        if files and lost:
            newest = max(file.stat().st_mtime_ns for file in files)
            os.utime(path, ns=(newest, newest))
    return path


def is_number(text: str, value: float) -> bool:
    """Whether a cell holds this number."""
    try:
        return float(text) == value
    except ValueError:
        return False


def modules_of(package: str) -> list[str]:
    """Modules (dotted, sorted) of a package that finds them by itself, without an import statement."""
    folder = PACKAGE.joinpath(*package.split("."))
    return [f"{package}.{path.stem}" for path in sorted(folder.glob("*.py")) if path.name != "__init__.py"]


@dataclass(frozen=True)
class _Source:
    """What a source file means and needs."""

    meaning: str  # digest of its syntax tree without docstrings
    imported: frozenset[Path]  # of this package, and of studies


@cache
def _read(path: Path, mtime_ns: int) -> _Source:
    """What a source file means and needs; `mtime_ns`, when it was written, has it read again once that changes."""
    place, content = _place(path), path.read_bytes()
    parsed = _parsed(PACKAGE)
    entry = parsed.get(place)
    # Sealed with all that it depends on, so that an entry that is stale, broken or of another Python says so itself.
    if not isinstance(entry, list) or entry[:1] != [_seal(content, entry[1:])]:
        found = _parse(path, content)
        parsed[place] = entry = [_seal(content, found), *found]
    _, meaning, imports = entry
    files = (_file(tuple(name.split("."))) or _file(tuple(base.split("."))) for name, base in imports)
    return _Source(meaning, frozenset(file for file in files if file is not None))


def _parse(path: Path, content: bytes) -> list[Any]:
    """Digest of the syntax tree without docstrings; imported names, each with the module that it may be part of."""
    package = ("asphalt_nscd", *Path(_place(path)).parent.parts)
    imports: set[tuple[str, str]] = set()
    if not path.match("*.py"):
        return [hashlib.sha256(content).hexdigest(), []]
    tree = ast.parse(content)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            if ast.get_docstring(node, clean=False) is not None:
                node.body = node.body[1:]
        elif isinstance(node, ast.Import):
            imports.update((name.name, name.name) for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            base += tuple((node.module or "").split(".")) if node.module else ()
            imports.update((".".join((*base, name.name)), ".".join(base)) for name in node.names)
    meaning = hashlib.sha256(ast.dump(tree, annotate_fields=False).encode()).hexdigest()
    ours = ("asphalt_nscd", "studies")
    return [meaning, sorted([name, base] for name, base in imports if name.startswith(ours))]


def _seal(content: bytes, found: list[Any]) -> str:
    """Checksum of what was found in a source file, by this Python and this module."""
    parts = (sys.version.encode(), _own(), content, json.dumps(found).encode())
    return hashlib.sha256(b"\0".join(parts)).hexdigest()


@cache
def _own() -> bytes:
    return Path(__file__).read_bytes()


@cache
def _parsed(package: Path) -> dict[str, Any]:
    """By its path in the package, what earlier processes and this one found in each source file.

    To parse all of them takes a quarter of a dry run. They lie beside what Python compiled of them.
    """
    kept = package / "__pycache__/sources.json"
    try:
        table = json.loads(kept.read_bytes())
    except (OSError, ValueError):
        table = None
    parsed = table if isinstance(table, dict) else {}
    atexit.register(_keep_parsed, kept, parsed, json.dumps(parsed))
    return parsed


def _keep_parsed(kept: Path, parsed: dict[str, Any], before: str) -> None:
    """Write what was parsed for later processes; of two that end together one wins, and the rest is parsed again."""
    text = json.dumps(parsed)
    if text != before:
        temporary = kept.with_suffix(f".{os.getpid()}")
        with suppress(OSError):  # a package may stand where nobody writes
            temporary.write_text(text)
            temporary.replace(kept)
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def _file(module: tuple[str, ...]) -> Path | None:
    """File of a dotted module name; None if it is a module neither of this package nor of studies."""
    homes = {"asphalt_nscd": [PACKAGE], "studies": STUDIES}.get(module[0], [])
    for place in (home.joinpath(*module[1:]) for home in homes):
        for path in (place.with_suffix(".py"), place / "__init__.py"):
            if path.is_file():
                return path
    return None


def _place(path: Path) -> str:
    """A source file by its place in the package or in studies, which is the same in each copy."""
    if path.is_relative_to(PACKAGE):
        return path.relative_to(PACKAGE).as_posix()
    return "/".join(path.parts[-3:])
