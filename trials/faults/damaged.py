"""Files of results that a disk or an editor damaged."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

from faults.fault import MODEL, READ, Fault
from faults.study import Run, Study


def cut(path: Path) -> None:
    with path.open("r+b") as file:
        file.truncate(path.stat().st_size // 2)


def emptied(path: Path) -> None:
    path.write_bytes(b"")


def flipped(path: Path) -> None:
    """One bit, in the middle of what the file holds."""
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0x10
    path.write_bytes(data)


def without_its_last_line(path: Path) -> None:
    path.write_bytes(b"".join(path.read_bytes().splitlines(keepends=True)[:-1]))


def other_kind(path: Path) -> None:
    shutil.copy(path.parents[len(path.parts) - path.parts.index("smoke") - 2] / MODEL, path)


def changed(name: str, said: str, word: str) -> Fault:
    """One bit of a finished study edited or decayed; it is then run as a whole, so that what is missing is made too."""

    def disturb(study: Study) -> Run:
        {"edited": flipped, "decayed": _decay}[word](study.results / name)
        return study.finish()

    return Fault(f"{name} of a finished study {word}", disturb, said, "")


def _decay(path: Path, how: Callable[[Path], None] = flipped) -> None:
    """As damage to a disk leaves it: the times are those of before."""
    times = path.stat()
    how(path)
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def damaged(name: str, how: Callable[[Path], None], said: str) -> Fault:
    def disturb(study: Study) -> Run:
        _decay(study.results / name, how)
        (study.results / READ[name]).unlink()
        return study.finish()

    return Fault(f"{name} {how.__name__.replace('_', ' ')}", disturb, said, READ[name])
