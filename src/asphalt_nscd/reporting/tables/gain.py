"""What the diagnosis gained in the simulation itself: errors before and after, beside the scatter."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import at_temperature, origin_of, read_measured, read_tests, the_only
from asphalt_nscd.reporting.tables.table4 import ERRORS, read_errors


def make(
    simulations: list[Path], extended: list[Path], measured: list[Path], diagnosis: list[Path],
    published: Sequence[Path] = (),
) -> pd.DataFrame:  # fmt: skip
    """Mean relative errors (Table 4) of the tests as in the paper and extended, for each temperature.

    refitted: a Burgers law fitted at each temperature; left_out: one law for all temperatures fitted
    without this temperature; both as the numerical specimen shows them. scatter: of one measured test.
    """
    data, content = read_measured(measured), read_json(the_only(diagnosis, "diagnosis"))
    table = _named(mean_relative_error(data, read_tests(simulations)), "before")
    table = table.merge(_named(mean_relative_error(data, read_tests(extended)), "after"), on="temperature_C")
    baseline = content["baseline"]
    law = [rung for rung in content["ladder"] if rung["cause"] == "relaxation_spectrum"]
    left_out = law[0]["gain"]["held_out"].get("leave_one_isotherm_out", {}) if law else {}
    for error in ERRORS:
        at = [f"{t:g}" for t in table["temperature_C"]]
        table[_name(error, "refitted")] = [baseline[error].get(t, np.nan) for t in at]
        table[_name(error, "left_out")] = [
            left_out.get("averages_by_temperature", {}).get(t, {}).get(error, {}).get("after", np.nan)
            for t in at
        ]
    table["scatter_E_percent"] = content["scatter"]["modulus_percent"]
    table["scatter_phase_percent"] = [
        100.0 * float((content["scatter"]["phase_deg"] / at_temperature(data, t)["phase_deg"]).abs().mean())
        for t in table["temperature_C"]
    ]
    if published:
        printed = _named(read_errors(the_only(published, "published")), "published")
        table = table.merge(printed, on="temperature_C", how="left")
    table.insert(1, "compared_with", [origin_of(at_temperature(data, t)) for t in table["temperature_C"]])
    return table


def _name(error: str, kind: str) -> str:
    return error.replace("_percent", f"_{kind}_percent")


def _named(errors: pd.DataFrame, kind: str) -> pd.DataFrame:
    return errors.rename(columns={error: _name(error, kind) for error in ERRORS})
