"""Spheres in text: tables with a header, YADE's `export.text`, dumps of LIGGGHTS and LAMMPS."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.packings.spheres import UNITS, Spheres

RADIUS = {"radius": 1.0, "r": 1.0, "rad": 1.0, "radii": 1.0, "diameter": 0.5, "d": 0.5}
AXES = ("x", "y", "z")
UNWRAPPED = {"xu": "x", "yu": "y", "zu": "z"}
SAME_SIZE = 0.01  # of a radius, by which two columns of sizes may differ
_UNITS = "|".join(UNITS)


def read_text(path: Path) -> Spheres:
    """Read spheres of a text file, in its unit, whichever of the known forms it has."""
    try:
        text = path.read_text(encoding="utf-8-sig")  # spreadsheets begin with a byte order mark
    except UnicodeDecodeError:
        mend = "give a deposit of this program to `asphalt-nscd trim` itself"
        if not path.read_bytes().startswith(b"\x89HDF"):
            mend = "give CSV, a dump, YADE's text or VTK"
        raise InputError(f"{path}: neither text nor VTK; {mend}.") from None
    if not text.strip():
        raise InputError(f"{path}: the file is empty; give one line for each sphere.")
    if text.lstrip()[0] in "{[<":
        raise InputError(
            f"{path}: no table of spheres, but JSON or XML; give CSV, a dump, YADE's text or VTK."
        )
    if text.startswith("ITEM:"):
        return _dump(path, text)
    return _table(path, text)


def _dump(path: Path, text: str) -> Spheres:
    """The last snapshot of a LIGGGHTS or LAMMPS dump."""
    # snapshots before the last one show grains on their way
    start = text.rindex("ITEM: TIMESTEP") if "ITEM: TIMESTEP" in text else 0
    snapshots = text.count("ITEM: TIMESTEP")
    parts = re.split(r"^ITEM: ", text[start:], flags=re.MULTILINE)[1:]
    items = {part.partition("\n")[0]: part.partition("\n")[2] for part in parts}
    head = next((name for name in items if name.startswith("ATOMS")), None)
    if head is None:
        raise InputError(
            f"{path}: a dump without ITEM: ATOMS; was the run interrupted? Write the dump again."
        )
    rows = items[head].split("\n")
    stated = items.get("NUMBER OF ATOMS", "").strip()
    found = sum(bool(row.strip()) for row in rows)
    if stated not in ("", str(found)):
        raise InputError(
            f"{path}: the last snapshot holds {found} of {stated} atoms; was the run interrupted? Write it again."
        )
    names = [UNWRAPPED.get(name, name) for name in head.split()[1:]]
    if "xs" in names and "x" not in names:
        raise InputError(f"{path}: scaled coordinates xs ys zs; dump x y z radius instead.")
    step = items.get("TIMESTEP", "?").strip()
    notes = [f"dump of LIGGGHTS or LAMMPS, step {step}"]
    if snapshots > 1:
        notes[0] += f", the last of {snapshots} snapshots"
    return _spheres(path, _frame(path, items[head], names), notes)


def _table(path: Path, text: str) -> Spheres:
    """A table with a header, or YADE's, whose header is a comment `#format x_y_z_r`."""
    yade = re.search(r"^#\s*format\s+(\S+)", text, re.MULTILINE)
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise InputError(f"{path}: holds no spheres; give one line for each sphere.")
    if yade:
        return _spheres(path, _frame(path, "\n".join(lines), yade[1].split("_")), ["text of YADE"])
    names = re.split(r"[,;\t]\s*" if re.search("[,;\t]", lines[0]) else r"\s+", lines[0].strip())
    if all(_is_number(name) for name in names):
        if len(names) == 4:
            return _spheres(
                path, _frame(path, "\n".join(lines), [*AXES, "radius"]), ["no header: taken as x y z radius"]
            )
        raise InputError(f"{path}: {len(names)} columns without a header; name them x, y, z, radius.")
    if len(lines) == 1:
        raise InputError(f"{path}: a header without spheres; give one line for each sphere.")
    return _spheres(path, _frame(path, "\n".join(lines[1:]), names), [])


