"""The Burgers law of one temperature as published in Table 3."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.files.csvinput import Limits, Table, read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.limits import LIMITS
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import SAME_TEMPERATURE, write_law

PUBLISHED_COLUMNS = ("Em_kPa", "eta_m_kPa_s", "Ek_kPa", "eta_k_kPa_s")
UNITS = {"kPa": 1e3, "Pa": 1.0}  # readings of Table 3; the table prints Pa, kPa is what fits


def published_law(table: str | Path, temperature: float, unit: str, output: str | Path) -> dict[str, Any]:
    """Write the row of Table 3 at a temperature [degC] as a law, read in `unit`, "kPa" or "Pa" (as printed)."""
    temperatures, laws = read_published(table, unit)
    match = np.flatnonzero(np.abs(temperatures - temperature) < SAME_TEMPERATURE)
    if not match.size:
        available = ", ".join(f"{t:g}" for t in temperatures)
        raise InputError(f"{table}: no law at {temperature:g} degC; give one of {available}.")
    return write_law(output, laws[match[0]], source="published", temperature=temperature)


def read_published(path: str | Path, unit: str = "kPa") -> tuple[np.ndarray, list[Burgers]]:
    """Temperatures (t,) [degC] and laws of a table like Table 3, read in `unit`, "kPa" or "Pa" (as printed)."""
    if unit not in UNITS:
        raise InputError(f"unit {unit!r} is not known; read Table 3 in {' or '.join(UNITS)}.")
    table: Table = read_csv(path)
    table.require(["temperature_C", *PUBLISHED_COLUMNS])
    temperatures = table.numbers("temperature_C", LIMITS["temperature_C"])
    for row in range(1, temperatures.size):
        if temperatures[row] in temperatures[:row]:
            raise table.error(row, f"{temperatures[row]:g} degC appears twice; keep one line for it.")
    positive = Limits(1e-3, 1e15, "give a positive value in kPa or kPa s")
    columns = [table.numbers(name, positive) * UNITS[unit] for name in PUBLISHED_COLUMNS]
    return temperatures, [Burgers(*(float(value) for value in row)) for row in zip(*columns, strict=True)]
