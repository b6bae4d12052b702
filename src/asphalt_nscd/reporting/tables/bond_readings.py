"""|E*| over that of the law under the readings that the paper's words allow, and which of them its errors allow."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.tables import the_only
from asphalt_nscd.specimen.bond_readings import (
    crossing,
    farther_plates,
    ratio_without_moments,
    with_mean_radius,
)
from asphalt_nscd.specimen.preparation import read_specimen
from asphalt_nscd.specimen.prism import static_ratio
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen, trim

POISSON = 0.35  # of Eqs. (8)-(11)
PRINTED = 0.0056  # mean relative error of |E*| at -10 degC, Table 4: how near to one the authors' ratio was
PLATE = 0.010  # m, thickness assumed where l0 ends at the middle of a plate
OURS, AFTER = "as we read the paper", "dmin after the reduction of volume"
BARYCENTRES, MEAN_RADIUS = "forces at the barycentres, without moments", "mean radius of both spheres"


def make(deposits: list[Path], specimens: list[Path], loose: list[Path], blocked: list[Path]) -> pd.DataFrame:
    """One row for each reading and friction while pouring; static solutions.

    deposits, specimens: of the samples of the study, in one order; loose: deposits with more friction, of the first
    seed; blocked: tests of the first sample with a head that cannot turn. samples: how many the ratio E_over_law is
    the mean of. expected: the mean of all samples that a ratio of the first one stands for. possible: whether the
    authors' mean, of as many samples, could be one within the printed error and twice both standard errors.
    """
    names = [path.stem for path in deposits]
    cut = {path.stem: read_specimen(path) for path in specimens}
    said = load(specimens[0], "specimen").attributes
    reduction, gap = float(said["volume_reduction"]), float(said["gap_max_m"])
    shrunk = gap * (1.0 - reduction) ** (1.0 / 3.0)
    first = cut[names[0]]
    layers = {path.stem: load(path, "deposit") for path in [*deposits, *loose]}

    def bonded(name: str, reach: float) -> Specimen:
        if name in cut and reach == gap:
            return cut[name]
        arrays = layers[name].arrays
        return trim(arrays["position"], arrays["radius"], first.geometry, reduction, reach)

    def rows() -> Iterator[dict[str, Any]]:
        for reading, reach in ((OURS, gap), (AFTER, shrunk)):
            made = [bonded(name, reach) for name in names]
            yield _row(reading, reach, made[0], [_ratio(one) for one in made], layers[names[0]])
            for path in loose:
                one = bonded(path.stem, reach)
                yield _row(reading, reach, one, [_ratio(one)], layers[path.stem])
            if reach == shrunk:
                far = _ratio(farther_plates(made[0], PLATE / 2.0))
                yield _row(f"{AFTER}, l0 to the middle of plates", reach, made[0], [far], layers[names[0]])
        alone = {
            BARYCENTRES: ratio_without_moments(first, POISSON),
            MEAN_RADIUS: _ratio(with_mean_radius(first)),
            "rmin before the reduction of volume": _ratio(first) * (1.0 - reduction) ** (-2.0 / 3.0),
            "head that cannot turn": _of_test(the_only(blocked, "blocked")),
        }
        for reading, ratio in alone.items():
            yield _row(reading, gap, first, [ratio], layers[names[0]])

    table = pd.DataFrame(rows())
    ours = table.iloc[0]
    error = ours["std_error"]
    of_first = ours["E_over_law"] / _ratio(first)
    table["expected"] = table["E_over_law"].where(table["samples"] > 1, table["E_over_law"] * of_first)
    table["possible"] = (table["expected"] - 1.0).abs() <= PRINTED + 2.0 * np.sqrt(2.0) * error
    return table


def _row(reading: str, reach: float, specimen: Specimen, ratios: list[float], layer: Any) -> dict[str, Any]:
    several = len(ratios) > 1
    return {
        "reading": reading,
        "friction": layer.attributes["friction"],
        "solid_fraction": layer.attributes["solid_fraction"],
        "gap_max_mm": 1e3 * reach,
        "bonds": specimen.network.first.size,
        "through_third_sphere_percent": 100.0 * crossing(specimen).mean(),
        "samples": len(ratios),
        "E_over_law": float(np.mean(ratios)),
        "std_error": float(np.std(ratios, ddof=1) / np.sqrt(len(ratios))) if several else np.nan,
    }


def _ratio(specimen: Specimen) -> float:
    return static_ratio(bending_system(specimen, POISSON, np.inf, 0.0), specimen.geometry)


def _of_test(path: Path) -> float:
    test = load(path, "test").attributes
    return float(test["E_MPa"] / test["E_law_MPa"])
