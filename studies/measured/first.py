"""How far what grains and films do lies from the first prediction, which was made before it was laid beside a mix.

The first tables (`predictions`) are of 495 stones and films of a forecast that has been replaced. Both are asked for
the mixes of the first tables, with an amplitude of 35e-6.
"""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import write_table
from studies.measured.mechanisms import NAMES, Mechanisms
from studies.measured.stated import AMPLITUDES

FIRST = SimpleNamespace(**{name: Path(__file__).parent / f"predictions/{name}.csv" for name in NAMES})


def compared(now: Mechanisms, first: Mechanisms) -> pd.DataFrame:
    """By |E*| and phase of a mix: changes of |E*| and phase by contacts and by softening, first and now."""
    amplitude = AMPLITUDES["ncat"]
    table = first.usual(amplitude)[["E_MPa", "phase_deg"]].reset_index(drop=True)
    modulus = 1e6 * table["E_MPa"].to_numpy() * np.exp(1j * np.radians(table["phase_deg"].to_numpy()))
    for mechanism in ("contacts", "softening"):
        for when, own in (("first_", first), ("", now)):
            change = getattr(own, mechanism)(modulus, amplitude)
            table[f"{when}{mechanism}_E_percent"] = 100.0 * change.real
            table[f"{when}{mechanism}_deg"] = np.degrees(change.imag)
    return table


def run(job: Any) -> None:
    """first.csv."""
    write_table(job.output[0], compared(Mechanisms(job.input), Mechanisms(FIRST)))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
