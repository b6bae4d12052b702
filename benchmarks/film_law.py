"""The law of a film against elasticity: two spheres by finite elements, many by FFT.

    python benchmarks/film_law.py cells --rows CELL.csv... --output CELLS.csv
    python benchmarks/film_law.py pairs --output PAIRS.csv
    python benchmarks/film_law.py shears --output SHEARS.csv
    python benchmarks/film_law.py summary CELLS.csv --output CELLS_SUMMARY.csv

Moduli over Young's modulus of the grains, lengths over the edge of a cell or the radius of the larger sphere. `pairs`
and `shears` need scikit-fem and gmsh: pip install "asphalt-nscd[film]".
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from itertools import product

import numpy as np
import pandas as pd
from film_cells import GRAIN, LOADS, MODULI, poisson, shrunk
from film_packings import MANDEL, isotropic, network

from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.film import (
    Films,
    Matrix,
    Solid,
    bulk_modulus,
    deviatoric_stiffness,
    film_stiffness,
    pair_stiffness,
)

RATIOS, GAPS, SIDE = [1.0, 0.3, 0.1], [0.3, 0.1, 0.03, 0.01, 0.003], 0.9
RIGID = 1e-7  # M over Young's modulus of grains that do not yield
FREE_SIDES = 0.2  # of Young's modulus of a film between rigid grains that its sides do not lower


def matrix(modulus: float) -> Matrix:
    return Matrix(np.array(modulus), Solid(modulus, poisson(modulus)).bulk)


def cells(paths: Sequence[str]) -> pd.DataFrame:
    """The network of films beside each cell of voxels: shear modulus of the two strains, Young's modulus."""
    voxels = pd.concat([pd.read_csv(path) for path in paths], ignore_index=True)
    rows = []
    for (path, fraction), same in voxels.groupby(["packing", "fraction"], sort=False):
        bonds = network(*shrunk(pd.read_csv(path), fraction))
        for modulus in MODULI:
            solid = matrix(modulus)
            pairs = bonds.stiffness(*deviatoric_stiffness(bonds.films, GRAIN, solid))
            bulk, shear = isotropic(bonds.stiffness(*film_stiffness(bonds.films, GRAIN, solid, fraction)))
            young = 9.0 * bulk * shear / (3.0 * bulk + shear)
            for count, found in same[same["M_over_Ea"] == modulus].groupby("voxels"):
                energy = found.set_index("load")["stiffness"]
                strains = [np.einsum("kij,ij->k", MANDEL, LOADS[load]) for load in ("shear", "stretch")]
                by_pairs = np.mean([strain @ pairs @ strain for strain in strains])
                by_voxels = energy[["shear", "stretch"]].mean()
                # of all directions, as far from these two strains as in the network
                around = by_voxels * isotropic(pairs)[1] / by_pairs
                expected = 9.0 * energy["volume"] * around / (3.0 * energy["volume"] + around)
                gap = bonds.films.gap.min() * count
                low, high = bounds(GRAIN, solid, fraction)
                rows.append(
                    (len(pd.read_csv(path)), fraction, modulus, count, gap, by_voxels / solid.shear)
                    + (by_pairs / by_voxels - 1.0, expected / modulus, young / expected - 1.0)
                    + (low / modulus, young / modulus, high / modulus)
                    + (float(bulk_modulus(GRAIN, solid, fraction)) / energy["volume"] - 1.0,)
                )
    columns = [
        "spheres", "fraction", "M_over_Ea", "voxels", "voxels_in_least_gap", "G_voxels_over_matrix", "G_error",
        "E_voxels_over_M", "E_error", "E_lower_bound_over_M", "E_network_over_M", "E_upper_bound_over_M", "K_error",
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def bounds(grain: Solid, solid: Matrix, fraction: float) -> tuple[float, float]:
    """Young's modulus by Hashin & Shtrikman (1963), lower and upper."""
    found = []
    for (k1, g1, f1), (k2, g2, f2) in (
        ((float(solid.bulk), float(solid.shear), 1.0 - fraction), (grain.bulk, grain.shear, fraction)),
        ((grain.bulk, grain.shear, fraction), (float(solid.bulk), float(solid.shear), 1.0 - fraction)),
    ):
        bulk = k1 + f2 / (1.0 / (k2 - k1) + 3.0 * f1 / (3.0 * k1 + 4.0 * g1))
        shear = g1 + f2 / (1.0 / (g2 - g1) + 6.0 * f1 * (k1 + 2.0 * g1) / (5.0 * g1 * (3.0 * k1 + 4.0 * g1)))
        found.append(9.0 * bulk * shear / (3.0 * bulk + shear))
    return found[0], found[1]


def pairs() -> pd.DataFrame:
    """Two spheres in a cylinder of free sides: the law with Young's moduli along its lines, by finite elements."""
    from film_pair import Pair, normal_stiffness

    rows = []
    for ratio, gap, modulus in product(RATIOS, GAPS, [*MODULI, 1e-5]):
        pair = Pair(1.0, ratio, gap * ratio, SIDE * ratio)
        area, solid = np.pi * pair.side**2, matrix(modulus)
        films = Films(*np.array([[pair.first], [pair.second], [pair.gap], [area]]))
        soft = solid.modulus * (1.0 - FREE_SIDES * (1.0 - solid.shear / GRAIN.shear))
        law = pair_stiffness(films, GRAIN, solid, (soft, GRAIN.modulus))[0][0]
        phases = (GRAIN.shear, GRAIN.bulk), (float(solid.shear), float(solid.bulk))
        coarse, fine = (normal_stiffness(pair, *phases, fineness) for fineness in (2.0, 3.5))
        unit = modulus * area / pair.length
        rows.append((ratio, gap, modulus, fine / unit, coarse / fine - 1.0, law / unit, law / fine - 1.0))
        print(*rows[-1], flush=True)
    columns = [
        "ratio",
        "gap_over_smaller_radius",
        "M_over_Ea",
        "FE_over_MA_l",
        "FE_coarser",
        "law_over_MA_l",
        "error",
    ]
    return pd.DataFrame(rows, columns=columns)


def shears() -> pd.DataFrame:
    """Spheres that slide and do not turn: rigid pairs in a cylinder of free sides, and a cubic lattice of equal ones.

    Between free sides neighbours do not incline the film: the law without that part. The cell of the lattice is a
    cylinder of the section of its facet, whose side moves as the lattice does.
    """
    from film_pair import Pair, shear_stiffness

    tests = [(ratio, gap, RIGID, False) for ratio, gap in product(RATIOS, GAPS)]
    tests += [(1.0, gap, modulus, True) for modulus, gap in product([*MODULI, 1e-5], GAPS)]
    rows = []
    for ratio, gap, modulus, lattice in tests:
        length = 1.0 + ratio + gap * ratio
        pair = Pair(1.0, ratio, gap * ratio, length / np.sqrt(np.pi) if lattice else SIDE * ratio)
        area, solid = np.pi * pair.side**2, matrix(modulus)
        shear = float(solid.shear)
        films = Films(*np.array([[pair.first], [pair.second], [pair.gap], [area]]))
        unit = (2.0 if lattice else 1.0) * shear * area / length
        law = deviatoric_stiffness(films, GRAIN, solid)[1][0] - (0.0 if lattice else shear * area / length)
        phases = (GRAIN.shear, GRAIN.bulk), (shear, float(solid.bulk))
        coarse, fine = (shear_stiffness(pair, *phases, fineness, lattice) for fineness in (2.0, 3.5))
        test = "lattice" if lattice else "free sides"
        rows.append(
            (test, ratio, gap, modulus, fine / unit, coarse / fine - 1.0, law / unit, law / fine - 1.0)
        )
        print(*rows[-1], flush=True)
    columns = [
        "test", "ratio", "gap_over_smaller_radius", "M_over_Ea", "FE_over_one_material", "FE_coarser",
        "law_over_one_material", "error",
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def cells_summary(table: pd.DataFrame) -> pd.DataFrame:
    """Errors of the finest cell of each packing and fraction, percent."""
    finest = table.sort_values("voxels", kind="stable").drop_duplicates(
        ["spheres", "fraction", "M_over_Ea"], keep="last"
    )
    found = finest.sort_index()[["spheres", "fraction", "M_over_Ea"]].rename(columns={"M_over_Ea": "M / Ea"})
    return found.assign(**{f"{name}, %": (100.0 * finest[f"{name}_error"]).round(1) for name in "EG"})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parts = parser.add_subparsers(dest="part", required=True)
    part = parts.add_parser("cells")
    part.add_argument("--rows", nargs="+", required=True)
    parts.add_parser("pairs")
    parts.add_parser("shears")
    parts.add_parser("summary").add_argument("table")
    for part in parts.choices.values():
        part.add_argument("--output", required=True)
    given = parser.parse_args()
    if given.part == "cells":
        write_table(given.output, cells(given.rows))
    elif given.part == "summary":
        write_table(given.output, cells_summary(pd.read_csv(given.table)))
    else:
        write_table(given.output, pairs() if given.part == "pairs" else shears())


if __name__ == "__main__":
    main()
