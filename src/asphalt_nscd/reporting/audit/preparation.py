"""Counts, masses and the preparation of specimens (section 3.2.1)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.reporting.audit.equations import PAPER
from asphalt_nscd.reporting.audit.statement import (
    DIFFERS,
    INCONSISTENT,
    UNCHECKED,
    Statement,
    compared,
    judged,
)

BOX = (0.25, 0.025, 1.6)  # m
CELL = 0.010  # m
LAYER = 0.060  # m
LAYER_FRACTION = 0.695  # solid fraction of Table 2's spheres in a layer so high
PERIODS = 30  # of the vibration: 30 Hz for 1 s
SPHERES = 14_160
KEPT = 12_000
DENSITY = 3415.0  # kg/m3
POURED_DENSITY = 2600.0  # kg/m3
REDUCTION = 0.10
GRAVITY = 9.81  # m/s2


def counts(diameter: np.ndarray, count: np.ndarray) -> Iterator[Statement]:
    """Rows that follow from Table 2 alone: diameter (s,) [m], count (s,)."""
    volume = np.pi / 6.0 * diameter**3
    total = float((count * volume).sum())
    cells = int(np.prod(np.floor(np.array(BOX) / CELL + 1e-9)))
    yield Statement(
        "3.2.1",
        "The spheres are disposed in a lattice of 10 mm cells, 0.25 x 0.025 x 1.6 m.",
        cells,
        int(count.sum()),
        "cells against spheres",
        INCONSISTENT,
        "One sphere per cell leaves no room for the number of Table 2. We put up to eight spheres into the "
        "octants of a cell where they fit.",
    )
    mean_diameter = float((count * diameter).sum() / count.sum())
    yield compared(
        "3.2.2", "Mean particle size.", 2.52e-3, mean_diameter, "m", 0.01, "Number average of Table 2."
    )
    of_mean_diameter = DENSITY * np.pi / 6.0 * 2.52e-3**3
    mean_mass = DENSITY * total / count.sum()
    yield Statement(
        "3.2.2",
        "Average mass of the particles.",
        2.86e-5,
        mean_mass,
        "kg",
        INCONSISTENT,
        f"2.86e-5 kg is the mass of a sphere of the mean diameter ({of_mean_diameter:.3g} kg). The mean mass "
        "of Table 2's spheres is larger, as large spheres weigh with the cube of their size.",
    )
    yield compared(
        "3.2.2",
        "Time of rearrangement m/(p d), about 2e-3 s.",
        2e-3,
        float(np.sqrt(2.86e-5 / (2.79e3 * 2.52e-3))),
        "s",
        0.05,
        "Holds with a square root, sqrt(m/(p d)); without it the quantity is in s2.",
    )
    yield compared(
        "3.2.2",
        "Mean pressure.",
        2.79e3,
        DENSITY * GRAVITY * PAPER.h / 3.0,
        "Pa",
        0.01,
        "Ours: rho g h/3, that is phi rho g h/2 with a solid fraction phi = 2/3.",
    )
    stiffness = np.pi * 1e-3**2 / 2e-3 * 2.43e7
    yield Statement(
        "3.2.2",
        "Elastic time scale sqrt(m/K) at 15 degC, about 2e-5 s.",
        2e-5,
        float(np.sqrt(2.86e-5 / (1e3 * stiffness))),
        "s",
        INCONSISTENT,
        f"With Em in Pa and two touching 2 mm spheres it is {np.sqrt(2.86e-5 / stiffness):.2g} s, with Em in kPa "
        "1/32 of that: the paper computed its time scale from the Pa reading that its moduli contradict.",
    )
    trapezoid = 0.5 * (PAPER.b + PAPER.B) * PAPER.e * PAPER.h
    share = trapezoid / (BOX[0] * BOX[1] * LAYER)
    yield Statement(
        "3.2.1",
        "Trimming leaves about 12 000 particles.",
        KEPT,
        round(share * SPHERES),
        "spheres",
        INCONSISTENT,
        f"The trapezoid is {100.0 * share:.1f} % of a 60 mm layer, so as much of the 14 160 spheres remains.",
    )
    solid = PAPER.mass / DENSITY / trapezoid
    yield Statement(
        "3.2.1",
        "At 3415 kg/m3 the spheres weigh 0.6 kg after a reduction of their volume by 10 %.",
        solid,
        total / (BOX[0] * BOX[1] * LAYER) * (1.0 - REDUCTION),
        "solid fraction",
        INCONSISTENT,
        "0.6 kg at 3415 kg/m3 fill that part of the trapezoid, which is the fraction of the 60 mm layer "
        "before the reduction: the density was matched to the unreduced volume.",
    )


def grading(table: pd.DataFrame) -> Iterator[Statement]:
    """Table 2 against the sieve curve of Table 1. table: table2.csv."""
    both = table.dropna(subset=["count_published", "count_from_grading"])
    apart = (both["volume_published_percent"] / both["volume_from_grading_percent"] - 1.0).abs()
    yield Statement(
        "Table 2",
        "The numbers of spheres follow the sieve curve of Table 1 cut at 2 mm.",
        "follow",
        100.0 * float(apart.max()),
        "% of a volume share, largest difference",
        judged(float(apart.max()) < 0.03),
        "Each sphere has the diameter of the sieve that retains its class. Below 3 % counts as following.",
    )


def samples(
    deposits: Sequence[Mapping[str, Any]], specimens: Sequence[Mapping[str, Any]]
) -> Iterator[Statement]:
    """Rows on the poured and trimmed samples, from the attributes of their files."""
    full = all(deposit["spheres"] == SPHERES for deposit in deposits)
    height = float(np.mean([deposit["layer_height_m"] for deposit in deposits]))
    poured = float(np.mean([deposit["poured_layer_height_m"] for deposit in deposits]))
    fraction = float(np.mean([deposit["solid_fraction"] for deposit in deposits]))
    segregation = float(np.mean([deposit["segregation"] for deposit in deposits]))
    driven = max(deposit["largest_overlap_moving_m"] for deposit in deposits)
    touched = min(deposit["periods_with_contact"] for deposit in deposits)
    overlap = max(deposit["largest_overlap_m"] for deposit in deposits)
    spheres = np.array([specimen["spheres"] for specimen in specimens])
    density = float(np.mean([specimen["density"] for specimen in specimens]))
    reduced = "" if full else " This study pours fewer spheres than the paper."
    rows = [
        compared(
            "3.2.1",
            "Height of the layer after vibration.",
            LAYER,
            height,
            "m",
            0.01,
            f"Twice the height of the centre of mass, mean of {len(deposits)} samples; largest overlap "
            f"{overlap:.1e} m at rest. The layer stays {1e3 * (height - LAYER):.2f} mm above 60 mm. More push does not "
            "close that: 4 and 16 times the weight of a smaller layer brought 0.4 mm more than once its weight "
            "(docs/pouring.md). Rigid grains jam.",
        ),
        compared(
            "3.2.1",
            "Vibration (6 mm, 30 Hz, 1 s) compacts the layer to 60 mm.",
            LAYER_FRACTION,
            fraction,
            "solid fraction",
            0.01,
            f"The layer sinks by {1e3 * (poured - height):.2f} mm. 6 mm are taken from crest to crest about the "
            "top of the layer, found anew in each period; the wall pushes with at most the weight of the layer, and "
            f"grains overlap by at most {driven:.1e} m meanwhile.",
        ),
        Statement(
            "3.2.1",
            "The top wall vibrates the layer for 1 s at 30 Hz.",
            PERIODS,
            touched,
            "periods in which it touches",
            judged(touched >= PERIODS - 2),
            "The fewest of all samples; 28 of 30 count as reproduced.",
        ),
        Statement(
            "3.2.1",
            "No segregation.",
            0.0,
            segregation,
            "difference of mean heights over layer height",
            judged(abs(segregation) < 0.05),
            "Largest against smallest spheres after vibration; positive: the largest lie higher. Below 0.05 "
            "counts as none.",
        ),
        compared(
            "3.2.1",
            "Particles in a specimen.",
            KEPT,
            float(spheres.mean()),
            "spheres",
            0.05,
            f"{spheres.min()} to {spheres.max()}; barycentres inside the trapezoid.",
        ),
        compared(
            "3.2.1",
            "Density that gives 0.6 kg.",
            DENSITY,
            density,
            "kg/m3",
            0.03,
            f"With the reduced volume. With the unreduced one it would be {density * (1.0 - REDUCTION):.0f} kg/m3.",
        ),
    ]
    for row in rows:
        yield row if full else _unchecked(row, reduced)
    loose = sum(specimen["loose_grains"] for specimen in specimens)
    yield Statement(
        "3.1.1",
        "Every pair with a gap below the smallest diameter is bonded.",
        "bonds all",
        loose,
        "grains with fewer than three bonds",
        judged(loose == 0) if loose == 0 else DIFFERS,
        "Such grains can still move freely; they are taken out when the layer is cut.",
    )


def bonds(readings: pd.DataFrame) -> Iterator[Statement]:
    """Rows on what the paper says of its bonds. readings: bond_readings.csv."""
    as_paper, nearer, without_moments = readings.to_dict("records")
    yield Statement(
        "3.1.1",
        "Pairs closer than dmin, the smallest diameter, are bonded.",
        as_paper["E_over_law"],
        nearer["E_over_law"],
        "static |E*| over that of the law",
        DIFFERS,
        "The paper does not say whether dmin is taken before the reduction of volume "
        f"({as_paper['gap_max_mm']:.4g} mm, {as_paper['bonds']} bonds: our reading and the first number) or after it "
        f"({nearer['gap_max_mm']:.4g} mm, {nearer['bonds']} bonds).",
    )
    yield Statement(
        "3.1.1",
        "Forces are applied at the barycentre of each linked particle.",
        1.0,
        without_moments["E_over_law"],
        "static |E*| over that of the law",
        INCONSISTENT,
        "Taken literally no bond exerts a moment, no sphere turns, and tangential forces resist the turning of the "
        "specimen. We let forces act in the middle of the gap, and their moments turn the spheres: "
        f"{as_paper['E_over_law']:.3g}.",
    )
    yield Statement(
        "3.1.1",
        "A bond joins two neighbouring particles.",
        0.0,
        as_paper["through_third_sphere_percent"],
        "% of the bonds between spheres pass through a third sphere",
        DIFFERS,
        "A gap of one smallest diameter leaves room for another sphere between the two.",
    )


def _unchecked(row: Statement, why: str) -> Statement:
    return Statement(
        row.where, row.statement, row.published, row.ours, row.unit, UNCHECKED, row.evidence + why
    )
