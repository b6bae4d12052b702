"""Files: HDF5 and CSV that are written whole or not at all, and refused when damaged."""

from __future__ import annotations

import hashlib
import io
import json
import os
import platform
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from secrets import token_hex
from typing import TYPE_CHECKING, Any

from asphalt_nscd.files import digests
from asphalt_nscd.files.commit import commit
from asphalt_nscd.files.errors import DamagedFile, InputError, unreadable
from asphalt_nscd.files.paths import require_readable

if TYPE_CHECKING:  # a workflow reads this module beside a Snakemake that may have neither
    import numpy as np
    import pandas as pd

FORMAT_VERSION = 1
# endings of packings of other programs
_OF_OTHERS = (".csv", ".tsv", ".txt", ".dump", ".liggghts", ".vtk", ".vtp", ".vtu")
VERSIONS = "ASPHALT_NSCD_VERSIONS"  # a workflow tells its jobs: to find out takes a tenth of a test
_PACKAGES = ("asphalt-nscd", "numpy", "scipy", "numba", "pandas", "h5py", "matplotlib", "snakemake")


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """A temporary path beside `path`, moved there only when the block succeeds; `path` is new or a regular file."""
    path = Path(path)
    if path.exists() and not path.is_file():
        raise InputError(f"{path}: not a regular file, so it is not replaced; choose another path.")
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the same folder, for a rename is atomic only within one file system.
    temporary = path.with_name(f".{path.stem}-{token_hex(8)}{path.suffix}")
    try:
        # Not by tempfile, whose files nobody else may read, whatever the umask.
        temporary.touch(exist_ok=False)
        yield temporary
        # Its bytes first: after a power cut the name must not stand for an empty file.
        with temporary.open("rb") as written:
            os.fsync(written.fileno())
        standing = digests.forget(path)  # a kill between leaves no digest, never that of another content
        temporary.replace(path)
        digests.keep(path, standing)
    except (OSError, RuntimeError) as error:
        # h5py and most libraries do not name the file that they could not write, nor would a
        # temporary name help.
        if getattr(error, "filename", None) in (None, str(temporary)):
            error.filename = str(path)  # type: ignore[union-attr]
        raise
    finally:
        temporary.unlink(missing_ok=True)


def write_table(path: str | Path, frame: pd.DataFrame) -> None:
    """Write a CSV table; column names carry the units."""
    with atomic_path(path) as temporary:
        # Line ends of one kind, so that equal tables have equal checksums on any system.
        frame.to_csv(temporary, index=False, float_format="%.10g", lineterminator="\n")


def write_json(path: str | Path, content: Any) -> None:
    """Write indented JSON."""
    with atomic_path(path) as temporary:
        temporary.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")


def read_json(path: str | Path) -> Any:
    """Read JSON; the error names a file that cannot be parsed."""
    require_readable(path, "run the rule that makes it, or check the path")
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:  # no JSON, no UTF-8, a number or nesting without end
        raise unreadable(path, f"not valid JSON ({error})", "give a JSON file, or make it again") from None


@dataclass(frozen=True)
class Record:
    """Arrays and attributes of one result file, by name, and the digest of kind, arrays and attributes."""

    arrays: dict[str, np.ndarray]
    attributes: dict[str, Any]
    digest: str


def save(
    path: str | Path,
    kind: str,
    arrays: Mapping[str, np.ndarray],
    attributes: Mapping[str, float | int | str],
) -> str:
    """Write one HDF5 result file; array names may contain slashes (groups). Returns the digest of its content.

    The digest of all arrays and attributes is kept in the file, so that a truncated or altered one is refused by
    `load`. Provenance (versions, commit) stays outside the digest: it may differ between two machines with equal
    results.
    """
    import h5py
    import numpy as np

    arrays = {name: np.ascontiguousarray(value) for name, value in arrays.items()}
    content = io.BytesIO()  # HDF5 prints tracebacks of its own where a disk is full
    with h5py.File(content, "w") as file:
        for name, value in arrays.items():
            file.create_dataset(name, data=value)
        for name, attribute in attributes.items():
            file.attrs[name] = attribute
        file.attrs["kind"] = kind
        file.attrs["format_version"] = FORMAT_VERSION
        file.attrs["digest"] = digest = _digest(kind, arrays, attributes)
        file.attrs["provenance"] = json.dumps(provenance())
    with atomic_path(path) as temporary:
        temporary.write_bytes(content.getbuffer())
    return digest


