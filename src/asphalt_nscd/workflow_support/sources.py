"""Source files that a module depends on, read from its import statements."""

from __future__ import annotations

import ast
import csv
import hashlib
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from asphalt_nscd.files.store import atomic_path

PACKAGE = Path(__file__).resolve().parents[1]


def source_files(*modules: str) -> list[Path]:
    """Files of `modules` (dotted, relative to the package) and of all they import from it, sorted.

    Imports inside functions count. A package's `__init__.py` counts only where it is itself imported.
    """
    found: set[Path] = set()
    waiting = []
    for module in modules:
        file = _file(("asphalt_nscd", *module.split(".")))
        if file is None:
            raise ValueError(f"no module asphalt_nscd.{module}")
        waiting.append(file)
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting.extend(_read(path, path.stat().st_mtime_ns).imported)
    return sorted(found)


def stamp(folder: str | Path, name: str, files: Sequence[Path]) -> Path:
    """A file that stands for the meaning of many source files, rewritten only when one of them changed.

    Comments, docstrings and layout mean nothing. Snakemake looks at each input of each waiting job
    whenever a job ends, so one file is better than thirty.
    """
    digest = hashlib.sha256()
    for file in files:
        digest.update(
            f"{file.relative_to(PACKAGE)}\n{_read(file, file.stat().st_mtime_ns).meaning}\n".encode()
        )
    return _keep(Path(folder, name), digest.hexdigest(), files)


def stamp_of_row(folder: str | Path, table: str | Path, key: str, value: float) -> Path:
    """The same for the row of a CSV table in which column `key` is `value`: other rows do not count.

    A table that cannot be read, or has no such row, stands as a whole: whoever reads it says what is wrong.
    """
    path = Path(table)
    text = path.read_text(encoding="utf-8-sig", errors="replace") if path.is_file() else ""
    rows = list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))
    content = text
    if rows and key in rows[0]:
        column = rows[0].index(key)
        found = [row for row in rows[1:] if len(row) > column and _is_number(row[column], value)]
        content = repr((rows[0], found)) if found else text
    digest = hashlib.sha256(content.encode()).hexdigest()
    return _keep(Path(folder, f"{path.stem}-{value:g}"), digest, [path] if path.is_file() else [])


def _keep(path: Path, content: str, files: Sequence[Path]) -> Path:
    """Write a stamp of `files` unless it stands already."""
    if not path.is_file() or path.read_text() != content:
        with atomic_path(path) as temporary:
            temporary.write_text(content)
        newest = max((file.stat().st_mtime_ns for file in files), default=0)
        os.utime(path, ns=(newest, newest))  # a lost stamp must not look like a change
    return path


def _is_number(text: str, value: float) -> bool:
    try:
        return float(text) == value
    except ValueError:
        return False


def modules_of(package: str) -> list[str]:
    """Modules of a package (dotted, relative to this one) that finds them by itself, without an import statement."""
    folder = PACKAGE.joinpath(*package.split("."))
    return [f"{package}.{path.stem}" for path in sorted(folder.glob("*.py")) if path.name != "__init__.py"]


@dataclass(frozen=True)
class _Source:
    """What a source file means and needs."""

    meaning: str  # digest of its syntax tree without docstrings
    imported: frozenset[Path]  # of this package


@cache
def _read(path: Path, mtime_ns: int) -> _Source:
    """mtime_ns: as it stood at which moment. Parsed once for both, which takes most of the time."""
    package = ("asphalt_nscd", *path.relative_to(PACKAGE).parent.parts)
    files: set[Path | None] = set()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            if ast.get_docstring(node, clean=False) is not None:
                node.body = node.body[1:]
        elif isinstance(node, ast.Import):
            files.update(_file(tuple(name.name.split("."))) for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            base += tuple((node.module or "").split(".")) if node.module else ()
            for name in node.names:
                files.add(_file((*base, name.name)) or _file(base))
    meaning = hashlib.sha256(ast.dump(tree, annotate_fields=False).encode()).hexdigest()
    return _Source(meaning, frozenset(file for file in files if file is not None))


def _file(module: tuple[str, ...]) -> Path | None:
    """File of a dotted module name; None if it is not a module of this package."""
    if module[:1] != ("asphalt_nscd",):
        return None
    place = PACKAGE.joinpath(*module[1:])
    for path in (place.with_suffix(".py"), place / "__init__.py"):
        if path.is_file():
            return path
    return None
