"""What a forecast leaves: forecast.csv, rivals.csv, aashtoware.csv, law.json and forecast.json."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline

from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.forecasting.forecast import INPUTS, Forecast
from asphalt_nscd.forecasting.recipe import Recipe
from asphalt_nscd.forecasting.rivals import RIVALS
from asphalt_nscd.forecasting.scheme import FILLER, binder_volume, modulus_of_mix
from asphalt_nscd.measurements.units import PSI
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.laws_io import chain_content
from asphalt_nscd.rheology.shift import Arrhenius
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import spectrum_content

TABLE, RIVAL_TABLE, DESIGN, LAW, SUMMARY = (
    "forecast.csv", "rivals.csv", "aashtoware.csv", "law.json", "forecast.json"
)  # fmt: skip
CHAIN_ERROR = 1e-3  # of ln E*
IN_A_DECADE = 8  # points of a law at one temperature
FURTHER = np.array([0.0, 10.0, 20.0])  # K: temperatures of a law beside those asked
SPREAD = np.geomspace(0.1, 100.0, 7)  # rad/s, likewise
DESIGN_F, DESIGN_HZ = (14, 40, 70, 100, 130), (0.1, 0.5, 1, 5, 10, 25)  # what AASHTOWare Pavement ME asks for
PARTS = {
    "volumes": {"contacts": 0.0, "pressure": 0.0},
    "and contacts": {"pressure": 0.0},
    "and dry skeleton": {},
}
SHOWN = (1e5, 1e6, 1e7, 1e8, 1e9)  # Pa, of the binder, at which amplifications are told


def points(found: Forecast) -> pd.DataFrame:
    """The forecast as a table: one row for each temperature and frequency, with the band of |E*| and phase."""
    size, phase = np.abs(found.modulus), np.angle(found.modulus)
    doubt = found.band()
    return pd.DataFrame(
        {
            "temperature_C": found.recipe.temperature,
            "frequency_Hz": found.recipe.frequency,
            "E_MPa": 1e-6 * size,
            "phase_deg": np.degrees(phase),
            "E_low_MPa": 1e-6 * size * np.exp(-doubt.real),
            "E_high_MPa": 1e-6 * size * np.exp(doubt.real),
            "phase_low_deg": np.degrees(np.maximum(phase - doubt.imag, 0.0)),
            "phase_high_deg": np.degrees(np.minimum(phase + doubt.imag, np.pi / 2.0)),
        }
    )


def rival_points(found: Forecast) -> pd.DataFrame:
    """What mean fields and regressions make of the recipe: one row for each temperature, frequency and rival."""
    frame = points(found)[["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]]
    for name, rival in RIVALS.items():
        modulus = rival(found.recipe)
        frame[f"{name}_E_MPa"] = 1e-6 * np.abs(modulus)
        # Witczak's regression is of |E*| alone; a phase of zero would be read as elastic.
        if np.iscomplexobj(modulus) and np.any(modulus.imag):
            frame[f"{name}_phase_deg"] = np.degrees(np.angle(modulus))
    return frame


def law_of_mix(found: Forecast) -> dict[str, Any]:
    """The law of the mix as other steps read it: 2S2P1D with the binder's kind of shift, or a Kelvin chain."""
    recipe, shift = found.recipe, found.recipe.binder.shift
    source = f"forecast from binder and recipe ({recipe.name})"
    omega = 2.0 * np.pi * recipe.frequency

    if recipe.shifted:
        kind = "arrhenius" if isinstance(shift, Arrhenius) else "wlf"
        temperature, modulus = recipe.temperature, found.modulus
        if np.unique(temperature).size < 3 or temperature.size < 9:  # too few for shift and shape
            for further in shift.reference_temperature + FURTHER:
                modulus = np.append(modulus, found.modulus_at(SPREAD, further))
                omega, temperature = (
                    np.append(omega, SPREAD),
                    np.append(temperature, np.full_like(SPREAD, further)),
                )
        fit = fit_spectrum(omega, temperature, modulus, shift.reference_temperature, Form(shift=kind))
        return spectrum_content(
            fit.law, source=source, rms_log_residual=fit.rms_log_residual, unseen=fit.unseen
        )
    chain, error = kelvin_chain(_smooth(found), omega.min(), omega.max(), CHAIN_ERROR)
    return chain_content(
        chain,
        source=source,
        temperature=shift.reference_temperature,
        error=error,
        lowest_hz=recipe.frequency.min(),
        highest_hz=recipe.frequency.max(),
    )


