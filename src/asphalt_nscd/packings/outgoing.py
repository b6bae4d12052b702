"""Deposits, specimens and tests as tables (CSV), and their spheres and bonds for ParaView (VTK)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, kind_of, load, write_table
from asphalt_nscd.packings.vtk_files import write_poly_data
from asphalt_nscd.specimen.preparation import DEPOSIT, SPECIMEN

TEST = "test"
FORMS = {"vtk": (".vtp",), "csv": (".csv",)}
BONDS = "-bonds"  # behind the name of the file of spheres


def export_result(source: str | Path, form: str, output: str | Path) -> str:
    """Write a result file in another form; one line that says what was written.

    A deposit or specimen is its spheres, in m; a specimen also its bonds, in a file beside; a test its history (csv).
    """
    output = Path(output)
    endings = FORMS.get(form)
    if endings is None:
        raise InputError(f"{source}: format {form!r} is one of laws; give one of {', '.join(FORMS)}.")
    if output.suffix.lower() not in endings:
        raise InputError(
            f"{output}: a file of format {form} ends in {' or '.join(endings)}; rename the output."
        )
    kind = kind_of(source)
    if kind not in _WRITERS:
        raise InputError(f"{source}: holds {kind!r}; give a file with one of {', '.join(_WRITERS)}.")
    return _WRITERS[kind](load(source, kind), form, output)


def _deposit(record: Record, form: str, output: Path) -> str:
    _spheres(record, form, output)
    return f"{output}: {record.arrays['radius'].size} spheres, lengths in m."


def _specimen(record: Record, form: str, output: Path) -> str:
    _spheres(record, form, output)
    beside = output.with_name(f"{output.stem}{BONDS}{output.suffix}")
    arrays, n = record.arrays, record.arrays["radius"].size
    ends = np.column_stack([arrays["network/first"], arrays["network/second"]])
    own = {f"{name}": arrays[f"network/{key}"] for name, key in _OF_BONDS.items()}
    if form == "csv":
        write_table(beside, pd.DataFrame({"first": ends[:, 0], "second": ends[:, 1], **own}))
    else:
        # A bond to a plate, body n or n + 1, ends where it acts.
        place, plate = np.concatenate([arrays["position"], arrays["network/point"]]), ends >= n
        ends = np.where(plate, n + np.arange(len(ends))[:, None], ends)
        used, lines = np.unique(ends, return_inverse=True)
        write_poly_data(
            beside,
            place[used],
            {},
            lines.reshape(ends.shape),
            own | {"plate": np.asarray(plate.any(axis=1), np.int8)},
        )
    return f"{output}: {n} spheres; {beside.name}: {len(ends)} bonds; lengths in m, areas in m2."


_OF_BONDS = {"area_m2": "area", "gap_m": "gap", "length_m": "length"}


def _spheres(record: Record, form: str, output: Path) -> None:
    position, radius = record.arrays["position"], record.arrays["radius"]
    sizes = np.unique(radius, return_inverse=True)[1]  # 0 for the smallest
    if form == "csv":
        columns = dict(zip(("x_m", "y_m", "z_m"), position.T, strict=True))
        write_table(output, pd.DataFrame({**columns, "radius_m": radius, "class": sizes}))
    else:
        write_poly_data(output, position, {"radius_m": radius, "class": sizes})


def _test(record: Record, form: str, output: Path) -> str:
    if form != "csv":
        raise InputError(f"{output}: a test holds a history and no motion of spheres; give --format csv.")
    history = {name: record.arrays[name] for name in ("time_s", "displacement_m", "force_N")}
    write_table(output, pd.DataFrame(history))
    return f"{output}: {record.arrays['time_s'].size} steps of time, displacement and force of the head."


_WRITERS: dict[str, Callable[[Record, str, Path], str]] = {
    DEPOSIT: _deposit,
    SPECIMEN: _specimen,
    TEST: _test,
}
