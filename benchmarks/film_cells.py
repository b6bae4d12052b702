"""Periodic cells of many spheres, solved in voxels: what the network of films is held against (film_law.py).

    python benchmarks/film_cells.py packing PACKING --output SPHERES.csv
    python benchmarks/film_cells.py cell SPHERES.csv FRACTION VOXELS --output CELL.csv

Moduli over Young's modulus of the grains, lengths over the edge of a cell.
"""

from __future__ import annotations

import argparse

import numpy as np
import pandas as pd
from film_packings import jammed
from film_voxels import VoxelCell

from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.film import Solid

PACKINGS = {"two": (32, 2.0, 1), "four": (48, 4.0, 3)}  # spheres, largest radius over smallest, seed
GRAIN = Solid(1.0, 0.2)
BITUMEN = 2.5 / 60.0  # bulk modulus over Young's modulus of the grains
MODULI = [0.2, 0.05, 1e-2, 1e-3, 1e-4]
LOADS = {
    "shear": np.array([[0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0]]),
    "stretch": np.diag([0.5, -0.5, 0.0]),
    "volume": np.eye(3) / 3.0,
}
TOLERANCE = 2e-3


def poisson(modulus: float) -> float:
    """Of the matrix: that of bitumen, 0.3 where its bulk modulus would make it less."""
    return max(0.5 - modulus / (6.0 * BITUMEN), 0.3)


def packing(name: str) -> pd.DataFrame:
    """Spheres that just touch."""
    position, radius = jammed(*PACKINGS[name])
    return pd.DataFrame(np.column_stack([position, radius]), columns=["x", "y", "z", "radius"])


def shrunk(spheres: pd.DataFrame, fraction: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions and radii of the spheres at a volume fraction."""
    radius = spheres["radius"].to_numpy()
    return spheres[["x", "y", "z"]].to_numpy(), radius * (
        fraction / (4.0 / 3.0 * np.pi * (radius**3).sum())
    ) ** (1.0 / 3.0)


def cell(path: str, fraction: float, voxels: int) -> pd.DataFrame:
    """Stiffness of the cell for each mean strain and modulus, in voxels."""
    position, radius = shrunk(pd.read_csv(path), fraction)
    solved, rows = VoxelCell(position, radius, voxels), []
    for load, strain in LOADS.items():
        start = None
        for modulus in MODULI:
            found, start, steps = solved.solve(
                GRAIN, Solid(modulus, poisson(modulus)), strain, TOLERANCE, start
            )
            rows.append((path, fraction, voxels, solved.fraction, load, modulus, found, steps))
            print(*rows[-1], flush=True)
    columns = ["packing", "fraction", "voxels", "voxel_fraction", "load", "M_over_Ea", "stiffness", "steps"]
    return pd.DataFrame(rows, columns=columns)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parts = parser.add_subparsers(dest="part", required=True)
    parts.add_parser("packing").add_argument("name", choices=PACKINGS)
    part = parts.add_parser("cell")
    part.add_argument("spheres")
    part.add_argument("fraction", type=float)
    part.add_argument("voxels", type=int)
    for part in parts.choices.values():
        part.add_argument("--output", required=True)
    given = parser.parse_args()
    if given.part == "packing":
        write_table(given.output, packing(given.name))
    else:
        write_table(given.output, cell(given.spheres, given.fraction, given.voxels))


if __name__ == "__main__":
    main()
