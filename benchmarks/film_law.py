"""The law of a film against elasticity: two spheres by finite elements, many by FFT.

    python benchmarks/film_law.py cells --rows CELL.csv... --output CELLS.csv
    python benchmarks/film_law.py pairs --output PAIRS.csv
    python benchmarks/film_law.py shears --output SHEARS.csv
    python benchmarks/film_law.py summaries PAIRS.csv SHEARS.csv CELLS.csv --output PAIRS_SUMMARY.csv \
        SHEARS_SUMMARY.csv CELLS_SUMMARY.csv

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


def shears_summary(table: pd.DataFrame) -> pd.DataFrame:
    """Errors, percent: a row for each ratio of radii between free sides and each modulus of the lattice."""
    rows = []
    for (test, ratio, modulus), same in table.groupby(["test", "ratio", "M_over_Ea"], sort=False):
        errors = (100.0 * same.set_index("gap_over_smaller_radius")["error"]).round(1)
        named = {"test": test, "R2 / R1": ratio, "M / Ea": modulus}
        rows.append(named | {f"gap {gap:g}": value for gap, value in errors.items()})
    return pd.DataFrame(rows)


def pairs_summary(table: pd.DataFrame) -> pd.DataFrame:
    """Largest errors over all ratios of radii, percent."""
    rows = []
    for modulus, same in table.groupby("M_over_Ea", sort=False):
        by = 100.0 * same.groupby("gap_over_smaller_radius", sort=False)["error"].agg(
            lambda error: error.loc[error.abs().idxmax()]
        )
        rows.append({"M / Ea": modulus} | {f"gap {gap:g}": value for gap, value in by.round(1).items()})
    return pd.DataFrame(rows)


def cells_summary(table: pd.DataFrame) -> pd.DataFrame:
    """The finest cell of each packing and fraction; how much the coarser one differs, percent."""
    rows = []
    for (spheres, fraction, modulus), same in table.groupby(["spheres", "fraction", "M_over_Ea"], sort=False):
        fine, coarse = same.sort_values("voxels").iloc[-1], same.sort_values("voxels").iloc[0]
        change = coarse["E_voxels_over_M"] / fine["E_voxels_over_M"] - 1.0 if len(same) > 1 else np.nan
        rows.append(
            {
                "spheres": spheres,
                "fraction": fraction,
                "M / Ea": modulus,
                "lower": fine["E_lower_bound_over_M"],
                "voxels": fine["E_voxels_over_M"],
                "network": fine["E_network_over_M"],
                "E, %": 100.0 * fine["E_error"],
                "G, %": 100.0 * fine["G_error"],
                "coarser, %": 100.0 * change,
                "film": round(fine["voxels_in_least_gap"], 1),
            }
        )
    return pd.DataFrame(rows).round({"E, %": 1, "G, %": 1, "coarser, %": 1})


SUMMARIES = {"pairs": pairs_summary, "shears": shears_summary, "cells": cells_summary}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parts = parser.add_subparsers(dest="part", required=True)
    part = parts.add_parser("cells")
    part.add_argument("--rows", nargs="+", required=True)
    parts.add_parser("pairs")
    parts.add_parser("shears")
    part = parts.add_parser("summaries")
    for table in SUMMARIES:
        part.add_argument(table)
    for name, part in parts.choices.items():
        part.add_argument("--output", required=True, nargs=len(SUMMARIES) if name == "summaries" else None)
    given = parser.parse_args()
    if given.part == "cells":
        write_table(given.output, cells(given.rows))
    elif given.part == "summaries":
        for (table, summary), output in zip(SUMMARIES.items(), given.output, strict=True):
            write_table(output, summary(pd.read_csv(getattr(given, table))))
    else:
        write_table(given.output, pairs() if given.part == "pairs" else shears())


if __name__ == "__main__":
    main()
