"""The statements of the paper, sections 2 to 5, beside what we find."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.bending.collect import collect
from asphalt_nscd.files.store import load, read_json
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import at_temperature, read_measured, the_only
from asphalt_nscd.reporting.audit import equations, outcomes, preparation
from asphalt_nscd.reporting.audit.statement import told
from asphalt_nscd.reporting.gathered import gathered
from asphalt_nscd.reporting.tables import table2
from asphalt_nscd.reporting.tables.table4 import read_errors
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.specimen.counts import read_counts


@dataclass(frozen=True)
class Results:
    """Paths of all that the statements are held against."""

    statements: list[Path]
    grading: list[Path]
    counts: list[Path]
    laws: list[Path]
    errors: list[Path]
    fitted: list[Path]
    measured: list[Path]
    simulations: list[Path]
    sensitivity: list[Path]
    readings: list[Path]
    bond_readings: list[Path]
    packing: list[Path]
    table4: list[Path]
    deposits: list[Path]
    specimens: list[Path]
    time_steps: list[Path]
    stopped: list[Path]
    waveform: list[Path]
    profile: list[Path]
    facets: Sequence[Path] = ()


@gathered(Results)
def make(results: Results) -> pd.DataFrame:
    """One row for each statement of the paper: what it says, what we find, and what would have changed that."""
    tests = pd.read_csv(the_only(results.simulations, "simulations"))
    changed = pd.read_csv(the_only(results.sensitivity, "sensitivity"))
    # In kPa: in the Pa that Table 3 prints, asphalt at -10 degC would be a rubber of 40 MPa.
    published = dict(zip(*read_published(the_only(results.laws, "laws"), "kPa"), strict=True))
    pascal, blocked = _relative(pd.read_csv(the_only(results.readings, "readings")), tests)
    diameter, count = read_counts(the_only(results.counts, "counts"))
    deposits = [load(path, "deposit") for path in results.deposits]
    readings = pd.read_csv(the_only(results.bond_readings, "bond_readings"))
    allowed = list(readings.loc[readings["possible"], "expected"])
    rows = chain(
        equations.laboratory(),
        equations.contact_law(published[15.0]),
        equations.calibration(published, pascal),
        equations.table_4(published, read_errors(the_only(results.errors, "errors"))),
        equations.typical_numbers(diameter, count, preparation.DENSITY),
        preparation.bonds(readings),
        [
            preparation.lattice(count),
            preparation.grading(table2.make(results.grading, results.counts, results.counts)),
            preparation.contacts(tests),
        ],
        preparation.samples(
            [deposit.attributes for deposit in deposits],
            [load(path, "specimen").attributes for path in results.specimens],
            [preparation.moved_above(deposit.arrays) for deposit in deposits],
        ),
        outcomes.numerics(
            tests, pd.read_csv(the_only(results.time_steps, "time_steps")), collect(results.stopped)
        ),
        outcomes.profile(load(the_only(results.profile, "profile"), "test").arrays),
        outcomes.laws_and_samples(
            tests,
            pd.read_csv(the_only(results.packing, "packing")),
            pd.read_csv(the_only(results.facets, "facets")) if results.facets else None,
            allowed,
        ),
        outcomes.agreement(
            pd.read_csv(the_only(results.table4, "table4")),
            tests,
            _refit_errors(results.fitted, results.measured),
            equations.head(blocked),
            allowed,
        ),
        [
            outcomes.reduction(tests),
            outcomes.waveform(load(the_only(results.waveform, "waveform"), "test")),
        ],
        outcomes.sensitivity(changed, at_temperature(tests, float(changed["temperature_C"].iloc[0]))),
    )
    return told(the_only(results.statements, "statements"), rows)


def _relative(other: pd.DataFrame, tests: pd.DataFrame) -> tuple[dict[float, float], dict[float, float]]:
    """|E*| over its law by frequency [Hz], over that of the same sample in the study: in Pa, and with its head blocked.

    other: readings.csv; tests: simulations.csv.
    """
    whole = tests[(tests["specimen"] == str(other["specimen"].iloc[0])) & (tests["broken_bonds"] == 0)]
    level = float((whole["E_MPa"] / whole["E_law_MPa"]).mean())
    ratio = other["E_MPa"] / other["E_law_MPa"] / level
    pascal, blocked = (
        dict(zip(other.loc[rows, "frequency_Hz"], ratio[rows], strict=True))
        for rows in (other["law_source"] == "pascal", other["head"] == "blocked")
    )
    return pascal, blocked


def _refit_errors(fitted: list[Path], measured: list[Path]) -> pd.DataFrame:
    """Mean relative errors of the refitted Burgers laws against the data that they were fitted to."""
    data = read_measured(measured)
    frames = []
    for path in fitted:
        law = read_law(path)
        points = at_temperature(data, read_json(path)["temperature_C"])[["temperature_C", "frequency_Hz"]]
        points = points.drop_duplicates()
        modulus = law.complex_modulus(2.0 * np.pi * points["frequency_Hz"].to_numpy())
        frames.append(points.assign(E_MPa=np.abs(modulus) / 1e6, phase_deg=np.degrees(np.angle(modulus))))
    return mean_relative_error(data, pd.concat(frames, ignore_index=True))
