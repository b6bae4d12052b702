"""The whole way, rung by rung: errors of the simulation as in the paper, with facets, with what was named."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.diagnosis.simulation.extension import causes_taken_off
from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import (
    KEYS,
    MODULUS,
    OF_THE_LAW,
    isotherm_rows,
    only_file,
    origin_of,
    read_measured,
    read_tests,
)
from asphalt_nscd.reporting.pages.way import LIKELIEST
from asphalt_nscd.reporting.tables.table4 import ERRORS, name_of, named, read_errors

PAPER, FACETS = "as in the paper", "facets"


def make(
    simulations: list[Path],
    measured: list[Path],
    diagnosis: list[Path],
    likely: Sequence[Path] = (),
    facets: Sequence[Path] = (),
    extended: Sequence[Path] = (),
    published: Sequence[Path] = (),
) -> pd.DataFrame:
    """Mean relative errors (Table 4) of each campaign of simulated tests at each temperature.

    likely: tests of one sample, by the likeliest reading of the paper; a rung below all others.
    facets: the tests of `simulations` with bonds that are facets; where there are none, those have them already.
    extended: with what the diagnosis named as well. Columns with law: errors of the law that a campaign has in its
    bonds; held_out: of the law of all temperatures, fitted without this one; scatter: of one test.
    """
    data, content = read_measured(measured), read_json(only_file(diagnosis, "diagnosis"))
    campaigns: dict[str, Sequence[Path]] = {LIKELIEST: likely} if likely else {}
    campaigns |= {PAPER: simulations, FACETS: facets} if facets else {FACETS: simulations}
    if extended:
        campaigns[_extension(diagnosis)] = extended
    rungs = []
    for name, paths in campaigns.items():
        tests = read_tests(paths)
        law = tests[[*KEYS, *OF_THE_LAW]].rename(columns=dict(zip(OF_THE_LAW, MODULUS, strict=True)))
        rung = mean_relative_error(data, tests)
        rung = rung.merge(named(mean_relative_error(data, law), "law"), on="temperature_C")
        rung.insert(0, "rung", name)
        for error in ERRORS:
            # Only the law of the last campaign was fitted without the temperature in question.
            held = _held_out(content, error) if paths is extended else {}
            rung[name_of(error, "held_out")] = [held.get(f"{t:g}") for t in rung["temperature_C"]]
        rungs.append(rung)
    table = pd.concat(rungs, ignore_index=True)
    table = table.astype({name_of(error, "held_out"): float for error in ERRORS})
    table["scatter_E_percent"] = content["scatter"]["modulus_percent"]
    degrees = content["scatter"]["phase_deg"]
    of_phase = {
        t: 100.0 * float((degrees / isotherm_rows(data, t)["phase_deg"]).abs().mean())
        for t in table["temperature_C"].unique()
    }
    table["scatter_phase_percent"] = table["temperature_C"].map(of_phase)
    if published:
        printed = named(read_errors(only_file(published, "published")), "published")
        # A temperature that the paper lacks stays, with empty cells.
        table = table.merge(printed, on="temperature_C", how="left")
    table.insert(2, "compared_with", [origin_of(isotherm_rows(data, t)) for t in table["temperature_C"]])
    kinds = [name for name in table if name not in ("rung", "temperature_C", "compared_with")]
    # A stable sort: |E*| first, and within each the kinds as they were made.
    return table[["rung", "temperature_C", "compared_with", *sorted(kinds, key=lambda name: "phase" in name)]]


def _extension(diagnosis: Sequence[Path]) -> str:
    """What the extended campaign has beside facets, in words: "spectrum", and causes at their place."""
    named = dict.fromkeys(
        candidate.cause.name.replace("_", " ") for candidate in causes_taken_off(diagnosis[0])
    )
    return ", ".join(["spectrum", *named])


def _held_out(content: dict[str, Any], error: str) -> dict[str, float]:
    """Error by temperature of the law fitted without it; none where too few temperatures were tested."""
    for rung in content["ladder"]:
        if rung["cause"] == "relaxation_spectrum":
            held = rung["gain"]["held_out"].get("leave_one_isotherm_out", {})
            return {t: one[error]["after"] for t, one in held.get("averages_by_temperature", {}).items()}
    return {}
