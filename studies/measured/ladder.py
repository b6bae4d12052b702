"""Laws of nine measured mixes, one after another, on the same tests and by one objective.

The rungs: a Burgers law at each temperature, as in the paper; one 2S2P1D law for all temperatures; that law read as a
machine reads a haversine without a term for the drift, which has no further parameter; and, beside them, the rival of
that reading, one constant added to all phases. Norm and phase count alike. Tests are averages over the specimens, at
each temperature and frequency. Of two temperatures that are left of three, the shift is Arrhenius', else WLF's.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import minimize_scalar

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import write_table
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.fitting import fit_burgers
from asphalt_nscd.rheology.spectrum import Spectrum, parameters
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from studies.measured.reading import log_reading

REFERENCE = 20.0  # degC
ROUNDS = 3  # of the fit of a law to what is read of it
LARGEST = -0.1, 0.2  # rad: an offset of -6 to 11 degrees
Modulus = Callable[[np.ndarray, np.ndarray], np.ndarray]  # E* [Pa] at omega [rad/s] and temperature [degC]


def burgers(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> tuple[Modulus, int]:
    """A Burgers law at each temperature; elsewhere the logarithms of its parameters follow straight lines."""
    at = np.unique(temperature)
    laws = [fit_burgers(omega[temperature == t], modulus[temperature == t]).law for t in at]
    logarithms = np.log([list(parameters(law).values()) for law in laws])

    def law(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        values = [
            Burgers(*np.exp([_line(t, at, column) for column in logarithms.T])).complex_modulus(w)
            for w, t in zip(omega, temperature, strict=True)
        ]
        return np.array(values)

    return law, 4 * at.size


def _line(place: float, at: np.ndarray, values: np.ndarray) -> float:
    """Value on the straight line through the two places that are nearest in their order."""
    right = int(np.clip(np.searchsorted(at, place), 1, at.size - 1))
    share = (place - at[right - 1]) / (at[right] - at[right - 1])
    return float(values[right - 1] + share * (values[right] - values[right - 1]))


def spectrum(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> tuple[Spectrum, int]:
    """One 2S2P1D law for all temperatures, and how many parameters it has."""
    form = Form(shift="wlf" if np.unique(temperature).size > 2 else "arrhenius")
    law = fit_spectrum(omega, temperature, modulus, REFERENCE, form).law
    return law, len(parameters(law)) + len(parameters(law.shift))


def one_law(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> tuple[Modulus, int]:
    """The same, as a function of omega and temperature."""
    law, fitted = spectrum(omega, temperature, modulus)
    return law.complex_modulus, fitted


def as_run(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> tuple[Modulus, int]:
    """The same law, fitted so that what the machine reads of it is what was measured."""
    law, fitted = spectrum(omega, temperature, modulus)
    for _ in range(ROUNDS):
        law, _ = spectrum(omega, temperature, modulus / np.exp(log_reading(law, omega, temperature)))

    def read(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return np.asarray(
            law.complex_modulus(omega, temperature) * np.exp(log_reading(law, omega, temperature))
        )

    return read, fitted


def phase_offset(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> tuple[Modulus, int]:
    """The same law, and one constant added to all phases."""

    def misfit(offset: float) -> float:
        turned = modulus * np.exp(-1j * offset)
        law, _ = one_law(omega, temperature, turned)
        return float((np.abs(np.log(turned / law(omega, temperature))) ** 2).sum())

    offset = float(minimize_scalar(misfit, bounds=LARGEST, method="bounded", options={"xatol": 1e-4}).x)
    law, fitted = one_law(omega, temperature, modulus * np.exp(-1j * offset))
    return lambda omega, temperature: law(omega, temperature) * np.exp(1j * offset), fitted + 1


RUNGS = {"burgers": burgers, "one_law": one_law, "as_run": as_run, "phase_offset": phase_offset}


def averages(table: pd.DataFrame) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """omega [rad/s], temperature [degC] and E* [Pa], means over the specimens at each temperature and frequency."""
    means = table.groupby(["temperature_C", "frequency_Hz"])[["E_MPa", "phase_deg"]].mean().reset_index()
    modulus = 1e6 * means["E_MPa"].to_numpy() * np.exp(1j * np.radians(means["phase_deg"].to_numpy()))
    return 2.0 * np.pi * means["frequency_Hz"].to_numpy(), means["temperature_C"].to_numpy(), modulus


def errors(law: Modulus, table: pd.DataFrame) -> np.ndarray:
    """Relative errors (n, 2) of |E*| and of the phase in percent, of the averages of a table."""
    omega, temperature, modulus = averages(table)
    seen = law(omega, temperature)
    norm = np.abs(np.abs(seen) / np.abs(modulus) - 1.0)
    return 100.0 * np.column_stack([norm, np.abs(np.angle(seen) / np.angle(modulus) - 1.0)])


def rows(mix: str, table: pd.DataFrame) -> list[dict[str, Any]]:
    """One row for each rung: errors in sample, and of what was left out, one isotherm or one specimen at a time."""
    found = []
    for name, rung in RUNGS.items():
        law, fitted = rung(*averages(table))
        row: dict[str, Any] = {"mix": mix, "rung": name, "fitted": fitted}
        row |= _named("", errors(law, table))
        for key, kind in (("temperature_C", "isotherm"), ("specimen", "specimen")):
            left = [
                errors(rung(*averages(table[table[key] != value]))[0], table[table[key] == value])
                for value in table[key].unique()
            ]
            row |= _named(f"left_out_{kind}_", np.vstack(left))
        found.append(row)
    return found


def _named(prefix: str, parts: np.ndarray) -> dict[str, float]:
    return dict(zip((f"{prefix}E_percent", f"{prefix}phase_percent"), parts.mean(axis=0), strict=True))


def run(job: Any) -> None:
    """ladder.csv of the mixes, and means.csv over them."""
    tables = {Path(path).stem: pd.read_csv(path, comment="#") for path in job.input.mixes}
    ladder = pd.DataFrame([row for mix, table in tables.items() for row in rows(mix, table)])
    write_table(job.output.ladder, ladder)
    means = ladder.drop(columns="mix").groupby("rung", sort=False).mean().reset_index()
    write_table(job.output.means, means)


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
