"""Content of diagnosis.json, typed: the schema, and what reads the file, are made from these classes.

Residuals are ln(measured / simulated): the real part is the relative error of |E*|, the imaginary part that of the
phase. In residuals.csv "before" is the campaign that was simulated, or where none is given the simulation with a
Burgers law for each temperature, "after" the one with all rungs of the ladder; a rung's own "before" is the fit without
it, of the one law where relaxation_spectrum is no rung. A key that changes its meaning raises schema_version.
"""

from __future__ import annotations

import re
from functools import cache
from inspect import getdoc
from typing import Annotated, Any, Literal, NotRequired, TypedDict

import msgspec
from msgspec import Meta

Count = Annotated[int, Meta(ge=0)]
Some = Annotated[int, Meta(ge=1)]
Positive = Annotated[float, Meta(gt=0)]
NotNegative = Annotated[float, Meta(ge=0)]
Probability = Annotated[float, Meta(ge=0, le=1)]
Interval = Annotated[list[float], Meta(min_length=2, max_length=2)]
# Status of a test:
USED = "used"
DOUBTFUL = "doubtful"  # used, but to be checked first
HELD_BACK = "held back"  # from law.json and what is reported, until a check clears it
LEFT_OUT = "left out"  # cannot be used
ITSELF = "its own isotherm"  # what decides: the other frequencies of the same specimen
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


class Estimate(TypedDict):
    """A value with its error.

    value: Value.
    std_error: Standard error; null where the fit does not give one.
    unit: Unit.
    interval_95: The 95 % interval as the page has it, widened where tests lie far from the fit; absent without a
        standard error.
    """

    value: float
    std_error: float | None
    unit: str
    interval_95: NotRequired[Interval]


class Gain(TypedDict):
    """Errors before and after a rung.

    averages_by_temperature: The two errors at each temperature as in Table 4, of averages over specimens; before
        bond_mapping and relaxation_spectrum those of the simulated campaigns, where they are given.
    mre_E_percent: Mean relative error of |E*| of single tests, percent.
    mre_phase_percent: Mean relative error of the phase of single tests, percent of the phase or of its scatter,
        whichever is larger.
    rms_over_scatter: Root mean square of residuals over the scatter of one test.
    """

    averages_by_temperature: dict[str, dict[str, BeforeAfter]]
    mre_E_percent: NotRequired[BeforeAfter]
    mre_phase_percent: NotRequired[BeforeAfter]
    rms_over_scatter: NotRequired[BeforeAfter]


class Variation(TypedDict):
    """Scatter of tests.

    E_percent: Coefficient of variation of |E*|, percent.
    phase_deg: Standard deviation of the phase, degrees.
    """

    E_percent: NotNegative
    phase_deg: NotNegative


class BeforeAfter(TypedDict):
    """A number before a rung and after it."""

    before: NotNegative
    after: NotNegative


class Scatter(TypedDict):
    """What tests and specimens differ by from chance; everything is judged against it.

    modulus_percent: Standard deviation of |E*| of one test, percent.
    phase_deg: Standard deviation of the phase of one test, degrees.
    specimens_percent: Standard deviation of |E*| from specimen to specimen, percent.
    air_voids: What air voids of the specimens explain of their levels of |E*|; null where they are not given.
    from_replicates: Whether replicates or the user state the scatter; if not, it is what a smooth law leaves.
    """

    modulus_percent: Positive
    phase_deg: Positive
    specimens_percent: NotNegative
    air_voids: dict[str, float] | None
    from_replicates: bool


class Numerics(TypedDict):
    """What the numerical specimen adds to the law of its bonds.

    specimen: Name of the numerical specimen.
    modulus_over_law: |E*| of the specimen over that of its law, at rest; one with facets.
    largest_modulus_percent: Largest effect on |E*| over the tests, percent.
    largest_phase_deg: Largest effect on the phase over the tests, degrees.
    campaign: Largest departures in a campaign of simulated tests: of time stepping and transient from the law times
        the specimen's own ratio, the same where bonds broke, and of peak picking from the harmonic fit.
    """

    specimen: str
    modulus_over_law: Positive
    largest_modulus_percent: NotNegative
    largest_phase_deg: NotNegative
    campaign: NotRequired[dict[str, NotNegative]]


class Baseline(TypedDict):
    """The simulation before, with the paper's law.

    law: The law.
    parameters: Burgers parameters by temperature in degrees Celsius.
    p_value: Chance of a misfit as large by replicate scatter alone.
    mre_E_percent: Mean relative error of |E*| by temperature, as in Table 4.
    mre_phase_percent: Mean relative error of the phase by temperature, as in Table 4.
    """

    law: Literal["burgers"]
    parameters: dict[str, dict[str, Positive]]
    p_value: Probability
    mre_E_percent: dict[str, float]
    mre_phase_percent: dict[str, float]


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


