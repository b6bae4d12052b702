"""The simulation extended by what a diagnosis named: a law for each test, and a rig for each sample.

One continuous law holds for all temperatures (`record.law`). It is fitted to the measurements less what causes do to
them, possible ones by their probability; the simulation puts back as much. A test gets the Kelvin chain of this law at
its temperature, changed by the causes that sit in the material or the specimen; those at the head and in the channel
become the rig.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import MATERIAL, SPECIMEN
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.observed.observations import Complex, Observations, Vector
from asphalt_nscd.diagnosis.observed.reading import read_observations
from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.laws_io import write_chain
from asphalt_nscd.rheology.spectrum import Spectrum
from asphalt_nscd.rheology.spectrum_io import read_spectrum

TOLERANCE = 1e-3  # of ln E* of a Kelvin chain over the tested band
MARGIN = 2.0  # of the band, for the transient of a test


@dataclass(frozen=True)
class Sample:
    """One numerical specimen, and the simulated tests on it.

    `number`, from 0, stands for the measured specimen of this number (more samples than specimens: for these in turn);
    `amplitude` in m; each of `tests` is temperature [degC], frequency [Hz] and the file of the bond law to write.
    """

    number: int
    amplitude: float
    tests: Sequence[tuple[float, float, str | Path]]


def extend(
    diagnosis_file: str | Path,
    law_file: str | Path,
    measured: str | Path,
    geometry: str | Path | Mapping[str, Any],
    sample: Sample,
    rig_output: str | Path,
) -> None:
    """Write the bond law (a Kelvin chain) of each test of one sample, and its rig.

    The law goes into the bonds as it is: with facets, |E*| of a specimen is that of its law (docs/mapping.md).
    """
    named = causes_taken_off(diagnosis_file)
    observed, _ = read_observations(measured, geometry)
    law = read_spectrum(law_file)
    # More samples than specimens stand for these in turn.
    stands_for = sample.number % len(observed.names)
    frequencies = [frequency for _, frequency, _ in sample.tests]
    band = {"lowest_hz": min(frequencies) / MARGIN, "highest_hz": max(frequencies) * MARGIN}
    slowest, fastest = (2.0 * np.pi * frequency for frequency in band.values())
    for temperature, frequency, path in sample.tests:
        row = _row(observed, stands_for, temperature, frequency)
        bonds = _bond_modulus(law, observed, row, named)
        chain, error = kelvin_chain(bonds, slowest, fastest, TOLERANCE)
        write_chain(path, chain, source="diagnosis", temperature=temperature, error=error, **band)
    rig: dict[str, float] = {}
    gamma = float(observed.form_factor[observed.specimen == stands_for][0])
    for candidate in named:
        if candidate.place is None or candidate.place == observed.names[stands_for]:
            rig |= candidate.cause.rig(np.array(candidate.values), gamma, sample.amplitude)
    write_json(rig_output, {key: float(value) for key, value in rig.items()})


def _bond_modulus(
    law: Spectrum, observed: Observations, row: int, named: Sequence[Candidate]
) -> Callable[[Vector], Complex]:
    """E* [Pa] at omega (m,) [rad/s] of the mix in one test, with the causes that sit in mix or specimen."""
    here = [c for c in named if c.cause.rows(observed, c.place)[row]]
    rises = [c.cause.temperature_rise(np.array(c.values), observed) for c in here]
    temperature = observed.temperature[row] + sum(np.broadcast_to(rise, observed.size)[row] for rise in rises)
    inside = [c for c in here if c.cause.stage == MATERIAL or _scales(c)]

    def modulus(omega: Vector) -> Complex:
        # A subset keeps the table as its whole, to which largest amplitudes and last cycles refer.
        swept = replace(observed.subset(np.full(omega.size, row)), frequency=omega / (2.0 * np.pi))
        value = law.complex_modulus(omega, temperature)
        for candidate in sorted(inside, key=lambda c: c.cause.stage):
            value = candidate.cause.apparent(value, np.array(candidate.values), swept)
        return value

    return modulus


def causes_taken_off(diagnosis_file: str | Path) -> list[Candidate]:
    """Causes in ladder order that the law of a diagnosis.json is free of, as large as it is; not bonds and law."""
    content = read_json(diagnosis_file)
    causes = {cause.name: cause for cause in CATALOGUE}
    out = []
    try:
        for rung in content["ladder"]:
            if rung["cause"] in ("relaxation_spectrum", BOND_MAPPING) or not rung["taken_off"]:
                continue
            cause = causes[rung["cause"]]
            size, *shapes = (float(rung["parameters"][p.name]["value"]) for p in cause.parameters)
            out.append(Candidate(cause, rung["where"], (float(rung["taken_off"]) * size, *shapes)))
    except (KeyError, TypeError) as error:
        raise InputError(
            f"{diagnosis_file}: not a diagnosis of this version ({error}); make it again."
        ) from None
    return out


def _scales(candidate: Candidate) -> bool:
    """Whether a cause of the specimen acts on its modulus, and not at its head."""
    rig = candidate.cause.rig(np.array(candidate.values), 1.0, 1.0)
    return candidate.cause.stage == SPECIMEN and not rig


def _row(observed: Observations, specimen: int, temperature: float, frequency: float) -> int:
    """The row of a test, of another specimen where this one has none."""
    near = (np.abs(observed.temperature - temperature) < 1e-6) & (
        np.abs(observed.frequency / frequency - 1.0) < 1e-9
    )
    own = np.flatnonzero(near & (observed.specimen == specimen))
    found = own if own.size else np.flatnonzero(near)
    if not found.size:
        raise InputError(
            f"the extended test at {temperature:g} degC, {frequency:g} Hz has no measurement; add one to the table."
        )
    return int(found[0])
