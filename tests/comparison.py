"""Two folders of results, compared bit for bit but for when, where and how fast they were made."""

from __future__ import annotations

from pathlib import Path

import h5py

VOLATILE = (
    "logs", "benchmarks", "compiled", "report.html", "workflow.html", "provenance.json", "timings.csv", "timings.md",
)  # fmt: skip


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
    missing = [str(path) for path in (first, second) if not path.is_file()]
    if missing:
        return f"no {missing[0]}"
    same = _content(first) == _content(second)
    return None if same else "differs"


def _content(path: Path) -> object:
    """Bytes; of HDF5 all arrays and attributes but the provenance, for these files hold addresses of their own."""
    if path.suffix != ".h5":
        return path.read_bytes()
    content: dict[str, object] = {}
    with h5py.File(path) as file:
        content |= {name: repr(value) for name, value in file.attrs.items() if name != "provenance"}
        file.visititems(
            lambda name, item: (
                content.__setitem__(f"/{name}", (item.dtype.str, item.shape, item[()].tobytes()))
                if isinstance(item, h5py.Dataset)
                else None
            )
        )
    return content
