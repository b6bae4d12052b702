"""What binder films that soften with strain do to a test: one number, from a published limit, and nothing fitted.

The limit of linear strain of binders, where |G*| has fallen by 5 %, is 12/|G*|^0.29 percent, |G*| in kPa (Anderson et
al. 1994, SHRP-A-369). Below it the fall is taken as proportional to strain. By the recipe of the forecast, a mix of
some |E*| has a binder of a certain |G*|; its mean square strain follows from how much |E*| hangs on it, c <g^2> =
e^2 dE/dG (Suquet 1995, the modified secant method). The mix then flows faster under stress, its clock by exp(b |s|),
b so that in tension-compression |E*| falls as the binder says; a haversine and its slope over frequency follow.
"""

from math import gamma
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.recipe import read_recipe
from asphalt_nscd.forecasting.scheme import binder_volume, modulus_of_mix
from asphalt_nscd.rheology.as_run import Programme

LIMIT = 0.12, 0.29, 1e3  # strain at 1 kPa, exponent, Pa: 12/|G*|^0.29 percent
FALL = 0.05  # of |G*| at the limit
BINDER = np.geomspace(1e3, 2e9, 60)  # E [Pa] of binders
SLOPES = np.linspace(0.02, 0.7, 18)
SLIGHT = 0.01  # b, for a derivative at none
TESTS = {name: Programme(name == "haversine", drift=True, samples=60) for name in ("haversine", "pulled")}


def binders(recipe: str | Path) -> pd.DataFrame:
    """For mixes of rising |E*|: |G*| of the binder, and the fall of ln|E*| in a test of a strain of one."""
    asked = read_recipe(recipe)
    mix = np.abs(modulus_of_mix(asked, BINDER))
    depends = np.gradient(np.log(mix), np.log(BINDER))
    shear = BINDER / 3.0
    strain = np.sqrt(depends * mix / shear / binder_volume(asked))  # of the binder, over that of the mix
    limit = LIMIT[0] / (shear / LIMIT[2]) ** LIMIT[1]
    fall = FALL * strain / limit * depends
    return pd.DataFrame(
        {"E_MPa": mix / 1e6, "G_MPa": shear / 1e6, "strain": strain, "limit": limit, "fall": fall}
    )


def clock() -> pd.DataFrame:
    """For a mix of each slope of ln|E*| over ln f: change of ln E* by b, in both tests."""
    rows = []
    for slope in SLOPES:
        row = {"slope": slope}
        for name, programme in TESTS.items():
            change = np.log(_read(slope, SLIGHT, programme) / _read(slope, 0.0, programme)) / SLIGHT
            row |= {f"{name}_lnE": change.real, f"{name}_deg": np.degrees(change.imag)}
        rows.append(row)
    return pd.DataFrame(rows)


def _read(slope: float, b: float, programme: Programme) -> complex:
    """E* that is read of a mix with the creep t^slope, its clock faster by exp(b |stress|); amplitudes are one."""
    angle = programme.angles()
    stress = programme.stress(angle)
    time = angle / (2.0 * np.pi)
    rate = np.exp(b * np.abs(stress))
    reduced = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time))])
    # product integration: stress is linear in reduced time within a step
    since = np.maximum(reduced[:, None] - reduced, 0.0) ** (slope + 1.0)
    rises = np.diff(stress) / np.diff(reduced)
    strain = (since[:, :-1] - since[:, 1:]) @ rises / gamma(slope + 2.0)
    return programme.phasor(stress, angle) / programme.phasor(strain, angle)


def run(job: Any) -> None:
    """binder.csv and clock.csv."""
    write_table(job.output.binder, binders(job.input.recipe))
    write_table(job.output.clock, clock())


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
