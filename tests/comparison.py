"""Two folders of results, compared bit for bit but for when, where and how fast they were made."""

from __future__ import annotations

import re
from pathlib import Path

import h5py
import pandas as pd

VOLATILE = (
    "logs", "benchmarks", "compiled", "report.html", "workflow.html", "provenance.json", "timings.csv", "timings.md",
)  # fmt: skip

_COMMIT = re.compile(rb"\b[0-9a-f]{40}(-dirty)?\b")  # of the code; a file edited meanwhile makes it dirty
CPU = "cpu_s"  # column and attribute


def differences(first: Path, second: Path) -> list[str]:
    """A sentence for each file that is missing on one side, or whose content differs."""
    names = sorted(_results(first) | _results(second))
    return [f"{name}: {said}" for name in names if (said := _difference(first / name, second / name))]


def _results(folder: Path) -> set[Path]:
    return {
        place
        for path in folder.rglob("*")
        if path.is_file()
        and (place := path.relative_to(folder)).parts[0] not in VOLATILE
        and place != Path("pages/timings.html")
    }


def _difference(first: Path, second: Path) -> str | None:
    if first.suffix == ".html" and _timed(first.parents[1] / f"{first.stem}.csv"):
        return None  # the table itself is compared
    missing = [str(path) for path in (first, second) if not path.is_file()]
    if missing:
        return f"no {missing[0]}"
    contents = _content(first), _content(second)
    if isinstance(contents[0], pd.DataFrame):
        return None if contents[0].equals(contents[1]) else "differs"
    return None if contents[0] == contents[1] else "differs"


def _timed(path: Path) -> bool:
    """Whether a table says how long each test took."""
    return path.is_file() and CPU in path.read_text(encoding="utf-8").partition("\n")[0].split(",")


def _content(path: Path) -> object:
    """Bytes; of HDF5 all arrays and attributes but the provenance, for these files hold addresses of their own."""
    if path.suffix == ".csv" and _timed(path):
        return pd.read_csv(path, dtype=str).drop(columns=CPU)
    if path.suffix != ".h5":
        return _COMMIT.sub(b"", path.read_bytes())
    content: dict[str, object] = {}
    with h5py.File(path) as file:
        content |= {
            name: repr(value)
            for name, value in file.attrs.items()
            if name not in ("provenance", "digest", CPU)
        }
        file.visititems(
            lambda name, item: (
                content.__setitem__(f"/{name}", (item.dtype.str, item.shape, item[()].tobytes()))
                if isinstance(item, h5py.Dataset)
                else None
            )
        )
    return content
