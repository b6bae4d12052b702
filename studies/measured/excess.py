"""The excess phase of measured mixes, and how much of it three mechanisms explain.

Nothing is fitted to a phase. One 2S2P1D law is fitted to the |E*| of a mix alone, with usual values of its parameters
as a prior. The reading is what a machine makes of that law, exactly (`reading.py`); grains that slip and films that
soften change it by tables that were fixed before they were laid beside a mix (`mechanisms.py`). What is measured is the
phase above what |E*| of the same isotherm requires (Kramers and Kronig), without a law. The reading is not blind: both
populations were in sight when it was thought of.
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
from studies.measured.mechanisms import Mechanisms, excess_of
from studies.measured.reading import log_reading
from studies.measured.stated import AMPLITUDES, WEAK

SCATTER = 0.02, np.radians(0.4)  # of ln|E*| and phase of one test, as usual in the nine NCAT campaigns
LEAST = 3  # frequencies of an isotherm
NO_PHASE = 1e3  # rad, as its standard deviation in a fit: it counts for nothing
REFERENCE = 20.0  # degC
USUAL_AMPLITUDE = 50e-6


PARTS = "reading", "contacts", "softening"
BESIDE = "weak_films"  # contacts once more, among films that are weak in shear; no part of the sum
UNLIKELY = 2.0  # standard errors


def predictions(
    means: list[tuple[float, pd.DataFrame]], mechanisms: Mechanisms, amplitude: float
) -> list[dict[str, np.ndarray]]:
    """Excess [deg] by each of PARTS, and BESIDE, at each frequency of each isotherm, by a law of |E*| alone."""
    temperature = np.concatenate([np.full(len(at), value) for value, at in means])
    omega = 2.0 * np.pi * np.concatenate([at.index.to_numpy() for _, at in means])
    modulus = 1e6 * np.exp(np.concatenate([at["log_modulus"] for _, at in means])) + 0j
    law = fit_spectrum(
        omega, temperature, modulus, REFERENCE, prior=prior_of("2s2p1d"), weights=(SCATTER[0], NO_PHASE)
    ).law
    of_law = law.complex_modulus(omega, temperature)
    reading = np.degrees(log_reading(law, omega, temperature).imag)
    changes = mechanisms.contacts(of_law, amplitude), mechanisms.softening(of_law, amplitude)
    beside = mechanisms.contacts(of_law, amplitude, WEAK)
    parts = []
    for value, at in means:
        own = temperature == value
        excesses = [excess_of(at.index.to_numpy(), of_law[own], change[own]) for change in changes]
        own_parts = dict(zip(PARTS, [reading[own], *excesses], strict=True))
        parts.append(own_parts | {BESIDE: excess_of(at.index.to_numpy(), of_law[own], beside[own])})
    return parts


def isotherms(table: pd.DataFrame) -> list[tuple[float, pd.DataFrame]]:
    """Mean ln|E*| and phase [rad] of the specimens at each frequency, by temperature [degC]."""
    means = table.assign(log_modulus=np.log(table["E_MPa"]), phase=np.radians(table["phase_deg"]))
    means = means.groupby(["temperature_C", "frequency_Hz"]).agg(
        log_modulus=("log_modulus", "mean"), phase=("phase", "mean"), count=("phase", "count")
    )
    each = ((float(temperature), group.droplevel(0)) for temperature, group in means.groupby(level=0))
    return [(temperature, group) for temperature, group in each if len(group) >= LEAST]


def excess(population: str, mix: str, table: pd.DataFrame, mechanisms: Mechanisms) -> pd.DataFrame:
    """One row for each test condition of a mix; `table` has temperature_C, frequency_Hz, E_MPa and phase_deg."""
    parts = []
    means = isotherms(table)
    predicted = predictions(means, mechanisms, AMPLITUDES.get(population, USUAL_AMPLITUDE))
    for (temperature, at), own in zip(means, predicted, strict=True):
        frequency = at.index.to_numpy()
        log_modulus, phase, count = (at[name].to_numpy() for name in ("log_modulus", "phase", "count"))
        scatter = np.outer(SCATTER, 1.0 / np.sqrt(count))
        required = required_phase(frequency, log_modulus, scatter[0])
        whole = constant_excess(frequency, np.array([log_modulus, phase]), scatter**2)
        columns = {
            "population": population,
            "mix": mix,
            "temperature_C": temperature,
            "frequency_Hz": frequency,
            "measured_deg": np.degrees(phase - required.phase),
            "standard_error_deg": np.degrees(np.hypot(required.std_error, scatter[1])),
            **{f"{name}_deg": values for name, values in own.items()},
            "isotherm_deg": np.degrees(whole[0]),
            "isotherm_standard_error_deg": np.degrees(whole[1]),
        }
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def budget(table: pd.DataFrame) -> pd.DataFrame:
    """By population and isotherm: mean excess over the mixes, what each part and a constant explain, a verdict.

    "explained": the parts leave less than a constant fitted to this isotherm would, and a mean within UNLIKELY standard
    errors of zero; "in part": they take a quarter of the root mean square or more; else "not".
    """
    parts, other = [f"{name}_deg" for name in PARTS], f"{BESIDE}_deg"
    by_mix = table.groupby(["population", "temperature_C", "mix"])[["isotherm_deg", *parts, other]].mean()
    rows = []
    for (population, temperature), group in by_mix.groupby(level=[0, 1]):
        measured, summed = group["isotherm_deg"], group[parts].sum(axis=1)
        several = len(group) > 2
        left = measured - summed
        row = {
            "population": population,
            "temperature_C": temperature,
            "mixes": len(group),
            "measured_deg": measured.mean(),
            "standard_error_deg": measured.sem() if several else np.nan,
            **group[parts].mean(),
            "sum_deg": summed.mean(),
            other: group[other].mean(),
            "rms_less_weak_films_deg": _rms(measured - group[other]),
            "correlation": measured.corr(summed) if several else np.nan,
            "rms_deg": _rms(measured),
            **{f"rms_less_{name}_deg": _rms(measured - group[f"{name}_deg"]) for name in PARTS},
            "rms_less_all_deg": _rms(left),
            "rms_less_mean_deg": measured.std(ddof=0),
        }
        if row["rms_less_all_deg"] < row["rms_less_mean_deg"] and abs(left.mean()) < UNLIKELY * left.sem():
            row["verdict"] = "explained"
        else:
            row["verdict"] = "in part" if row["rms_less_all_deg"] <= 0.75 * row["rms_deg"] else "not"
        rows.append(row)
    return pd.DataFrame(rows)


def _rms(values: pd.Series) -> float:
    return float(np.sqrt((values**2).mean()))


def run(job: Any) -> None:
    """excess.csv and budget.csv of the nine NCAT mixes and of those of data/mixes50."""
    mechanisms = Mechanisms(job.input)
    tables = [("ncat", Path(path).stem, pd.read_csv(path, comment="#")) for path in job.input.ncat]
    mixes = pd.read_csv(job.input.mixes, comment="#").groupby("mix")
    tables += [("mixes50", str(mix), rows) for mix, rows in mixes]
    parts = [excess(*what, mechanisms) for what in tables]
    table = pd.concat(parts, ignore_index=True)
    write_table(job.output.excess, table)
    write_table(job.output.budget, budget(table))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
