"""Deposits, specimens and tests as tables (CSV), and their spheres and bonds for ParaView (VTK)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, kind_of, load, write_table
from asphalt_nscd.files.words import counted
from asphalt_nscd.nscd.bonds.strength import utilisations
from asphalt_nscd.packings.vtk_files import require_vtk, write_poly_data, write_series
from asphalt_nscd.specimen.contents import DEPOSIT, SPECIMEN

TEST, FALL, RAMP = "test", "fall", "ramp"
FRAMES = "frames/"  # what a test keeps of all spheres and bonds, on request
FORMS = {"vtk": ".vtp", "csv": ".csv"}
SERIES = ".pvd"  # for a test or a fall as vtk
BONDS = "-bonds"  # behind the name of the file of spheres


def export_result(source: str | Path, form: str, output: str | Path) -> str:
    """Write a result file (HDF5) in another form, "csv" or "vtk", and return one line that says what was written.

    A deposit or specimen is its spheres, in m; a specimen also its bonds, in a file beside; a test its history (csv)
    or, of its last cycle, what all spheres and bonds do (vtk).
    """
    output = Path(output)
    if form not in FORMS:
        raise InputError(
            f"{source}: format {form!r} is not for spheres or tests; give one of {', '.join(FORMS)}."
        )
    kind = kind_of(source)
    if kind not in _WRITERS:
        raise InputError(f"{source}: holds {kind!r}; give a file with one of {', '.join(_WRITERS)}.")
    ending = SERIES if kind in (TEST, FALL, RAMP) and form == "vtk" else FORMS[form]
    if output.suffix.lower() != ending:
        raise InputError(f"{output}: a {kind} of format {form} ends in {ending}; rename the output.")
    return _WRITERS[kind](load(source, kind), form, output)


def _deposit(record: Record, form: str, output: Path) -> str:
    _spheres(record, form, output)
    return f"{output}: {counted(record.arrays['radius'].size, 'sphere')}, lengths in m."


def _specimen(record: Record, form: str, output: Path) -> str:
    """Its spheres, and in a file beside them its bonds."""
    _spheres(record, form, output)
    beside = output.with_name(f"{output.stem}{BONDS}{output.suffix}")
    arrays, n = record.arrays, record.arrays["radius"].size
    ends = np.column_stack([arrays["network/first"], arrays["network/second"]])
    own = {f"{name}": arrays[f"network/{key}"] for name, key in _OF_BONDS.items()}
    if form == "csv":
        write_table(beside, pd.DataFrame({"first": ends[:, 0], "second": ends[:, 1], **own}))
    else:
        place, lines, plate = _lines(arrays["position"], ends, arrays["network/point"])
        write_poly_data(beside, place, {}, lines, own | {"plate": plate})
    return f"{output}: {counted(n, 'sphere')}; {beside.name}: {counted(len(ends), 'bond')}; lengths in m, areas in m2."


def _lines(
    position: NDArray[np.float64], ends: NDArray[np.int64], point: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int8]]:
    """Places (p, 3) [m], lines between them (b, 2), and which lead to a plate (b,), of bonds that act at (b, 3)."""
    n = len(position)
    # A bond to a plate, body n or above, ends where it acts.
    place, plate = np.concatenate([position, point]), ends >= n
    used, lines = np.unique(np.where(plate, n + np.arange(len(ends))[:, None], ends), return_inverse=True)
    return place[used], lines.reshape(ends.shape), np.asarray(plate.any(axis=1), np.int8)


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
    if form == "vtk":
        return _series(record, output)
    write_table(output, history(record.arrays))
    return f"{output}: {counted(record.arrays['time_s'].size, 'step')} of time, displacement and force of the head."


def history(arrays: Mapping[str, NDArray[Any]]) -> pd.DataFrame:
    """What is there for each step of a test or a ramp: time_s, displacement_m, force_N of the head, then all others."""
    first = ["time_s", "displacement_m", "force_N"]
    more = sorted({name for name in arrays if "/" not in name and name != "broken"} - {*first})
    columns = {name: arrays[name] for name in (*first, *more)}
    return pd.DataFrame(
        {n: values for n, values in columns.items() if values.shape == arrays["time_s"].shape}
    )


def _series(record: Record, output: Path) -> str:
    """Write spheres and bonds at each instant that the test keeps, in files of a folder named as the series."""
    kept = _kept(record)
    if "strength_N" not in kept:
        raise InputError(
            f"{output}: the test holds no motion of spheres; simulate it again with --frames 24 (in Python "
            "Load(frames=24)), or give --format csv."
        )
    ends = np.column_stack([kept["first"], kept["second"]])
    place, lines, plate = _lines(kept["position_m"], ends, kept["point_m"])

    def instant(k: int) -> tuple[_Drawn, _Drawn]:
        own = {name: kept[name][k] for name in ("displacement_m", "velocity_m_s")}
        spheres = kept["position_m"], {"radius_m": kept["radius_m"], **own}
        return spheres, (place, {}, lines, _bond_loads(kept, k) | {"plate": plate})

    return f"{_filmed(output, kept, instant)}; displacements in m, forces in N."


def _fall(record: Record, form: str, output: Path) -> str:
    """As csv its account of energy over time; as vtk its spheres where they are, and the bonds that are left."""
    kept = _kept(record)
    if form == "csv":
        history = {name: values for name, values in record.arrays.items() if not name.startswith(FRAMES)}
        write_table(output, pd.DataFrame(history))
        return f"{output}: {counted(kept['time_s'].size, 'instant')}, energies in J."
    ends = np.column_stack([kept["first"], kept["second"]])

    def instant(k: int) -> tuple[_Drawn, _Drawn]:
        place, left = kept["position_m"] + kept["displacement_m"][k], ~kept["broken"][k]
        own = {name: kept[name][k] for name in ("velocity_m_s", "fragment")}
        bonds = {name: values[left] for name, values in _bond_loads(kept, k).items()}
        return (place, {"radius_m": kept["radius_m"], **own}), (place, {}, ends[left], bonds)

    return f"{_filmed(output, kept, instant)}; velocities in m/s, forces in N."


_Drawn = tuple[Any, ...]  # of `write_poly_data`, behind the path


def _kept(record: Record) -> dict[str, NDArray[Any]]:
    """What is kept of all spheres and bonds."""
    return {name.removeprefix(FRAMES): a for name, a in record.arrays.items() if name.startswith(FRAMES)}


def _bond_loads(kept: dict[str, NDArray[Any]], k: int) -> dict[str, NDArray[Any]]:
    """What bonds (b,) bear at an instant."""
    force = kept["bond_force_N"][k]
    return {
        "area_m2": kept["area_m2"],
        "tension_N": force[:, 0],
        "shear_N": np.hypot(force[:, 1], force[:, 2]),
        # 1 where a bond would break; 0 of bonds to the plates, which do not, and of broken ones
        "utilisation": utilisations(force * [-1.0, 1.0, 1.0], kept["strength_N"]),
    }


def _filmed(
    output: Path, kept: dict[str, NDArray[Any]], instant: Callable[[int], tuple[_Drawn, _Drawn]]
) -> str:
    """Write spheres and bonds of each instant, and the series; what was written, in words."""
    require_vtk()
    folder = output.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    steps = []
    for k, time in enumerate(kept["time_s"]):
        files = [folder / f"spheres-{k:03d}.vtp", folder / f"bonds-{k:03d}.vtp"]
        for file, drawn in zip(files, instant(k), strict=True):
            write_poly_data(file, *drawn)
        steps.append((float(time), files))
    write_series(output, steps)
    size = sum(file.stat().st_size for _, files in steps for file in files)
    return (
        f"{output}: {counted(len(steps), 'instant')} of {counted(len(kept['radius_m']), 'sphere')} and "
        f"{counted(len(kept['first']), 'bond')}, {size / 1e6:.3g} MB in {folder.name}/"
    )


_WRITERS: dict[str, Callable[[Record, str, Path], str]] = {
    DEPOSIT: _deposit,
    SPECIMEN: _specimen,
    TEST: _test,
    RAMP: _test,
    FALL: _fall,
}
