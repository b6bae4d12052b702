"""|E*| over that of the law under the readings that the paper's words allow, and which of them its errors allow."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_table
from asphalt_nscd.files.store import load
from asphalt_nscd.specimen.cutting import read_specimen
from asphalt_nscd.specimen.prism import static_ratio
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen, trim
from studies.paper.other_bonds import crossing, farther_plates, ratio_without_moments, with_mean_radius

POISSON = 0.35  # of Eqs. (8)-(11)
PRINTED = 0.0056  # mean relative error of |E*| at -10 degC, Table 4: how near to one the authors' ratio was
PLATE = 0.010  # m, thickness assumed where l0 ends at the middle of a plate
OURS, AFTER = "as we read the paper", "dmin after the reduction of volume"
BARYCENTRES, MEAN_RADIUS = "forces at the barycentres, without moments", "mean radius of both spheres"


def make(
    deposits: Sequence[str | Path],
    specimens: Sequence[str | Path],
    tests: Sequence[str | Path],
    blocked: str | Path,
) -> pd.DataFrame:
    """One row for each reading and friction while pouring.

    deposits: of all samples, those with more friction behind; specimens: of the samples of the study, in the same
    order; tests: tables of tests in which our own reading is tested; blocked: a test of the first sample
    with a head that cannot turn. The other readings are static solutions. samples: how many the ratio
    E_over_law is the mean of. expected: the mean of all samples that a ratio of the first one stands for. possible:
    whether the authors' mean, of as many samples, could be one within the printed error and twice both standard errors.
    """
    layers = {Path(path).stem: load(path, "deposit") for path in deposits}
    said = load(specimens[0], "specimen").attributes
    reduction, gap = float(said["volume_reduction"]), float(said["gap_max_m"])
    shrunk = gap * (1.0 - reduction) ** (1.0 / 3.0)
    names = [Path(path).stem for path in specimens]
    loose = [name for name in layers if name not in names]
    first = read_specimen(specimens[0])
    tested = _tested(tests)
    known = tested.loc[names, "ratio"].to_numpy()

    def bonded(name: str, reach: float) -> Specimen:
        arrays = layers[name].arrays
        return trim(arrays["position"], arrays["radius"], first.geometry, reduction, reach)

    nearer = [bonded(name, shrunk) for name in names]
    crossed, crossed_nearer = (100.0 * crossing(one).mean() for one in (first, nearer[0]))
    whole, bonds = {"reach": gap, "crossed": crossed}, first.network.first.size
    rows = [_row(OURS, layers[names[0]], list(known), bonds, whole)]
    for name in loose:
        ratio, count = tested.loc[name, ["ratio", "bonds"]]
        rows.append(_row(OURS, layers[name], [ratio], count, {"reach": gap}))
    beside = {"reach": shrunk, "crossed": crossed_nearer}
    ratios = [_ratio(one) for one in nearer]
    rows.append(_row(AFTER, layers[names[0]], ratios, nearer[0].network.first.size, beside))
    for name in loose:
        one = bonded(name, shrunk)
        rows.append(_row(AFTER, layers[name], [_ratio(one)], one.network.first.size, {"reach": shrunk}))
    alone = {
        "l0 to the middle of plates of 10 mm": _ratio(farther_plates(first, PLATE / 2.0)),
        BARYCENTRES: ratio_without_moments(first, POISSON),
        MEAN_RADIUS: _ratio(with_mean_radius(first)),
        # An area goes with the square of rmin.
        "rmin before the reduction of volume": known[0] * (1.0 - reduction) ** (-2.0 / 3.0),
        "head that cannot turn": _of_test(blocked),
    }
    rows += [_row(reading, layers[names[0]], [ratio], bonds, whole) for reading, ratio in alone.items()]
    table = pd.DataFrame(rows)
    error = table["std_error"].iloc[0]
    of_all = table["E_over_law"] * known.mean() / known[0]
    table["expected"] = table["E_over_law"].where(table["samples"] > 1, of_all)
    # sqrt(2): the authors' mean of as many samples scatters as ours does.
    table["possible"] = (table["expected"] - 1.0).abs() <= PRINTED + 2.0 * np.sqrt(2.0) * error
    return table


def _tested(tables: Sequence[str | Path]) -> pd.DataFrame:
    """|E*| over that of the law (`ratio`) and bonds by sample, of tests with the paper's bonds in which none broke."""
    tests = pd.concat([pd.read_csv(path) for path in tables])
    if "mapping" in tests:
        tests = tests[tests["mapping"] != "facets"]
    whole = tests[tests["broken_bonds"] == 0]
    ratio = whole["E_MPa"] / whole["E_law_MPa"]
    return whole.assign(ratio=ratio).groupby("specimen")[["ratio", "bonds"]].mean()


def _row(reading: str, layer: Any, ratios: list[float], bonds: float, of: dict[str, float]) -> dict[str, Any]:
    several = len(ratios) > 1
    return {
        "reading": reading,
        "friction": layer.attributes["friction"],
        "solid_fraction": layer.attributes["solid_fraction"],
        "gap_max_mm": 1e3 * of["reach"],
        "bonds": int(bonds),
        "through_third_sphere_percent": of.get("crossed", np.nan),
        "samples": len(ratios),
        "E_over_law": float(np.mean(ratios)),
        "std_error": float(np.std(ratios, ddof=1) / np.sqrt(len(ratios))) if several else np.nan,
    }


def _ratio(specimen: Specimen) -> float:
    return static_ratio(bending_system(specimen, POISSON, np.inf, 0.0), specimen.geometry)


def _of_test(path: str | Path) -> float:
    test = load(path, "test").attributes
    return float(test["E_MPa"] / test["E_law_MPa"])


if __name__ == "__main__":
    run_table(globals()["snakemake"], make)
