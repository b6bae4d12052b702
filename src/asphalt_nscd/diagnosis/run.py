"""A diagnosis from files to files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis import (
    bond_mapping,
    measured_limits,
    quality,
    repeatability,
    report,
    suspects,
    within_isotherm,
)
from asphalt_nscd.diagnosis.diagnose import Diagnosis, diagnose
from asphalt_nscd.diagnosis.extension import law_notes, material_law, prior_notes
from asphalt_nscd.diagnosis.instructions import instructions
from asphalt_nscd.diagnosis.measured_limits import Progress
from asphalt_nscd.diagnosis.numerics import of_campaign
from asphalt_nscd.diagnosis.observations import Observations
from asphalt_nscd.diagnosis.reading import read_observations
from asphalt_nscd.diagnosis.simulated import NumericalSpecimen, read_specimen
from asphalt_nscd.diagnosis.summary import summary
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.measurements.campaign import Campaign, isotherm_notes
from asphalt_nscd.rheology.spectrum_io import spectrum_content

STEPS = 5  # read, causes, law, second opinion, next tests
FEW_DRAWS = 1000  # where a second opinion is asked for


@dataclass
class Steps:
    """Says how far a diagnosis has come."""

    progress: Progress
    done: int = 0

    def step(self) -> None:
        self.done += 1
        self.progress("Diagnose", self.done, STEPS)


@dataclass(frozen=True)
class Outcome:
    """What a diagnosis gives: the content of its files."""

    content: dict[str, Any]  # of diagnosis.json
    residuals: pd.DataFrame
    causality: pd.DataFrame
    law: dict[str, Any] | None  # content of law.json; None for one isotherm
    diagnosis: Diagnosis | None = None  # that gave them; None if they were read from files
    limits: pd.DataFrame | None = None  # of limits.csv, where limits were verified

    def with_limits(self, table: pd.DataFrame) -> Outcome:
        """The same with limits that were verified."""
        content = self.content | {"measured_limits": measured_limits.summarised(table)}
        return replace(self, content=content, limits=table)

    def write(self, folder: str | Path) -> list[str]:
        """Write the files into a folder; their names."""
        folder = Path(folder)
        write_table(folder / "residuals.csv", self.residuals)
        write_table(folder / "causality.csv", self.causality)
        if self.law is not None:
            write_json(folder / "law.json", self.law)
        if self.limits is not None:
            write_table(folder / "limits.csv", self.limits)
        write_json(folder / "diagnosis.json", self.content)
        return [
            "diagnosis.json",
            "residuals.csv",
            "causality.csv",
            *([] if self.law is None else ["law.json"]),
            *([] if self.limits is None else ["limits.csv"]),
        ]

    def written(self, folder: str | Path) -> str:
        """Write the files; the summary, and what was written."""
        names = self.write(folder)
        return f"{summary(self.content)}\n\nWritten to {folder}: {', '.join(names)}."


def run(
    measurements: str | Path | Campaign, folder: str | Path, geometry: str | Path | Mapping[str, Any],
    specimen: str | Path | None = None, static_modulus: float | None = None,
    scatter: tuple[float, float] | None = None, draws: int = 4000, seed: int = 0,
    simulations: str | Path | None = None, facets: str | Path | None = None,
) -> str:  # fmt: skip
    """Diagnose measurements and write four files into the folder; the summary. See `conclude`."""
    outcome = conclude(
        measurements, geometry, specimen, static_modulus, scatter, draws, seed, simulations, facets
    )
    return outcome.written(folder)


def conclude(
    measurements: str | Path | Campaign, geometry: str | Path | Mapping[str, Any],
    specimen: str | Path | None = None, static_modulus: float | None = None,
    scatter: tuple[float, float] | None = None, draws: int = 4000, seed: int = 0,
    simulations: str | Path | None = None, facets: str | Path | None = None,
    progress: Progress = lambda *_: None,
) -> Outcome:  # fmt: skip
    """Diagnose measurements.

    static_modulus [Pa]; scatter: of |E*| (relative) and phase [rad]. simulations: table of simulated tests, whose
    numerics are judged; facets: of the same tests with bonds that are facets, beside which bond_mapping is judged.
    """
    done = Steps(progress)
    numerical = read_specimen(specimen)
    campaign = measurements if isinstance(measurements, Campaign) else None
    given = Path(measurements) if campaign is None else campaign.table.path
    files = (given,) if campaign is None else campaign.files
    observed, origin = read_observations(measurements, geometry, static_modulus)
    done.step()
    try:
        diagnosis = diagnose(observed, scatter, draws=draws, seed=seed)
    except InputError as error:
        raise InputError(f"{given}: {error}") from None
    done.step()
    fit = None if observed.isotherms.size < 2 else material_law(diagnosis)
    content, before = report.as_json(diagnosis, numerical), None
    if fit is not None:
        content["notes"] += law_notes(diagnosis, fit.law) + prior_notes(fit)
    done.step()
    content["reading"] = reading(observed, () if campaign is None else campaign.notes)
    if simulations is not None:
        content["numerics"]["campaign"] = of_campaign(simulations, observed.temperature, observed.frequency)
        before = _begin_with_campaigns(content, diagnosis, numerical, simulations, facets)
    content["origin"] = origin
    held = within_isotherm.hold(observed)
    content["repeatability"] = repeatability.coefficients(diagnosis.observed)
    content["with_suspects"] = with_suspects(diagnosis, scatter, seed)
    done.step()
    content["instructions"] = instructions(diagnosis)
    done.step()
    content["contradictory_isotherms"] = [
        {"temperature_C": one.temperature, "sentence": one.sentence}
        for one in suspects.broken_isotherms(observed, held)
    ]
    content["provenance"] = {
        **provenance(),
        "measurements": given.name,
        **(_checksums(files) if files else {}),
        "draws": draws,
        "seed": seed,
        "geometry": dict(geometry) if isinstance(geometry, Mapping) else Path(geometry).name,
        "specimen": None if specimen is None else Path(specimen).name,
        "static_modulus_Pa": static_modulus,
        "scatter_stated": None if scatter is None else list(scatter),
    }
    law = None
    if fit is not None:
        law = spectrum_content(
            fit.law, source=f"fitted ({origin})", rms_log_residual=fit.rms_log_residual,
            std_error=fit.std_error, unseen=fit.unseen, from_prior=fit.from_prior,
        )  # fmt: skip
    return Outcome(
        content, report.residual_table(diagnosis, numerical, before),
        suspects.table(observed, list(diagnosis.suspects), held), law, diagnosis,
    )  # fmt: skip


def _begin_with_campaigns(
    content: dict[str, Any], diagnosis: Diagnosis, specimen: NumericalSpecimen, simulations: str | Path,
    facets: str | Path | None,
) -> NDArray[np.complex128]:  # fmt: skip
    """Put what was simulated before the ladder: its first rung, and the errors before the law. ln E* (n,) of it."""
    observed = diagnosis.observed
    before = after = bond_mapping.simulated(simulations, observed)
    rung = None
    if facets is None:
        content["notes"].append(bond_mapping.void(simulations))
    else:
        after = bond_mapping.simulated(facets, observed)
        rung, sentence = bond_mapping.bond_mapping(
            simulations, facets, report.averages(diagnosis, before, after)
        )
        content["notes"].append(sentence)
    for law in content["ladder"]:
        if law["cause"] == "relaxation_spectrum":
            law["gain"]["in_sample"]["averages_by_temperature"] = report.averages(
                diagnosis, after, report.with_common_law(diagnosis, specimen)
            )
    content["ladder"][:0] = [] if rung is None else [rung]
    return before


def with_suspects(
    diagnosis: Diagnosis, scatter: tuple[float, float] | None, seed: int
) -> dict[str, Any] | None:
    """What is named if the tests that were set aside are used; None where none was."""
    if diagnosis.whole is None or not diagnosis.set_aside.size:
        return None
    other = diagnose(diagnosis.whole, scatter, draws=FEW_DRAWS, seed=seed, use_suspects=True)
    named = [
        {"cause": rung.candidate.cause.name, "where": rung.candidate.place} for rung in other.ladder.rungs
    ]
    law = [{"cause": "relaxation_spectrum", "where": None}] if other.relaxation_spectrum else []
    return {"verdict": other.verdict, "causes": [*law, *named]}


def reading(observed: Observations, notes: Sequence[str]) -> dict[str, Any]:
    """How the measurements were read: test type, isotherms, quality limits exceeded; notes of the import."""
    specimen = [observed.names[place] for place in observed.specimen]
    above = [
        {
            "specimen": specimen[one.row], "temperature_C": float(observed.isotherm[one.row]),
            "frequency_Hz": float(observed.frequency[one.row]), "column": one.column, "value": one.value,
            "limit": one.limit,
        }
        for one in quality.exceeded(observed)
    ]  # fmt: skip
    together = isotherm_notes(observed.temperature, observed.isotherm)
    if together:
        together.append("The law is fitted to the measured temperatures.")
    return {
        "test_type": observed.test_type,
        "specimens": list(observed.names),
        "isotherms_C": observed.isotherms.tolist(),
        "quality_columns": [name for name in quality.COLUMNS if name in observed.quality],
        "limits_exceeded": above,
        "notes": [
            *notes,
            *together,
            *_quality_notes(above, observed.size),
        ],
    }


def _quality_notes(above: Sequence[Mapping[str, Any]], tests: int) -> list[str]:
    """A sentence for each quality limit that some tests exceed, with the worst of them."""
    notes = []
    for name, limit in quality.LIMITS.items():
        found = sorted((one for one in above if one["column"] == name), key=lambda one: -one["value"])
        if found:
            worst = "; ".join(
                f"{one['specimen']} at {one['temperature_C']:g} degC, {one['frequency_Hz']:g} Hz: "
                f"{one['value']:g} {limit.unit}"
                for one in found[:3]
            )
            notes.append(
                f"{limit.label.capitalize()} above {limit.limit:g} {limit.unit} ({limit.source}) in {len(found)} of "
                f"{tests} tests: {worst}{'; and others' if len(found) > 3 else ''}."
            )
    return notes


def _checksums(files: Sequence[Path]) -> dict[str, Any]:
    """The SHA-256 of one file, or name and SHA-256 of each of several."""
    sums = [(path.name, sha256(path.read_bytes()).hexdigest()) for path in files]
    if len(sums) == 1:
        return {"sha256": sums[0][1]}
    return {"files": [{"name": name, "sha256": digest} for name, digest in sums]}
