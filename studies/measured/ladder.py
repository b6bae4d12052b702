"""Laws of nine measured mixes, one after another, on the same tests and by one objective.

The rungs: a Burgers law at each temperature, as in the paper; one 2S2P1D law for all temperatures; that law read as a
machine reads a haversine without a term for the drift; with grains that slip beside it; with films that soften, too.
None of these three has a further parameter. Beside them the rival, one constant added to all phases. Norm and phase
count alike. Tests are averages over the specimens, at each temperature and frequency. Of two temperatures that are left
of three, the shift is Arrhenius', else WLF's. What is simulated is the law that was fitted to all tests, on a cylinder
of full size, pressed from rest as machines do; grains and films change it by their tables (`mechanisms.py`).
"""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.interpolate import make_interp_spline
from scipy.optimize import minimize_scalar

from asphalt_nscd.bending.excerpt import ModelExcerpt, read_excerpt
from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import write_table
from asphalt_nscd.rheology.as_run import Programme
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.fitting import fit_burgers
from asphalt_nscd.rheology.spectrum import Spectrum, parameters
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from studies.measured.mechanisms import Mechanisms
from studies.measured.reading import PROGRAMME, Modulus, chain_at, log_reading
from studies.measured.simulated import modulus_of_cylinder
from studies.measured.stated import AMPLITUDES

REFERENCE = 20.0  # degC
UNREAD = "burgers", "one_law", "phase_offset"  # rungs that say nothing of how a test is read
STEADY = Programme(haversine=False, cycles=10, read=5, drift=True)
ROUNDS = 3  # of the fit of a law to what is read of it
LARGEST = -0.1, 0.2  # rad: an offset of -6 to 11 degrees
Bonds = Callable[[np.ndarray, float], KelvinChain]  # the chain around omega at a temperature
Change = Callable[[Spectrum, np.ndarray, np.ndarray], np.ndarray]  # of ln E*, likewise


class Fit(NamedTuple):
    """What a rung says is measured, its number of parameters, the law of its bonds, and what changes it beside."""

    modulus: Modulus
    fitted: int
    bonds: Bonds
    beside: Modulus = lambda omega, temperature: np.ones(omega.size)


Rung = Callable[[np.ndarray, np.ndarray, np.ndarray], Fit]


