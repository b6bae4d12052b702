"""Spheres that were made elsewhere: whether they are spheres at all, and how deep they overlap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.spheres.neighbours import find_pairs

NOTABLE = 0.01  # of the smaller radius: an overlap that is said
FURTHEST = 1e6  # m
TOUCHING = 1e-6  # m, gap below which two spheres count as touching


def require_spheres(
    name: object, position: np.ndarray, radius: np.ndarray, furthest: float = FURTHEST
) -> None:
    """InputError unless `position` is (n, 3), `radius` (n,), all finite and all radii above zero.

    Compiled code looks at no bounds: a radius below zero would have it write outside of its arrays.
    """
    if np.ma.isMaskedArray(position) or np.ma.isMaskedArray(radius):
        raise InputError(f"{name}: holds masked arrays; give plain ones, without what is masked.")
    position, radius = np.asarray(position), np.asarray(radius)
    if (
        position.shape != (radius.size, 3)
        or radius.ndim != 1
        or {position.dtype.kind, radius.dtype.kind} - set("fiu")
    ):
        raise InputError(
            f"{name}: positions {position.shape} and radii {radius.shape}; give numbers x, y, z for each sphere, and "
            "one radius."
        )
    if not radius.size:
        raise InputError(f"{name}: holds no sphere; give at least one.")
    for bad, problem in (
        (~np.isfinite(np.column_stack([position, radius])).all(axis=1), "is not finite"),
        (radius <= 0.0, "has a radius of zero or less"),
        (
            np.abs(np.column_stack([position, radius])).max(axis=1) > furthest,
            "is more than 1000 km away or wide",
        ),
    ):
        if bad.any():
            raise InputError(f"{name}: sphere {int(bad.argmax()) + 1} {problem}; correct or remove it.")


@dataclass(frozen=True)
class Overlaps:
    """What touches and overlaps among spheres.

    `touching` (p, 2) holds pairs of spheres; `largest` is the largest overlap [m]; `share` is the largest one over the
    smaller radius, `pair` its two spheres, counted from 1; `count` pairs overlap by more than NOTABLE.
    """

    touching: np.ndarray
    largest: float
    pair: tuple[int, int]
    share: float
    count: int


def overlaps(position: np.ndarray, radius: np.ndarray) -> Overlaps:
    """Find what touches and overlaps among spheres; `position` (n, 3) and `radius` (n,) in m."""
    none = np.empty((0, 3))
    start, other = find_pairs(position, radius, none, none, TOUCHING)
    first = np.repeat(np.arange(radius.size), np.diff(start))
    gap = np.linalg.norm(position[other] - position[first], axis=1) - radius[first] - radius[other]
    touching = np.column_stack([first, other])[gap < TOUCHING]
    if not gap.size or gap.min() >= 0.0:
        return Overlaps(touching, 0.0, (0, 0), 0.0, 0)
    share = -gap / np.minimum(radius[first], radius[other])
    worst = int(share.argmax())
    # spheres are counted from one, as one counts the lines of a file
    return Overlaps(
        touching,
        float(-gap.min()),
        (int(first[worst]) + 1, int(other[worst]) + 1),
        float(share[worst]),
        int((share > NOTABLE).sum()),
    )