def load(path: str | Path, kind: str) -> Record:
    """Read one HDF5 result file of a kind; DamagedFile for another format or damaged content."""
    import h5py

    if not Path(path).is_file():
        raise InputError(f"{path}: no such file; run the rule that makes it, or check the path.")
    arrays: dict[str, np.ndarray] = {}
    try:
        with h5py.File(path, "r") as file:
            attributes = {name: _plain(value) for name, value in file.attrs.items()}
            file.visititems(
                lambda name, item: (
                    arrays.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None
                )
            )
    except Exception as error:  # h5py raises nearly any exception on a damaged file
        if Path(path).suffix.lower() in _OF_OTHERS:
            raise InputError(
                f"{path}: not an HDF5 file; convert a packing with `asphalt-nscd import-packing`."
            ) from None
        raise DamagedFile(path, f"damaged or not HDF5 ({_first_line(error)})") from None
    found, format_version = attributes.pop("kind", None), attributes.pop("format_version", None)
    digest = attributes.pop("digest", None)
    # Not in the digest: another version of a package that gives the same numbers gives the same digest.
    attributes.pop("provenance", None)
    if found != kind:
        raise unreadable(
            path,
            f"expected a {kind} file; found {f'a {found} file' if found else 'another kind of data'}",
            "give the right file",
        )
    if format_version != FORMAT_VERSION:
        raise DamagedFile(path, f"format {format_version}, this version reads {FORMAT_VERSION}")
    if digest != _digest(kind, arrays, attributes):
        raise DamagedFile(path, "content does not match its digest, so the file is damaged")
    return Record(arrays, attributes, digest)


def kind_of(path: str | Path) -> str:
    """Kind of a result file as `save` took it, without reading its arrays."""
    import h5py

    if not Path(path).is_file():
        raise InputError(f"{path}: no such file; run the rule that makes it, or check the path.")
    try:
        with h5py.File(path, "r") as file:
            return str(file.attrs.get("kind", "nothing of ours"))
    except Exception as error:  # h5py raises nearly any exception on a damaged file
        raise DamagedFile(path, f"damaged or not HDF5 ({_first_line(error)})") from None


def provenance() -> dict[str, Any]:
    """Git commit, package versions and Python of this run."""
    told = os.environ.get(VERSIONS)
    return {
        "git_commit": commit(),
        "python": platform.python_version(),
        "packages": json.loads(told) if told else package_versions(),
    }


def made_by(folder: str | Path) -> dict[str, dict[str, int]]:
    """For each part of a folder of results, the number of its files by the commit that made them."""
    import h5py

    makers = digests.makers(folder)
    for path in Path(folder).rglob("[!.]*.h5"):
        with h5py.File(path, "r") as file:
            makers[path] = json.loads(file.attrs.get("provenance", "{}")).get("git_commit", "unknown")
    parts: dict[str, Counter[str]] = {}
    for path, commit_of_it in sorted(makers.items()):
        part = path.relative_to(folder).parts[0]
        parts.setdefault(part, Counter())[commit_of_it] += 1
    return {part: dict(count) for part, count in parts.items()}


def package_versions() -> dict[str, str]:
    """Installed versions of the packages behind a result."""
    from importlib.metadata import PackageNotFoundError, version

    def installed(name: str) -> str:
        try:
            return version(name)
        except PackageNotFoundError:
            return "absent"

    return {name: installed(name) for name in _PACKAGES}


def _digest(kind: str, arrays: Mapping[str, np.ndarray], attributes: Mapping[str, Any]) -> str:
    """SHA-256 of kind, arrays and attributes, in whatever order these come."""
    import numpy as np

    digest = hashlib.sha256(kind.encode())
    # Sorted, because HDF5 gives names in another order than they were written in.
    for name in sorted(arrays, key=str):  # of a damaged file, some may be bytes
        value = np.ascontiguousarray(arrays[name])
        # Type and shape too: (2, 3) and (3, 2) have the same bytes.
        digest.update(f"{name}{value.dtype.str}{value.shape}".encode())
        digest.update(value.tobytes())
    for name in sorted(attributes, key=str):
        digest.update(f"{name}={_plain(attributes[name])!r}".encode())
    return digest.hexdigest()


def _plain(value: Any) -> Any:
    import numpy as np

    return value.item() if isinstance(value, np.generic) else value


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0][:120]
