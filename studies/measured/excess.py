"""The excess phase of measured mixes, and how much of it is the machine's reading of a haversine that drifts.

Nothing is fitted to a phase. One 2S2P1D law is fitted to the |E*| of a mix alone, with usual values of its parameters
as a prior. The reading is what a machine makes of that law, exactly (`reading.py`). What is measured is the phase above
what |E*| of the same isotherm requires (Kramers and Kronig), without a law. It is not blind: both populations were in
sight when the mechanism was thought of.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_script
from asphalt_nscd.diagnosis.screening.excess_phase import constant_excess
from asphalt_nscd.diagnosis.screening.kramers_kronig import required_phase
from asphalt_nscd.files.store import write_table
from asphalt_nscd.rheology.priors import prior_of
from asphalt_nscd.rheology.spectrum_fitting import fit_spectrum
from studies.measured.reading import log_reading

SCATTER = 0.02, np.radians(0.4)  # of ln|E*| and phase of one test, as usual in the nine NCAT campaigns
LEAST = 3  # frequencies of an isotherm
NO_PHASE = 1e3  # rad, as its standard deviation in a fit: it counts for nothing
REFERENCE = 20.0  # degC


def readings(means: list[tuple[float, pd.DataFrame]]) -> list[np.ndarray]:
    """Phase [deg] that the machine adds at each frequency of each isotherm, by a law of |E*| alone."""
    temperature = np.concatenate([np.full(len(at), value) for value, at in means])
    omega = 2.0 * np.pi * np.concatenate([at.index.to_numpy() for _, at in means])
    modulus = 1e6 * np.exp(np.concatenate([at["log_modulus"] for _, at in means])) + 0j
    law = fit_spectrum(
        omega, temperature, modulus, REFERENCE, prior=prior_of("2s2p1d"), weights=(SCATTER[0], NO_PHASE)
    ).law
    added = np.degrees(log_reading(law, omega, temperature).imag)
    return [added[temperature == value] for value, _ in means]


def isotherms(table: pd.DataFrame) -> list[tuple[float, pd.DataFrame]]:
    """Mean ln|E*| and phase [rad] of the specimens at each frequency, by temperature [degC]."""
    means = table.assign(log_modulus=np.log(table["E_MPa"]), phase=np.radians(table["phase_deg"]))
    means = means.groupby(["temperature_C", "frequency_Hz"])[["log_modulus", "phase"]].agg(["mean", "count"])
    found = []
    for temperature, group in means.groupby(level=0):
        rows = group.droplevel(0)
        if len(rows) >= LEAST:
            columns = {name: rows[(name, "mean")] for name in ("log_modulus", "phase")}
            found.append((float(temperature), pd.DataFrame(columns).assign(count=rows[("phase", "count")])))
    return found


def excess(population: str, mix: str, table: pd.DataFrame) -> pd.DataFrame:
    """One row for each test condition of a mix; `table` has temperature_C, frequency_Hz, E_MPa and phase_deg."""
    parts = []
    means = isotherms(table)
    for (temperature, at), reading in zip(means, readings(means), strict=True):
        frequency, log_modulus, phase, count = (
            at.index.to_numpy(),
            at["log_modulus"].to_numpy(),
            at["phase"].to_numpy(),
            at["count"].to_numpy(),
        )
        modulus_scatter, phase_scatter = (size / np.sqrt(count) for size in SCATTER)
        required = required_phase(frequency, log_modulus, modulus_scatter)
        whole = constant_excess(
            frequency, np.array([log_modulus, phase]), np.array([modulus_scatter, phase_scatter]) ** 2, 0.0
        )
        parts.append(
            pd.DataFrame(
                {
                    "population": population,
                    "mix": mix,
                    "temperature_C": temperature,
                    "frequency_Hz": frequency,
                    "measured_deg": np.degrees(phase - required.phase),
                    "standard_error_deg": np.degrees(np.hypot(required.std_error, phase_scatter)),
                    "reading_deg": reading,
                    "isotherm_deg": np.degrees(whole[0]),
                    "isotherm_standard_error_deg": np.degrees(whole[1]),
                }
            )
        )
    return pd.concat(parts, ignore_index=True)


def budget(table: pd.DataFrame) -> pd.DataFrame:
    """By population and isotherm: mean excess over the mixes, what the reading explains, and what a constant would."""
    by_mix = table.groupby(["population", "temperature_C", "mix"])[["isotherm_deg", "reading_deg"]].mean()
    rows = []
    for (population, temperature), group in by_mix.groupby(level=[0, 1]):
        measured, reading = group["isotherm_deg"], group["reading_deg"]
        several = len(group) > 2
        rows.append(
            {
                "population": population,
                "temperature_C": temperature,
                "mixes": len(group),
                "measured_deg": measured.mean(),
                "standard_error_deg": measured.sem() if several else np.nan,
                "reading_deg": reading.mean(),
                "correlation": measured.corr(reading) if several else np.nan,
                "rms_deg": np.sqrt((measured**2).mean()),
                "rms_less_reading_deg": np.sqrt(((measured - reading) ** 2).mean()),
                "rms_less_mean_deg": measured.std(ddof=0),
            }
        )
    return pd.DataFrame(rows)


def run(job: Any) -> None:
    """excess.csv and budget.csv of the nine NCAT mixes and of those of data/mixes50."""
    parts = [excess("ncat", Path(path).stem, pd.read_csv(path, comment="#")) for path in job.input.ncat]
    mixes = pd.read_csv(job.input.mixes, comment="#").groupby("mix")
    parts += [excess("mixes50", str(mix), rows) for mix, rows in mixes]
    table = pd.concat(parts, ignore_index=True)
    write_table(job.output.excess, table)
    write_table(job.output.budget, budget(table))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
