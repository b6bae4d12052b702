"""What one law for all temperatures gains on data that are not of its own family."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.simulation.simulated import NumericalSpecimen, read_specimen
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import KEYS, read_measured, the_only
from asphalt_nscd.reporting.pages.way import read_ladder
from asphalt_nscd.reporting.tables.table4 import ERRORS
from asphalt_nscd.rheology.spectrum import Spectrum
from asphalt_nscd.rheology.spectrum_io import read_spectrum

OF_LAW = ("relaxation_spectrum", BOND_MAPPING)  # rungs that are no cause in the measurements


def make(
    measured: list[Path],
    diagnosis: list[Path],
    law: list[Path],
    specimen: list[Path],
    ladder: Sequence[Path] = (),
) -> pd.DataFrame:
    """One row for each table of measurements: errors as in Table 4 in percent, mean over temperatures.

    measured, diagnosis, law: one file each for a table, in one order, named by the folder of the diagnosis.
    burgers: a Burgers law fitted at each temperature; law: one 2S2P1D law for all, as the reduced specimen shows it;
    held_out: each temperature from the others; simulated: the extended tests themselves (ladder, of the first table).
    """
    numerical = read_specimen(the_only(specimen, "specimen"))
    rows = []
    for number, (table, found, of_all) in enumerate(zip(measured, diagnosis, law, strict=True)):
        data, content = read_measured([table]), read_diagnosis([found])
        fitted = read_spectrum(of_all)
        shown = mean_relative_error(data, _shown(fitted, numerical, data)).set_index("temperature_C")
        held = _held_out(content)
        row = {
            # The first table is the study's own; the others are called after their folders.
            "data": found.parent.name if number else content["origin"],
            "origin": content["origin"],
            "causes_named": ", ".join(
                rung["cause"] for rung in content["ladder"] if rung["cause"] not in OF_LAW
            ),
        }
        last = read_ladder(ladder) if ladder and not number else None
        for error in ERRORS:
            quantity = error.split("_")[1]
            row[_name(error, "burgers")] = float(np.mean(list(content["baseline"][error].values())))
            row[_name(error, "law")] = float(shown[error].mean())
            row[_name(error, "law_worst")] = float(shown[error].max())
            row[_name(error, "held_out")] = held.get(error, np.nan)
            row[_name(error, "simulated")] = (
                np.nan if last is None else last.loc[last["rung"] == last["rung"].iloc[-1], error].mean()
            )
            scatter = content["scatter"]["modulus_percent" if quantity == "E" else "phase_deg"]
            of_one = 1.0 if quantity == "E" else 100.0 * float((1.0 / data["phase_deg"]).mean())
            row[f"scatter_{quantity}_percent"] = scatter * of_one
        rows.append(row)
    return pd.DataFrame(rows)


def _shown(law: Spectrum, specimen: NumericalSpecimen, data: pd.DataFrame) -> pd.DataFrame:
    """|E*| and phase of the specimen with this law at each condition of the data: its steady response."""
    conditions = data[KEYS].drop_duplicates().reset_index(drop=True)
    omega = 2.0 * np.pi * conditions["frequency_Hz"].to_numpy()
    bonds = law.complex_modulus(omega, conditions["temperature_C"].to_numpy())
    modulus = specimen.apparent_modulus(omega, bonds)
    return conditions.assign(E_MPa=np.abs(modulus) * 1e-6, phase_deg=np.degrees(np.angle(modulus)))


def _held_out(content: dict) -> dict[str, float]:
    """Errors at temperatures left out of the fit, mean over those between others."""
    for rung in content["ladder"]:
        if rung["cause"] == "relaxation_spectrum":
            held = rung["gain"]["held_out"].get("leave_one_isotherm_out")
            if held is not None:
                by_temperature = held["averages_by_temperature"]
                # The ends are predicted from one side alone, which is another question.
                inner = sorted(by_temperature, key=float)[1:-1]
                return {e: float(np.mean([by_temperature[t][e]["after"] for t in inner])) for e in ERRORS}
    return {}


def _name(error: str, kind: str) -> str:
    return error.replace("_percent", f"_{kind}_percent")
