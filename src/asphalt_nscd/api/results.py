"""What steps of the simulation leave: arrays and attributes of a file, in memory or on disk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from asphalt_nscd.files.store import load, save


@dataclass(frozen=True)
class Result:
    """Arrays and attributes; names of attributes end in their unit."""

    kind: ClassVar[str]  # of its file

    arrays: Mapping[str, np.ndarray]
    attributes: Mapping[str, Any]
    name: str = field(default="in memory", compare=False)

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """From a file of the command line, or of `write`."""
        record = load(path, cls.kind)
        return cls(record.arrays, record.attributes, Path(path).stem)

    def write(self, path: str | Path) -> None:
        """To an HDF5 file that the command line reads."""
        save(path, self.kind, self.arrays, self.attributes)
