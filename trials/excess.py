"""Does the excess of the phase in a diagnosis hold zero where a mix has none?

    python -m excess 200 --folder results/excess

Tables of laboratories, as `attack.laboratory` invents them, whose gauges are sound: errors of every day and no fault.
Each is given to `diagnose`, which is stopped as soon as it knows its scatter: from then on the excess is settled.
Beside it stand two estimates, each a mean over the specimens. One has no model: the phase in the middle of an isotherm
less 90 degrees times the slope of ln|E*| over ln f between its ends. The other is the best that can be where the slope
of a mix is not known, and is told all else, how its |E*| and phase bend: the mean error of the phases less 90 degrees
times the slope of the errors of ln|E*|. A mounting that turns all phases, or tilts |E*|, moves it, and no estimate
could see that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from unittest.mock import patch

import click
import numpy as np
import pandas as pd
from attack.laboratory import CYLINDER, Campaign, sound_campaigns, written
from attack.rates import line

import asphalt_nscd as an
from asphalt_nscd.diagnosis.screening import excess_phase
from asphalt_nscd.files.store import write_table

SEED = 20281207
NEAR = 0.3  # deg
HOLDS = 0.93, 0.98
HOT = 30.0  # degC
LESS = 0.5, 0.25  # shares of the usual errors


class _Known(Exception):
    """Observations and noise of a diagnosis."""


def _stop(*known: object) -> bool:
    raise _Known(*known)


def rows(campaign: Campaign) -> Iterator[dict[str, object]]:
    """A row for each isotherm: both estimates, and the standard error of that of the diagnosis [deg]."""
    table = written(campaign, campaign.unmoved())
    try:
        with patch.object(excess_phase, "shows_excess", _stop):
            an.diagnose(table, measured_in=campaign.bench)
    except _Known as known:
        found = excess_phase.excess_phases(*known.args)
    own = campaign.tests.assign(log_modulus=campaign.own.real, phase=np.degrees(campaign.own.imag))
    measured = table.assign(log_modulus=np.log(table["E_MPa"]), phase=table["phase_deg"])
    for one in found:
        yield {
            "table": campaign.name,
            "bench": campaign.bench,
            "law": campaign.about["law"],
            "temperature_C": one.temperature,
            "excess_deg": np.degrees(one.excess),
            "standard_error_deg": np.degrees(one.std_error),
            "by_slope_deg": of_specimens(by_slope, measured, one.temperature),
            "best_possible_deg": of_specimens(by_errors, own, one.temperature),
        }


Sweep = Callable[[np.ndarray, np.ndarray, np.ndarray], float]


def of_specimens(estimate: Sweep, table: pd.DataFrame, temperature: float) -> float:
    """Mean of an estimate over the specimens tested at three frequencies or more at this temperature."""
    isotherm = table[table["temperature_C"] == temperature]
    sweeps = isotherm.groupby(["specimen", "frequency_Hz"])[["log_modulus", "phase"]].mean()
    each = [
        estimate(np.log(own.index.get_level_values(1).to_numpy()), *own.to_numpy().T)
        for _, own in sweeps.groupby(level=0)
        if len(own) >= excess_phase.LEAST
    ]
    return float(np.mean(each))


def by_slope(log_f: np.ndarray, log_modulus: np.ndarray, phase: np.ndarray) -> float:
    """Phase in the middle less 90 degrees times the slope between the ends [deg]."""
    slope = (log_modulus[-1] - log_modulus[0]) / (log_f[-1] - log_f[0])
    return float(np.interp(0.5 * (log_f[0] + log_f[-1]), log_f, phase) - 90.0 * slope)


def by_errors(log_f: np.ndarray, log_modulus: np.ndarray, phase: np.ndarray) -> float:
    """Mean of the phases less 90 degrees times the slope [deg], by least squares, of errors alone."""
    return float(phase.mean() - 90.0 * np.polyfit(log_f, log_modulus, 1)[0])


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Rates with their intervals, and whether they are as asked for."""
    held = np.abs(table["excess_deg"] / table["standard_error_deg"]) < 1.96
    hot = (table["bench"] == CYLINDER) & (table["temperature_C"] > HOT)
    own, by_slope, best = (table[f"{name}_deg"] for name in ("excess", "by_slope", "best_possible"))

    def near(what: str, off: pd.Series, target: float = 0.0) -> dict[str, object]:
        asked = f">= {100.0 * target:g} %" if target else "reported"
        return line(what, asked, np.abs(off) < NEAR, target)

    lines = [
        line("isotherms whose 95 % interval holds no excess", "93 - 98 %", held, *HOLDS),
        line(f"the same, of cylinders above {HOT:g} degC", "93 - 98 %", held[hot], *HOLDS),
        near(f"excess within {NEAR:g} deg of that by the slope", own - by_slope, 0.95),
        near(f"best possible excess within {NEAR:g} deg of that by the slope", best - by_slope),
        near(f"excess within {NEAR:g} deg of none", own),
        near(f"excess by the slope within {NEAR:g} deg of none", by_slope),
        near(f"best possible excess within {NEAR:g} deg of none", best),
        *(near(f"the same, with {less:g} times these errors", less * best) for less in LESS),
        line("tables that would be taken for a mix that is not linear", "<= 5 %", _spoken(table), 0.0, 0.05),
    ]
    return pd.DataFrame(lines)


def _spoken(table: pd.DataFrame) -> pd.Series:
    above = table["excess_deg"] > excess_phase.SPEAKS * table["standard_error_deg"]
    return above.groupby(table["table"]).any()


@click.command()
@click.argument("tables", type=int)
@click.option("--folder", required=True, type=click.Path(path_type=Path))
def main(tables: int, folder: Path) -> None:
    """Try so many TABLES."""
    sound = islice(sound_campaigns(SEED), tables)
    table = pd.DataFrame([row for campaign in sound for row in rows(campaign)])
    write_table(folder / "excess.csv", table.round(4))
    write_table(folder / "summary.csv", summary(table))


if __name__ == "__main__":
    main()
