"""Bending tests on a specimen whose bonds are films between grains that touch: by time steps, by frequency, by one map.

python benchmarks/films.py SPECIMEN.h5 --recipe RECIPE.yaml --packings FOLDER --output ROWS.csv

The specimen's spheres are the stones of the recipe in the mortar that the forecast makes of it; the law of a bond is
that of the forecast (docs/film.md), air voids and dry contacts with it. Stepping knows it by a Kelvin chain for each
class of bonds, the frequency domain as it is, the map by 23 static solutions with real moduli; of the twelve among
them that a forecast takes, it is told how far their map is from this one. The shift of the binder over temperature is
not in its source: 150 kJ/mol are taken.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import load, write_table
from asphalt_nscd.forecasting.forecast import Networks, Settings, kept_in, modulus_of, physics_of
from asphalt_nscd.forecasting.network import Contents, bond_stiffness
from asphalt_nscd.forecasting.recipe import read_recipe
from asphalt_nscd.forecasting.static_map import RATIOS, fit_map
from asphalt_nscd.forecasting.stepping import Stiffness, fit_bonds, harmonic_stiffness, step_test
from asphalt_nscd.measurements.twopoint import complex_modulus, norm_and_phase
from asphalt_nscd.specimen.contents import SPECIMEN
from asphalt_nscd.specimen.cutting import specimen_of
from asphalt_nscd.specimen.system import bending_system, facet_share
from asphalt_nscd.specimen.trimming import Specimen

TEMPERATURES, FREQUENCIES = (0.0, 15.0, 30.0), (3.0, 25.0)  # degC, Hz
BEYOND = 3.0  # of the band of the chains, over the frequencies of the tests
AMPLITUDE = 63e-6  # m, the paper's
AT_REST = 1e-6  # rad/s
DENSE = np.geomspace(RATIOS[0], RATIOS[-1], 2 * RATIOS.size - 1)  # every other is one of RATIOS


def stones(path: str) -> tuple[Specimen, Contents]:
    """The specimen; the same with its spheres as large as they were poured, and what share of it they fill."""
    record = load(path, SPECIMEN)
    specimen = specimen_of((record.arrays, record.attributes))
    poured = specimen.radius * (1.0 - record.attributes["volume_reduction"]) ** (-1.0 / 3.0)
    whole, network = specimen.geometry, specimen.network
    own = np.append(poured, np.zeros(len(whole.plates)))
    network = replace(network, gap=network.length - own[network.first] - own[network.second])
    volume = 0.5 * (whole.b + whole.B) * whole.e * whole.h
    filled = float(4.0 / 3.0 * np.pi * (poured**3).sum() / volume)
    return specimen, Contents(replace(specimen, radius=poured, network=network), filled)


def rows(specimen_file: str, recipe_file: str, packings: str) -> list[dict[str, object]]:
    """A row for each test."""
    (specimen, contents), recipe, settings = stones(specimen_file), read_recipe(recipe_file), Settings()
    grain = recipe.aggregate
    *finer, last = Networks(kept_in(packings)).chain(recipe, settings, 1)
    physics = physics_of(recipe, settings, last.level, last=True)
    share = np.tile(facet_share(specimen.geometry, 1.0), specimen.network.first.size)

    def of_ratio(ratio: np.ndarray) -> np.ndarray:
        return share * bond_stiffness(contents, last.level, grain, last.matrix_bulk, physics, ratio)

    def mortar(omega: np.ndarray, temperature: float) -> np.ndarray:
        binder = recipe.binder.complex_modulus(omega, temperature)
        return modulus_of(tuple(finer), grain, binder) / grain.modulus

    system = bending_system(specimen, 0.35, np.inf, 0.7)
    system = replace(system, load=np.zeros_like(system.load))  # the frequency domain knows no weight

    def norm(stiffness: complex, omega: float) -> tuple[float, float]:
        found = complex_modulus(
            specimen.geometry,
            omega / (2.0 * np.pi),
            AMPLITUDE * abs(stiffness),
            AMPLITUDE,
            np.angle(stiffness),
        )
        size, phase = norm_and_phase(complex(found))
        return float(size), float(phase)

    at_rest = [harmonic_stiffness(system, lambda _, own=own: own[None], AT_REST) for own in of_ratio(DENSE)]
    solved = np.array([norm(abs(one), AT_REST)[0] for one in at_rest]) / grain.modulus
    static, coarse = fit_map(solved, DENSE), fit_map(solved[::2])
    found = []
    for temperature in TEMPERATURES:

        def stiffness(omega: np.ndarray, temperature: float = temperature) -> np.ndarray:
            return of_ratio(mortar(omega, temperature))

        found += _tests(system, stiffness, temperature, norm)
        for row in found[-len(FREQUENCIES) :]:
            omega = 2.0 * np.pi * np.array([row["frequency_Hz"]])
            ratio = mortar(omega, temperature)
            mapped = grain.modulus * complex(static(ratio)[0])
            twelve = complex(coarse(ratio)[0] / static(ratio)[0])
            row["E_map_MPa"], row["phase_map_deg"] = abs(mapped) / 1e6, float(np.degrees(np.angle(mapped)))
            row["E_from_map_percent"] = 100.0 * (row["E_MPa"] / row["E_map_MPa"] - 1.0)
            row["phase_from_map_deg"] = row["phase_deg"] - row["phase_map_deg"]
            row["twelve_percent"], row["twelve_deg"] = (
                100.0 * (abs(twelve) - 1.0),
                float(np.degrees(np.angle(twelve))),
            )
            row |= {"spheres": specimen.radius.size, "bonds": system.gap.size, "map_error": static.error}
            print(row, flush=True)
    return found


def _tests(system, stiffness: Stiffness, temperature: float, norm) -> list[dict[str, object]]:
    """Those of a temperature, stepped and in the frequency domain."""
    band = 2.0 * np.pi * np.array([min(FREQUENCIES) / BEYOND, max(FREQUENCIES) * BEYOND])
    bonds, found = fit_bonds(system, stiffness, *band), []
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
            size, phase = norm(value, omega)
            row |= {f"E{name}_MPa": size / 1e6, f"phase{name}_deg": float(np.degrees(phase))}
        row |= {
            "E_difference_percent": 100.0 * (abs(ratio) - 1.0),
            "phase_difference_deg": float(np.degrees(np.angle(ratio))),
            "least_bond_MPa": float(np.quantile(np.abs(own), 0.01)) / 1e6,
            "largest_bond_MPa": float(np.quantile(np.abs(own), 0.99)) / 1e6,
            "least_bond_phase_deg": float(np.degrees(np.angle(own)).min()),
            "largest_bond_phase_deg": float(np.degrees(np.angle(own)).max()),
            "classes": len(bonds.laws.table),
            "elements": bonds.elements,
            "largest_bond_error_percent": 100.0 * bonds.largest_error,
            "rms_bond_error_percent": 100.0 * bonds.rms_error,
            "energy_error": abs(stepped.energies.error / stepped.energies.actuator),
            "cpu_s": cpu,
        }
        found.append(row)
    return found


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("specimen")
    parser.add_argument("--recipe", required=True)
    parser.add_argument("--packings", required=True)
    parser.add_argument("--output", required=True)
    given = parser.parse_args()
    write_table(given.output, pd.DataFrame(rows(given.specimen, given.recipe, given.packings)))
