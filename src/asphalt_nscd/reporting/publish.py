"""Published results: files copied beside their checksums, and blocks of README.md made from them."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path

CHECKSUMS = "SHA256SUMS"


def publish(files: Sequence[Path], root: Path, output: Path) -> None:
    """Copy files (below root) into output, keeping their places; the list of SHA-256 sums there names all files."""
    for path in files:
        with atomic_path(output / path.relative_to(root)) as temporary:
            shutil.copyfile(path, temporary)
    with atomic_path(output / CHECKSUMS) as temporary:
        temporary.write_text("".join(f"{_sum(path)}  {name}\n" for name, path in _published(output)))


def altered(folder: Path) -> list[str]:
    """What differs from the list of checksums in a published folder, a sentence for each file."""
    sums = folder / CHECKSUMS
    if not sums.is_file():
        return [f"{sums}: is missing"]
    lines = [line.partition("  ") for line in sums.read_text(encoding="utf-8", errors="replace").splitlines()]
    listed = {name: digest for digest, _, name in lines}
    if "" in listed:
        return [f"{sums}: a line is no checksum, two spaces and a name"]
    there = dict(_published(folder))
    found = []
    for name in sorted(listed.keys() | there.keys()):
        if name not in there:
            found.append(f"{folder / name}: is missing")
        elif listed.get(name) != _sum(there[name]):
            found.append(f"{there[name]}: is not the file that was published ({CHECKSUMS})")
    return found


def _published(folder: Path) -> list[tuple[str, Path]]:
    """Names below folder, and paths, of all files but the list itself and hidden ones."""
    files = (path for path in folder.rglob("*") if path.is_file() and not path.name.startswith("."))
    return sorted((path.relative_to(folder).as_posix(), path) for path in files if path != folder / CHECKSUMS)


def _sum(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def fill_blocks(document: Path, blocks: Mapping[str, Path]) -> None:
    """Replace what stands between `<!-- name -->` and `<!-- end name -->` by a table.

    A Markdown file is taken as it is; of a CSV file the table is made.
    """
    text = document.read_text(encoding="utf-8")
    for name, source in blocks.items():
        begin, end = f"<!-- {name} -->\n", f"<!-- end {name} -->"
        if text.count(begin) != 1 or text.count(end) != 1 or text.index(begin) > text.index(end):
            raise InputError(f"{document}: no block {begin.strip()} ... {end}; add the two lines.")
        head, tail = text.split(begin)[0], text.split(end)[1]
        text = head + begin + _markdown(source) + end + tail
    with atomic_path(document) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _markdown(source: Path) -> str:
    if source.suffix == ".md":
        return source.read_text(encoding="utf-8")
    table = pd.read_csv(source).convert_dtypes()  # whole numbers stay so beside empty fields
    shown = table.astype(object).where(table.notna(), None)
    return shown.to_markdown(index=False, floatfmt=".4g", missingval="") + "\n"
