"""A mix whose binder is known by its penetration grade alone: the paper's, against the laws of its Table 3.

Stiffness of a binder after mixing by Ullidtz & Larsen (1983), a fit to van der Poel's nomograph, from its penetration
before: 0.01 to 0.1 s, 20 to 60 K below the softening point, index of penetration -1 to 1. It gives no phase; over the
time of loading it is a power law, whose phase is that of its exponent.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.recipe import Grading, Recipe, read_recipe
from asphalt_nscd.forecasting.scheme import modulus_of_mix
from asphalt_nscd.rheology.published_laws import read_published

# S = 1.157e-7 t^-0.368 exp(-index) (softening point - T)^5 [MPa], with t = 1 / omega.
EXPONENT = 0.368
TIMES, BELOW = (0.01, 0.1), (20.0, 60.0)  # s; K under the softening point
PENETRATIONS = {"soft": 50.0, "middle": 42.0, "hard": 35.0}  # 0.1 mm, of a 35/50
FREQUENCIES = (3.0, 6.0, 10.0)  # Hz of the paper, of a time of loading 1 / omega in TIMES


def softening_point(penetration: float) -> float:
    """Ring and ball [degC] of the binder in the mix, 98.4 - 26.4 log10(0.65 penetration) (Ullidtz & Larsen 1983).

    `penetration` is that before mixing [0.1 mm], of which mixing leaves 0.65.
    """
    # Mixing hardens a binder: 0.65 of its penetration is left.
    return 98.4 - 26.4 * float(np.log10(0.65 * penetration))


def stiffness(penetration: float, temperature: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """E* of the binder in the mix (Ullidtz & Larsen 1983), complex (n,) [Pa]; NaN where none is known.

    `penetration` before mixing [0.1 mm], `temperature` (n,) [degC], `omega` (n,) [rad/s].
    """
    log = np.log10(penetration)
    index = (27.0 * log - 21.65) / (76.35 * log - 232.82)
    below = softening_point(penetration) - np.asarray(temperature, float)
    modulus = 1e6 * 1.157e-7 * omega**EXPONENT * np.exp(-index) * np.maximum(below, 0.0) ** 5
    known = (below >= BELOW[0]) & (below <= BELOW[1]) & (1 / omega >= TIMES[0]) & (1 / omega <= TIMES[1])
    return np.where(known, modulus, np.nan) * np.exp(0.5j * np.pi * EXPONENT)


def compare_paper(grading: str | Path, laws: str | Path, recipe: Recipe) -> pd.DataFrame:
    """The paper's mix forecast from the grade of its binder, beside Table 3: |E*| [MPa] and phase of each point.

    All else is that of the recipe: the paper gives neither binder content nor air voids nor densities. `grading` is a
    CSV of diameter_mm, passing_percent; `laws` a CSV as Table 3.
    """
    table = read_csv(grading)
    table.require(["diameter_mm", "passing_percent"])
    sieve = 1e-3 * table.numbers("diameter_mm", Limits(1e-3, 100.0, "give it in mm"))
    passing = 0.01 * table.numbers("passing_percent", Limits(0.0, 100.0, "give per cent that passes"))
    order = np.argsort(sieve)
    own = replace(recipe, grading=Grading(sieve[order], passing[order]), file=str(grading))
    rows = []
    for temperature, law in zip(*read_published(laws), strict=True):
        omega = 2.0 * np.pi * np.array(FREQUENCIES)
        binder = np.array([stiffness(one, temperature, omega) for one in PENETRATIONS.values()])
        known = np.isfinite(binder).all(axis=0)
        measured = law.complex_modulus(omega[known])
        made = np.array([modulus_of_mix(own, of[known]) for of in binder])
        middle = made[list(PENETRATIONS).index("middle")]
        for k, frequency in enumerate(np.array(FREQUENCIES)[known]):
            row = {"temperature_C": temperature, "frequency_Hz": frequency}
            moduli = dict(zip(["table3", *PENETRATIONS], [measured, *made], strict=True))
            row |= {f"E_{name}_MPa": 1e-6 * abs(found[k]) for name, found in moduli.items()}
            row["phase_table3_deg"] = np.degrees(np.angle(measured[k]))
            rows.append(row | {"phase_middle_deg": np.degrees(np.angle(middle[k]))})
    return pd.DataFrame(rows)


def run(job: Any) -> None:
    """From the files of the rule to its tables."""
    given, made = job.input, job.output
    write_table(made[0], compare_paper(given.grading, given.laws, read_recipe(given.recipe)))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
