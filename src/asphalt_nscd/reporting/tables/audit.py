"""Every checkable statement of the paper beside what we find."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import chain
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.bending.collect import collect
from asphalt_nscd.files.store import load, read_json
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import at_temperature, read_measured, the_only
from asphalt_nscd.reporting.audit import equations, outcomes, preparation
from asphalt_nscd.reporting.gathered import gathered
from asphalt_nscd.reporting.tables import table2
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.specimen.counts import read_counts


@dataclass(frozen=True)
class Results:
    """Paths of all that the statements are held against."""

    grading: list[Path]
    counts: list[Path]
    laws: list[Path]
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
    converged: list[Path]
    stopped: list[Path]
    profile: list[Path]
    ladder: list[Path]
    facets: Sequence[Path] = ()


@gathered(Results)
def make(results: Results) -> pd.DataFrame:
    """One row for each statement: where, statement, published, ours, unit, verdict, evidence."""
    tests = pd.read_csv(the_only(results.simulations, "simulations"))
    changed = pd.read_csv(the_only(results.sensitivity, "sensitivity"))
    other = pd.read_csv(the_only(results.readings, "readings"))
    errors = pd.read_csv(the_only(results.table4, "table4"))
    published = dict(zip(*read_published(the_only(results.laws, "laws"), "kPa"), strict=True))
    other["ratio"] = other["E_MPa"] / other["E_law_MPa"]
    pascal, blocked = other[other["law_source"] == "pascal"], other[other["head"] == "blocked"]
    audited = str(other["specimen"].iloc[0])
    whole = tests[(tests["specimen"] == audited) & (tests["broken_bonds"] == 0)]
    c = float((whole["E_MPa"] / whole["E_law_MPa"]).mean())
    rungs = pd.read_csv(the_only(results.ladder, "ladder"))
    scatter = float(rungs.loc[rungs["temperature_C"].idxmin(), "scatter_phase_percent"])
    rows = chain(
        equations.equations(published),
        equations.readings(c, _by_frequency(pascal), _by_frequency(blocked)),
        preparation.bonds(pd.read_csv(the_only(results.bond_readings, "bond_readings"))),
        preparation.counts(*read_counts(the_only(results.counts, "counts"))),
        preparation.grading(table2.make(results.grading, results.counts, results.counts)),
        preparation.samples(
            [load(path, "deposit").attributes for path in results.deposits],
            [load(path, "specimen").attributes for path in results.specimens],
        ),
        outcomes.numerics(tests, collect(results.converged), collect(results.stopped)),
        outcomes.profile(load(the_only(results.profile, "profile"), "test").arrays),
        outcomes.laws_and_samples(
            tests,
            pd.read_csv(the_only(results.packing, "packing")),
            pd.read_csv(the_only(results.facets, "facets")) if results.facets else None,
        ),
        outcomes.agreement(errors, _refit_errors(results.fitted, results.measured), scatter),
        outcomes.sensitivity(changed, at_temperature(tests, float(changed["temperature_C"].iloc[0]))),
        outcomes.not_checkable(),
    )
    return pd.DataFrame([asdict(row) for row in rows]).map(_rounded)


def _rounded(value: object) -> object:
    return float(f"{value:.6g}") if isinstance(value, float) else value


def _by_frequency(tests: pd.DataFrame) -> dict[float, float]:
    return dict(zip(tests["frequency_Hz"], tests["ratio"], strict=True))


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