class Excess(TypedDict):
    """Excess.

    temperature_C: Isotherm, degrees Celsius.
    excess_deg: Excess, degrees.
    standard_error_deg: Its standard error, degrees.
    deformation_drift_percent: Mean drift of the deformation as the machine states it, percent; null where it states
        none.
    """

    temperature_C: float
    excess_deg: float
    standard_error_deg: Positive
    deformation_drift_percent: float | None


class VariationAt(TypedDict):
    """Variation at.

    temperature_C: Isotherm, degrees Celsius.
    between: Specimens at one frequency.
    within: Tests of one specimen about its own level.
    """

    temperature_C: float
    between: Variation | None
    within: Variation | None


class Repeatability(TypedDict):
    """The scatter as a laboratory quotes it, of the tests used; null where nothing was repeated.

    between: Specimens at one temperature and frequency, all isotherms.
    within: Tests of one specimen about its own level, all isotherms.
    by_isotherm: The same for each isotherm.
    """

    between: Variation | None
    within: Variation | None
    by_isotherm: list[VariationAt]


class TriedAt(TypedDict):
    """Tried at.

    tried: Places and signs tried.
    named: How often the cause was named where it was put in.
    within_interval: How often its size lay within the 95 % interval.
    other_named: How often another cause was named that was not there before.
    stated_power: Chance to find it as stated.
    """

    tried: Some
    named: Count
    within_interval: Count
    other_named: Count
    stated_power: Probability


class Order(TypedDict):
    """Order.

    text: The order with its hours, a sentence.
    act: What to do, a clause.
    purpose: What it is for, a few words; empty where the order says it.
    why: What it would tell, sentences.
    hours: Hours of the machine; zero where a word is enough.
    nats: Expected gain, ln of the Bayes factor for the right answers.
    specimens: Specimens to test.
    temperature_C: Temperature, degrees Celsius; null for a metal reference and for an order at several temperatures.
    frequencies_Hz: Frequencies, Hz.
    half_strain: Whether at half of the usual strain.
    """

    text: str
    act: str
    purpose: str
    why: list[str]
    hours: NotNegative
    nats: NotNegative
    specimens: list[str]
    temperature_C: float | None
    frequencies_Hz: list[Positive]
    half_strain: bool


class Instructions(TypedDict):
    """What to test next: doubtful tests first, then by expected gain per hour.

    costs: What was counted as the cost of a test, a sentence.
    orders: At most five.
    """

    costs: str
    orders: list[Order]


class Trust(TypedDict):
    """How many tests can be used as they are, how many only after a check, and how many not at all.

    held_back: Of those to check
    check_of: Specimens all of whose tests need a check, where these are all that do.
    use: Tests with nothing against them.
    check: Tests that are odd, doubtful, off their target temperature, at an isotherm that contradicts itself, or
        above a quality limit that half of all tests exceed.
    not_used: Tests that were left out.
    check_at_C: Isotherms to be checked as a whole, where no other test is to be checked, degrees Celsius.
    use_by_specimen: Tests with nothing against them by specimen.
    """

    held_back: Count
    check_of: list[str]
    use: Count
    check: Count
    not_used: Count
    check_at_C: list[float]
    use_by_specimen: dict[str, Count]


class Contradictory(TypedDict):
    """Contradictory.

    temperature_C: Isotherm, degrees Celsius.
    sentence: What contradicts, with numbers.
    worst_Hz: Frequency at which the phase contradicts |E*| most, Hz.
    worst_deg: Phase measured less phase that |E*| requires there, degrees.
    offset_deg: What all phases are off by alike, degrees.
    interval_95: Of offset_deg, where the fault was found beside the last fit.
    probability: Of the fault at this place, where it was found beside the last fit.
    """

    temperature_C: float
    sentence: str
    worst_Hz: NotRequired[Positive]
    worst_deg: NotRequired[float]
    offset_deg: NotRequired[float]
    interval_95: NotRequired[Interval]
    probability: NotRequired[Probability]


class OddLevel(TypedDict):
    """Odd level.

    specimen: Specimen.
    temperature_C: Isotherm, degrees Celsius.
    factor: |E*| over what the others say.
    """

    specimen: str
    temperature_C: float
    factor: Positive


