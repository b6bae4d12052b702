"""Published results: files copied beside their checksums, and tables in README.md and docs/ made from them."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import pandas as pd

from asphalt_nscd.files import digests
from asphalt_nscd.files.commit import commit
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path, read_json, write_json
from asphalt_nscd.reporting.published_tables import shown
from asphalt_nscd.workflow_support.sources import meaning_of, source_files

CHECKSUMS = "SHA256SUMS"
CARRIERS = (
    "files",
    "cli.__init__",
    "cli._data",
    "cli._options",
    "cli._progress",
)  # of numbers, which they leave alone
RESTS_ON = "sources.json"  # of what is published together: its commit, its sources, and what these meant


@dataclass(frozen=True)
class Sources:
    """What published tables rest on: modules with all that they import, dotted as `source_files` takes them; files."""

    modules: Sequence[str]
    files_read: Sequence[str]

    def digest(self) -> str:
        """Digest of what the modules mean and of the bytes of the files, as they are now; "" where one is missing."""
        try:
            parts = [
                meaning_of(source_files(*self.modules, without=CARRIERS)),
                *(f"{name} {_sum(Path(name))}" for name in self.files_read),
            ]
        except (OSError, ValueError):
            return ""
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def publish(
    files: Sequence[Path], root: Path, output: Path, name: str = "", sources: Sources | None = None
) -> None:
    """Copy files to a folder, keeping their places below `root`, with the list of SHA-256 sums.

    With `sources` it is noted, under `name`, of which commits the files are and what they rest on.
    """
    for path in files:
        with atomic_path(output / path.relative_to(root)) as temporary:
            shutil.copyfile(path, temporary)
    if sources:
        makers = digests.makers(root)
        noted = {
            "files": sorted(path.relative_to(root).as_posix() for path in files),
            "commits": sorted({makers.get(path, commit()) for path in files}),
            "digest": sources.digest(),
            **asdict(sources),
        }
        standing = read_json(output / RESTS_ON) if (output / RESTS_ON).is_file() else {}
        write_json(output / RESTS_ON, standing | {name: noted})
    with atomic_path(output / CHECKSUMS) as temporary:
        # As `sha256sum --check` reads it.
        temporary.write_text("".join(f"{_sum(path)}  {name}\n" for name, path in _published(output)))


def altered(folder: Path) -> list[str]:
    """A sentence for each file that differs from the list of checksums in a published folder."""
    sums = folder / CHECKSUMS
    if not sums.is_file():
        return [f"{sums}: is missing"]
    # Whatever bytes a damaged list holds, it is told as one.
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


def stale(published: Path) -> dict[str, str]:
    """Why, for each name under which something was published, if its sources mean something else by now."""
    found = {}
    for folder in sorted(path for path in published.iterdir() if path.is_dir()):
        entries = read_json(folder / RESTS_ON) if (folder / RESTS_ON).is_file() else {}
        if not entries:
            found[f"publish_{folder.name}"] = "its sources were never noted"
        for name, noted in entries.items():
            now = Sources(noted["modules"], noted["files_read"]).digest()
            if not now or now != noted["digest"]:
                found[name] = (
                    "its sources have changed" if noted["digest"] else "its sources were never noted"
                )
    return found


def _published(folder: Path) -> list[tuple[str, Path]]:
    """Names below folder, and paths, of all files but the list itself and hidden ones."""
    files = (path for path in folder.rglob("*") if path.is_file() and not path.name.startswith("."))
    return sorted((path.relative_to(folder).as_posix(), path) for path in files if path != folder / CHECKSUMS)


def _sum(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def fill_blocks(documents: Sequence[Path], blocks: Mapping[str, Path]) -> None:
    """Replace what stands between `<!-- name -->` and `<!-- end name -->` by a table.

    `blocks` names the source of each block: a Markdown source is taken as it is; of a CSV file the table is made
    (reporting/published_tables.yaml). `documents` are Markdown files or folders of them. Each block must stand once in
    all of them together; else nothing is changed.
    """
    pages = [page for path in documents for page in (sorted(path.glob("*.md")) if path.is_dir() else [path])]
    before = {page: page.read_text(encoding="utf-8") for page in pages}
    texts = dict(before)
    for name, source in blocks.items():
        begin, end = f"<!-- {name} -->\n", f"<!-- end {name} -->"
        places = [page for page, text in texts.items() if begin in text or end in text]
        page = places[0] if len(places) == 1 else None
        if page is None or not _stands_once(texts[page], begin, end):
            where = ", ".join(map(str, places or documents))
            raise InputError(
                f"{where}: the block {begin.strip()} ... {end} must stand once; mend the two lines."
            )
        head, tail = texts[page].split(begin)[0], texts[page].split(end)[1]
        texts[page] = head + begin + _markdown(name, source) + end + tail
    # Only now: a block that is missing leaves every page as it was.
    for page, text in texts.items():
        if text != before[page]:
            with atomic_path(page) as temporary:
                temporary.write_text(text, encoding="utf-8")


def _stands_once(text: str, begin: str, end: str) -> bool:
    return text.count(begin) == 1 == text.count(end) and text.index(begin) < text.index(end)


def _markdown(block: str, source: Path) -> str:
    return source.read_text(encoding="utf-8") if source.suffix == ".md" else shown(block, pd.read_csv(source))
