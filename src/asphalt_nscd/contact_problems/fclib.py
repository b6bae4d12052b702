"""Frictional contact problems in the HDF5 format of FCLIB (https://frictionalcontactlibrary.github.io).

Group `fclib_local` holds `spacedim`, `W`, `vectors/q` and `vectors/mu`, normal first in each contact.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy import sparse

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd import solve_contacts

_COMPRESSED_COLUMNS, _COMPRESSED_ROWS = -1, -2
_MEND = "give a local problem in three dimensions as FCLIB writes it"


@dataclass(frozen=True)
class LocalProblem:
    """u = W r + q with friction mu."""

    W: sparse.csr_array  # (3 c, 3 c)
    q: np.ndarray  # (3 c,)
    mu: np.ndarray  # (c,)


@dataclass(frozen=True)
class Outcome:
    """One line of the table: what became of one file.

    `error` is the natural map as Siconos states it, `scaled_error` the same in units of energy; `iterations` counts
    sweeps and steps; `seconds` is CPU time, reading, compilation and first use of memory aside. `converged` holds where
    both errors are within the tolerance.
    """

    file: str
    contacts: int
    iterations: int
    error: float
    scaled_error: float
    seconds: float
    converged: bool

    def __str__(self) -> str:
        verdict = "converged" if self.converged else "NOT converged"
        return (
            f"{self.file}: {self.contacts} contacts, {self.iterations} iterations, error {self.error:.1e} "
            f"(scaled {self.scaled_error:.1e}), {self.seconds:.4f} s, {verdict}"
        )


def solve_files(files: Sequence[str | Path], tolerance: float) -> list[Outcome]:
    """Solve the FCLIB problem of each file to a tolerance of both errors; all are read before the first is solved."""
    # all first: a file that cannot be read is told before minutes go into the others
    problems = [read_problem(file) for file in files]
    outcomes = []
    for file, problem in zip(files, problems, strict=True):
        try:  # compiles, warms up
            solve_contacts(problem.W, problem.q, problem.mu, most_sweeps=20, most_steps=0)
        except ValueError as error:
            raise InputError(f"{file}: {error}; {_MEND}.") from None
        begin = time.process_time()
        solution = solve_contacts(problem.W, problem.q, problem.mu, tolerance)
        seconds = time.process_time() - begin
        outcomes.append(
            Outcome(
                Path(file).name,
                problem.mu.size,
                solution.iterations,
                solution.error,
                solution.scaled_error,
                seconds,
                solution.converged,
            )
        )
    return outcomes


def table(outcomes: Sequence[Outcome]) -> pd.DataFrame:
    """Table of outcomes, one row for each file."""
    return pd.DataFrame([asdict(outcome) for outcome in outcomes])


def read_problem(path: str | Path) -> LocalProblem:
    """Read and check one FCLIB file: W, q and mu; any other or damaged file is refused in one sentence."""
    import h5py

    if not Path(path).is_file():
        raise InputError(f"{path}: no such file, or a folder; check the path.")
    try:
        with h5py.File(path, "r") as file:
            found: dict[str, Any] = {}
            file.visititems(
                lambda name, item: (
                    found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None
                )
            )
    except Exception as error:  # h5py raises nearly any exception on a damaged file
        reason = (str(error).splitlines() or [type(error).__name__])[0][:120]
        raise InputError(f"{path}: damaged or not HDF5 ({reason}); {_MEND}.") from None
    try:
        return _problem({name: value for name, value in found.items() if name.startswith("fclib_")})
    except KeyError as error:
        raise InputError(f"{path}: no dataset {error.args[0]}; {_MEND}.") from None
    except (ValueError, TypeError) as error:
        raise InputError(f"{path}: {error}; {_MEND}.") from None


def _problem(found: dict[str, np.ndarray]) -> LocalProblem:
    """The local problem in datasets by name; ValueError or KeyError says why there is none."""
    if any(name.startswith("fclib_global/") for name in found):
        raise ValueError("a global problem (M, H), not a local one (W)")
    if any(name.startswith("fclib_local/R/") for name in found):
        raise ValueError("a problem with bilateral constraints (V, R), which are not solved here")
    spacedim = _integer(found, "fclib_local/spacedim")
    if spacedim != 3:
        raise ValueError(f"spacedim is {spacedim}")
    matrix = _matrix(found, "fclib_local/W")
    q, mu = (_numbers(found, f"fclib_local/vectors/{name}", float) for name in ("q", "mu"))
    if matrix.shape != (q.size, q.size) or q.size != 3 * mu.size or mu.size == 0:
        raise ValueError(f"W {matrix.shape}, q ({q.size},) and mu ({mu.size},) do not belong together")
    if not (mu >= 0.0).all():
        raise ValueError("vectors/mu has negative values")
    return LocalProblem(matrix, q, mu)


def _matrix(found: dict[str, np.ndarray], name: str) -> sparse.csr_array:
    """A matrix by rows (nz = -2), by columns (nz = -1) or as triplets (nz >= 0), as CSR.

    Of triplets `i` holds the rows and `p` the columns, as CSparse has it; the comment in fclib.h
    says the opposite.
    """
    m, n, nz, nzmax = (_integer(found, f"{name}/{key}") for key in ("m", "n", "nz", "nzmax"))
    if m <= 0 or n <= 0:
        raise ValueError(f"W has {m} rows and {n} columns")
    p, i = (_numbers(found, f"{name}/{key}", int) for key in ("p", "i"))
    x = _numbers(found, f"{name}/x", float)
    if nz >= 0:
        if min(p.size, i.size, x.size) < nz:
            raise ValueError(f"W announces {nz} entries and holds {min(p.size, i.size, x.size)}")
        inside = (i[:nz] >= 0).all() and (i[:nz] < m).all() and (p[:nz] >= 0).all() and (p[:nz] < n).all()
        if not inside:
            raise ValueError("W has entries outside its rows and columns")
        return sparse.csr_array(sparse.coo_array((x[:nz], (i[:nz], p[:nz])), shape=(m, n)))
    if nz not in (_COMPRESSED_COLUMNS, _COMPRESSED_ROWS):
        raise ValueError(f"W is stored in an unknown way (nz = {nz})")
    lines, width = (m, n) if nz == _COMPRESSED_ROWS else (n, m)
    if p.size != lines + 1 or p[0] != 0 or (np.diff(p) < 0).any() or p[-1] > min(i.size, x.size, nzmax):
        raise ValueError("the pointers W/p do not fit W/i and W/x")
    # there may be room for more entries than there are (nzmax): the last pointer tells
    i, x = i[: p[-1]], x[: p[-1]]
    if ((i < 0) | (i >= width)).any():
        raise ValueError("W has entries outside its rows and columns")
    storage = sparse.csr_array if nz == _COMPRESSED_ROWS else sparse.csc_array
    matrix = sparse.csr_array(storage((x, i, p), shape=(m, n)))
    # an entry that is there twice means its sum, as in CSparse
    matrix.sum_duplicates()
    return matrix


def _integer(found: dict[str, np.ndarray], name: str) -> int:
    values = _numbers(found, name, int)
    if values.size != 1:
        raise ValueError(f"{name} is not one number")
    return int(values[0])


def _numbers(found: dict[str, np.ndarray], name: str, kind: type) -> np.ndarray:
    """Values (n,) of a dataset; ValueError for another kind of values, or for some that are not finite."""
    values = np.ravel(found[name])
    if values.dtype.kind not in ("if" if kind is float else "iu"):
        raise ValueError(f"{name} does not hold {'numbers' if kind is float else 'integers'}")
    if not np.isfinite(values).all():
        raise ValueError(f"{name} has values that are not finite")
    return values.astype(kind)
