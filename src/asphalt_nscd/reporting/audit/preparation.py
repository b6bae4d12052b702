"""Counts, masses, the preparation of specimens and their bonds (sections 3.1.1 and 3.2.1)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.measurements.twopoint import PAPER
from asphalt_nscd.reporting.audit.statement import (
    DIFFERS,
    HOLDS,
    INCONSISTENT,
    LEFT_OPEN,
    REPRODUCED,
    UNCHECKED,
    Judgement,
    compared,
    judged,
)
from asphalt_nscd.reporting.tables.bond_readings import AFTER, BARYCENTRES, MEAN_RADIUS, OURS
from asphalt_nscd.specimen.system import affine_poisson

BOX = (0.25, 0.025, 1.6)  # m
CELL = 0.010  # m
LAYER = 0.060  # m
LAYER_FRACTION = 0.695  # solid fraction of Table 2's spheres in a layer so high
SPHERES = 14_160
KEPT = 12_000
DENSITY = 3415.0  # kg/m3
REDUCTION = 0.10
LIFT = 4e-3  # m, difference of the largest and the smallest radius of Table 2
SEGREGATED = 0.05  # of the height of the layer
POISSON = 0.35
DENSITY_TOLERANCE, COUNT_TOLERANCE = 0.03, 0.05
TOP = 0.9  # share of what grains move that the upper half must have, where vibration acts on the top only


def lattice(count: np.ndarray) -> Judgement:
    """count (s,): Table 2."""
    # 1e-9: a side of whole cells must not lose one to rounding.
    cells = int(np.prod(np.floor(np.array(BOX) / CELL + 1e-9)))
    return Judgement(
        "lattice",
        cells,
        int(count.sum()),
        "cells against spheres",
        INCONSISTENT,
        "One sphere per cell leaves no room for the number of Table 2. We put up to eight spheres into the octants of "
        "a cell where they fit.",
        "At least as many cells as spheres.",
    )


def grading(table: pd.DataFrame) -> Judgement:
    """Table 2 against the sieve curve of Table 1. table: table2.csv."""
    both = table.dropna(subset=["count_published", "count_from_grading"])
    apart = (both["volume_published_percent"] / both["volume_from_grading_percent"] - 1.0).abs()
    return Judgement(
        "counts",
        "follow",
        100.0 * float(apart.max()),
        "% of a volume share, largest difference",
        judged(float(apart.max()) < 0.03, HOLDS),
        "Each sphere has the diameter of the sieve that retains its class.",
        "A difference of 3 % of a share.",
    )


def samples(
    deposits: Sequence[Mapping[str, Any]],
    specimens: Sequence[Mapping[str, Any]],
    moved: Sequence[float],
) -> Iterator[Judgement]:
    """Rows on the poured and trimmed samples, from the attributes of their files.

    moved: share of the squared displacements by vibration that the upper half of each layer has.
    """
    # The paper's layer has this many; what fewer spheres do says nothing of it.
    full = all(deposit["spheres"] == SPHERES for deposit in deposits)
    for row in _of_layers(deposits, moved), _of_specimens(specimens):
        for one in row:
            yield one if full else _unchecked(one)


def _of_layers(deposits: Sequence[Mapping[str, Any]], moved: Sequence[float]) -> Iterator[Judgement]:
    height, poured, fraction, segregation = (
        float(np.mean([deposit[name] for deposit in deposits]))
        for name in ("layer_height_m", "poured_layer_height_m", "solid_fraction", "poured_segregation")
    )
    driven = max(deposit["largest_overlap_moving_m"] for deposit in deposits)
    touched = min(deposit["periods_with_contact"] for deposit in deposits)
    of_size = LIFT / poured
    yield Judgement(
        "segregation",
        0.0,
        segregation,
        "difference of mean heights over layer height",
        UNCHECKED
        if SEGREGATED <= abs(segregation) < SEGREGATED + of_size
        else judged(abs(segregation) < SEGREGATED),
        "Largest against smallest spheres at the end of pouring; positive: the largest lie higher. The paper gives no "
        f"measure. On the floor the centres of the largest lie {1e3 * LIFT:g} mm higher than those of the smallest: "
        f"up to {of_size:.2g} can be size alone.",
        f"A difference below {SEGREGATED:g}, which counts as none, or above {SEGREGATED + of_size:.2g}, which size "
        "does not explain.",
    )
    yield compared(
        "layer",
        LAYER,
        height,
        "m",
        0.01,
        f"Twice the height of the centre of mass, mean of {len(deposits)} samples: a solid fraction of {fraction:.3f}, "
        f"where 60 mm have {LAYER_FRACTION:.3f}. The layer sinks by {1e3 * (poured - height):.2f} mm. 6 mm are taken "
        f"from crest to crest about the top of the layer, found anew in each period; the wall touches it in {touched} "
        "of 30 periods or more and pushes with at most its weight. More push does not close the gap: 4 and 16 times "
        f"the weight of a smaller layer brought 0.4 mm more (docs/pouring.md). Grains overlap by at most {driven:.1e} "
        "m.",
    )
    least = min(moved)
    yield Judgement(
        "top_layers",
        "top layers",
        100.0 * float(np.mean(moved)),
        "% of the squared displacements by vibration, in the upper half",
        judged(least > TOP),
        f"From the poured layer to the vibrated one; at least {100.0 * least:.0f} % in each sample.",
        f"{100.0 * TOP:.0f} % or less in a sample.",
    )


def _of_specimens(specimens: Sequence[Mapping[str, Any]]) -> Iterator[Judgement]:
    spheres = np.array([specimen["spheres"] for specimen in specimens])
    density = float(np.mean([specimen["density"] for specimen in specimens]))
    trapezoid = 0.5 * (PAPER.b + PAPER.B) * PAPER.e * PAPER.h
    share = trapezoid / (BOX[0] * BOX[1] * LAYER)
    contradicted = round(share * SPHERES)
    yield Judgement(
        "particles_kept",
        KEPT,
        float(spheres.mean()),
        "spheres",
        INCONSISTENT if abs(contradicted / KEPT - 1.0) > COUNT_TOLERANCE else judged(True),
        f"{spheres.min()} to {spheres.max()}. The trapezoid is {100.0 * share:.1f} % of a 60 mm layer, so "
        f"{contradicted} of the 14 160 spheres of Table 2 remain by the paper's own numbers.",
        f"A share of the layer within {100.0 * COUNT_TOLERANCE:g} % of 12 000.",
    )
    solid = PAPER.mass / DENSITY / trapezoid
    reduced = LAYER_FRACTION * (1.0 - REDUCTION)
    yield Judgement(
        "density",
        DENSITY,
        density,
        "kg/m3",
        INCONSISTENT if abs(solid / reduced - 1.0) > DENSITY_TOLERANCE else judged(True),
        f"0.6 kg at 3415 kg/m3 fill {solid:.3f} of the trapezoid. The 60 mm layer has {LAYER_FRACTION:.3f} before the "
        f"reduction by 10 %, {reduced:.3f} after it: the density was matched to the unreduced volume. Ours with the "
        f"unreduced volume would be {density * (1.0 - REDUCTION):.0f} kg/m3.",
        f"Solid fractions within {100.0 * DENSITY_TOLERANCE:g} % of each other.",
    )


def moved_above(deposit: Mapping[str, np.ndarray]) -> float:
    """Share of the squared displacements from the poured to the vibrated layer that its upper half has."""
    height = deposit["poured_position"][:, 2]
    moved = ((deposit["position"] - deposit["poured_position"]) ** 2).sum(axis=1)
    return float(moved[height > 0.5 * height.max()].sum() / moved.sum())


def bonds(readings: pd.DataFrame) -> Iterator[Judgement]:
    """Rows on what the paper says of its bonds. readings: bond_readings.csv."""
    usual = readings[readings["friction"] == readings["friction"].iloc[0]].set_index("reading")
    said, nearer = usual.loc[OURS, "E_over_law"], usual.loc[AFTER, "E_over_law"]
    possible = [
        f"{row.reading}, friction {row.friction:g}: {row.expected:.3f}"
        for row in readings[readings["possible"]].itertuples()
    ]
    yield Judgement(
        "reach",
        "before or after the reduction",
        f"{said:.4g} or {nearer:.4g}",
        "|E*| over that of the law with dmin from before or after the reduction of volume, mean of all samples",
        LEFT_OPEN,
        f"The paper does not say which. {usual.loc[OURS, 'gap_max_mm']:.4g} mm (our reading) make "
        f"{usual.loc[OURS, 'bonds']} bonds in a sample, {usual.loc[AFTER, 'gap_max_mm']:.4g} mm "
        f"{usual.loc[AFTER, 'bonds']}. The printed errors allow these readings: {'; '.join(possible) or 'none'}. A gap "
        "of one smallest diameter leaves room for another sphere: "
        f"{usual.loc[OURS, 'through_third_sphere_percent']:.3g} % of the bonds between spheres pass through a third "
        "one.",
        "A value of dmin, or a ratio that does not depend on it.",
    )
    yield Judgement(
        "barycentre",
        "at the barycentre",
        f"{usual.loc[BARYCENTRES, 'E_over_law']:.4g} or {said:.4g}",
        "|E*| over that of the law, taken literally or with moments",
        LEFT_OPEN,
        "Taken literally no bond exerts a moment, no sphere turns, and tangential forces resist the turning of the "
        "specimen: the paper's results exclude that. We let forces act in the middle of the gap, and their moments "
        "turn the spheres.",
        "A ratio near one without moments.",
    )
    yield Judgement(
        "tangential",
        POISSON,
        affine_poisson(0.5 / (1.0 + POISSON)),
        "Poisson's ratio of an isotropic network of such bonds",
        DIFFERS,
        "Affine theory; networks that were pulled have 0.16 (docs/mapping.md). 1/(2 (1 + nu)) relates shear to Young's "
        "modulus in a continuum, and the tangential to the normal stiffness in no network: 0.35 lies beyond the 1/4 "
        "that bonds without tangential stiffness have.",
        "A network of such bonds with a Poisson's ratio of 0.35.",
    )
    larger = usual.loc[MEAN_RADIUS, "E_over_law"]
    yield Judgement(
        "conservative",
        "conservative",
        said,
        "|E*| over that of the law with rmin",
        # Open where another reading that may be theirs lies on the other side of one.
        LEFT_OPEN if said >= 1.0 > readings["expected"][readings["possible"]].min() else judged(said < 1.0),
        f"With rmin our specimen is {'less' if said < 1.0 else 'already more'} stiff than its law. The printed errors "
        f"allow other readings: {'; '.join(possible) or 'none'}. The mean radius of "
        f"both spheres gives {larger:.3g}.",
        "A ratio below one with rmin." if said >= 1.0 else "A ratio above one with rmin.",
    )


def contacts(tests: pd.DataFrame) -> Judgement:
    """tests: simulations.csv."""
    gap = float(tests["smallest_gap_m"].min())
    return Judgement(
        "both_act",
        "both",
        1e6 * gap,
        "um, smallest gap in any test",
        UNCHECKED if gap > 0.0 else REPRODUCED,
        "Not exercised: no gap closes in any test, so that friction plays no part. `make verify` tests the law of both."
        if gap > 0.0
        else "A gap closes.",
        "A gap that closes." if gap > 0.0 else "No gap that closes.",
    )


def _unchecked(row: Judgement) -> Judgement:
    if row.verdict == INCONSISTENT:
        return row
    reason = f"{row.evidence} This study pours fewer spheres than the paper."
    return replace(row, verdict=UNCHECKED, evidence=reason)
