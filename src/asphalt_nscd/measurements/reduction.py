"""Measurements of complex modulus tests: three forms in, one reduced table out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.csvinput import Table, read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import inside
from asphalt_nscd.files.store import write_table
from asphalt_nscd.files.words import counted, specimen_named
from asphalt_nscd.measurements import signals, twopoint
from asphalt_nscd.measurements.campaign import nominal_temperatures
from asphalt_nscd.measurements.geometry import read_geometry
from asphalt_nscd.measurements.limits import LIMITS, least_modulus
from asphalt_nscd.measurements.signs import wrong_sign
from asphalt_nscd.measurements.slips import digit_too_many

LEAST_TESTS, LEAST_FREQUENCIES = 4, 2  # that a diagnosis takes
ORIGINS = ("measured", "digitised", "reconstructed", "synthetic")
LABELS = ("replicate",)  # told apart, not measured
KEYS = ("temperature_C", "frequency_Hz")
FORMS = {"peaks": ("F0_N", "z0_m", "psi_deg"), "moduli": ("E_MPa", "phase_deg"), "records": ("record",)}
RECORD_COLUMNS = ("time_s", "force_N", "displacement_m")
PICKED = (
    "E_peak_MPa",
    "phase_peak_deg",
)  # from the peaks of a record, as in the paper; the rest is a harmonic fit
OF_RECORDS = (*FORMS["peaks"], *FORMS["moduli"], *PICKED)
REDUCED_COLUMNS = ("specimen", *KEYS, "origin", *OF_RECORDS)

# Of |E*| without the mass term, which is real: |E*| sin(phase) is left at least, and soft mixes have a sine above this.
SHARE_LEFT_BY_MASS = 0.3
# In degrees the largest phase is above pi/2 (the largest in radians) for a mix that has less than 15 GPa somewhere, and
# above 0.3 for any mix.
LARGEST_PHASE_AT_LEAST = {"soft": np.pi / 2, "glassy": 0.3}  # deg
GLASSY = 15e3  # MPa


def reduce_table(
    measurements: str | Path,
    geometry: str | Path | Mapping[str, Any],
    output: str | Path,
    *,
    cycles: int | None = None,
) -> pd.DataFrame:
    """Read a measurement table of any form, reduce it by Eqs. (1)-(5), write the reduced table to `output`.

    `measurements` is a CSV with `specimen, temperature_C, frequency_Hz`, optionally `origin`, and one of FORMS; paths
    of records are relative to the table. `geometry` is that of `read_geometry`, not looked at for ready moduli.
    `cycles` is the number at the end of each record that is reduced, None for those of the last ten seconds.
    """
    table = read_csv(measurements)
    frame = reduced_frame(table, geometry, cycles=cycles)
    isotherm = nominal_temperatures(table, frame["temperature_C"].to_numpy(float))
    if (turned := wrong_sign(frame.assign(temperature_C=isotherm))) is not None:
        raise table.error(*turned)
    frame = frame.reindex(columns=REDUCED_COLUMNS)
    write_table(output, frame)
    return frame


def reduced_frame(
    table: Table,
    geometry: str | Path | Mapping[str, Any],
    *,
    cycles: int | None = None,
    tests: Sequence[str] = KEYS,
) -> pd.DataFrame:
    """The rows of a measurement table with E_MPa and phase_deg, as `reduce_table` describes them.

    `tests` are the columns which, with the specimen, tell one test from another.
    """
    frame, form = _tests(table, tests)
    if form == "moduli":
        for name in FORMS[form]:
            frame[name] = table.numbers(name)
            if (told := digit_too_many(frame, name)) is not None:
                raise table.error(*told)
            table.numbers(name, LIMITS[name])
        stiffness, softest = frame["E_MPa"], 1.0
    else:
        specimens = read_geometry(geometry, frame["specimen"])
        if form == "peaks":
            _reduce_peaks(table, frame, specimens)
        else:
            _reduce_records(table, frame, specimens, cycles)
        _check_reduced(table, frame, form)
        # Judged without the mass term, which would hide a force a thousand times too small; of a true |E*| at least
        # SHARE_LEFT_BY_MASS is left without it.
        gamma = frame["specimen"].map({name: twopoint.form_factor(g) for name, g in specimens.items()})
        stiffness, softest = 1e-6 * gamma * frame["F0_N"] / frame["z0_m"], SHARE_LEFT_BY_MASS
    _check_stiffness(table, frame, form, stiffness, softest)
    _check_whole_table(table, frame, form)
    return frame


def is_reduced(columns: Iterable[str]) -> bool:
    """Whether a table with these columns, or more, is one that `reduce_table` wrote: peaks stand beside the moduli."""
    return {*KEYS, *FORMS["peaks"], *FORMS["moduli"], *PICKED} <= set(columns)


def require_enough(tests: int, frequencies: int) -> None:
    """Refuse fewer tests, or fewer different frequencies, than a diagnosis needs."""
    if tests < LEAST_TESTS or frequencies < LEAST_FREQUENCIES:
        raise InputError(
            f"{counted(tests, 'test')} at {frequencies} {'frequency' if frequencies == 1 else 'frequencies'} are too "
            f"few for a diagnosis; measure at least {LEAST_TESTS} tests at {LEAST_FREQUENCIES} frequencies."
        )


def tests_measured(measurements: str | Path) -> tuple[pd.DataFrame, str]:
    """Specimen, temperature, frequency and origin of each row of a table of any form, and which form it has."""
    return _tests(read_csv(measurements), KEYS)


def _tests(table: Table, tests: Sequence[str]) -> tuple[pd.DataFrame, str]:
    frame, form = _read_keys(table, tests), _form_of(table)
    table.require(FORMS[form])
    return frame, form


def read_reduced(path: str | Path) -> pd.DataFrame:
    """Read specimen (text), temperature, frequency, origin and modulus of each test of a reduced table."""
    table = read_csv(path)
    frame = _read_keys(table)
    table.require(FORMS["moduli"])
    for name in FORMS["moduli"]:
        frame[name] = table.numbers(name, LIMITS[name])
    return frame


def _read_keys(table: Table, tests: Sequence[str] = KEYS) -> pd.DataFrame:
    """Specimen, columns `tests` and origin of each row; refuses a test that is given twice."""
    table.require(["specimen", *KEYS])
    frame = pd.DataFrame({"specimen": table.text("specimen")})
    for name in tests:
        frame[name] = table.text(name) if name in LABELS else table.numbers(name, LIMITS.get(name))
    origin = table.text("origin") if "origin" in table.columns else ["measured"] * len(frame)
    for row, word in enumerate(origin):
        if word not in ORIGINS:
            raise table.error(row, f"origin {word!r} is not known; write one of {', '.join(ORIGINS)}.")
    again = np.flatnonzero(frame.duplicated())
    if again.size:
        raise table.error(int(again[0]), _repetition(table, frame, again))
    frame["origin"] = origin
    return frame


def _repetition(table: Table, frame: pd.DataFrame, again: NDArray[np.int64]) -> str:
    """What to say of rows `again` (n,), which repeat specimen and condition of earlier rows, and how to mend them."""
    rows = pd.Series(frame.index, frame.index)
    earlier = rows.groupby([frame[name] for name in frame]).transform("first").to_numpy()[again]
    names = [name for form in FORMS.values() for name in form if name in table.columns]
    values = pd.DataFrame({name: table.columns[name] for name in names})
    now, before = values.iloc[again], values.iloc[earlier]
    differ = now.to_numpy() != before.to_numpy()
    row, of = int(earlier[0]), frame.iloc[again[differ.any(axis=1)]]
    told = f"repeats the test of line {table.lines[row]}"
    if table.files is not None and table.files[row] != table.files[int(again[0])]:
        told = f"repeats the test of {table.place(row)}"
    if again.size > 1:
        told += f", and so {'do' if again.size > 2 else 'does'} {counted(again.size - 1, 'more row')}"
    if of.empty:
        return f"{told}, with equal values; keep one of the two."
    place = int(np.flatnonzero(differ.any(axis=1))[0])
    both = [
        f"{name} {before[name].iloc[place]} and {now[name].iloc[place]}"
        for name in now.columns[differ[place]]
    ]
    block, at = specimen_named(str(of["specimen"].iloc[0])), of["temperature_C"].unique()
    if len(of) == 1 or of["specimen"].nunique() > 1:
        ask = "is a name, a temperature or a frequency wrong? Correct it, or keep the true one of the two"
    elif at.size > 1:
        ask = f"is the name of this block, {block}, wrong? Correct it"
    else:
        ask = f"is the temperature of this block, {at[0]:g} degC, or its name, {block}, wrong? Correct it"
    return f"{told}, with other values ({', '.join(both)}): {ask}."


def _form_of(table: Table) -> str:
    """The one form of FORMS of which columns are there, in whatever unit; refuses none or several."""
    present = [
        form
        for form, names in FORMS.items()
        if any(name in table.columns or table.lookalike(name) is not None for name in names)
    ]
    forms = "; or ".join(", ".join(names) for names in FORMS.values())
    if not present:
        raise InputError(f"{table.path}: no measured quantity found; give the columns {forms}.")
    if len(present) > 1:
        raise InputError(f"{table.path}: holds {' and '.join(present)} together; keep one of {forms}.")
    return present[0]


def _reduce_peaks(table: Table, frame: pd.DataFrame, specimens: dict[str, twopoint.Geometry]) -> None:
    """Put peaks, and by Eqs. (1)-(5) E_MPa and phase_deg, into `frame`."""
    for name in FORMS["peaks"]:
        frame[name] = table.numbers(name, LIMITS[name])
    for specimen, rows in frame.groupby("specimen").groups.items():
        part = frame.loc[rows]
        modulus = twopoint.complex_modulus(
            specimens[specimen], part["frequency_Hz"], part["F0_N"], part["z0_m"], np.radians(part["psi_deg"])
        )
        frame.loc[rows, "E_MPa"], frame.loc[rows, "phase_deg"] = _table_values(modulus)


def _reduce_records(
    table: Table, frame: pd.DataFrame, specimens: dict[str, twopoint.Geometry], cycles: int | None
) -> None:
    """Put OF_RECORDS into `frame`, each record reduced twice: by a harmonic fit, and by its peaks as in the paper."""
    reduced = []
    for row, name in enumerate(table.text("record")):
        specimen, frequency = frame.at[row, "specimen"], frame.at[row, "frequency_Hz"]
        try:
            path = inside(table.path.parent, name)
            record = read_csv(path)
            record.require(RECORD_COLUMNS)
            time, force, displacement = (record.numbers(column) for column in RECORD_COLUMNS)
            try:
                harmonic = signals.harmonic_response(time, force, displacement, frequency, cycles)
                peak = signals.peak_response(time, force, displacement, frequency, cycles)
            except InputError as error:
                raise InputError(f"{path}: {error}") from None
        except InputError as error:
            raise table.error(row, f"record {error}") from None
        values = [harmonic.force_amplitude, harmonic.displacement_amplitude, np.degrees(harmonic.phase)]
        for response in (harmonic, peak):
            modulus = twopoint.complex_modulus(
                specimens[specimen],
                frequency,
                response.force_amplitude,
                response.displacement_amplitude,
                response.phase,
            )
            values.extend(_table_values(modulus))
        reduced.append(values)
    frame[list(OF_RECORDS)] = np.array(reduced)


def _table_values(modulus: NDArray[np.complex128]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    norm, phase = twopoint.norm_and_phase(modulus)
    return norm * 1e-6, np.degrees(phase)


def _check_reduced(table: Table, frame: pd.DataFrame, form: str) -> None:
    """Refuse a row whose peaks or record give an impossible E*."""
    for name in FORMS["moduli"]:
        limits = LIMITS[name]
        outside = np.flatnonzero(~frame[name].between(limits.low, limits.high))
        if outside.size:
            row = int(outside[0])
            raise table.error(
                row,
                f"the {form} give {name} = {frame.at[row, name]:.4g}, outside {limits.low:g} to "
                f"{limits.high:g}; check the units of force and displacement, the sign of the phase "
                "and the geometry.",
            )


def _check_stiffness(
    table: Table, frame: pd.DataFrame, form: str, stiffness: pd.Series, softest: float
) -> None:
    """Refuse a `stiffness` (n,) [MPa] below `softest` times that of any asphalt at its temperature and frequency."""
    least = softest * least_modulus(frame["temperature_C"], frame["frequency_Hz"])
    below = np.flatnonzero(stiffness < least)
    if below.size:
        row = int(below[0])
        mend = "E_MPa looks like GPa, multiply by 1000" if form == "moduli" else "check F0 in N and z0 in m"
        raise table.error(
            row,
            f"{stiffness[row]:.4g} MPa is softer than any asphalt at {frame.at[row, 'temperature_C']:g} degC and "
            f"{frame.at[row, 'frequency_Hz']:g} Hz ({float(f'{least[row]:.2g}'):g} MPa); {mend}.",
        )


def _check_whole_table(table: Table, frame: pd.DataFrame, form: str) -> None:
    """Refuse a table whose values make sense only in another unit or with the other sign."""
    if frame["phase_deg"].median() < -0.5:  # an elastic reference beam may scatter about zero
        raise InputError(
            f"{table.path}: phases are mostly negative; give the angle by which the force leads: remove the minus "
            "signs."
        )
    largest = frame["phase_deg"].abs().max()
    expected = LARGEST_PHASE_AT_LEAST["soft" if frame["E_MPa"].min() < GLASSY else "glassy"]
    # Phases of records are computed here: their unit is not in question.
    if form != "records" and largest <= expected:
        raise InputError(
            f"{table.path}: the largest phase is {largest:.3g}: is it in radians? "
            "Multiply by 180/pi. If it is in degrees, the specimen is elastic and says nothing about a mix."
        )
