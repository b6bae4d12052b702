"""The fit of one law to tests at all temperatures, by their number.

python benchmarks/law.py --output ROWS.csv
"""

from __future__ import annotations

import argparse

import numpy as np
from rows import Clock, write_rows

from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.priors import ASPHALT_CONCRETE
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_fitting import fit_spectrum

TOPIC = "fit of a law"
LAW = TwoS2P1D(80e6, 42e9, 0.2, 0.6, 1.64, 0.14, 28.0, WLF(11.7, 79.9, 15.0))
SCATTER = 0.02
TESTS = 54, 120, 1000
BANDS = {"-10 to 50 degC": [-10.0, 5.0, 20.0, 35.0, 50.0], "45 to 55 degC": [45.0, 50.0, 55.0]}


def row(tests: int, band: str) -> dict[str, object]:
    """A fit with the prior of asphalt concrete."""
    random = np.random.default_rng(tests)
    omega = 2.0 * np.pi * np.exp(random.uniform(np.log(0.1), np.log(25.0), tests))
    temperature = random.choice(BANDS[band], tests)
    noise = SCATTER * random.standard_normal((2, tests))
    modulus = LAW.complex_modulus(omega, temperature) * np.exp(noise[0] + 1j * noise[1])
    clock = Clock()
    fit = fit_spectrum(omega, temperature, modulus, 15.0, prior=ASPHALT_CONCRETE)
    remark = f"from the prior: {', '.join(fit.from_prior) or 'nothing'}"
    return {"topic": TOPIC, "case": f"{tests} tests, {band}", "remark": remark} | clock.row()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", required=True)
    output = parser.parse_args().output
    write_rows(output, [row(tests, band) for tests in TESTS for band in BANDS])
