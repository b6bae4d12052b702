"""Table 4: mean relative error of |E*| and phase for each temperature."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.csvinput import Limits, read_csv
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

ERRORS = ["mre_E_percent", "mre_phase_percent"]
PERCENT = Limits(0.0, 1e4, "give a percentage")


def make(simulations: list[Path], measured: list[Path], published: Sequence[Path] = ()) -> pd.DataFrame:
    """Simulation against measurement, the bonds' law against measurement, and the published errors.

    The error of the law is what the simulation could at best reach: it knows nothing else.
    """
    tests, data = read_tests(simulations), read_measured(measured)
    law = tests[[*KEYS, *OF_THE_LAW]].rename(columns=dict(zip(OF_THE_LAW, MODULUS, strict=True)))
    simulated = named(mean_relative_error(data, tests), "simulated")
    table = simulated.merge(named(mean_relative_error(data, law), "law"), on="temperature_C")
    if published:
        printed = read_errors(only_file(published, "published"))
        # A temperature that the paper lacks stays, with an empty cell.
        table = table.merge(named(printed, "published"), on="temperature_C", how="left")
    kinds = ["published", "simulated", "law"] if published else ["simulated", "law"]
    table["compared_with"] = [origin_of(isotherm_rows(data, t)) for t in table["temperature_C"]]
    errors = [name_of(error, kind) for error in ERRORS for kind in kinds]
    return table[["temperature_C", "compared_with", *errors]]


def read_errors(path: str | Path) -> pd.DataFrame:
    """Published errors: temperature_C and ERRORS."""
    table = read_csv(path)
    table.require(["temperature_C", *ERRORS])
    columns = {"temperature_C": table.numbers("temperature_C")}
    return pd.DataFrame(columns | {name: table.numbers(name, PERCENT) for name in ERRORS})


def name_of(error: str, kind: str) -> str:
    """Column of one of ERRORS of a kind: "law", say."""
    return error.replace("_percent", f"_{kind}_percent")


def named(errors: pd.DataFrame, kind: str) -> pd.DataFrame:
    """The same errors in the columns of a kind."""
    return errors.rename(columns={error: name_of(error, kind) for error in ERRORS})