def _smooth(found: Forecast) -> Callable[[np.ndarray], np.ndarray]:
    """E* [Pa] at angular frequencies [rad/s] of the recipe's band and its one temperature, through points of it."""
    reference = found.recipe.binder.shift.reference_temperature
    omega = 2.0 * np.pi * found.recipe.frequency
    low, high = 0.5 * omega.min(), 2.0 * omega.max()
    at = np.geomspace(low, high, max(5, int(np.ceil(IN_A_DECADE * np.log10(high / low)))))
    spline = CubicSpline(np.log(at), np.log(found.modulus_at(at, reference)))
    return lambda omega: np.asarray(np.exp(spline(np.log(omega))))


def design_points(found: Forecast) -> pd.DataFrame:
    """|E*| [psi] at the temperatures [degF] and frequencies of AASHTOWare Pavement ME, a row for each temperature."""
    rows = []
    for fahrenheit in DESIGN_F:
        modulus = found.modulus_at(2.0 * np.pi * np.array(DESIGN_HZ), (fahrenheit - 32.0) / 1.8)
        told = (np.abs(modulus) / PSI).round()
        rows.append(
            {"temperature_F": fahrenheit}
            | {f"E_psi_{f:g}_Hz": e for f, e in zip(DESIGN_HZ, told, strict=True)}
        )
    return pd.DataFrame(rows)


def summary(found: Forecast) -> dict[str, Any]:
    """Volumes, amplifications, and what each input moves, as the file holds them."""
    recipe, binder = found.recipe, np.array(SHOWN)
    moved = {
        INPUTS[name]: {
            "E_percent": 100.0 * float(np.sqrt((change.real**2).mean())),
            "phase_deg": float(np.degrees(np.sqrt((change.imag**2).mean()))),
        }
        for name, change in found.moved.items()
    }
    amplified = {name: amplification(found, name, binder).round(1).tolist() for name in PARTS}
    return {
        "format": 2,
        "kind": "forecast",
        "recipe": recipe.name,
        "source": recipe.source,
        "caution": recipe.caveat,
        "volume_percent": {name: 100.0 * share for name, share in composition(recipe).items()},
        "relaxed_modulus_MPa": 1e-6 * float(modulus_of_mix(recipe, np.array([1e-3]), found.settings)[0].real),
        "amplification_of_binder_at_MPa": [1e-6 * size for size in SHOWN],
        "amplification": amplified,
        "inputs": moved,
        "largest": max(moved, key=lambda name: moved[name]["E_percent"]),
        "provenance": provenance(),
    }


def amplification(found: Forecast, part: str, binder: np.ndarray) -> np.ndarray:
    """|E*| of the mix over that of its binder (n,) [Pa], by one of PARTS."""
    settings = replace(found.settings, **PARTS[part])
    return np.abs(modulus_of_mix(found.recipe, binder, settings) / binder)


def composition(recipe: Recipe) -> dict[str, float]:
    """Shares of the volume of the mix."""
    stone = (1.0 - recipe.voids) * recipe.aggregate_fraction
    filler, sand = (float(recipe.grading.passing_at(size)) for size in (FILLER, 2e-3))
    return {
        "stones": stone * (1.0 - sand),
        "sand": stone * (sand - filler),
        "filler": stone * filler,
        "binder": binder_volume(recipe),
        "air": recipe.voids,
    }


def names(found: Forecast) -> list[str]:
    """Files of a forecast; of a binder at one temperature nothing is known for a design."""
    return [TABLE, RIVAL_TABLE, *([DESIGN] if found.recipe.shifted else []), LAW, SUMMARY]


def write(found: Forecast, folder: str | Path) -> list[str]:
    """Write all files of a forecast into a folder, made where it does not exist; returns their names."""
    folder = Path(folder)
    write_table(folder / TABLE, points(found))
    write_table(folder / RIVAL_TABLE, rival_points(found))
    if found.recipe.shifted:
        write_table(folder / DESIGN, design_points(found))
    write_json(folder / LAW, law_of_mix(found))
    write_json(folder / SUMMARY, summary(found))
    return names(found)