def _frame(path: Path, rows: str, names: list[str]) -> pd.DataFrame:
    """Table of rows of text, with `names` for its columns."""
    separator = r"[,;\t]\s*" if re.search("[,;\t]", rows) else r"\s+"
    if ";" in rows and "," in rows:
        raise InputError(f"{path}: decimals are written with a comma; write them with a point.")
    try:
        # a separator that is a regular expression needs the engine in Python
        frame = pd.read_csv(
            io.StringIO(rows), sep=separator, header=None, engine="python", skipinitialspace=True
        )
    except (ValueError, pd.errors.ParserError) as error:
        raise InputError(
            f"{path}: not a table of numbers ({error}); give one line for each sphere."
        ) from None
    if frame.shape[1] > len(names) and frame.iloc[:, len(names) :].isna().all(axis=None):
        frame = frame.iloc[:, : len(names)]  # a separator at the end of lines
    if frame.shape[1] != len(names):
        raise InputError(f"{path}: {frame.shape[1]} fields under {len(names)} names; give one for each.")
    return frame.set_axis([name.strip().strip('"') for name in names], axis=1)


def _spheres(path: Path, frame: pd.DataFrame, notes: list[str]) -> Spheres:
    """Spheres from the columns that are understood, all in one unit."""
    columns: dict[str, tuple[str, str | None]] = {}
    for name in frame:
        quantity, unit = _understood(str(name))
        if quantity in (*AXES, *RADIUS):
            if quantity in columns:
                raise InputError(
                    f"{path}: columns {columns[quantity][0]!r} and {name!r} say the same; keep one."
                )
            columns[quantity] = str(name), unit
    sizes = [quantity for quantity in RADIUS if quantity in columns]
    missing = [axis for axis in AXES if axis not in columns] + ([] if sizes else ["radius"])
    if missing:
        raise InputError(
            f"{path}: no column for {' and '.join(missing)} (found: {', '.join(map(str, frame))}); name columns "
            "x, y, z, radius, with their unit behind, as in x_mm."
        )
    wanted = [*AXES, sizes[0]]
    units = {columns[quantity][1] for quantity in wanted}
    if len(units) > 1:
        named = ", ".join(columns[quantity][0] for quantity in wanted)
        raise InputError(f"{path}: columns {named} have different units; give all in one.")
    values = [_numbers(path, frame, columns[quantity][0]) for quantity in wanted]
    for other in sizes[1:]:
        name, unit = columns[other]
        apart = RADIUS[other] * _numbers(path, frame, name) - RADIUS[sizes[0]] * values[3]
        # a file may write one of both with few digits
        if unit == columns[sizes[0]][1] and (np.abs(apart) > SAME_SIZE * RADIUS[sizes[0]] * values[3]).any():
            raise InputError(
                f"{path}: columns {columns[sizes[0]][0]!r} and {name!r} give different sizes; keep the right one."
            )
    return Spheres(path, np.column_stack(values[:3]), RADIUS[sizes[0]] * values[3], units.pop(), notes)


def _numbers(path: Path, frame: pd.DataFrame, name: str) -> np.ndarray:
    """A column of numbers (n,); InputError for the first sphere that has none."""
    numbers = pd.to_numeric(frame[name], errors="coerce").to_numpy(float)
    bad = np.flatnonzero(np.isnan(numbers))
    if bad.size:
        found = frame[name].iloc[int(bad[0])]
        raise InputError(f"{path}: sphere {bad[0] + 1}: {name} = {str(found)!r} is not a number; correct it.")
    return numbers


def _understood(name: str) -> tuple[str, str | None]:
    """Quantity and unit of `x_mm`, `X [m]`, `radius (mm)`, `Points:0`."""
    points = re.fullmatch(r"Points[:_]([012])", name)
    if points:
        return AXES[int(points[1])], None
    match = re.fullmatch(rf"\s*([A-Za-z]+?)\s*(?:[_ ]?[(\[]?({_UNITS})[)\]]?)?\s*", name)
    if match and match[1].lower() in (*AXES, *RADIUS):
        return match[1].lower(), match[2]
    return name, None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
