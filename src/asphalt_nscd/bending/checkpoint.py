"""A run that was stopped goes on from its last checkpoint, and ends with the same bits."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load, save

_TRANSPOSED = "transposed"  # arrays stored so: linear algebra adds in another order by columns than by rows


@dataclass(frozen=True)
class Checkpoint:
    """Where and how often a run is kept: `every` in steps; `run` says which run it is, and another one is refused."""

    path: Path
    every: int
    run: dict[str, float | int | str]

    def resume(self) -> dict[str, np.ndarray] | None:
        """Arrays that were kept last, by name; None before the first time; another run's file is refused."""
        if not self.path.exists():
            return None
        record = load(self.path, "checkpoint")
        transposed = str(record.attributes.pop(_TRANSPOSED)).split(",")
        for name, value in self.run.items():
            if (kept := record.attributes.get(name)) != value:
                raise InputError(
                    f"{self.path}: belongs to another run ({name} is {kept} there, {value} here); "
                    "delete it or give another file."
                )
        return {name: value.T if name in transposed else value for name, value in record.arrays.items()}

    def is_due(self, done: int, steps: int) -> bool:
        """Whether the run is to be kept now: after each `every` steps but the last."""
        return done % self.every == 0 and done < steps

    def keep(self, arrays: dict[str, np.ndarray]) -> None:
        """Replace what was kept before; a run killed meanwhile leaves that."""
        transposed = [name for name, value in arrays.items() if not value.flags.c_contiguous]
        stored = {name: value.T if name in transposed else value for name, value in arrays.items()}
        save(self.path, "checkpoint", stored, self.run | {_TRANSPOSED: ",".join(transposed)})

    def drop(self) -> None:
        """The run is complete."""
        self.path.unlink(missing_ok=True)


def digest(path: str | Path) -> str:
    """SHA-256 of a file, hexadecimal, which names it in `run`."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
