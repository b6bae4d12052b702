"""A diagnosis by `asphalt-nscd diagnose`, start of the program included, by the number of tests.

python benchmarks/diagnosis.py NUMBER... --output ROWS.csv

The tables are drawn like real ones (trials/drawn/reallike.py), two hot isotherms break causality: more is left than
scatter, so that every cause is judged beside a discrepancy.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from rows import run, write_rows

import asphalt_nscd

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "trials"))

from drawn.design import factorial
from drawn.laws import draw_law
from drawn.reallike import KINDS, Sizes

TOPIC = "diagnosis"
SEED = 7
SIZES = Sizes(0.02, np.radians(0.4), 0.04, 0.012)
# The program of this package, not of another one that is installed.
SOURCE = str(Path(asphalt_nscd.__file__).parents[1])
START = f"import sys; sys.path.insert(0, {SOURCE!r}); from asphalt_nscd.cli import main; main()"
DESIGNS = {  # specimens, temperatures [degC], frequencies: as an AMPT, as the paper, as a year's work
    54: (3, (4.0, 21.0, 37.0), 6),
    120: (4, (-10.0, 0.0, 10.0, 15.0, 20.0, 30.0), 5),
    1000: (10, tuple(np.linspace(-15.0, 57.0, 10).round(1)), 10),
}


def table(tests: int) -> pd.DataFrame:
    """Moduli and phases of a mix with scatter, odd levels and hot isotherms that break causality."""
    rng = np.random.default_rng(SEED)
    specimens, temperatures, frequencies = DESIGNS[tests]
    band = np.geomspace(0.1, 25.0, frequencies).round(3).tolist()
    design = factorial([f"S{k + 1}" for k in range(specimens)], list(temperatures), band)
    omega = 2.0 * np.pi * design["frequency_Hz"].to_numpy(float)
    law = replace(draw_law(rng), shift="wlf", shift_parameters={"c1": 13.0, "c2": 110.0})
    modulus = law.modulus(omega, design["temperature_C"].to_numpy(float))
    level = rng.normal(0.0, SIZES.specimen, specimens)[pd.factorize(design["specimen"])[0]]
    scatter = SIZES.modulus * rng.standard_normal(omega.size) + 1j * SIZES.phase * rng.standard_normal(
        omega.size
    )
    logarithm = np.log(modulus) + KINDS["broken_hot"](design, SIZES, rng) + level + scatter
    measured = design[["specimen", "temperature_C", "frequency_Hz"]]
    return measured.assign(
        E_MPa=1e-6 * np.exp(logarithm.real), phase_deg=np.degrees(logarithm.imag).clip(0.5)
    )


def row(tests: int) -> dict[str, object]:
    """The whole command on one table."""
    with tempfile.TemporaryDirectory() as folder:
        measured = Path(folder, "measured.csv")
        table(tests).to_csv(measured, index=False)
        command = [sys.executable, "-c", START, "diagnose", str(measured), "--output", folder]
        cpu, memory, _ = run(command, folder)
        written = Path(folder, "diagnosis.json").stat().st_size
    return {
        "topic": TOPIC,
        "case": f"{tests} tests",
        "cpu_s": cpu,
        "memory_MB": memory,
        "remark": f"with the start of the program; diagnosis.json of {written // 1024} kB",
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tests", type=int, nargs="+", choices=DESIGNS)
    parser.add_argument("--output", required=True)
    told = parser.parse_args()
    write_rows(told.output, [row(tests) for tests in told.tests])
