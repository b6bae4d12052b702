"""Does the excess of the phase in a diagnosis hold zero where a mix has none?

    python -m excess 200 --folder results/excess

Tables of laboratories, as `attack.laboratory` invents them, whose gauges are sound: errors of every day and no fault.
Each is given to `diagnose`, which is stopped as soon as it knows its scatter: from then on the excess is settled.
Beside it stands an estimate without any model, of the phase in the middle of an isotherm less 90 degrees times the
slope of ln|E*| over ln f between its ends.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pandas as pd
from attack.laboratory import CYLINDER, Campaign, invented, written
from attack.rates import line

import asphalt_nscd as an
from asphalt_nscd.diagnosis.screening import excess_phase

SEED = 20281201
NEAR = 0.3  # deg
HOLDS = 0.93, 0.98
HOT = 30.0  # degC


class _Known(Exception):
    """Observations and noise of a diagnosis."""


def _stop(*known: object) -> bool:
    raise _Known(*known)


def sound(number: int) -> Iterator[Campaign]:
    """So many campaigns without a fault."""
    place = given = 0
    while given < number:
        campaign = invented(place, SEED)
        place += 1
        if campaign.broken is None:
            given += 1
            yield campaign


def rows(campaign: Campaign) -> Iterator[dict[str, object]]:
    """A row for each isotherm: both estimates, and the standard error of that of the diagnosis [deg]."""
    table = written(campaign, campaign.unmoved())
    try:
        with patch.object(excess_phase, "shows_excess", _stop):
            an.diagnose(table, measured_in=campaign.bench)
    except _Known as known:
        found = excess_phase.excess_phases(*known.args)
    for one in found:
        yield {
            "table": campaign.name,
            "bench": campaign.bench,
            "law": campaign.about["law"],
            "temperature_C": one.temperature,
            "excess_deg": np.degrees(one.excess),
            "standard_error_deg": np.degrees(one.std_error),
            "by_slope_deg": by_slope(table[table["temperature_C"] == one.temperature]),
        }


def by_slope(isotherm: pd.DataFrame) -> float:
    """Phase in the middle less 90 degrees times the slope between the ends [deg], of means over the specimens."""
    means = isotherm.assign(E=np.log(isotherm["E_MPa"])).groupby("frequency_Hz")[["E", "phase_deg"]].mean()
    log_f = np.log(means.index.to_numpy())
    slope = (means["E"].iloc[-1] - means["E"].iloc[0]) / (log_f[-1] - log_f[0])
    middle = np.interp(0.5 * (log_f[0] + log_f[-1]), log_f, means["phase_deg"])
    return float(middle - 90.0 * slope)


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Rates with their intervals, and whether they are as asked for."""
    held = np.abs(table["excess_deg"] / table["standard_error_deg"]) < 1.96
    near = np.abs(table["excess_deg"] - table["by_slope_deg"]) < NEAR
    hot = (table["bench"] == CYLINDER) & (table["temperature_C"] > HOT)
    lines = [
        line("isotherms whose 95 % interval holds no excess", "93 - 98 %", held, *HOLDS),
        line(f"the same, of cylinders above {HOT:g} degC", "93 - 98 %", held[hot], *HOLDS),
        line(f"isotherms whose excess is within {NEAR:g} deg of that by the slope", ">= 95 %", near, 0.95),
        line(f"the same, up to {HOT:g} degC", ">= 95 %", near[table["temperature_C"] <= HOT], 0.95),
        line("tables that would be taken for a mix that is not linear", "<= 5 %", _spoken(table), 0.0, 0.05),
    ]
    return pd.DataFrame(lines)


def _spoken(table: pd.DataFrame) -> pd.Series:
    above = table["excess_deg"] > excess_phase.SPEAKS * table["standard_error_deg"]
    return above.groupby(table["table"]).any()


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tables", type=int)
    parser.add_argument("--folder", type=Path, required=True)
    given = parser.parse_args(arguments)
    table = pd.DataFrame([row for campaign in sound(given.tables) for row in rows(campaign)])
    given.folder.mkdir(parents=True, exist_ok=True)
    table.round(4).to_csv(given.folder / "excess.csv", index=False, lineterminator="\n")
    summary(table).to_csv(given.folder / "summary.csv", index=False, lineterminator="\n")


if __name__ == "__main__":
    main()
