"""Bending tests on a specimen whose bonds are films between elastic grains: by time steps and by frequency.

python benchmarks/films.py SPECIMEN.h5 --output ROWS.csv

Each bond has its own complex stiffness A / (gap / M + (l - gap) / Ea), M being the modulus of a synthetic mortar.
Stepping knows it by a Kelvin chain for each class of bonds, the frequency domain as it is.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import write_table
from asphalt_nscd.formulation.stepping import Stiffness, fit_bonds, harmonic_stiffness, step_test
from asphalt_nscd.measurements.twopoint import complex_modulus, norm_and_phase
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum import TwoS2P1D
from asphalt_nscd.specimen.preparation import read_specimen
from asphalt_nscd.specimen.system import bending_system, facet_share
from asphalt_nscd.specimen.trimming import Specimen

MORTAR = TwoS2P1D(
    1e6, 12e9, k=0.2, h=0.6, delta=2.2, tau=2e-3, beta=100.0, shift=WLF(20.0, 150.0, 15.0)
)  # synthetic
GRAIN = 60e9  # Pa
TEMPERATURES, FREQUENCIES = (0.0, 15.0, 30.0), (3.0, 25.0)  # degC, Hz
BEYOND = 3.0  # of the band of the chains, over the frequencies of the tests
AMPLITUDE = 63e-6  # m, the paper's


def films(specimen: Specimen, temperature: float) -> Stiffness:
    """Stiffness of all bonds at a temperature [degC]; normal and tangential alike."""
    network = specimen.network
    area = np.outer(network.area, facet_share(specimen.geometry, 1.0)).ravel()
    film = np.repeat(network.gap, 3)
    stone = np.repeat(network.length, 3) - film

    def stiffness(omega: np.ndarray) -> np.ndarray:
        modulus = MORTAR.complex_modulus(omega, temperature)[:, None]
        return np.asarray(area / (film / modulus + stone / GRAIN))

    return stiffness


def rows(specimen_file: str) -> list[dict[str, object]]:
    """A row for each test."""
    specimen = read_specimen(specimen_file)
    system = bending_system(specimen, 0.35, np.inf, 0.7)
    system = replace(system, load=np.zeros_like(system.load))  # the frequency domain knows no weight
    found = []
    for temperature in TEMPERATURES:
        stiffness = films(specimen, temperature)
        band = 2.0 * np.pi * np.array([min(FREQUENCIES) / BEYOND, max(FREQUENCIES) * BEYOND])
        bonds = fit_bonds(system, stiffness, *band)
        for frequency in FREQUENCIES:
            omega = 2.0 * np.pi * frequency
            began = time.process_time()
            stepped = step_test(bonds, frequency, AMPLITUDE)
            cpu = time.process_time() - began
            exact = harmonic_stiffness(system, stiffness, omega)
            ratio = stepped.stiffness / exact
            own = stiffness(np.array([omega]))[0] / system.weight
            row: dict[str, object] = {"temperature_C": temperature, "frequency_Hz": frequency}
            for name, value in (("", stepped.stiffness), ("_frequency_domain", exact)):
                modulus = complex_modulus(
                    specimen.geometry, frequency, AMPLITUDE * abs(value), AMPLITUDE, float(np.angle(value))
                )
                norm, phase = norm_and_phase(complex(modulus))
                row |= {f"E{name}_MPa": float(norm) / 1e6, f"phase{name}_deg": float(np.degrees(phase))}
            row |= {
                "E_difference_percent": 100.0 * (abs(ratio) - 1.0),
                "phase_difference_deg": float(np.degrees(np.angle(ratio))),
                "least_bond_MPa": float(np.abs(own).min()) / 1e6,
                "largest_bond_MPa": float(np.abs(own).max()) / 1e6,
                "least_bond_phase_deg": float(np.degrees(np.angle(own)).min()),
                "largest_bond_phase_deg": float(np.degrees(np.angle(own)).max()),
                "spheres": specimen.radius.size,
                "bonds": system.gap.size,
                "classes": len(bonds.laws.table),
                "elements": bonds.elements,
                "largest_bond_error_percent": 100.0 * bonds.largest_error,
                "rms_bond_error_percent": 100.0 * bonds.rms_error,
                "energy_error": abs(stepped.energies.error / stepped.energies.actuator),
                "cpu_s": cpu,
            }
            found.append(row)
            print(row, flush=True)
    return found


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("specimen")
    parser.add_argument("--output", required=True)
    given = parser.parse_args()
    write_table(given.output, pd.DataFrame(rows(given.specimen)))
