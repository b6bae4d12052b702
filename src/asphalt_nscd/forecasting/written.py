"""What a forecast leaves: forecast.csv, rivals.csv, law.json and forecast.json."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.forecasting.forecast import DOUBTS, MODEL, Forecast
from asphalt_nscd.forecasting.levels import film_thickness
from asphalt_nscd.forecasting.rivals import RIVALS
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.laws_io import chain_content
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import spectrum_content

TABLE, RIVAL_TABLE, LAW, SUMMARY = "forecast.csv", "rivals.csv", "law.json", "forecast.json"
CHAIN_ERROR = 1e-3  # of ln E*
FURTHER, SPREAD = (
    np.array([0.0, 10.0, 20.0]),
    np.geomspace(0.1, 100.0, 7),
)  # K, rad/s: points of a law beside those asked
SHOWN = (1e5, 1e6, 1e7, 1e8, 1e9)  # Pa, of the binder, at which amplifications are told
WORDS = {
    "packing": "the packing drawn",
    "aggregate": f"the modulus of the aggregate, x {DOUBTS['aggregate']:g}",
    "film_factor": f"the film between touching grains, x {DOUBTS['film_factor']:g}",
    "skeleton_pressure": f"the pressure in dry contacts, / {DOUBTS['skeleton_pressure']:g}",
    "voids": f"the air voids, + {100 * DOUBTS['voids']:g} %",
}


def points(found: Forecast) -> pd.DataFrame:
    """The forecast as a table: one row for each temperature and frequency, with the band of |E*| and phase."""
    size, phase = np.abs(found.modulus), np.angle(found.modulus)
    doubt = found.band(MODEL)
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
        kind = "wlf" if isinstance(shift, WLF) else "arrhenius"
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
    at_reference = partial(found.modulus_at, temperature=shift.reference_temperature)
    chain, error = kelvin_chain(at_reference, omega.min(), omega.max(), CHAIN_ERROR)
    return chain_content(
        chain,
        source=source,
        temperature=shift.reference_temperature,
        error=error,
        lowest_hz=recipe.frequency.min(),
        highest_hz=recipe.frequency.max(),
    )


def summary(found: Forecast) -> dict[str, Any]:
    """Levels, packings, amplifications, and how much each doubt moves the answer, as the file holds them."""
    recipe = found.recipe
    doubts = {
        WORDS[name]: {
            "E_percent": 100.0 * float(np.sqrt((change.real**2).mean())),
            "phase_deg": float(np.degrees(np.sqrt((change.imag**2).mean()))),
        }
        for name, change in found.deviation.items()
    }
    levels, modulus, shown = [], np.array(SHOWN), [f"{size / 1e6:g} MPa" for size in SHOWN]
    for result in found.levels:
        after = recipe.aggregate.modulus * result.map(modulus / recipe.aggregate.modulus)
        levels.append(
            {
                "name": result.level.name,
                "grains_mm": [1e3 * result.level.smallest, 1e3 * result.level.largest],
                "volume_fraction": result.level.fraction,
                "grains_touch": bool(result.level.touching and found.settings.touching),
                "solid_fraction_of_packing": result.packing.solid_fraction,
                "coordination_of_packing": result.packing.coordination,
                "grains_in_network": result.grains,
                "matrix_bulk_GPa": 1e-9 * result.matrix_bulk,
                "amplification": dict(zip(shown, (after / modulus).tolist(), strict=True)),
                "map_error": result.map.error,
            }
        )
        modulus = after
    return {
        "format": 1,
        "kind": "forecast",
        "recipe": recipe.name,
        "source": recipe.source,
        "temperature_stated": recipe.temperature_stated,
        "aggregate_volume_percent": 100.0 * recipe.aggregate_fraction * (1.0 - recipe.voids),
        "binder_volume_percent": 100.0 * (1.0 - recipe.aggregate_fraction) * (1.0 - recipe.voids),
        "air_voids_percent": 100.0 * recipe.voids,
        "film_thickness_um": 1e6 * film_thickness(recipe),
        "relaxed_modulus_MPa": 1e-6 * recipe.aggregate.modulus * found.levels[-1].map.constant,
        "levels": levels,
        "doubts": doubts,
        "caution": found.caution,
        "largest_doubt": max(doubts, key=lambda name: doubts[name]["E_percent"]),
        "provenance": provenance(),
    }


def write(found: Forecast, folder: str | Path) -> list[str]:
    """Write all files of a forecast into a folder, made where it does not exist; returns their names."""
    folder = Path(folder)
    write_table(folder / TABLE, points(found))
    write_table(folder / RIVAL_TABLE, rival_points(found))
    write_json(folder / LAW, law_of_mix(found))
    write_json(folder / SUMMARY, summary(found))
    return [TABLE, RIVAL_TABLE, LAW, SUMMARY]
