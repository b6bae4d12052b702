"""A diagnosis as `diagnosis.json`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import Place
from asphalt_nscd.diagnosis.criteria import NOTABLE, WIDE_SPREAD
from asphalt_nscd.diagnosis.model.bases import BurgersAtEach
from asphalt_nscd.diagnosis.model.heldout import HeldOut
from asphalt_nscd.diagnosis.model.joint import Joint
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.scatter import STATED
from asphalt_nscd.diagnosis.record.rungs import cause_rung, law_rung
from asphalt_nscd.diagnosis.screening.excess_phase import excess_phases
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, cell_residuals
from asphalt_nscd.diagnosis.simulation.gain import burgers_prediction, errors, joint_alone, simulated_by
from asphalt_nscd.diagnosis.simulation.simulated import NumericalSpecimen
from asphalt_nscd.diagnosis.written import CONFINED_TO, SCHEMA_VERSION, UNITS, name_at, widening


def diagnosis_content(diagnosis: Diagnosis, specimen: NumericalSpecimen) -> dict[str, Any]:
    """Content of `diagnosis.json` (typed by `diagnosis.content.whole`)."""
    ladder, held = [], HeldOut(joint_alone(diagnosis))
    if diagnosis.relaxation_spectrum:
        ladder.append(law_rung(diagnosis, specimen, held))
    ladder += [cause_rung(diagnosis, rung, specimen, held) for rung in diagnosis.ladder.rungs]
    spread = diagnosis.ladder.estimates_spread
    wide = (
        f"These tests lie {spread:.1f} times as far from the free master curve as their scatter suggests. Intervals "
        f"and limits are therefore multiplied by {spread:.1f}; standard errors are not."
    )
    left, pattern = diagnosis.ladder.remaining, None
    if left is not None:
        pattern = {"pattern": left.pattern, "p_value": left.p_value, "z": float(np.sqrt(left.gain))}
    modulus_scatter, phase_scatter = diagnosis.noise.sigma
    highest = diagnosis.ladder.at_highest
    return {
        "schema_version": SCHEMA_VERSION,
        "verdict": diagnosis.verdict,
        "tests": diagnosis.observed.size,
        "tested": diagnosis.replicated and diagnosis.observed.frequencies.size > 2,
        "scatter": {
            "modulus_percent": 100.0 * modulus_scatter,
            "phase_deg": float(np.degrees(phase_scatter)),
            "specimens_percent": 100.0 * diagnosis.noise.scale,
            "from_replicates": diagnosis.replicated and diagnosis.noise.freedom < STATED,
        },
        "numerics": _numerics(diagnosis, specimen),
        "baseline": {
            "law": "burgers",
            "parameters": _burgers_parameters(diagnosis),
            "p_value": diagnosis.baseline_p,
            **errors(diagnosis, burgers_prediction(diagnosis, specimen)),
        },
        "ladder": ladder,
        "withdrawn": [name_at(*rung.candidate.key) for rung in diagnosis.ladder.withdrawn],
        "indistinguishable": _indistinguishable(diagnosis),
        "not_testable": _untestable_causes(diagnosis),
        "detection_limits": _limits(diagnosis),
        "detection_limits_of_one_place": _limits_of_one_place(diagnosis),
        "estimates": _estimates(diagnosis),
        "estimates_spread": spread,
        "excess_phase": _excess_phases(diagnosis),
        "discrepancy": [
            {
                "kind": one.kind,
                "part": one.part,
                "temperature_C": one.isotherm,
                "specimen": one.specimen,
                "size": size,
            }
            for one, size in diagnosis.ladder.noticed.items()
            if diagnosis.verdict == "unexplained_structure"
        ],
        "lack_of_fit_p_value": diagnosis.law_p,
        "largest_pattern_left": pattern,
        "unexplained": _unexplained(diagnosis),
        "notes": [*diagnosis.notes, *[wide] * (spread >= WIDE_SPREAD)],
        "highest_frequency": None if highest is None else highest.content(widening(spread)),
        "measured_limits": {},
        # Of law.json, where there is one:
        "law_parameters": {},
        "law_misses": None,
        "laws": [],
        "undetermined": "",
    }


def _numerics(diagnosis: Diagnosis, specimen: NumericalSpecimen) -> dict[str, Any]:
    """What the simulation adds to its law."""
    joint, fitted = diagnosis.baseline_joint, diagnosis.baseline
    effect = simulated_by(joint, fitted, specimen) - fitted.modelled
    return {
        "specimen": specimen.name,
        "modulus_over_law": specimen.ratio(),
        "largest_modulus_percent": 100.0 * float(np.abs(effect.real).max()),
        "largest_phase_deg": float(np.degrees(np.abs(effect.imag).max())),
    }


def _excess_phases(diagnosis: Diagnosis) -> list[dict[str, Any]]:
    """The excess of each isotherm, with the mean drift of the deformation where the machine gave it."""
    observed = diagnosis.observed
    drift = observed.quality.get("deformation_drift_percent", np.full(observed.size, np.nan))
    rows = []
    for one in excess_phases(observed, diagnosis.alone):
        known = drift[(observed.isotherm == one.temperature) & np.isfinite(drift)]
        rows.append(
            {
                "temperature_C": one.temperature,
                "excess_deg": float(np.degrees(one.excess)),
                "standard_error_deg": float(np.degrees(one.std_error)),
                "deformation_drift_percent": float(known.mean()) if known.size else None,
            }
        )
    return rows


def _burgers_parameters(diagnosis: Diagnosis) -> dict[str, dict[str, float]]:
    rows, base = np.exp(diagnosis.baseline.law).reshape(-1, 4), diagnosis.baseline_joint.base
    assert isinstance(base, BurgersAtEach)
    names = ["Em_Pa", "eta_m_Pa_s", "Ek_Pa", "eta_k_Pa_s"]
    return pd.DataFrame(rows, [f"{t:g}" for t in base.isotherms], names).to_dict("index")


def _indistinguishable(diagnosis: Diagnosis) -> list[list[str]]:
    """Groups that this design, or these data, cannot tell apart."""
    rivals = [(rung.candidate, *rung.rivals) for rung in diagnosis.ladder.rungs if rung.rivals]
    groups = (*rivals, *diagnosis.ladder.alike)
    out = [[name_at(*candidate.key) for candidate in group] for group in groups]
    possible = [cause for cause in CATALOGUE if cause.possible_on_bench(diagnosis.observed)]
    limited = {name for name, _ in diagnosis.ladder.limits}
    out += [
        list(cause.alike)
        for cause in possible
        if cause.alike and not (cause.followed and cause.name in limited)
    ]
    return out


def _untestable_causes(diagnosis: Diagnosis) -> list[dict[str, str]]:
    observed, ladder = diagnosis.observed, diagnosis.ladder
    none = [cause for cause in CATALOGUE if not cause.places(observed)]
    out = [(cause.name, cause.needs or "more frequencies and temperatures") for cause in none]
    shown = {c.key for rung in ladder.rungs for c in (rung.candidate, *rung.rivals)}
    out += [(name_at(*one.key), one.cause.shows_in) for one in ladder.unseen if one.key not in shown]
    seen = physical_limits(diagnosis)
    nowhere = {name for name, _ in ladder.limits} - {name for name, _ in seen}
    unreached = ladder.limits.keys() - seen
    beyond = {name_at(name, None if name in nowhere else place) for name, place in unreached}
    out += [
        (name, "other tests: in these, only an impossibly large one would show") for name in sorted(beyond)
    ]
    if not diagnosis.relaxation_spectrum and observed.frequencies.size < 3:
        out.append(("relaxation_spectrum", "three frequencies: a Burgers law fits any two"))
    elif not diagnosis.replicated:
        out.append(("relaxation_spectrum", "replicates, or a stated scatter"))
    return [{"cause": name, "needs": needs} for name, needs in out]


def _limits(diagnosis: Diagnosis) -> dict[str, dict[str, Any]]:
    """Amplitude found with 95 % probability: of each cause, and of each place of a confined one."""
    limits: dict[str, dict[str, Any]] = {}
    for (name, place), value in physical_limits(diagnosis).items():
        entry = limits.setdefault(name, {"value": np.inf, "unit": UNITS[name]})
        entry["value"] = min(entry["value"], float(value))
        if place is not None:
            entry["confined_to"] = CONFINED_TO[name]
            entry.setdefault("places", {})[str(place)] = float(value)
    return limits


def _limits_of_one_place(diagnosis: Diagnosis) -> dict[str, dict[str, Any]]:
    """Size that would usually be told: of each fault of one place, at each place where it would be physical."""
    limits: dict[str, dict[str, Any]] = {}
    factor = widening(diagnosis.ladder.estimates_spread)
    for one in diagnosis.ladder.smallest:
        if (value := factor * one.size) <= one.largest:
            entry = limits.setdefault(one.kind, {"value": value, "unit": one.unit, "places": []})
            entry["value"] = min(entry["value"], value)
            where = {"specimen": one.specimen, "temperature_C": one.isotherm, "value": value}
            entry["places"].append(where)
    return limits


def _estimates(diagnosis: Diagnosis) -> dict[str, Any]:
    """Amplitude of every cause at every place and its standard error, where a discrepancy was estimated."""
    out: dict[str, Any] = {}
    for (name, place), (value, error) in diagnosis.ladder.estimates.items():
        places = out.setdefault(name, {"places": {}})["places"]
        where = "all" if place is None else str(place)
        places[where] = {"value": float(value), "std_error": float(error), "unit": UNITS[name]}
    return out


def physical_limits(diagnosis: Diagnosis) -> dict[tuple[str, Place], float]:
    """Limits by cause and place within the bounds of the amplitude, widened where the tests lie far from the fit."""
    first = {cause.name: cause.parameters[0] for cause in CATALOGUE}
    most = {name: max(abs(amplitude.low), abs(amplitude.high)) for name, amplitude in first.items()}
    factor = widening(diagnosis.ladder.estimates_spread)
    limits = {key: factor * value for key, value in diagnosis.ladder.limits.items()}
    return {key: value for key, value in limits.items() if value <= most[key[0]]}


def _unexplained(diagnosis: Diagnosis) -> list[dict[str, float | str | None]]:
    observed = diagnosis.observed
    out: list[dict[str, float | str | None]] = []
    if diagnosis.verdict == "unexplained_structure":
        mean, z = cell_residuals(diagnosis)
        for cell in np.argsort(-z):
            # At least one, however small, for something is unexplained.
            if z[cell] < NOTABLE and out:
                break
            out.append(_miss(observed, int(np.flatnonzero(observed.cell == cell)[0]), mean[cell], z[cell]))
    aside, joint = diagnosis.set_aside, diagnosis.ladder.joint
    if not aside.size:
        return out
    left = aside.logarithm - Joint(aside, joint.base, joint.noise).predict(diagnosis.ladder.fitted)
    of_modulus, of_phase = diagnosis.noise.sigma
    size = np.maximum(np.abs(left.real) / of_modulus, np.abs(left.imag) / of_phase)
    return out + [
        _miss(aside, row, left[row], size[row]) | {"specimen": aside.names[aside.specimen[row]]}
        for row in range(aside.size)
    ]


def _miss(observed: Observations, row: int, residual: complex, z: float) -> dict[str, float | str | None]:
    return {
        "specimen": None,
        "temperature_C": float(observed.isotherm[row]),
        "frequency_Hz": float(observed.frequency[row]),
        "residual_E_percent": 100.0 * float(residual.real),
        "residual_phase_deg": float(np.degrees(residual.imag)),
        "z": float(z),
    }
