"""The first rung: as Eqs. (30)-(33) bond the spheres, the modulus of a specimen is not that of its law.

Two campaigns of simulated tests show it without any measurement: the same laws in the same packings, bonded as in
the paper and by facets. |E*| over that of the law is a number of the packing and the size by the one, one by the
other (docs/mapping.md). Nothing is fitted, so what the rung gains is gained on data that nothing has seen.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.observed.observations import Complex, Observations
from asphalt_nscd.diagnosis.simulation.numerics import NEAR_DEGREES, NEAR_FREQUENCY
from asphalt_nscd.diagnosis.written import NO_CAUSE, interval_95
from asphalt_nscd.measurements.tables import KEYS, MODULUS, read_tests

NAME = "bond_mapping"
MATTERS = 0.01  # of |E*| over that of the law from one; facets at full size leave 0.002
SENTENCE = (
    "the modulus of a specimen is not that of its law: the areas of Eqs. (30)-(33) do not fill its volume, so that "
    "size and packing decide"
)
CONFIRMED_BY = "the same law in other packings and sizes: packing.csv, docs/mapping.md"


def simulated(campaign: str | Path, observed: Observations) -> Complex:
    """ln E* (n,) of simulated tests at each measured condition, mean over samples; NaN where none is near."""
    tests = read_tests([campaign]).groupby(KEYS)[MODULUS].mean().reset_index()
    temperature, frequency = (tests[name].to_numpy(float) for name in KEYS)
    kelvin = np.abs(observed.temperature[:, None] - temperature) / NEAR_DEGREES
    octave = np.abs(np.log(observed.frequency[:, None] / frequency)) / NEAR_FREQUENCY
    away = np.maximum(kelvin, octave)
    nearest = away.argmin(axis=1)
    norm, phase = (tests[name].to_numpy(float) for name in MODULUS)
    shown = np.log(1e6 * norm) + 1j * np.radians(phase)
    return np.where(away.min(axis=1) <= 1.0, shown[nearest], complex(np.nan, np.nan))


def ratio_to_law(campaign: str | Path) -> pd.Series:
    """|E*| over that of the law, by sample: mean over its tests without broken bonds in a folder of simulated tests."""
    tests = read_tests([campaign], ["broken_bonds"])
    # A broken bond softens a specimen whatever its mapping.
    whole = tests[tests["broken_bonds"] == 0]
    return (whole["E_MPa"] / whole["E_law_MPa"]).groupby(whole["specimen"]).mean()


def bond_mapping(
    paper: str | Path, facets: str | Path, averages: dict[str, dict[str, dict[str, float]]]
) -> tuple[dict[str, Any] | None, str]:
    """The rung of the mapping of the law to the bonds (None where the paper's return the law), and a sentence."""
    ratio, by_facets = ratio_to_law(paper), ratio_to_law(facets)
    if ratio.empty or by_facets.empty:
        return None, "bond_mapping is not judged: no simulated test is without broken bonds."
    before, after = _range(ratio), _range(by_facets)
    if (ratio - 1.0).abs().max() < MATTERS:
        return None, f"No rung bond_mapping: as the paper bonds spheres, |E*| is {before} of the law."
    evidence = (
        f"the same laws in {len(ratio)} packing{'s' if len(ratio) > 1 else ''}: |E*| is {before} of the law as in the "
        f"paper, {after} with facets"
    )
    return NO_CAUSE | {
        "cause": NAME,
        "parameters": {
            "modulus_over_law": _estimate(ratio),
            "modulus_over_law_with_facets": _estimate(by_facets),
        },
        "p_value": None,
        "gain": {"in_sample": {"averages_by_temperature": averages}, "held_out": {}},
        "established": True,
        "sentence": SENTENCE,
        "evidence": evidence,
        "confirmed_by": CONFIRMED_BY,
    }, f"bond_mapping: {evidence}."


def void(campaign: str | Path) -> str:
    """What to say of a campaign that stands alone, without another mapping beside it, in a sentence."""
    ratio = ratio_to_law(campaign)
    of_law = f"; |E*| of its samples is {_range(ratio)} of the law" if len(ratio) else ""
    return f"No rung bond_mapping: the campaign has one mapping of the law to the bonds{of_law}."


def _range(values: pd.Series) -> str:
    low, high = f"{values.min():.3f}", f"{values.max():.3f}"
    return low if low == high else f"{low} to {high}"


def _estimate(values: pd.Series) -> dict[str, Any]:
    """Mean over samples, and the standard deviation from sample to sample."""
    found = {"value": float(values.mean()), "std_error": None, "unit": "-"}
    if len(values) == 1:
        return found
    scatter = float(values.std(ddof=1))
    return found | {"std_error": scatter, "interval_95": interval_95(float(values.mean()), scatter)}
