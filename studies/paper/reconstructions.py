"""What Table 4 says of the reconstructed measurements: drawn many times, and held against it without any simulation."""

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_table
from asphalt_nscd.reporting.tables.table4 import read_errors
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.reconstruct import fit_published
from asphalt_nscd.rheology.sampling import FREQUENCIES, Sampling

DRAWS = 200
FACTOR = 2.0  # of the printed error
USUAL = Sampling(seed=0)


def make(laws: str | Path, errors: str | Path) -> pd.DataFrame:
    """One row for each temperature: errors of Table 3's laws against draws of `reconstruct`, in percent.

    smooth_law: against the law behind them, without scatter; lowest, highest: bounds of 95 % of DRAWS draws; above:
    share of draws with a larger error than printed; within: share that lies within a FACTOR of the printed error at
    every temperature, the same in each row.
    """
    temperatures, published = read_published(laws)
    printed = read_errors(errors).set_index("temperature_C").loc[temperatures]
    omega = 2.0 * np.pi * np.array(FREQUENCIES)
    known = np.log(np.array([law.complex_modulus(omega) for law in published]))
    law = fit_published(laws)[1].law
    smooth = np.log(np.array([law.complex_modulus(omega, t) for t in temperatures]))
    table = pd.DataFrame({"temperature_C": temperatures})
    drawn = [_missed(known, smooth + _scatter(seed, smooth.shape)) for seed in range(DRAWS)]
    for k, quantity in enumerate(("E", "phase")):
        found = np.array([errors[k] for errors in drawn])
        wanted = printed[f"mre_{quantity}_percent"].to_numpy()
        low, high = np.quantile(found, [0.025, 0.975], axis=0)
        inside = ((found > wanted / FACTOR) & (found < wanted * FACTOR)).all(axis=1)
        columns = {
            "published": wanted,
            "smooth_law": _missed(known, smooth)[k],
            "lowest": low,
            "highest": high,
            "above": 100.0 * (found > wanted).mean(axis=0),
            "within": 100.0 * inside.mean(),
        }
        table = table.assign(**{f"{name}_{quantity}_percent": value for name, value in columns.items()})
    return table


def _missed(law: np.ndarray, data: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean relative errors in percent (t,) of |E*| and phase of laws against data, both ln E* (t, f)."""
    apart = law - data
    norm, phase = np.abs(np.expm1(apart.real)), np.abs(apart.imag / data.imag)
    return 100.0 * norm.mean(axis=1), 100.0 * phase.mean(axis=1)


def _scatter(seed: int, shape: tuple[int, ...]) -> np.ndarray:
    """Of averages over the specimens of `reconstruct`: of ln E*."""
    random, of_mean = np.random.default_rng([seed, 4]), np.sqrt(USUAL.specimens)
    level = USUAL.specimen_scatter * random.standard_normal()
    norm, phase = random.standard_normal((2, *shape))
    return (level + USUAL.modulus_scatter * norm + 1j * np.radians(USUAL.phase_scatter_deg) * phase) / of_mean


if __name__ == "__main__":
    run_table(globals()["snakemake"], make)
