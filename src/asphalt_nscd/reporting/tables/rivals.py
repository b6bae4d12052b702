"""How far one law for all temperatures reaches: on what it was fitted to, and on what it has not seen."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.measurements.agreement import KEYS
from asphalt_nscd.measurements.tables import origin_of, read_measured
from asphalt_nscd.rheology.rivals import Complex, Rival, Vector, left_out, rivals

REFERENCE = 15.0  # degC; any choice gives the same laws
KINDS = ("fitted", "inner_temperatures", "end_temperatures", "inner_frequencies", "end_frequencies")
TEMPERATURES = 4  # fewest of which one can be left out: two parameters of the shift need three


def make(measured: list[Path]) -> pd.DataFrame:
    """One row for each table of measurements and law: mean relative errors in percent of averages over specimens.

    measured: files, one for each table, named by the folder that holds them. fitted: errors of the tests that the law
    was fitted to. Each other column: tests left out, a temperature or a frequency at a time; "end" is the lowest and
    the highest, "inner" all between; none where the rest would have fewer than three temperatures, which leave the
    shift undetermined. No simulation: a specimen with facets returns its law.
    """
    rows: list[dict[str, object]] = []
    for number, path in enumerate(measured):
        frame = read_measured([path])
        origin = origin_of(frame)
        # The first table is the study's own; the others are called after their folders.
        name = path.parent.name if number else origin
        data = frame.groupby(KEYS)[["E_MPa", "phase_deg"]].mean().reset_index()
        omega = 2.0 * np.pi * data["frequency_Hz"].to_numpy()
        temperature = data["temperature_C"].to_numpy()
        modulus = 1e6 * data["E_MPa"].to_numpy() * np.exp(1j * np.radians(data["phase_deg"].to_numpy()))
        for rival in rivals(omega, temperature, modulus, REFERENCE):
            errors = dict(errors_of(rival, omega, temperature, modulus))
            rows.append(
                {"data": name, "origin": origin, "law": rival.name, "parameters": rival.low.size}
                | {
                    f"{kind}_{q}_percent": errors.get((kind, q), np.nan)
                    for q in ("E", "phase")
                    for kind in KINDS
                }
            )
    return pd.DataFrame(rows)


def errors_of(
    rival: Rival, omega: Vector, temperature: Vector, modulus: Complex
) -> Iterator[tuple[tuple[str, str], float]]:
    """Mean relative error in percent by (tests, quantity)."""

    def missed(x: Vector, tests: np.ndarray) -> dict[str, Vector]:
        law, true = rival.modulus(x, omega[tests], temperature[tests]), modulus[tests]
        return {
            "E": np.abs(np.abs(law) / np.abs(true) - 1.0),
            "phase": np.abs(np.angle(law) - np.angle(true)) / np.abs(np.angle(true)),
        }

    everywhere = np.ones(omega.size, bool)
    whole = rival.fit(omega, temperature, modulus)
    for quantity, errors in missed(whole, everywhere).items():
        yield ("fitted", quantity), 100.0 * float(errors.mean())
    for kind, groups, fewest in (("temperatures", temperature, TEMPERATURES), ("frequencies", omega, 2)):
        if np.unique(groups).size < fewest:
            continue
        ends = groups.min(), groups.max()
        found: dict[tuple[str, str], list[float]] = {}
        for value, x in left_out(rival, omega, temperature, modulus, groups, whole):
            place = "end" if value in ends else "inner"
            for quantity, errors in missed(x, groups == value).items():
                found.setdefault((f"{place}_{kind}", quantity), []).append(float(errors.mean()))
        for key, means in sorted(found.items(), reverse=True):
            yield key, 100.0 * float(np.mean(means))
