"""Two folders of results, compared bit for bit but for when, where and how fast they were made.

Left out are files that hold nothing else (`OF_A_RUN`), hidden ones, which hold digests of others, the commit in
JSON and on pages, and which commit made how many files. Of HDF5, which holds addresses of its own, every array and
attribute is compared, not the bytes.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import h5py
import numpy as np

OF_A_RUN = (
    "logs", "benchmarks", "compiled", "report.html", "workflow.html", "timings.csv", "timings.md", "pages/timings.html",
)  # fmt: skip
_COMMIT = {
    ".json": re.compile(rb'(?<="git_commit": ")[^"]*'),
    ".html": re.compile(rb"(?<=, commit )[^ <]*(?=\.</p>)"),
}


def differences(first: Path, second: Path) -> list[str]:
    """A sentence for each file that is missing on one side, or whose content differs."""
    names = sorted(results(first) | results(second))
    return [f"{name}: {said}" for name in names if (said := _difference(first / name, second / name))]


def results(folder: Path) -> set[Path]:
    """Files below a folder that are compared."""
    places = {path.relative_to(folder) for path in folder.rglob("[!.]*") if path.is_file()}
    return {place for place in places if not any(place.is_relative_to(name) for name in OF_A_RUN)}


def _difference(first: Path, second: Path) -> str | None:
    missing = [str(path) for path in (first, second) if not path.is_file()]
    if missing:
        return f"no {missing[0]}"
    return None if _content(first) == _content(second) else "differs"


def _content(path: Path) -> object:
    if path.suffix == ".h5":
        with h5py.File(path) as file:
            content: dict[str, object] = {"/": _attributes(file)}
            file.visititems(lambda name, item: content.__setitem__(name, (_array(item), _attributes(item))))
        return content
    text = path.read_bytes()
    if path.name == "provenance.json":
        return {key: told for key, told in json.loads(text).items() if key not in ("git_commit", "made_by")}
    if path.suffix in _COMMIT:
        text = _COMMIT[path.suffix].sub(b"", text)
    return text


def _array(item: h5py.Dataset | h5py.Group) -> object:
    return _exactly(item[()]) if isinstance(item, h5py.Dataset) else None


def _attributes(item: h5py.Dataset | h5py.Group) -> dict[str, object]:
    return {name: _exactly(item.attrs[name]) for name in item.attrs if name != "provenance"}


def _exactly(value: object) -> object:
    array = np.asarray(value)
    return array.dtype.str, array.shape, array.tolist() if array.dtype == object else array.tobytes()