def burgers(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> Fit:
    """A Burgers law at each temperature; elsewhere the logarithms of its parameters follow straight lines."""
    at = np.unique(temperature)
    laws = [fit_burgers(omega[temperature == t], modulus[temperature == t]).law for t in at]
    lines = make_interp_spline(at, np.log([list(parameters(law).values()) for law in laws]), k=1)

    def law_at(temperature: float) -> Burgers:
        return Burgers(*np.exp(lines(temperature)).tolist())

    def law(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return np.array([law_at(t).complex_modulus(w) for w, t in zip(omega, temperature, strict=True)])

    return Fit(law, 4 * at.size, lambda omega, temperature: law_at(temperature).kelvin_form())


def spectrum(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> tuple[Spectrum, int]:
    """One 2S2P1D law for all temperatures, and how many parameters it has."""
    form = Form(shift="wlf" if np.unique(temperature).size > 2 else "arrhenius")
    law = fit_spectrum(omega, temperature, modulus, REFERENCE, form).law
    return law, len(parameters(law))


def one_law(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> Fit:
    """The same, as a function of omega and temperature."""
    law, fitted = spectrum(omega, temperature, modulus)
    return Fit(law.complex_modulus, fitted, partial(chain_at, law.complex_modulus))


def as_tested(changes: Sequence[Change]) -> Rung:
    """The rung of the same law, fitted so that what a machine reads of it, with these changes, is what was measured."""

    def rung(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> Fit:
        def beside(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
            parts = [change(law, omega, temperature) for change in changes]
            return np.exp(np.sum([np.zeros(omega.size), *parts], axis=0))

        def read(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
            return np.exp(log_reading(law, omega, temperature)) * beside(omega, temperature)

        def seen(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
            return np.asarray(law.complex_modulus(omega, temperature) * read(omega, temperature))

        law, fitted = spectrum(omega, temperature, modulus)
        for _ in range(ROUNDS):
            law, _ = spectrum(omega, temperature, modulus / read(omega, temperature))
        return Fit(seen, fitted, partial(chain_at, law.complex_modulus), beside)

    return rung


def phase_offset(omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray) -> Fit:
    """The same law, and one constant added to all phases."""

    def misfit(offset: float) -> float:
        turned = modulus * np.exp(-1j * offset)
        law = one_law(omega, temperature, turned).modulus
        return float((np.abs(np.log(turned / law(omega, temperature))) ** 2).sum())

    offset = float(minimize_scalar(misfit, bounds=LARGEST, method="bounded", options={"xatol": 1e-4}).x)
    law, fitted, bonds, _ = one_law(omega, temperature, modulus * np.exp(-1j * offset))
    turned = np.exp(1j * offset)
    return Fit(
        lambda omega, temperature: law(omega, temperature) * turned,
        fitted + 1,
        bonds,
        lambda omega, temperature: np.full(omega.size, turned),
    )


def rungs(mechanisms: Mechanisms) -> dict[str, Rung]:
    """All, by name, in the order of the table."""

    def contacts(law: Spectrum, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return mechanisms.contacts(law.complex_modulus(omega, temperature), AMPLITUDES["ncat"])

    def softening(law: Spectrum, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return mechanisms.softening(law.complex_modulus(omega, temperature), AMPLITUDES["ncat"])

    return {
        "burgers": burgers,
        "one_law": one_law,
        "as_run": as_tested([]),
        "contacts": as_tested([contacts]),
        "softening": as_tested([contacts, softening]),
        "phase_offset": phase_offset,
    }


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


def rows(
    mix: str, table: pd.DataFrame, ladder: dict[str, Rung], cylinder: ModelExcerpt
) -> list[dict[str, Any]]:
    """One row for each rung: errors in sample, of what was left out, and of what the cylinder shows of its law."""
    found = []
    for name, rung in ladder.items():
        fit = rung(*averages(table))
        row: dict[str, Any] = {"mix": mix, "rung": name, "fitted": fit.fitted}
        row |= _named("", errors(fit.modulus, table))
        for key, kind in (("temperature_C", "isotherm"), ("specimen", "specimen")):
            left = [
                errors(rung(*averages(table[table[key] != value])).modulus, table[table[key] == value])
                for value in table[key].unique()
            ]
            row |= _named(f"left_out_{kind}_", np.vstack(left))
        simulated = shown_by(cylinder, fit, STEADY if name in UNREAD else PROGRAMME)
        found.append(row | _named("simulated_", errors(simulated, table)))
    return found


def shown_by(cylinder: ModelExcerpt, fit: Fit, programme: Programme) -> Modulus:
    """What is read of the law of a fit on the cylinder, with whatever else changes it."""

    def modulus(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        shown = np.empty(omega.size, complex)
        for value in np.unique(temperature):
            at = np.flatnonzero(temperature == value)
            chain = fit.bonds(omega[at], value)
            for k in at:
                shown[k] = modulus_of_cylinder(cylinder, chain, omega[k] / (2.0 * np.pi), programme)
        return shown * fit.beside(omega, temperature)

    return modulus


def _named(prefix: str, parts: np.ndarray) -> dict[str, float]:
    return dict(zip((f"{prefix}E_percent", f"{prefix}phase_percent"), parts.mean(axis=0), strict=True))


def run(job: Any) -> None:
    """ladder.csv of the mixes, and means.csv over them."""
    ladder, cylinder = rungs(Mechanisms(job.input)), read_excerpt(job.input.excerpt, job.input.model)
    tables = {Path(path).stem: pd.read_csv(path, comment="#") for path in job.input.mixes}
    parts = [rows(mix, table, ladder, cylinder) for mix, table in tables.items()]
    table = pd.DataFrame([row for part in parts for row in part])
    write_table(job.output.ladder, table)
    write_table(job.output.means, table.drop(columns="mix").groupby("rung", sort=False).mean().reset_index())


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
