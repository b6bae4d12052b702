"""Can smooth data have Table 3 as their Burgers fit and Table 4 as its errors? Bounds, temperature by temperature."""

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_table
from asphalt_nscd.reporting.tables.table4 import read_errors
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.sampling import FREQUENCIES
from studies.paper.smooth_bounds import Printed, least_scatter, phase_error

WEIGHTS = (0.3, 1.0, 2.0, 10.0)  # of the phase in the fit; the paper does not say what it minimised


def make(laws: str | Path, errors: str | Path) -> pd.DataFrame:
    """One row for each weight and temperature, in percent.

    phase_weight: of the phase in the fit, relative to that of ln|E*|. smallest, largest: errors of the phase that
    smooth data can have, if Table 3 is their fit and the error of |E*| the printed one; none where there are no such
    data. scatter: by how much of ln E* some point must lie off every smooth law for both errors to be the printed ones;
    0.01 is 1 % of |E*| and 0.6 deg.
    """
    rows = []
    for weight in WEIGHTS:
        for temperature, one in printed(laws, errors, weight):
            rows.append(
                {
                    "phase_weight": weight,
                    "temperature_C": temperature,
                    "published_E_percent": 100.0 * one.error,
                    "published_phase_percent": 100.0 * one.phase_error,
                    "smallest_phase_percent": 100.0 * phase_error(one, largest=False),
                    "largest_phase_percent": 100.0 * phase_error(one, largest=True),
                    "scatter_percent": round(100.0 * least_scatter(one), 4),
                }
            )
    return pd.DataFrame(rows)


def printed(laws: str | Path, errors: str | Path, weight: float = 1.0) -> list[tuple[float, Printed]]:
    """Temperature [degC] of each law of Table 3, with the errors of Table 4 at the frequencies of the paper."""
    temperatures, burgers = read_published(laws)
    missed = read_errors(errors).set_index("temperature_C").loc[temperatures] / 100.0
    omega = 2.0 * np.pi * np.array(FREQUENCIES)
    return [
        (float(t), Printed(law, omega, norm, phase, weight))
        for t, law, norm, phase in zip(
            temperatures, burgers, missed["mre_E_percent"], missed["mre_phase_percent"], strict=True
        )
    ]


if __name__ == "__main__":
    run_table(globals()["snakemake"], make)
