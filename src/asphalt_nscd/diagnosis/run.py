"""A diagnosis from files to files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis import bond_mapping, quality, report, suspects, within_isotherm
from asphalt_nscd.diagnosis.diagnose import Diagnosis, diagnose
from asphalt_nscd.diagnosis.extension import law_notes, material_law, prior_notes
from asphalt_nscd.diagnosis.numerics import of_campaign
from asphalt_nscd.diagnosis.observations import Observations
from asphalt_nscd.diagnosis.reading import read_observations
from asphalt_nscd.diagnosis.simulated import NumericalSpecimen, read_specimen
from asphalt_nscd.diagnosis.summary import summary
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.measurements.campaign import Campaign, isotherm_notes
from asphalt_nscd.rheology.spectrum_io import write_spectrum


def run(
    measurements: str | Path | Campaign, folder: str | Path, geometry: str | Path | Mapping[str, Any],
    specimen: str | Path | None = None, static_modulus: float | None = None,
    scatter: tuple[float, float] | None = None, draws: int = 4000, seed: int = 0,
    simulations: str | Path | None = None, facets: str | Path | None = None,
) -> str:  # fmt: skip
    """Diagnose measurements and write four files into the folder; the summary.

    The files: diagnosis.json, residuals.csv, causality.csv and law.json. simulations: table of simulated tests, whose
    numerics are judged; facets: of the same tests with bonds that are facets, beside which bond_mapping is judged.
    """
    numerical = read_specimen(specimen)
    campaign = measurements if isinstance(measurements, Campaign) else None
    given = Path(measurements) if campaign is None else campaign.table.path
    files = (given,) if campaign is None else campaign.files
    observed, origin = read_observations(measurements, geometry, static_modulus)
    try:
        diagnosis = diagnose(observed, scatter, draws=draws, seed=seed)
    except InputError as error:
        raise InputError(f"{given}: {error}") from None
    fit = None if observed.isotherms.size < 2 else material_law(diagnosis)
    content, before = report.as_json(diagnosis, numerical), None
    if fit is not None:
        content["notes"] += law_notes(diagnosis, fit.law) + prior_notes(fit)
    content["reading"] = reading(observed, () if campaign is None else campaign.notes)
    if simulations is not None:
        content["numerics"]["campaign"] = of_campaign(simulations, observed.temperature, observed.frequency)
        before = _begin_with_campaigns(content, diagnosis, numerical, simulations, facets)
    content["origin"] = origin
    content["provenance"] = {
        **provenance(),
        "measurements": given.name,
        **_checksums(files),
        "draws": draws,
        "seed": seed,
        "geometry": dict(geometry) if isinstance(geometry, Mapping) else Path(geometry).name,
        "specimen": None if specimen is None else Path(specimen).name,
        "static_modulus_Pa": static_modulus,
        "scatter_stated": None if scatter is None else list(scatter),
    }
    folder = Path(folder)
    write_table(folder / "residuals.csv", report.residual_table(diagnosis, numerical, before))
    held = within_isotherm.hold(observed)
    write_table(folder / "causality.csv", suspects.table(observed, list(diagnosis.suspects), held))
    if fit is not None:
        write_spectrum(
            folder / "law.json", fit.law, source=f"fitted ({origin})", rms_log_residual=fit.rms_log_residual,
            std_error=fit.std_error, unseen=fit.unseen, from_prior=fit.from_prior,
        )  # fmt: skip
    write_json(folder / "diagnosis.json", content)
    written = ["diagnosis.json", "residuals.csv", "causality.csv", *([] if fit is None else ["law.json"])]
    return f"{summary(content)}\n\nWritten to {folder}: {', '.join(written)}."


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
        if rung is None:
            content["notes"].append(sentence)
    for law in content["ladder"]:
        if law["cause"] == "relaxation_spectrum":
            law["gain"]["in_sample"]["averages_by_temperature"] = report.averages(
                diagnosis, after, report.with_common_law(diagnosis, specimen)
            )
    content["ladder"][:0] = [] if rung is None else [rung]
    return before


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