class OddPhase(TypedDict):
    """Odd phase.

    specimen: Specimen.
    temperature_C: Isotherm, degrees Celsius; null for all of the specimen.
    phase_deg: Phase minus what the others say, degrees; of a delay, at the highest frequency.
    delay_s: Delay of its displacement channel, where that is what is off, seconds.
    interval_95: Of delay_s where it is given, else of phase_deg, where the fault was found beside the last fit.
    probability: Of the fault at this place, where it was found beside the last fit.
    """

    specimen: str
    temperature_C: float | None
    phase_deg: float
    delay_s: NotRequired[float]
    interval_95: NotRequired[Interval]
    probability: NotRequired[Probability]


class OddTemperature(TypedDict):
    """Odd temperature.

    specimen: Specimen.
    temperature_C: Isotherm, degrees Celsius.
    kelvin: By how much the specimen seems warmer than stated.
    interval_95: Of kelvin, where the fault was found beside the last fit.
    probability: Of the fault at this place, where it was found beside the last fit.
    """

    specimen: str
    temperature_C: float
    kelvin: float
    interval_95: NotRequired[Interval]
    probability: NotRequired[Probability]


class HighestFrequency(TypedDict):
    """What all tests at the highest frequency are off by, where they are, from what the others ask for.

    frequency_Hz: The highest frequency, Hz.
    modulus_percent: |E*| measured less that asked for, of it, percent.
    modulus_interval_95: Of modulus_percent.
    phase_deg: Phase measured less that asked for, degrees.
    phase_interval_95: Of phase_deg.
    """

    frequency_Hz: Positive
    modulus_percent: float
    modulus_interval_95: Interval
    phase_deg: float
    phase_interval_95: Interval


class TestRecord(TypedDict):
    """Test record.

    specimen: Name of the specimen.
    temperature_C: Of the isotherm.
    frequency_Hz: Frequency of the test.
    reasons: Sentences that a reader can check, with numbers and units.
    status: doubtful, used, but to be checked first; held back, neither in law.json nor in what is reported until a
        check clears it; left out, in nothing.
    decided_by: What speaks against the test: its own isotherm, the other specimens, a column.
    """

    specimen: str
    temperature_C: float
    frequency_Hz: Positive
    reasons: list[str]
    status: Literal["doubtful", "held back", "left out"]
    decided_by: str


class NotTestable(TypedDict):
    """Not testable.

    cause: Name of the cause.
    needs: What the measurements would have to have.
    """

    cause: str
    needs: str


class LawMisses(TypedDict):
    """Errors of law.json with the named causes, as in Table 4, over the tests it is fitted to; absent without
    law.json.

    mre_E_percent: Of the modulus.
    mre_phase_percent: Of the phase.
    """

    mre_E_percent: NotNegative
    mre_phase_percent: NotNegative


class LawFitted(TypedDict):
    """Law fitted.

    law: As --law names it.
    title: As a reader knows it.
    parameters: Number of parameters, those of the shift among them.
    mre_E_percent: Of the modulus.
    mre_phase_percent: Of the phase.
    taken: Whether it is the one in law.json.
    """

    law: str
    title: str
    parameters: Some
    mre_E_percent: NotNegative
    mre_phase_percent: NotNegative
    taken: bool


class LawParameter(TypedDict):
    """Law parameter.

    value: In the unit at the end of the name.
    interval_95: Null where the tests and the fit give none.
    determined: Whether the tests determine it.
    """

    value: float
    interval_95: list[float] | None
    determined: bool


class Limit(TypedDict):
    """Limit.

    value: The limit, the least of all places.
    unit: Its unit.
    confined_to: What such a cause is confined to, one specimen or one temperature.
    places: Limits by specimen or temperature, for a cause confined to one.
    """

    value: Positive
    unit: str
    confined_to: NotRequired[Literal["specimen", "temperature_C"]]
    places: NotRequired[dict[str, Positive]]


class PlaceLimit(TypedDict):
    """Place limit.

    specimen: Specimen; null for one isotherm of all.
    temperature_C: Isotherm, degrees Celsius; null for a channel.
    value: In the unit.
    """

    specimen: str | None
    temperature_C: float | None
    value: Positive


class LimitOfPlace(TypedDict):
    """Limit of place.

    value: The limit, the least of all places.
    unit: Its unit.
    places: The limit at each place.
    """

    value: Positive
    unit: str
    places: list[PlaceLimit]


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


class OffTarget(TypedDict):
    """Off target.

    specimen: Name of the specimen.
    temperature_C: Target, degrees Celsius.
    measured_C: Mean of the measured temperatures, degrees Celsius.
    """

    specimen: str
    temperature_C: float
    measured_C: float


