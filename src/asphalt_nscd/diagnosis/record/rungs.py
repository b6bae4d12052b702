"""A rung of the ladder as `diagnosis.json` has it: cause, size, gain, how sure."""

from __future__ import annotations

from typing import Any

import numpy as np

from asphalt_nscd.diagnosis.criteria import CONFIDENCE
from asphalt_nscd.diagnosis.model.bases import LN10, FlexibleSpectrum
from asphalt_nscd.diagnosis.model.heldout import HeldOut
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.search.ladder import Rung
from asphalt_nscd.diagnosis.simulation import gain
from asphalt_nscd.diagnosis.simulation.simulated import NumericalSpecimen
from asphalt_nscd.diagnosis.written import NO_CAUSE, interval_95, name_at, widening


def cause_rung(
    diagnosis: Diagnosis, rung: Rung, specimen: NumericalSpecimen, held: HeldOut
) -> dict[str, Any]:
    """A rung of the ladder as diagnosis.json has it: what a cause gains in sample and on tests left out."""
    observed = diagnosis.observed
    before, after = (gain.nearest(diagnosis, fitted, specimen) for fitted in (rung.before, rung.after))
    in_sample, held_out = gain.compare_errors(diagnosis, before, after), {}
    for part, count in (("isotherm", observed.isotherms.size), ("frequency", observed.frequencies.size)):
        # Of two, the one that is left predicts nothing: it has no slope, or no shift.
        if count > 2:
            before, after = (held.predictions(fitted, part) for fitted in (rung.before, rung.after))
            errors = gain.compare_errors(diagnosis, before, after, inner=part == "isotherm")
            held_out[f"leave_one_{part}_out"] = errors
    return {
        "cause": rung.candidate.cause.name,
        "where": rung.candidate.place,
        "parameters": _parameters(diagnosis, _final(diagnosis, rung.candidate)),
        "p_value": rung.p_value,
        "gain": {"in_sample": in_sample, "held_out": held_out},
        "probability": diagnosis.probability(rung),
        "as_good": [name_at(*rival.key) for rival in rung.rivals],
        "established": diagnosis.established(rung),
        "taken_off": diagnosis.share(rung),
        "hangs_on": diagnosis.ladder.hangs_on.get(rung.candidate.key, []),
        "doubts": diagnosis.doubts.get(rung.candidate.key, []),
        "log10_shift": {},
        "sentence": rung.candidate.cause.sentence,
        "evidence": "",
        "confirmed_by": rung.candidate.cause.confirmed_by,
    }


def _final(diagnosis: Diagnosis, candidate: Candidate) -> Candidate:
    """The candidate as the last fit has it, with all causes fitted together."""
    active = diagnosis.ladder.rungs[-1].after.active
    return next(c for c in active if c.key == candidate.key)


def amplitude(diagnosis: Diagnosis, candidate: Candidate) -> tuple[float, float]:
    """Amplitude of a named cause in the last fit, and its standard error."""
    first = next(iter(_parameters(diagnosis, _final(diagnosis, candidate)).values()))
    return first["value"], first["std_error"]


def _parameters(diagnosis: Diagnosis, candidate: Candidate) -> dict[str, dict[str, Any]]:
    errors = diagnosis.ladder.std_errors(candidate)
    factor = widening(diagnosis.ladder.estimates_spread)
    found = {}
    for k, (parameter, value) in enumerate(zip(candidate.cause.parameters, candidate.values, strict=True)):
        of_logarithm = candidate.shaped and k == 0 and value > 0.0
        found[parameter.name] = _value(value, parameter.unit, float(errors[k]), factor, of_logarithm)
    return found


def law_rung(diagnosis: Diagnosis, specimen: NumericalSpecimen, held: HeldOut) -> dict[str, Any]:
    """The first rung: one continuous spectrum for all temperatures instead of a Burgers law for each."""
    ladder, observed = diagnosis.ladder, diagnosis.observed
    spectrum, fitted = ladder.joint.spectrum, ladder.fitted
    before = gain.burgers_prediction(diagnosis, specimen)
    after = gain.nearest(diagnosis, ladder.start, specimen)  # one law for all temperatures, without causes
    held_out, parameters = {}, {}
    if observed.isotherms.size > 2:
        # A Burgers law says nothing of another temperature: before is its fit, which has seen the data.
        predicted = held.predictions(ladder.start, "isotherm")
        held_out["leave_one_isotherm_out"] = gain.compare_errors(diagnosis, before, predicted, inner=True)
        # Two isotherms have one shift between them; one has none.
        parameters = _shift_constants(spectrum, fitted, widening(ladder.estimates_spread))
    if observed.frequencies.size > 2:
        without_law = HeldOut(diagnosis.baseline_joint).predictions(diagnosis.baseline, "frequency")
        predicted = held.predictions(ladder.start, "frequency")
        held_out["leave_one_frequency_out"] = gain.compare_errors(diagnosis, without_law, predicted)
    # As the last fit has them: a delay, say, that is not yet taken would be taken for relaxation.
    shift = spectrum.log_shift(fitted.law, observed.isotherms)[0] / LN10
    return NO_CAUSE | {
        "cause": "relaxation_spectrum",
        "parameters": parameters | {"reference_temperature": _value(spectrum.reference_temperature, "degC")},
        "log10_shift": {f"{t:g}": float(s) for t, s in zip(observed.isotherms, shift, strict=True)},
        "p_value": diagnosis.baseline_p,
        "gain": {"in_sample": gain.compare_errors(diagnosis, before, after), "held_out": held_out},
        "established": not diagnosis.too_few,
        "sentence": "the mix relaxes over many decades of time; one Burgers law for each temperature has two times",
        "confirmed_by": "tests over more decades of frequency, or creep at the warmest temperature",
    }


def _shift_constants(spectrum: FlexibleSpectrum, fitted: Fitted, factor: float) -> dict[str, dict[str, Any]]:
    """C1 and C2, or the slope, where the shift may be straight, which has them at infinity, or bends the other way."""
    at = [fitted.law.size - 3, fitted.law.size - 2]
    slope, (curvature, change) = float(np.exp(fitted.law[-3])), spectrum.curvature(fitted.law[-2])
    variance = np.array([1.0, change])[:, None] * fitted.covariance[np.ix_(at, at)] * [1.0, change]
    of_curvature = float(np.sqrt(variance[1, 1]))
    if curvature < CONFIDENCE * of_curvature:
        straight = {"shift_slope": _value(slope, "decades/K", slope * np.sqrt(variance[0, 0]), factor)}
        bent = {"shift_curvature": _value(curvature, "1/K", of_curvature, factor)}  # the other way than WLF
        return straight | (bent if curvature < -CONFIDENCE * of_curvature else {})
    of_c1, of_c2 = np.array([1.0, -1.0 / curvature]), np.array([0.0, -1.0 / curvature])  # of their logarithms
    of_c1, of_c2 = (np.sqrt(along @ variance @ along) for along in (of_c1, of_c2))
    c1, c2 = slope / curvature, 1.0 / curvature
    return {
        "wlf_C1": _value(c1, "decades", c1 * of_c1, factor),
        "wlf_C2": _value(c2, "K", c2 * of_c2, factor),
    }


def _value(
    value: float, unit: str, error: float | None = None, factor: float = 1.0, of_logarithm: bool = False
) -> dict[str, Any]:
    """factor, of_logarithm: of the interval."""
    if error is None:
        return {"value": float(value), "std_error": None, "unit": unit}
    interval = interval_95(float(value), float(error), factor, of_logarithm)
    return {"value": float(value), "std_error": float(error), "unit": unit, "interval_95": interval}
