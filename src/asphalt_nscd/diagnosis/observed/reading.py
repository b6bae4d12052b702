"""Measurements for a diagnosis: the table forms of `reduce`, usual synonyms, and optional columns."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.csvinput import Limits, Table, read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import choice
from asphalt_nscd.measurements.campaign import Campaign, nominal_temperatures, separate_sweeps
from asphalt_nscd.measurements.geometry import read_geometry
from asphalt_nscd.measurements.reduction import FORMS, KEYS, PICKED, is_reduced, reduced_frame
from asphalt_nscd.measurements.signs import wrong_sign
from asphalt_nscd.measurements.slips import slips
from asphalt_nscd.measurements.twopoint import form_factor, mass_factor

SYNONYMS = {"T_C": "temperature_C", "f_Hz": "frequency_Hz", "phi_deg": "phase_deg"}
OPTIONAL = {
    "amplitude_m": Limits(1e-9, 1e-2, "give the displacement amplitude in m"),
    "order": Limits(0, 1e9, "number the tests of the campaign from 1"),
    "time_step_s": Limits(1e-9, 10.0, "give the time step of the simulation in s"),
    "cycles": Limits(0, 1e12, "give the load cycles borne before the test"),
}
PEAKS = (*FORMS["peaks"], *PICKED)
MOST_ROWS = 3000  # the chance level takes matrices of twice the rows
BEYOND_SCATTER = 1.25  # a softest test may scatter below the static modulus, not by more
HALF_MICRO = 0.5e-6  # the amplitude in one of a peak-to-peak value in millionths
PAPER_GEOMETRY = {
    "b_mm": 25.0,
    "B_mm": 56.0,
    "e_mm": 25.0,
    "h_mm": 250.0,
    "mass_kg": 0.6,
    "mobile_mass_kg": 0.235,
}


def read_observations(
    measurements: str | Path | Campaign,
    geometry: str | Path | Mapping[str, Any],
    static_modulus: float | None = None,
) -> tuple[Observations, str]:
    """Observations of a campaign or of a measurement table, and the origin its rows state ("mixed" where they differ).

    Columns specimen (or replicate), temperature_C (T_C), frequency_Hz (f_Hz), and one of the forms of `reduce`;
    optional amplitude_m, order, cycles, replicate beside specimen, nominal_temperature_C (of the isotherm), microstrain
    (peak to peak, as T 378 sets it) and those of `diagnosis.observed.quality`, which may have empty cells. `geometry`
    gives form factors, and Eq. (1) where forces are given; `static_modulus` in Pa.
    """
    campaign = measurements if isinstance(measurements, Campaign) else None
    table = _renamed(measurements.table if isinstance(measurements, Campaign) else read_csv(measurements))
    path = table.path
    if "E_MPa" in table.columns and "phase_deg" not in table.columns:
        raise InputError(
            f"{path}: |E*| without a phase, of which nothing can be diagnosed; add the phase, or take the master curve "
            "that `asphalt-nscd diagnose` gives of such a table."
        )
    reduced = is_reduced(table.columns)  # before: peaks stand beside the moduli
    if reduced:
        table = _drop_columns(table, (name for name in PEAKS if np.isnan(table.numbers_or_nan(name)).all()))
    if len(table.lines) > MOST_ROWS:
        raise InputError(
            f"{path}: {len(table.lines)} rows; give at most {MOST_ROWS}, for example one mix at a time."
        )
    optional = {
        name: table.numbers(name, limits) for name, limits in OPTIONAL.items() if name in table.columns
    }
    if "z0_m" in table.columns and "amplitude_m" not in optional:
        optional["amplitude_m"] = table.numbers("z0_m", OPTIONAL["amplitude_m"])
    distinguishing = [
        name for name in ("replicate", "amplitude_m", "order", "cycles") if name in table.columns
    ]
    by_force = bool({"F0_N", "record"} & set(table.columns))
    test_type = "bending" if campaign is None else campaign.test_type
    if by_force and test_type != "bending":
        way = choice("say --measured-in bending", "choose it in the menu")
        raise InputError(
            f"{path}: forces and displacements are reduced by Eq. (1) of two-point bending; give the moduli of a "
            f"{test_type} test, or {way}."
        )
    if reduced:
        table = _drop_columns(table, PEAKS)
    frame = reduced_frame(table, geometry, tests=(*KEYS, *distinguishing))
    names, specimen = np.unique(frame["specimen"], return_inverse=True)
    geometries = read_geometry(geometry, names)
    gamma = np.array([form_factor(geometries[name]) for name in names])
    # Ready moduli may come from any test; only peaks and records went through Eq. (1).
    mass = np.array([mass_factor(geometries[name]) if by_force else 0.0 for name in names])
    temperature, frequency = frame["temperature_C"].to_numpy(float), frame["frequency_Hz"].to_numpy(float)
    nominal = nominal_temperatures(table, temperature)
    if "nominal_temperature_C" not in table.columns:
        nominal = separate_sweeps(nominal, specimen)
    isotherm = temperature if (nominal == temperature).all() else nominal
    # T 378 sets strains from peak to peak, and displacements elsewhere are amplitudes.
    strain = table.numbers_or_nan("microstrain") * HALF_MICRO
    origins = sorted(set(frame["origin"]))
    observed = Observations(
        specimen=specimen,
        names=tuple(str(name) for name in names),
        temperature=temperature,
        frequency=_nominal_frequencies(frequency, specimen, isotherm),
        modulus=frame["E_MPa"].to_numpy(float)
        * 1e6
        * np.exp(1j * np.radians(frame["phase_deg"].to_numpy(float))),
        form_factor=gamma[specimen],
        inertia=(gamma * mass)[specimen],
        amplitude=_grouped(optional["amplitude_m"], 0.05) if "amplitude_m" in optional else None,
        order=optional.get("order"),
        cycles=optional.get("cycles"),
        time_step=optional.get("time_step_s"),
        static_modulus=static_modulus,
        nominal_temperature=None if isotherm is temperature else isotherm,
        strain=None if np.isnan(strain).all() else strain,
        quality={name: table.numbers_or_nan(name) for name in quality.COLUMNS if name in table.columns},
        test_type=test_type,
    )
    labelled = frame.assign(temperature_C=isotherm, frequency_Hz=observed.frequency)
    if (turned := wrong_sign(labelled)) is not None:
        raise table.error(*turned)
    found = next(slips(labelled), None)
    if found is not None:
        raise InputError(f"{path}: {found}")
    softest = float(observed.modulus.real.min())
    if static_modulus is not None and static_modulus > BEYOND_SCATTER * softest:
        raise InputError(
            f"{path}: the static modulus, {static_modulus * 1e-6:g} MPa, is above the storage modulus of the softest "
            f"test, {softest * 1e-6:.4g} MPa; give the modulus at long times, or leave it out."
        )
    return observed, origins[0] if len(origins) == 1 else "mixed: " + ", ".join(origins)


def _nominal_frequencies(frequency: np.ndarray, specimen: np.ndarray, temperature: np.ndarray) -> np.ndarray:
    """Frequencies of a grid as set: measured ones scatter by a per cent; a fine sweep is left as it is."""
    grouped = _grouped(frequency, 0.015)
    tests = np.column_stack([specimen, temperature, frequency])
    as_grouped = np.column_stack([specimen, temperature, grouped])
    fewer = len(np.unique(as_grouped, axis=0)) < len(np.unique(tests, axis=0))
    return frequency if fewer else grouped


def _grouped(values: np.ndarray, apart: float) -> np.ndarray:
    """Means of values whose logarithms follow one another by less than `apart`."""
    order = np.argsort(values)
    jumps = np.diff(np.log(values[order])) > apart
    group = np.concatenate([[0], np.cumsum(jumps)])
    groups = [values[order][group == g] for g in range(group[-1] + 1)]
    # the mean of equal values may differ from them in the last digit
    means = np.array([one.mean() if np.ptp(one) else one[0] for one in groups])
    set_to = np.empty_like(values)
    set_to[order] = means[group]
    return set_to


def _drop_columns(table: Table, names: Iterable[str]) -> Table:
    left_out = set(names)
    return replace(table, columns={k: v for k, v in table.columns.items() if k not in left_out})


def _renamed(table: Table) -> Table:
    columns = {}
    for name, values in table.columns.items():
        wanted = SYNONYMS.get(name, name)
        if name == "replicate" and "specimen" not in table.columns:
            wanted = "specimen"
        if wanted in columns or (wanted != name and wanted in table.columns):
            raise InputError(
                f"{table.path}: columns {name!r} and {wanted!r} hold the same quantity; keep one of them."
            )
        columns[wanted] = values
    return replace(table, columns=columns)