class LimitExceeded(TypedDict):
    """Limit exceeded.

    specimen: Name of the specimen.
    temperature_C: Nominal temperature of the isotherm, degrees Celsius.
    frequency_Hz: Frequency of the test.
    column: Quality column.
    value: What the machine gave.
    limit: Largest value that the standard accepts.
    """

    specimen: str
    temperature_C: float
    frequency_Hz: Positive
    column: str
    value: float
    limit: float


class Reading(TypedDict):
    """How the measurements were read, from which test, and what the testing machine itself says of them.

    test_type: Test that gave the moduli.
    specimens: Names of the specimens.
    isotherms_C: Nominal temperatures, degrees Celsius.
    off_target: Isotherms of a specimen that were measured further from their target than T 378 allows; absent if none
        was.
    quality_columns: Quality columns of the machine that the files give.
    limits_exceeded: Tests whose quality column is above the limit of AASHTO T 378, in the unit that its name carries.
    notes: Sentences on how files and columns were read.
    not_tested: Specimens without tests at a temperature at which most others have some, in words.
    files_without_tests: A sentence for each folder some of whose files hold no test, and for each table some of whose
        tests lack a phase.
    """

    test_type: Literal["bending", "tension-compression", "unknown"]
    specimens: list[str]
    isotherms_C: list[float]
    off_target: list[OffTarget]
    quality_columns: list[str]
    limits_exceeded: list[LimitExceeded]
    notes: list[str]
    not_tested: list[str]
    files_without_tests: list[str]


class FileSum(TypedDict):
    """File sum.

    name: File name.
    sha256: Checksum.
    """

    name: str
    sha256: str


class Provenance(TypedDict):
    """Versions, file and settings behind this diagnosis.

    git_commit: Commit of this package.
    python: Version of Python.
    packages: Versions of packages by name.
    measurements: File name of the measurements.
    draws: Draws behind the chance levels.
    seed: Seed of the draws.
    sha256: Checksum of the measurements, where they are one file.
    files: Name and checksum of each file, where the measurements are several.
    geometry: Geometry of the specimens as given, or its file.
    specimen: File of the numerical specimen; null for the one shipped.
    static_modulus_Pa: Static modulus of the mix, if stated.
    scatter_stated: Scatter of |E*| (relative) and phase [rad], if stated.
    """

    git_commit: str
    python: str
    packages: dict[str, Any]
    measurements: str
    draws: int
    seed: int
    sha256: NotRequired[str]
    files: NotRequired[list[FileSum]]
    geometry: NotRequired[dict[str, Any] | str]
    specimen: NotRequired[str | None]
    static_modulus_Pa: NotRequired[float | None]
    scatter_stated: list[Any] | None


