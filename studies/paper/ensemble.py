"""What one law for all temperatures gains on data that have Table 3 as their fit and Table 4 as its errors."""

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_table
from asphalt_nscd.reporting.tables.rivals import KINDS, REFERENCE, errors_of
from asphalt_nscd.rheology.reconstruct import fit_published
from asphalt_nscd.rheology.rivals import rivals
from studies.paper.consistent import draws, nearest_law
from studies.paper.smoothness import printed

DRAWS = 20
SEED = 2020


def make(laws: str | Path, errors: str | Path) -> pd.DataFrame:
    """One row for each kind of tests: mean relative errors in percent, mean over temperatures.

    burgers: of the laws of Table 3, the same on all these data. nearest: of a 2S2P1D law fitted to the data nearest to
    one; mean, lowest, highest: of such laws over DRAWS draws. fitted: errors of what the law was fitted to; each other
    kind: of what was left out, as in rivals.csv.
    """
    temperatures, known = zip(*printed(laws, errors), strict=True)
    temperature, omega = np.array(temperatures), known[0].omega
    smooth = fit_published(laws)[1].law
    start = np.log(np.array([smooth.complex_modulus(omega, t) for t in temperature]))
    law, distance = nearest_law(known, temperature, start, REFERENCE)
    # The first is the nearest law itself, at no distance from it.
    data = np.concatenate([draws(known, law, 0.0, 1, SEED), draws(known, law, distance, DRAWS, SEED)])
    each, every = np.tile(omega, temperature.size), np.repeat(temperature, omega.size)
    found = pd.DataFrame(
        dict(errors_of(next(rivals(each, every, modulus, REFERENCE)), each, every, modulus))
        for modulus in np.exp(data).reshape(len(data), -1)
    )
    table = pd.DataFrame({"tests": KINDS})
    for quantity, printed_error in (("E", "error"), ("phase", "phase_error")):
        over = found[[(kind, quantity) for kind in KINDS]]
        drawn = over.iloc[1:]
        mean = 100.0 * np.mean([getattr(one, printed_error) for one in known])
        columns = {
            "burgers": [mean, *[np.nan] * (len(KINDS) - 1)],
            "nearest": over.iloc[0].to_numpy(),
            "mean": drawn.mean().to_numpy(),
            "lowest": drawn.min().to_numpy(),
            "highest": drawn.max().to_numpy(),
        }
        table = table.assign(**{f"{name}_{quantity}_percent": value for name, value in columns.items()})
    return table.assign(distance_percent=100.0 * distance)


if __name__ == "__main__":
    run_table(globals()["snakemake"], make)
