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
    """Arrays and attributes that a step of the simulation leaves.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        By their place in the HDF5 file.
    attributes : mapping
        Of the file; names end in their unit.
    name : str
        In messages.
    """

    kind: ClassVar[str]  # of its file

    arrays: Mapping[str, np.ndarray]
    attributes: Mapping[str, Any]
    # Not compared: two results with the same arrays are equal, wherever they came from.
    name: str = field(default="in memory", compare=False)

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """Read a file of the command line, or of `write`.

        Parameters
        ----------
        path : path
            HDF5 file of this kind.

        Returns
        -------
        Packing, Specimen, Test or Failure
            Of the class that reads.

        Raises
        ------
        InputError
            Where the file is missing, damaged or of another kind.
        """
        record = load(path, cls.kind)
        return cls(record.arrays, record.attributes, Path(path).stem)

    def write(self, path: str | Path) -> None:
        """Write an HDF5 file that the command line reads.

        Parameters
        ----------
        path : path
            File to write.
        """
        save(path, self.kind, self.arrays, self.attributes)
