"""What one law for all temperatures gains on data that are not of its own family."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import KEYS, read_measured
from asphalt_nscd.reporting.pages.way import read_ladder
from asphalt_nscd.reporting.tables.rivals import REFERENCE
from asphalt_nscd.reporting.tables.table4 import ERRORS
from asphalt_nscd.rheology.fitting import fit_burgers
from asphalt_nscd.rheology.rivals import rivals

OF_LAW = ("relaxation_spectrum", BOND_MAPPING)  # rungs that are no cause in the measurements


def make(measured: list[Path], diagnosis: list[Path], ladder: Sequence[Path] = ()) -> pd.DataFrame:
    """One row for each table of measurements: errors as in Table 4 in percent, mean over temperatures.

    measured, diagnosis: one file each for a table, in one order, named by the folder of the diagnosis. burgers: a
    Burgers law fitted at each temperature; law: one 2S2P1D law for all; both to averages over specimens, norm and phase
    alike. held_out: each temperature from the others, by the diagnosis; simulated: the extended tests themselves
    (ladder, of the first table).
    """
    rows = []
    for number, (table, found) in enumerate(zip(measured, diagnosis, strict=True)):
        data, content = read_measured([table]), read_diagnosis([found])
        errors = {name: mean_relative_error(data, law) for name, law in _fitted(data).items()}
        held = _held_out(content)
        row: dict[str, Any] = {
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
            row[_name(error, "burgers")] = float(errors["burgers"][error].mean())
            row[_name(error, "law")] = float(errors["law"][error].mean())
            row[_name(error, "law_worst")] = float(errors["law"][error].max())
            row[_name(error, "held_out")] = held.get(error, np.nan)
            row[_name(error, "simulated")] = (
                np.nan if last is None else last.loc[last["rung"] == last["rung"].iloc[-1], error].mean()
            )
            scatter = content["scatter"]["modulus_percent" if quantity == "E" else "phase_deg"]
            of_one = 1.0 if quantity == "E" else 100.0 * float((1.0 / data["phase_deg"]).abs().mean())
            row[f"scatter_{quantity}_percent"] = scatter * of_one
        rows.append(row)
    return pd.DataFrame(rows)


def _fitted(data: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """|E*| and phase of Burgers laws and of one law for all, at each condition of the data."""
    means = data.groupby(KEYS)[["E_MPa", "phase_deg"]].mean().reset_index()
    omega, temperature = 2.0 * np.pi * means["frequency_Hz"].to_numpy(), means["temperature_C"].to_numpy()
    modulus = 1e6 * means["E_MPa"].to_numpy() * np.exp(1j * np.radians(means["phase_deg"].to_numpy()))
    burgers = np.empty_like(modulus)
    for value in np.unique(temperature):
        at = temperature == value
        burgers[at] = fit_burgers(omega[at], modulus[at]).law.complex_modulus(omega[at])
    rival = next(rivals(omega, temperature, modulus, REFERENCE))
    law = rival.modulus(rival.fit(omega, temperature, modulus), omega, temperature)
    return {
        name: means.assign(E_MPa=np.abs(fitted) * 1e-6, phase_deg=np.degrees(np.angle(fitted)))
        for name, fitted in (("burgers", burgers), ("law", law))
    }


def _held_out(content: Mapping[str, Any]) -> dict[str, float]:
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
