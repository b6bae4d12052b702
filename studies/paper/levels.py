"""|E*| over that of the law at each temperature, with the strength of 2.7 MPa and without, under two readings."""

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_table
from asphalt_nscd.reporting.tables.table4 import read_errors
from studies.paper.bond_readings import OURS

LIKELIEST = "dmin after the reduction of volume, looser layer"


def make(simulations: str | Path, likely: str | Path, errors: str | Path) -> pd.DataFrame:
    """One row for each reading and temperature.

    simulations: the tests of the study; likely: those of one of its samples, packed and bonded as the authors most
    likely did. unbroken: mean ratio of all tests of the reading that break no bond, as if the strength had no end: then
    geometry and law separate, and one ratio holds at all temperatures. E_over_law: mean at this temperature, breaks and
    all; expected: of all samples, where the reading was tested in one. allowed: whether the authors' mean of as many
    samples could be one within the printed error and twice both standard errors, as in bond_readings.csv.
    """
    printed = read_errors(errors).set_index("temperature_C")["mre_E_percent"]
    ours, theirs = _with_ratio(simulations), _with_ratio(likely)
    by_sample = ours.groupby("specimen")["ratio"].mean()
    several = len(by_sample) > 1
    error = 100.0 * by_sample.std() / np.sqrt(len(by_sample)) if several else 0.0
    # The other reading was tested in one sample: its ratio is taken to differ from the mean as ours does there.
    others = by_sample.mean() / by_sample[str(theirs["specimen"].iloc[0]).partition("-")[0]]
    rows = []
    for reading, tests, scale in ((OURS, ours, 1.0), (LIKELIEST, theirs, others)):
        unbroken = float(tests.loc[tests["broken_bonds"] == 0, "ratio"].mean())
        for temperature, some in tests.groupby("temperature_C"):
            ratio = float(some["ratio"].mean())
            far = 100.0 * abs(scale * ratio - 1.0)
            rows.append(
                {
                    "reading": reading,
                    "temperature_C": temperature,
                    "samples": some["specimen"].nunique(),
                    "broken_bonds": int(some["broken_bonds"].sum()),
                    "unbroken": unbroken,
                    "E_over_law": ratio,
                    "expected": scale * ratio,
                    "published_E_percent": printed[temperature],
                    # sqrt(2): their mean of as many samples scatters as ours does.
                    "allowed": bool(far <= printed[temperature] + 2.0 * np.sqrt(2.0) * error),
                }
            )
    return pd.DataFrame(rows)


def _with_ratio(path: str | Path) -> pd.DataFrame:
    tests = pd.read_csv(path)
    return tests.assign(ratio=tests["E_MPa"] / tests["E_law_MPa"])


if __name__ == "__main__":
    run_table(globals()["snakemake"], make)
