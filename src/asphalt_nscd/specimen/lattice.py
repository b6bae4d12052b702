"""The random lattice from which the spheres are poured."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.files.errors import InputError


def random_lattice(
    diameters: np.ndarray, counts: np.ndarray, box: tuple[float, float, float], rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 3) and radii (n,) [m] of spheres strewn over a cubic lattice, ordered by height.

    `diameters` (c,) and `box` (length, width, height) in m; `counts` (c,) are the spheres of each diameter. The lattice
    constant is the largest diameter of a sphere, widened to fit the box. The paper's 14 160 spheres outnumber its at
    most 8 000 cells, so a cell holds either one sphere or up to eight of those that fit into its octants.
    """
    # a seed gives the same packing, in whatever order the sizes come
    by_size = np.argsort(diameters, kind="stable")
    diameters, counts = np.asarray(diameters, float)[by_size], np.asarray(counts, int)[by_size]
    # a size of which there is no sphere takes no room
    diameters, counts = diameters[counts > 0], counts[counts > 0]
    size = np.asarray(box, float)
    # a box as wide as a whole number of grains has room for them, however the quotient rounds
    shape = np.floor(size / diameters.max() + 1e-9).astype(int)
    if (shape < 1).any():
        raise InputError(
            f"box of {box} m: smaller than the largest sphere of {diameters.max()} m; enlarge the box."
        )
    cell = size / shape
    shares = 2.0 * diameters <= cell.min()
    radii = np.repeat(diameters / 2.0, counts)
    sharing = np.repeat(shares, counts)
    order = rng.permutation(radii.size)
    alone = order[~sharing[order]]
    grouped = order[sharing[order]]
    cells = rng.permutation(int(shape.prod()))
    room = cells.size - alone.size
    if room < 0 or grouped.size > 8 * room:
        raise InputError(
            f"box of {box} m: its {cells.size} lattice cells cannot hold {radii.size} spheres; "
            "enlarge the box or lower the counts."
        )
    position = np.empty((radii.size, 3))
    position[alone] = _place(cells[: alone.size], shape, cell, radii[alone], 1, np.zeros(3), rng)
    if grouped.size:
        # deal the sharing spheres evenly over the remaining cells, each in an octant of its own
        home = cells[alone.size :][np.arange(grouped.size) % room]
        octants = rng.permuted(np.tile(np.arange(8), (room, 1)), axis=1)
        octant = octants[np.arange(grouped.size) % room, np.arange(grouped.size) // room]
        corner = np.stack([octant % 2, octant // 2 % 2, octant // 4], axis=1)
        position[grouped] = _place(home, shape, cell, radii[grouped], 2, corner, rng)
    # the rain is searched from the ground up (`GranularBed.let_fall`)
    by_height = np.argsort(position[:, 2], kind="stable")
    return position[by_height], radii[by_height]


def _place(
    cells: np.ndarray,
    shape: np.ndarray,
    cell: np.ndarray,
    radii: np.ndarray,
    parts: int,
    corner: np.ndarray,
    rng: np.random.Generator,
) -> np.ndarray:
    """Random centres (m, 3) [m] in cells cut into parts^3 boxes, each sphere in the box `corner` of its cell."""
    index = np.stack([cells % shape[0], cells // shape[0] % shape[1], cells // (shape[0] * shape[1])], axis=1)
    part = cell / parts
    slack = part - 2.0 * radii[:, None]
    low = index * cell + corner * part
    return low + radii[:, None] + slack * rng.random((radii.size, 3))
