"""Published results: files copied beside their checksums, and blocks of README.md made from them."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.errors import InputError
from asphalt_nscd.store import atomic_path

CHECKSUMS = "SHA256SUMS"


def publish(files: Sequence[Path], root: Path, output: Path) -> None:
    """Copy files (below root) into output, keeping their places, and list their SHA-256 sums there."""
    lines = []
    for path in sorted(files):
        place = path.relative_to(root)
        with atomic_path(output / place) as temporary:
            shutil.copyfile(path, temporary)
        lines.append(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {place.as_posix()}\n")
    with atomic_path(output / CHECKSUMS) as temporary:
        temporary.write_text("".join(lines), encoding="utf-8")


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
