"""A packing of another program as a deposit: in metres, upright, on the floor of its box, its overlaps judged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import is_file
from asphalt_nscd.files.words import counted
from asphalt_nscd.packings.spheres import Spheres
from asphalt_nscd.packings.texts import read_text
from asphalt_nscd.packings.vtk_files import ENDINGS, read_points
from asphalt_nscd.specimen.contents import Content
from asphalt_nscd.specimen.given_spheres import NOTABLE, Overlaps, overlaps
from asphalt_nscd.specimen.preparation import layer_statistics

MOST = 0.1  # overlap over the smaller radius that is refused
DIGITS = 1e-4  # of the smallest radius: what positions must resolve
UP = ("x", "y", "z")


def read_packing(path: str | Path) -> Spheres:
    """Read spheres in the unit of the file: CSV, text of YADE, dump of LIGGGHTS or LAMMPS, or VTK."""
    path = Path(path)
    if path.is_dir():
        raise InputError(f"{path}: a folder; give the file that holds the spheres.")
    if not is_file(path):
        raise InputError(f"{path}: no such file; check the path.")
    if path.suffix.lower() in ENDINGS:
        return read_points(path)
    return read_text(path)


def deposit_content(spheres: Spheres, unit: str | None = None, up: str = "z") -> tuple[Content, list[str]]:
    """Arrays and attributes of a deposit file made of a packing, and sentences on what was read.

    The longer horizontal side becomes x, the length of the box; the box is as large as the spheres are. `unit` is that
    of lengths where the file does not say it; `up` is the axis against gravity.
    """
    if up not in UP:
        raise InputError(f"up {up!r} is no axis; give one of {', '.join(UP)}.")
    metric, said = spheres.convert_to_metres(unit)
    notes = [*spheres.notes, said]
    if metric.radius.size < 2:
        raise InputError(f"{spheres.path}: holds one sphere alone; give the whole packing.")
    _require_digits(metric)
    order = [axis for axis in range(3) if axis != UP.index(up)] + [UP.index(up)]
    position, radius = metric.position[:, order], metric.radius
    low, high = (position - radius[:, None]).min(axis=0), (position + radius[:, None]).max(axis=0)
    # 1e-9: rounding must not turn a square box
    if high[1] - low[1] > (high[0] - low[0]) * (1.0 + 1e-9):
        turn = [1, 0, 2]
        position, low, high = position[:, turn], low[turn], high[turn]
        order = [order[1], order[0], order[2]]
    if order != [0, 1, 2]:
        notes.append(f"axes {', '.join(UP[axis] for axis in order)} of the file became length, width, height")
    # contiguous, as the kernels are compiled for: a view of columns would have a kernel compiled anew
    position = np.ascontiguousarray(position - low)
    box = high - low
    # so far away, digits may have been lost when the file was written
    far = bool((np.abs(low) > 10.0 * box.max()).any())
    if far:
        places = ", ".join(f"{UP[axis]} {-low[k]:+.6g} m" for k, axis in enumerate(order))
        notes.append(f"the packing lies far from the origin; it was moved there: {places}")
    _require_whole(spheres.path, position, radius)
    found = overlaps(position, radius)
    _judge(spheres.path, found, notes, far)
    statistics = layer_statistics(position, radius, (box[0], box[1], box[2]), found.touching)
    notes.append(
        f"{counted(radius.size, 'sphere')}, radii {1e3 * radius.min():.3g} to {1e3 * radius.max():.3g} mm, in a box of "
        f"{1e3 * box[0]:.4g} x {1e3 * box[1]:.4g} x {1e3 * box[2]:.4g} mm, solid fraction "
        f"{statistics['solid_fraction']:.3f}"
    )
    arrays = {"position": position, "radius": np.ascontiguousarray(radius), "box": box}
    attributes = {
        "source": spheres.path.name,
        "spheres": radius.size,
        "highest_point_m": float(box[2]),
        **statistics,
        "largest_overlap_m": found.largest,
    }
    return (arrays, attributes), notes


def _require_digits(metric: Spheres) -> None:
    """InputError where positions are so large that their last digit is no small part of a radius."""
    largest = float(np.abs(metric.position).max())
    if np.spacing(largest) > DIGITS * metric.radius.min():
        raise InputError(
            f"{metric.path}: positions up to {largest:.3g} m leave no digits for radii of {metric.radius.min():.3g} m; "
            "move the packing to the origin before it is written."
        )


def _require_whole(path: Path, position: NDArray[np.float64], radius: NDArray[np.float64]) -> None:
    """InputError where an empty slab across the box, wider than any sphere, parts the spheres."""
    for axis, name in enumerate(("length", "width", "height")):
        low, high = position[:, axis] - radius, position[:, axis] + radius
        order = np.argsort(low)
        reached = np.maximum.accumulate(high[order])[:-1]  # by all spheres that begin earlier
        empty = low[order][1:] - reached
        k = int(empty.argmax())
        if empty[k] > 2.0 * radius.max():
            apart = counted(min(k + 1, radius.size - k - 1), "sphere")
            raise InputError(
                f"{path}: an empty gap of {1e3 * empty[k]:.4g} mm along the {name} parts {apart} from the others; "
                "remove what does not belong to the packing, or give a packing at rest."
            )


def _judge(path: Path, found: Overlaps, notes: list[str], far: bool) -> None:
    """Refuse overlaps beyond MOST of the smaller radius, and note those beyond NOTABLE."""
    one, other = found.pair
    if found.share > MOST:
        mend = "give a packing at rest of stiffer spheres, and no clumps"
        if far:
            mend = "positions so far from the origin may have been rounded: write them with more digits, or move them"
        raise InputError(
            f"{path}: spheres {one} and {other} overlap by {100.0 * found.share:.0f} % of the smaller radius, and "
            f"{counted(found.count, 'pair')} by more than {100.0 * NOTABLE:g} %; bonds need spheres apart: {mend}."
        )
    if found.count:
        pairs = "1 pair overlaps" if found.count == 1 else f"{found.count} pairs overlap"
        notes.append(
            f"{pairs} by more than {100.0 * NOTABLE:g} % of the smaller radius, spheres {one} and "
            f"{other} by {100.0 * found.share:.1f} %; trimming takes 3.5 % off the radii unless told otherwise"
        )
