"""The verdict of diagnosis.json, the causes named with their gains, and what stays unexplained."""

from __future__ import annotations

from typing import Literal, NotRequired, TypedDict

from asphalt_nscd.diagnosis.content.numbers import BeforeAfter, Estimate, NotNegative, Positive, Probability

Verdict = Literal["explained", "unexplained_structure", "nothing_to_explain"]


class CauseAt(TypedDict):
    """A cause and where it sits.

    cause: Name of the cause.
    where: Specimen or temperature in degrees Celsius, null for all tests.
    """

    cause: str
    where: str | float | None


class NamedThen(TypedDict):
    """What another choice of tests would name.

    verdict: The verdict then.
    causes: The causes named then.
    """

    verdict: Verdict
    causes: list[CauseAt]


class Gain(TypedDict):
    """Errors before and after a rung.

    averages_by_temperature: The two errors at each temperature as in Table 4, and that of the phase in degrees, of
        averages over specimens; before bond_mapping and relaxation_spectrum those of the simulated campaigns, where
        they are given.
    mre_E_percent: Mean relative error of |E*| of single tests, percent.
    mre_phase_percent: Mean relative error of the phase of single tests, percent of the phase or of its scatter,
        whichever is larger.
    rms_over_scatter: Root mean square of residuals over the scatter of one test.
    """

    averages_by_temperature: dict[str, dict[str, BeforeAfter]]
    mre_E_percent: NotRequired[BeforeAfter]
    mre_phase_percent: NotRequired[BeforeAfter]
    rms_over_scatter: NotRequired[BeforeAfter]


class Baseline(TypedDict):
    """The simulation before, with the paper's law.

    law: The law.
    parameters: Burgers parameters by temperature in degrees Celsius.
    p_value: Chance of a misfit as large by replicate scatter alone.
    mre_E_percent: Mean relative error of |E*| by temperature, as in Table 4.
    mre_phase_percent: Mean relative error of the phase by temperature, as in Table 4.
    off_phase_deg: Mean error of the phase by temperature, degrees.
    """

    law: Literal["burgers"]
    parameters: dict[str, dict[str, Positive]]
    p_value: Probability
    mre_E_percent: dict[str, float]
    mre_phase_percent: dict[str, float]
    off_phase_deg: NotRequired[dict[str, float]]


class HeldOutGains(TypedDict):
    """On data left out of the fit; empty where too few temperatures and frequencies were tested.

    leave_one_isotherm_out: Each inner temperature predicted from the rest; averages_by_temperature has the two at the
        ends too, which are extrapolated.
    leave_one_frequency_out: Each frequency predicted from the others.
    """

    leave_one_isotherm_out: NotRequired[Gain]
    leave_one_frequency_out: NotRequired[Gain]


class GainOfRung(TypedDict):
    """Misfit before and after this rung, on the data of the fit and on data it has not seen.

    in_sample: On the data of the fit.
    held_out: On data left out of the fit; empty where too few temperatures and frequencies were tested.
    """

    in_sample: Gain
    held_out: HeldOutGains


class Rung(TypedDict):
    """Rung.

    cause: Name of the cause.
    where: The specimen (text) or the temperature in degrees Celsius (number) it is confined to; null for all tests.
    parameters: Parameters of the cause by name, the first its amplitude, as the last fit has them with all causes
        together.
    log10_shift: Of relaxation_spectrum, decimal logarithm of the shift factor by temperature in degrees Celsius.
    p_value: Chance that the best of the whole catalogue does as well on data without any cause; null of bond_mapping.
    gain: Misfit before and after this rung, on the data of the fit and on data it has not seen.
    probability: Of a cause at its place, against none and against every other cause that came near; given that what
        holds is in the catalogue or in the discrepancy. Calibrated: the share of such names that are right in drawn
        tables. At least 0.95 of an established one.
    as_good: Causes that fit as well at this rung; the data do not tell them apart from this one.
    established: Whether the name is more than the likeliest; the whole table carries it and nothing fits as well.
    taken_off: Of a cause, by how much of it law.json is free and the extended simulation holds it: probability of the
        explanations of averaged_over that hold it, one if established.
    hangs_on: Isotherms, frequencies or specimens without which these data would not show the cause.
    doubts: Reasons, in words, why an effect that the catalogue lacks may stand behind the name.
    sentence: What is wrong, in words.
    evidence: Of bond_mapping, what shows it without any measurement.
    confirmed_by: The measurement that would confirm it.
    """

    cause: str
    where: str | float | None
    parameters: dict[str, Estimate]
    log10_shift: dict[str, float]
    p_value: Probability | None
    gain: GainOfRung
    probability: Probability | None
    as_good: list[str]
    established: bool
    taken_off: Probability
    hangs_on: list[str]
    doubts: list[str]
    sentence: str
    evidence: str
    confirmed_by: str


class HypothesisShare(TypedDict):
    """Hypothesis share.

    causes: Possible causes that hold.
    probability: Of the hypothesis.
    """

    causes: list[str]
    probability: Probability


class EstimatesOfCause(TypedDict):
    """Estimates of cause.

    places: Estimates by specimen or temperature in degrees Celsius; `all` without a place.
    """

    places: dict[str, Estimate]


class PartLeft(TypedDict):
    """Part left.

    kind: What may depart.
    part: Of |E*| or of the phase; of a spectrum both.
    temperature_C: The isotherm, degrees Celsius; null where it is none.
    specimen: The specimen; null where it is none.
    size: In units of the scatter of one test.
    """

    kind: Literal["isotherm", "specimen", "spectrum", "all"]
    part: Literal["modulus", "phase", "both"]
    temperature_C: float | None
    specimen: str | None
    size: NotNegative


class NotTestable(TypedDict):
    """Not testable.

    cause: Name of the cause.
    needs: What the measurements would have to have.
    """

    cause: str
    needs: str


class Pattern(TypedDict):
    """The largest nameless pattern in what is left; null where none was sought.

    pattern: Where it sits and in what.
    p_value: Chance of one as large anywhere.
    z: Its size, standard deviations.
    """

    pattern: str
    p_value: Probability
    z: NotNegative


class Miss(TypedDict):
    """Miss.

    specimen: Specimen, of a test set aside.
    temperature_C: Temperature, degrees Celsius.
    frequency_Hz: Frequency, Hz.
    residual_E_percent: Residual of |E*|, percent, mean over specimens.
    residual_phase_deg: Residual of the phase, degrees, mean over specimens.
    z: The larger of both, standard deviations.
    """

    specimen: str | None
    temperature_C: float
    frequency_Hz: float
    residual_E_percent: float
    residual_phase_deg: float
    z: NotNegative