class Content(TypedDict):
    """Content.

    schema_version: Version of this schema.
    verdict: explained, what is left is replicate scatter; unexplained_structure, something significant is left that
        no cause of the catalogue fits, or the data are too few to tell the causes named from what the catalogue
        lacks; nothing_to_explain, the Burgers laws already fit.
    tested: Whether the data can judge the laws themselves; not without a known scatter, nor with two frequencies.
    tests: Number of tests diagnosed, those set aside not counted.
    origin: What the measurements are, in a word; several where rows of the table say different things.
    scatter: What tests and specimens differ by from chance; everything is judged against it.
    numerics: What the numerical specimen adds to the law of its bonds.
    baseline: The simulation before, with the paper's law.
    ladder: The causes found, in the order taken.
    averaged_over: The hypotheses that law.json, reported.csv and master_curve.csv are the mean of, likeliest first:
        possible causes and their probability. Established causes hold in each.
    withdrawn: Causes considered but not named, for zero lies in their interval. No result holds them.
    estimates: Amplitude of every cause at every place (`all` where it has none), named or not, where more than
        scatter was left; of a cause that is not named, as if it were the next one.
    discrepancy: Where more than scatter was left, the size of what has no name, by isotherm, specimen and in common,
        in units of the scatter of one test.
    excess_phase: How far the phases of an isotherm lie above what its own |E*| requires (Kramers and Kronig), mean
        over its frequencies. No law and no other isotherm is asked; an isotherm of fewer than three frequencies is
        left out.
    repeatability: The scatter as a laboratory quotes it, of the tests used; null where nothing was repeated.
    measured_limits: Only with --verify-limits: of each cause put into these tests at a multiple of its stated limit,
        how often it was named.
    with_suspects: What is named if the suspect tests that were set aside are used; null where none was.
    without_doubtful: What is named if the doubtful tests that are used are not; null where they are few or nothing
        was named.
    instructions: What to test next: doubtful tests first, then by expected gain per hour.
    trust: How many tests can be used as they are, how many only after a check, and how many not at all.
    contradictory_isotherms: Isotherms whose modulus and phase contradict each other as a whole.
    one_sided: Where at least half of the phases lie on one side of what |E*| requires and no cause was named, that in
        a sentence; else empty.
    odd_levels: Isotherms of one specimen whose |E*| is off the level of its other isotherms and of the other
        specimens.
    odd_phases: Isotherms of one specimen, or whole specimens, whose phase is off that of the others.
    odd_temperatures: Isotherms of one specimen where |E*| and phase are both off as if the specimen had another
        temperature.
    highest_frequency: What all tests at the highest frequency are off by, where they are, from what the others ask
        for.
    suspect_tests: The record of every test that is not simply used, with reasons.
    indistinguishable: Groups that this design or these data cannot tell apart.
    not_testable: Causes that these data could not have shown at any size.
    law_misses: Errors of law.json with the named causes, as in Table 4, over the tests it is fitted to; absent
        without law.json.
    laws: Each law of all temperatures fitted to the same tests: errors as in law_misses, and which is in law.json.
    undetermined: What the tests do not determine of law.json, a sentence; absent where they determine all.
    law_parameters: Parameters of law.json with their 95 % intervals, the same as there.
    estimates_spread: Root mean square of the estimates of causes without a name, in their standard errors; 1 at
        least, and 1 where no discrepancy was fitted. Detection limits times this spread hold in nine of ten cases.
    detection_limits: Amplitude of each cause that would have been found with 95 % probability.
    detection_limits_of_one_place: Size of each fault of one specimen or one isotherm that would usually have been
        told, by the fault. A place where only an impossibly large one would show is absent.
    lack_of_fit_p_value: Chance, by replicate scatter alone, of what is left after all rungs.
    largest_pattern_left: The largest nameless pattern in what is left; null where none was sought.
    unexplained: Conditions that stay unexplained, largest first, then single tests set aside as outliers.
    notes: Sentences on what limits this diagnosis.
    reported: E* of the mix at 15 degC and 10 Hz, with 95 % intervals; within_the_tests is false where it is
        extrapolated.
    reading: How the measurements were read, from which test, and what the testing machine itself says of them.
    provenance: Versions, file and settings behind this diagnosis.
    """

    schema_version: Literal[3]
    verdict: Verdict
    tested: bool
    tests: Some
    origin: str
    scatter: Scatter
    numerics: Numerics
    baseline: Baseline
    ladder: list[Rung]
    averaged_over: list[HypothesisShare]
    withdrawn: list[str]
    estimates: dict[str, EstimatesOfCause]
    discrepancy: list[PartLeft]
    excess_phase: list[Excess]
    repeatability: Repeatability | None
    measured_limits: dict[str, dict[str, TriedAt]]
    with_suspects: NamedThen | None
    without_doubtful: NamedThen | None
    instructions: Instructions
    trust: Trust
    contradictory_isotherms: list[Contradictory]
    one_sided: str
    odd_levels: list[OddLevel]
    odd_phases: list[OddPhase]
    odd_temperatures: list[OddTemperature]
    highest_frequency: HighestFrequency | None
    suspect_tests: list[TestRecord]
    indistinguishable: list[list[str]]
    not_testable: list[NotTestable]
    law_misses: LawMisses | None
    laws: list[LawFitted]
    undetermined: str
    law_parameters: dict[str, LawParameter]
    estimates_spread: float
    detection_limits: dict[str, Limit]
    detection_limits_of_one_place: dict[str, LimitOfPlace]
    lack_of_fit_p_value: Probability
    largest_pattern_left: Pattern | None
    unexplained: list[Miss]
    notes: list[str]
    reported: dict[str, float | bool]
    reading: Reading
    provenance: Provenance


@cache
def schema() -> dict[str, Any]:
    """JSON schema of diagnosis.json; a line `key: words` of a docstring describes that key."""
    made: dict[str, Any] = msgspec.json.schema(Content)
    for name, part in made["$defs"].items():
        about = re.split(r"\n(?=\w+: )", getdoc(globals()[name]) or "")
        for line in about[1:]:
            key, _, words = line.partition(": ")
            part["properties"][key] = {"description": " ".join(words.split())} | part["properties"][key]
    return made


def checked(content: Any) -> Content:
    """The content of a diagnosis.json, as its types say; msgspec.ValidationError says which key is not."""
    return msgspec.convert(content, Content)
