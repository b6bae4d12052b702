"""A diagnosis from files to files, and its summary for the terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from tabulate import tabulate

from asphalt_nscd.diagnosis import quality, report, suspects, within_isotherm
from asphalt_nscd.diagnosis.diagnose import diagnose
from asphalt_nscd.diagnosis.extension import law_notes, material_law, prior_notes
from asphalt_nscd.diagnosis.numerics import of_campaign
from asphalt_nscd.diagnosis.observations import Observations
from asphalt_nscd.diagnosis.reading import read_observations
from asphalt_nscd.diagnosis.simulated import read_specimen
from asphalt_nscd.diagnosis.written import CONFIDENCE, UNJUDGED
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.measurements.campaign import Campaign, isotherm_notes
from asphalt_nscd.rheology.spectrum_io import write_spectrum

VERDICTS = {
    "explained": "explained: what is left is replicate scatter.",
    "unexplained_structure": "unexplained structure: something is left that no single cause of the catalogue explains.",
    "nothing_to_explain": "nothing to explain: the Burgers laws miss the measurements by no more than scatter.",
}
HELD_OUT = {
    "isotherms held out / scatter": "leave_one_isotherm_out",
    "frequencies held out / scatter": "leave_one_frequency_out",
}


def run(
    measurements: str | Path | Campaign, folder: str | Path, geometry: str | Path | Mapping[str, Any],
    specimen: str | Path | None = None, static_modulus: float | None = None,
    scatter: tuple[float, float] | None = None, draws: int = 4000, seed: int = 0,
    simulations: str | Path | None = None,
) -> str:  # fmt: skip
    """Diagnose measurements and write four files into the folder; the summary.

    The files: diagnosis.json, residuals.csv, causality.csv and law.json. simulations: table of simulated tests whose
    numerics are told apart.
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
    content = report.as_json(diagnosis, numerical)
    if fit is not None:
        content["notes"] += law_notes(diagnosis, fit.law) + prior_notes(fit)
    content["reading"] = reading(observed, () if campaign is None else campaign.notes)
    if simulations is not None:
        content["numerics"]["campaign"] = of_campaign(simulations, observed.temperature, observed.frequency)
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
    write_table(folder / "residuals.csv", report.residual_table(diagnosis, numerical))
    held = within_isotherm.hold(observed)
    write_table(folder / "causality.csv", suspects.table(observed, list(diagnosis.suspects), held))
    if fit is not None:
        write_spectrum(
            folder / "law.json", fit.law, source=f"fitted ({origin})", rms_log_residual=fit.rms_log_residual,
            std_error=fit.std_error, unseen=fit.unseen, from_prior=fit.from_prior,
        )  # fmt: skip
    write_json(folder / "diagnosis.json", content)
    return summary(content)


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


def _size(parameters: dict[str, Any]) -> str:
    """The first parameter, which is the amplitude, with its 95 % interval."""
    name, amplitude = next(iter(parameters.items()))
    if name == "reference_temperature":  # of a law whose shift these tests do not determine
        return ""
    error = amplitude["std_error"]
    return (
        f"{name} {amplitude['value']:.3g}"
        + ("" if error is None else f" +- {CONFIDENCE * error:.2g}")
        + f" {amplitude['unit']}"
    )


def summary(content: dict[str, Any]) -> str:
    """The ladder as a table, with verdict, limits and notes."""
    rows = []
    for rung in content["ladder"]:
        inside, held = rung["gain"]["in_sample"], rung["gain"]["held_out"]
        rows.append([
            rung["cause"], "" if rung["where"] is None else rung["where"],
            _size(rung["parameters"]),
            f"{rung['p_value']:.1g}" if rung["p_value"] > 1e-6 else "< 1e-6",
            *(f"{inside[k]['before']:.2f} -> {inside[k]['after']:.2f}" for k in ("mre_E_percent", "mre_phase_percent")),
            *(
                "{before:.2f} -> {after:.2f}".format(**held[way]["rms_over_scatter"]) if way in held else ""
                for way in HELD_OUT.values()
            ),
        ])  # fmt: skip
    headers = [
        "cause",
        "where",
        "parameter, 95 %",
        "p",
        "error |E*| %",
        "error phase %",
        *HELD_OUT,
    ]
    scatter = content["scatter"]
    judged = content["verdict"] != "nothing_to_explain" or content["tested"]
    read = content.get("reading", {"notes": []})
    lines = [
        *read["notes"],
        *([""] if read["notes"] else []),
        f"{content['tests']} tests, scatter {scatter['modulus_percent']:.3g} % in |E*|, "
        f"{scatter['phase_deg']:.3g} deg in phase.",
        "",
        tabulate(rows, headers) if rows else "No cause beats chance.",
        "",
        VERDICTS[content["verdict"]] if judged else f"{UNJUDGED}.",
    ]
    left = content["largest_pattern_left"]
    if content["verdict"] == "unexplained_structure" and left is not None:
        lines.append(
            f"Largest pattern left: {left['pattern']}, {left['z']:.1f} standard deviations of one pattern, "
            f"p = {left['p_value']:.2g} among all."
        )
    if content["withdrawn"]:
        lines.append(
            "Considered but not named, for too much is left: " + ", ".join(content["withdrawn"]) + "."
        )
    lines += [
        f"{rung['cause']} fits no better than {', '.join(rung['as_good'])}: one of these."
        for rung in content["ladder"]
        if rung["as_good"]
    ]
    lines += content["notes"]
    return "\n".join(lines)
