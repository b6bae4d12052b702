"""The same sample bonded as the paper says it, and under other readings of its words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.tables import the_only
from asphalt_nscd.specimen.bond_readings import crossing, ratio_without_moments, with_mean_radius
from asphalt_nscd.specimen.preparation import read_specimen
from asphalt_nscd.specimen.prism import static_ratio
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen, trim

POISSON = 0.35  # of Eqs. (8)-(11)


def make(deposit: list[Path], specimen: list[Path]) -> pd.DataFrame:
    """One row for each reading: bonds, share of those between spheres that pass through a third, |E*| over the law's.

    Static solutions. gap_max_mm: largest gap of two spheres that are bonded.
    """
    path = the_only(specimen, "specimen")
    said, as_paper = load(path, "specimen").attributes, read_specimen(path)
    layer = load(the_only(deposit, "deposit"), "deposit").arrays
    reduction, gap = float(said["volume_reduction"]), float(said["gap_max_m"])
    shrunk_gap = gap * (1.0 - reduction) ** (1.0 / 3.0)
    nearer = trim(layer["position"], layer["radius"], as_paper.geometry, reduction, shrunk_gap)
    rows = [
        ("as in the paper", gap, as_paper, _ratio(as_paper)),
        ("smallest diameter after the reduction of volume", shrunk_gap, nearer, _ratio(nearer)),
        (
            "forces at the barycentres, without moments",
            gap,
            as_paper,
            ratio_without_moments(as_paper, POISSON),
        ),
        ("mean radius of both spheres", gap, as_paper, _ratio(with_mean_radius(as_paper))),
    ]
    return pd.DataFrame(
        {
            "reading": reading,
            "gap_max_mm": 1e3 * reach,
            "bonds": of.network.first.size,
            "through_third_sphere_percent": 100.0 * crossing(of).mean(),
            "E_over_law": ratio,
        }
        for reading, reach, of, ratio in rows
    )


def _ratio(specimen: Specimen) -> float:
    return static_ratio(bending_system(specimen, POISSON, np.inf, 0.0), specimen.geometry)
