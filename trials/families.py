"""Measurements drawn from a family of laws that the simulation does not fit, as a table for `diagnose`.

    python -m families huet_sayegh --seed 2020 --temperatures=-10,0,15 --frequencies 3,10,40 --output measured.csv

The reconstructed measurements are drawn from 2S2P1D with a WLF shift, and the extended simulation fits just that. These
are the same design and scatter about another mix: Huet-Sayegh with an Arrhenius shift, a ladder of Maxwell branches
whose weights are skewed with a WLF shift, or Havriliak-Negami with a quadratic shift. Huet-Sayegh is 2S2P1D without its
dashpot, and Arrhenius is WLF with C2 = 288 K at 15 degC, so that only the others are outside the fitted family. The
laws are those of `drawn`; nothing of the package under test is imported.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from drawn.design import factorial
from drawn.laws import CENTRES, Law

SHIFTS = {
    "huet_sayegh": ("arrhenius", {"energy": 200e3}),  # J/mol
    "maxwell_ladder": ("wlf", {"c1": 15.0, "c2": 120.0}),
    "havriliak_negami": ("quadratic", {"slope": 0.125, "bend": 1.0 / 120.0}),  # decades/K, 1/K
}
SPECIMEN_SCATTER, MODULUS_SCATTER, PHASE_SCATTER = 0.03, 0.01, np.radians(0.3)  # of the reconstruction
SPECIMENS = "1234"


def law(family: str) -> Law:
    """The mix of a family."""
    return Law(family, CENTRES[family], *SHIFTS[family])


def draw(family: str, temperatures: Sequence[float], frequencies: Sequence[float], seed: int) -> pd.DataFrame:
    """Moduli of specimens "1" to "4" about the law: specimen, temperature_C, frequency_Hz, E_MPa, phase_deg, origin."""
    parts = []
    for number, specimen in enumerate(SPECIMENS):
        rng = np.random.default_rng([seed, list(SHIFTS).index(family), number])
        tests = factorial([specimen], temperatures, frequencies)
        true = np.log(law(family).modulus(2.0 * np.pi * tests["frequency_Hz"], tests["temperature_C"]))
        norm = true.real + SPECIMEN_SCATTER * rng.standard_normal()
        norm = norm + MODULUS_SCATTER * rng.standard_normal(true.size)
        phase = true.imag + PHASE_SCATTER * rng.standard_normal(true.size)
        parts.append(tests.assign(E_MPa=np.exp(norm) * 1e-6, phase_deg=np.degrees(phase), origin="synthetic"))
    return pd.concat(parts, ignore_index=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("family", choices=SHIFTS)
    parser.add_argument("--seed", type=int, required=True)
    for name in ("temperatures", "frequencies"):
        parser.add_argument(f"--{name}", type=lambda text: [float(x) for x in text.split(",")], required=True)
    parser.add_argument("--output", type=Path, required=True)
    given = parser.parse_args()
    given.output.parent.mkdir(parents=True, exist_ok=True)
    table = draw(given.family, given.temperatures, given.frequencies, given.seed)
    table.to_csv(given.output, index=False, float_format="%.10g", lineterminator="\n")


if __name__ == "__main__":
    main()
