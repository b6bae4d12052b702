"""A diagnosis as `diagnosis.json` and `residuals.csv`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.bases import LN10, BurgersAtEach, FlexibleSpectrum
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import Place
from asphalt_nscd.diagnosis.diagnose import Diagnosis, cell_residuals
from asphalt_nscd.diagnosis.heldout import HeldOut
from asphalt_nscd.diagnosis.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.ladder import Rung
from asphalt_nscd.diagnosis.observations import Observations
from asphalt_nscd.diagnosis.scatter import STATED
from asphalt_nscd.diagnosis.simulated import NumericalSpecimen
from asphalt_nscd.diagnosis.written import CONFIDENCE, NOTABLE, SCHEMA_VERSION
from asphalt_nscd.measurements.agreement import mean_relative_error

ERRORS = ("mre_E_percent", "mre_phase_percent")  # of Table 4
WIDE_SPREAD = 1.2  # of the estimates, above which it is said
NOTICED = 0.1  # size of a discrepancy over the scatter of one test, below which it is none
Logarithm = NDArray[np.complex128]  # ln E* (n,)


def as_json(diagnosis: Diagnosis, specimen: NumericalSpecimen) -> dict[str, Any]:
    """Content of `diagnosis.json` (schema: diagnosis.schema.yaml beside this file)."""
    ladder, held = [], HeldOut(diagnosis.ladder.joint)
    if diagnosis.relaxation_spectrum:
        ladder.append(_law_rung(diagnosis, specimen, held))
    ladder += [_rung(diagnosis, rung, specimen, held) for rung in diagnosis.ladder.rungs]
    spread = estimates_spread(diagnosis)
    remaining = diagnosis.ladder.remaining
    modulus_scatter, phase_scatter = diagnosis.noise.sigma
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
        "suspect_tests": _suspects(diagnosis),
        "numerics": _numerics(diagnosis, specimen),
        "baseline": {
            "law": "burgers",
            "parameters": _burgers_parameters(diagnosis),
            "p_value": diagnosis.baseline_p,
            **_errors(diagnosis, with_burgers_laws(diagnosis, specimen)),
        },
        "ladder": ladder,
        "withdrawn": [name_of(rung.candidate) for rung in diagnosis.ladder.withdrawn],
        "indistinguishable": _indistinguishable(diagnosis),
        "not_testable": _not_testable(diagnosis),
        "detection_limits": _limits(diagnosis),
        "estimates": _estimates(diagnosis),
        "estimates_spread": spread,
        "discrepancy": {name: size for name, size in diagnosis.ladder.discrepancy.items() if size > NOTICED},
        "lack_of_fit_p_value": diagnosis.law_p,
        "largest_pattern_left": None
        if remaining is None
        else {
            "pattern": remaining.pattern,
            "p_value": remaining.p_value,
            "z": float(np.sqrt(remaining.gain)),
        },
        "unexplained": _unexplained(diagnosis),
        "notes": [*diagnosis.notes, *_spread_note(spread)],
    }


def with_burgers_laws(diagnosis: Diagnosis, specimen: NumericalSpecimen) -> Logarithm:
    """ln E* (n,) as the numerical specimen shows a Burgers law fitted at each temperature."""
    return _simulated(diagnosis.baseline_joint, diagnosis.baseline, specimen)


def with_common_law(diagnosis: Diagnosis, specimen: NumericalSpecimen) -> Logarithm:
    """ln E* (n,) as the numerical specimen shows one law for all temperatures, without causes."""
    return _simulated(diagnosis.ladder.joint, diagnosis.ladder.start, specimen)


def residual_table(
    diagnosis: Diagnosis, specimen: NumericalSpecimen, before: Logarithm | None = None
) -> pd.DataFrame:
    """Each test: measured, simulated before and after, and complex residuals ln(measured / simulated).

    before: ln E* (n,) of a simulation as it was (NaN: not simulated); else with a Burgers law fitted at each
    temperature.
    """
    observed, ladder = diagnosis.observed, diagnosis.ladder
    frame = _frame(diagnosis, observed.logarithm)
    if before is None:
        before = with_burgers_laws(diagnosis, specimen)
    for name, simulated in (("before", before), ("after", _simulated(ladder.joint, ladder.fitted, specimen))):
        left = observed.logarithm - simulated
        frame[f"E_{name}_MPa"] = np.exp(simulated.real) * 1e-6
        frame[f"phase_{name}_deg"] = np.degrees(simulated.imag)
        frame[f"residual_E_{name}_percent"] = 100.0 * left.real
        frame[f"residual_phase_{name}_deg"] = np.degrees(left.imag)
    return frame


def _simulated(joint: Joint, fitted: Fitted, specimen: NumericalSpecimen) -> NDArray[np.complex128]:
    """ln E* (n,) as the numerical specimen shows the law."""
    observed = joint.observed
    law = joint.apparent(fitted.law, ())[0]
    effect = np.log(specimen.apparent_modulus(observed.omega, law) / law)
    return fitted.modelled + effect


def _numerics(diagnosis: Diagnosis, specimen: NumericalSpecimen) -> dict[str, Any]:
    """What the simulation adds to its law."""
    joint, fitted = diagnosis.baseline_joint, diagnosis.baseline
    effect = _simulated(joint, fitted, specimen) - fitted.modelled
    return {
        "specimen": specimen.name,
        "modulus_over_law": specimen.ratio(),
        "largest_modulus_percent": 100.0 * float(np.abs(effect.real).max()),
        "largest_phase_deg": float(np.degrees(np.abs(effect.imag).max())),
    }


def _frame(diagnosis: Diagnosis, logarithm: NDArray[np.complex128]) -> pd.DataFrame:
    observed = diagnosis.observed
    return pd.DataFrame(
        {
            "specimen": np.array(observed.names)[observed.specimen],
            "temperature_C": observed.temperature,
            "frequency_Hz": observed.frequency,
            "E_MPa": np.exp(logarithm.real) * 1e-6,
            "phase_deg": np.degrees(logarithm.imag),
        }
    )


def _errors(diagnosis: Diagnosis, logarithm: NDArray[np.complex128]) -> dict[str, dict[str, float]]:
    """Mean relative errors by isotherm, as in Table 4, of what was simulated (NaN: not)."""
    isotherm = diagnosis.observed.isotherm
    simulated = _frame(diagnosis, logarithm).assign(temperature_C=isotherm).dropna()
    if simulated.empty:
        return {name: {} for name in ERRORS}
    scatter = float(np.degrees(diagnosis.noise.sigma[1]))
    measured = _frame(diagnosis, diagnosis.observed.logarithm).assign(temperature_C=isotherm)
    errors = mean_relative_error(measured, simulated, scatter)
    by = [f"{t:g}" for t in errors["temperature_C"]]
    return {name: dict(zip(by, errors[name].tolist(), strict=True)) for name in ERRORS}


def _misses(diagnosis: Diagnosis, logarithm: Logarithm, rows: NDArray[np.bool_]) -> dict[str, float]:
    """Mean relative errors of single tests, and the error over the scatter (root mean square), of some rows.

    Not of averages over specimens, as in Table 4: these hide what is wrong with one specimen.
    """
    observed = diagnosis.observed.logarithm[rows]
    left = observed - logarithm[rows]
    sigma = diagnosis.noise.sigma
    squares = np.concatenate([(left.real / sigma[0]) ** 2, (left.imag / sigma[1]) ** 2])
    return {
        "mre_E_percent": 100.0 * float(np.abs(np.expm1(-left.real)).mean()),
        # A phase below its own scatter, of an elastic reference beam say, is nothing to divide by.
        "mre_phase_percent": 100.0
        * float(np.mean(np.abs(left.imag) / np.maximum(np.abs(observed.imag), sigma[1]))),
        "rms_over_scatter": float(np.sqrt(squares.mean())),
    }


def _pair(diagnosis: Diagnosis, before: Logarithm, after: Logarithm, inner: bool = False) -> dict[str, Any]:
    """Errors before and after: of single tests, and of averages over specimens at each temperature.

    inner: single tests at the temperatures between others only; an isotherm at an end, left out, is
    extrapolated, which tells of the law's end and of no cause.
    """
    temperature = diagnosis.observed.isotherm
    rows = np.full(temperature.size, True)
    if inner:
        rows = (temperature > temperature.min()) & (temperature < temperature.max())
    first, second = _misses(diagnosis, before, rows), _misses(diagnosis, after, rows)
    pair: dict[str, Any] = {name: {"before": first[name], "after": second[name]} for name in first}
    pair["averages_by_temperature"] = averages(diagnosis, before, after)
    return pair


def averages(
    diagnosis: Diagnosis, before: Logarithm, after: Logarithm
) -> dict[str, dict[str, dict[str, float]]]:
    """Errors before and after by temperature, as in Table 4, of the conditions that hold both (NaN: one does not)."""
    before, after = np.where(np.isnan(after), after, before), np.where(np.isnan(before), before, after)
    errors = [_errors(diagnosis, logarithm) for logarithm in (before, after)]
    return {
        t: {name: {"before": errors[0][name][t], "after": errors[1][name][t]} for name in errors[0]}
        for t in errors[0]["mre_E_percent"]
    }


def _rung(diagnosis: Diagnosis, rung: Rung, specimen: NumericalSpecimen, held: HeldOut) -> dict[str, Any]:
    joint, observed = diagnosis.ladder.joint, diagnosis.observed
    before, after = (_simulated(joint, fitted, specimen) for fitted in (rung.before, rung.after))
    gain: dict[str, Any] = {"in_sample": _pair(diagnosis, before, after)}
    held_out = {}
    for part, count in (("isotherm", observed.isotherms.size), ("frequency", observed.frequencies.size)):
        if count > 2:
            before, after = (held.predictions(fitted, part) for fitted in (rung.before, rung.after))
            held_out[f"leave_one_{part}_out"] = _pair(diagnosis, before, after, inner=part == "isotherm")
    gain["held_out"] = held_out
    final = _final(diagnosis, rung.candidate)
    return {
        "cause": rung.candidate.cause.name,
        "where": rung.candidate.place,
        "parameters": _parameters(diagnosis, final),
        "p_value": rung.p_value,
        "gain": gain,
        "as_good": [name_of(rival) for rival in rung.rivals],
        "established": diagnosis.established(rung),
        "hangs_on": diagnosis.ladder.hangs_on.get(rung.candidate.key, []),
        "doubts": diagnosis.doubts.get(rung.candidate.key, []),
        "sentence": rung.candidate.cause.sentence,
        "confirmed_by": rung.candidate.cause.confirmed_by,
    }


def _final(diagnosis: Diagnosis, candidate: Candidate) -> Candidate:
    """The candidate as the last fit has it, with all causes fitted together."""
    active = diagnosis.ladder.rungs[-1].after.active
    return next(c for c in active if c.key == candidate.key)


def amplitude(diagnosis: Diagnosis, candidate: Candidate) -> tuple[float, float]:
    """Amplitude of a named cause and its standard error, in the last fit."""
    first = next(iter(_parameters(diagnosis, _final(diagnosis, candidate)).values()))
    return first["value"], first["std_error"]


def _parameters(diagnosis: Diagnosis, candidate: Candidate) -> dict[str, dict[str, Any]]:
    fitted = diagnosis.ladder.rungs[-1].after
    first = fitted.jacobian.shape[1] - sum(len(c.values) for c in fitted.active)
    for active in fitted.active:
        if active.key == candidate.key:
            break
        first += len(active.values)
    errors = np.sqrt(np.diag(fitted.covariance))[first : first + len(candidate.values)] * candidate.typical
    if candidate.key in diagnosis.ladder.estimates:
        errors[0] = max(errors[0], diagnosis.ladder.estimates[candidate.key][1])
    return {
        parameter.name: {
            "value": value,
            "std_error": float(errors[k]),
            "unit": parameter.unit,
        }
        for k, (parameter, value) in enumerate(zip(candidate.cause.parameters, candidate.values, strict=True))
    }


def _law_rung(diagnosis: Diagnosis, specimen: NumericalSpecimen, held: HeldOut) -> dict[str, Any]:
    """The first rung: one continuous spectrum for all temperatures instead of a Burgers law for each."""
    ladder, observed = diagnosis.ladder, diagnosis.observed
    before = _simulated(diagnosis.baseline_joint, diagnosis.baseline, specimen)
    after = with_common_law(diagnosis, specimen)
    held_out = {}
    if observed.isotherms.size > 2:
        # A Burgers law says nothing of another temperature: before is its fit, which has seen the data.
        predicted = held.predictions(ladder.start, "isotherm")
        held_out["leave_one_isotherm_out"] = _pair(diagnosis, before, predicted, inner=True)
    if observed.frequencies.size > 2:
        without_law = HeldOut(diagnosis.baseline_joint).predictions(diagnosis.baseline, "frequency")
        held_out["leave_one_frequency_out"] = _pair(
            diagnosis, without_law, held.predictions(ladder.start, "frequency")
        )
    # As the last fit has them: a delay, say, that is not yet taken would be taken for relaxation.
    spectrum, fitted = ladder.joint.spectrum, ladder.fitted
    shift = spectrum.log_shift(fitted.law, observed.isotherms)[0] / LN10
    return {
        "cause": "relaxation_spectrum",
        "where": None,
        "parameters": {
            # Two isotherms have one shift between them; one has none.
            **(_shift_constants(spectrum, fitted) if observed.isotherms.size > 2 else {}),
            "reference_temperature": _value(spectrum.reference_temperature, "degC"),
        },
        "log10_shift": {f"{t:g}": float(s) for t, s in zip(observed.isotherms, shift, strict=True)},
        "p_value": diagnosis.baseline_p,
        "gain": {"in_sample": _pair(diagnosis, before, after), "held_out": held_out},
        "as_good": [],
        "established": not diagnosis.too_few,
        "hangs_on": [],
        "doubts": [],
        "sentence": "the mix relaxes over many decades of time; one Burgers law for each temperature has two times",
        "confirmed_by": "tests over more decades of frequency, or creep at the warmest temperature",
    }


def _shift_constants(spectrum: FlexibleSpectrum, fitted: Fitted) -> dict[str, dict[str, Any]]:
    """C1 and C2, or the slope, where the shift may be straight, which has them at infinity, or bends the other way."""
    at = [fitted.law.size - 3, fitted.law.size - 2]
    slope, (curvature, change) = float(np.exp(fitted.law[-3])), spectrum.curvature(fitted.law[-2])
    variance = np.array([1.0, change])[:, None] * fitted.covariance[np.ix_(at, at)] * [1.0, change]
    of_curvature = float(np.sqrt(variance[1, 1]))
    if curvature < CONFIDENCE * of_curvature:
        straight = {"shift_slope": _value(slope, "decades/K", slope * np.sqrt(variance[0, 0]))}
        bent = {"shift_curvature": _value(curvature, "1/K", of_curvature)}  # the other way than WLF
        return straight | (bent if curvature < -CONFIDENCE * of_curvature else {})
    of_c1, of_c2 = np.array([1.0, -1.0 / curvature]), np.array([0.0, -1.0 / curvature])  # of their logarithms
    return {
        name: _value(value, unit, value * np.sqrt(along @ variance @ along))
        for name, value, unit, along in (
            ("wlf_C1", slope / curvature, "decades", of_c1),
            ("wlf_C2", 1.0 / curvature, "K", of_c2),
        )
    }


def _value(value: float, unit: str, error: float | None = None) -> dict[str, Any]:
    return {"value": float(value), "std_error": None if error is None else float(error), "unit": unit}


def _burgers_parameters(diagnosis: Diagnosis) -> dict[str, dict[str, float]]:
    names = ("Em_Pa", "eta_m_Pa_s", "Ek_Pa", "eta_k_Pa_s")
    rows, base = np.exp(diagnosis.baseline.law).reshape(-1, 4), diagnosis.baseline_joint.base
    assert isinstance(base, BurgersAtEach)
    return {
        f"{t:g}": dict(zip(names, row.tolist(), strict=True))
        for t, row in zip(base.isotherms, rows, strict=True)
    }


def name_of(candidate: Candidate) -> str:
    """`cause` or `cause @ place`."""
    place = candidate.place
    return candidate.cause.name if place is None else f"{candidate.cause.name} @ {place}"


def _indistinguishable(diagnosis: Diagnosis) -> list[list[str]]:
    """Groups that this design, or these data, cannot tell apart."""
    out = [
        [name_of(rung.candidate), *map(name_of, rung.rivals)]
        for rung in diagnosis.ladder.rungs
        if rung.rivals
    ]
    out += [[name_of(one), name_of(other)] for one, other in diagnosis.ladder.alike]
    possible = {cause.name for cause in CATALOGUE if cause.on_bench(diagnosis.observed)}
    if "loose_clamp" in possible:
        out.append(["loose_clamp of all specimens", "relaxation_spectrum"])
    if "guide_stiffness" in possible - {name for name, _ in diagnosis.ladder.limits}:
        out.append(["guide_stiffness", "static modulus of relaxation_spectrum"])
    out.append(["specimen_geometry of all specimens", "glassy modulus of relaxation_spectrum"])
    out.append(["temperature_bias of all isotherms", "shift constants of relaxation_spectrum"])
    return out


def _not_testable(diagnosis: Diagnosis) -> list[dict[str, str]]:
    observed = diagnosis.observed
    out = [
        {"cause": cause.name, "needs": cause.needs or "more frequencies and temperatures"}
        for cause in CATALOGUE
        if not cause.places(observed)
    ]
    shown = {c.key for rung in diagnosis.ladder.rungs for c in (rung.candidate, *rung.rivals)}
    out += [
        {"cause": name_of(candidate), "needs": candidate.cause.shows_in}
        for candidate in diagnosis.ladder.unseen
        if candidate.key not in shown
    ]
    seen = {name for name, _ in physical_limits(diagnosis)}
    out += [
        {"cause": name, "needs": "a design in which less of it shows than is physical"}
        for name in sorted({name for name, _ in diagnosis.ladder.limits} - seen)
    ]
    if not diagnosis.relaxation_spectrum and observed.frequencies.size < 3:
        out.append({"cause": "relaxation_spectrum", "needs": "three frequencies: a Burgers law fits any two"})
    elif not diagnosis.replicated:
        out.append({"cause": "relaxation_spectrum", "needs": "replicates, or a stated scatter"})
    return out


def _limits(diagnosis: Diagnosis) -> dict[str, dict[str, Any]]:
    """Amplitude found with 95 % probability: of each cause, and of each place of a confined one."""
    units = {cause.name: cause.parameters[0].unit for cause in CATALOGUE}
    limits: dict[str, dict[str, Any]] = {}
    for (name, place), value in physical_limits(diagnosis).items():
        entry = limits.setdefault(name, {"value": np.inf, "unit": units[name]})
        entry["value"] = min(entry["value"], float(value))
        if place is not None:
            entry["confined_to"] = "specimen" if isinstance(place, str) else "temperature_C"
            entry.setdefault("places", {})[str(place)] = float(value)
    return limits


def _suspects(diagnosis: Diagnosis) -> list[dict[str, Any]]:
    """Doubtful tests with their reasons, and whether the diagnosis used them."""
    whole = diagnosis.whole or diagnosis.observed
    return [
        {
            "specimen": whole.names[whole.specimen[one.row]],
            "temperature_C": float(whole.isotherm[one.row]),
            "frequency_Hz": float(whole.frequency[one.row]),
            "reasons": list(one.reasons),
            "used": one.used,
        }
        for one in diagnosis.suspects
    ]


def _estimates(diagnosis: Diagnosis) -> dict[str, Any]:
    """Amplitude of every cause at every place and its standard error, where a discrepancy was estimated."""
    out: dict[str, Any] = {}
    units = {cause.name: cause.parameters[0].unit for cause in CATALOGUE}
    for (name, place), (value, error) in diagnosis.ladder.estimates.items():
        where = "all" if place is None else str(place)
        places = out.setdefault(name, {"places": {}})["places"]
        places[where] = {"value": float(value), "std_error": float(error), "unit": units[name]}
    return out


def estimates_spread(diagnosis: Diagnosis) -> float:
    """Root mean square of the estimates of causes without a name, in their standard errors; 1 at least.

    What a table holds and no process of its discrepancy describes spreads them all (genomic control of Devlin and
    Roeder 1999). An effect of a limit times this spread was named in 55 of 61 cases, one of the limit in 41 of 62.
    """
    named = {rung.candidate.cause.name for rung in diagnosis.ladder.rungs}
    squares: dict[str, list[float]] = {}
    for (name, _), (value, error) in diagnosis.ladder.estimates.items():
        if name not in named and 0.0 < error < np.inf:
            squares.setdefault(name, []).append((value / error) ** 2)
    each = [float(np.mean(one)) for one in squares.values()]
    return max(1.0, float(np.sqrt(np.mean(each)))) if each else 1.0


def _spread_note(spread: float) -> list[str]:
    if spread < WIDE_SPREAD:
        return []
    return [
        f"The causes that got no name have estimates {spread:.1f} times their standard errors, where 1 is expected: "
        "these tests hold more structure than the diagnosis describes. "
        f"Multiply each detection limit by {spread:.1f}."
    ]


def physical_limits(diagnosis: Diagnosis) -> dict[tuple[str, Place], float]:
    """Limits that the cause can reach within the bounds of its amplitude."""
    most = {
        cause.name: max(abs(cause.parameters[0].low), abs(cause.parameters[0].high)) for cause in CATALOGUE
    }
    return {key: value for key, value in diagnosis.ladder.limits.items() if value <= most[key[0]]}


def _unexplained(diagnosis: Diagnosis) -> list[dict[str, float | str]]:
    observed = diagnosis.observed
    out: list[dict[str, float | str]] = []
    if diagnosis.verdict == "unexplained_structure":
        mean, z = cell_residuals(diagnosis)
        for cell in np.argsort(-z):
            if z[cell] < NOTABLE and out:
                break
            row = int(np.flatnonzero(observed.cell == cell)[0])
            at = {"temperature_C": float(observed.isotherm[row])}  # of all specimens in the mean
            out.append({**_miss(observed, row, mean[cell], z[cell]), **at})
    aside = diagnosis.set_aside
    for row in range(aside.size):
        law = diagnosis.ladder.joint.base.modulus(
            diagnosis.ladder.fitted.law, aside.omega[[row]], aside.temperature[[row]]
        )[0]
        left = complex(aside.logarithm[row] - np.log(law[0]))
        sigma = diagnosis.noise.sigma
        size = max(abs(left.real) / sigma[0], abs(left.imag) / sigma[1])
        out.append({**_miss(aside, row, left, size), "specimen": aside.names[aside.specimen[row]]})
    return out


def _miss(observed: Observations, row: int, residual: complex, z: float) -> dict[str, float | str]:
    return {
        "temperature_C": float(observed.temperature[row]),
        "frequency_Hz": float(observed.frequency[row]),
        "residual_E_percent": 100.0 * residual.real,
        "residual_phase_deg": float(np.degrees(residual.imag)),
        "z": float(z),
    }
