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
from typing import Any, Literal, TypedDict

import msgspec

from asphalt_nscd.diagnosis.content import doubts, ladder, law, limits, numbers, orders, reading
from asphalt_nscd.diagnosis.content.numbers import Probability, Some

PARTS = {
    name: part
    for room in (doubts, ladder, law, limits, numbers, orders, reading)
    for name, part in vars(room).items()
}


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
    verdict: ladder.Verdict
    tested: bool
    tests: Some
    origin: str
    scatter: reading.Scatter
    numerics: reading.Numerics
    baseline: ladder.Baseline
    ladder: list[ladder.Rung]
    averaged_over: list[ladder.HypothesisShare]
    withdrawn: list[str]
    estimates: dict[str, ladder.EstimatesOfCause]
    discrepancy: list[ladder.PartLeft]
    excess_phase: list[doubts.Excess]
    repeatability: reading.Repeatability | None
    measured_limits: dict[str, dict[str, limits.TriedAt]]
    with_suspects: ladder.NamedThen | None
    without_doubtful: ladder.NamedThen | None
    instructions: orders.Instructions
    trust: doubts.Trust
    contradictory_isotherms: list[doubts.Contradictory]
    one_sided: str
    odd_levels: list[doubts.OddLevel]
    odd_phases: list[doubts.OddPhase]
    odd_temperatures: list[doubts.OddTemperature]
    highest_frequency: doubts.HighestFrequency | None
    suspect_tests: list[doubts.TestRecord]
    indistinguishable: list[list[str]]
    not_testable: list[ladder.NotTestable]
    law_misses: law.LawMisses | None
    laws: list[law.LawFitted]
    undetermined: str
    law_parameters: dict[str, law.LawParameter]
    estimates_spread: float
    detection_limits: dict[str, limits.Limit]
    detection_limits_of_one_place: dict[str, limits.LimitOfPlace]
    lack_of_fit_p_value: Probability
    largest_pattern_left: ladder.Pattern | None
    unexplained: list[ladder.Miss]
    notes: list[str]
    reported: dict[str, float | bool]
    reading: reading.Reading
    provenance: reading.Provenance


@cache
def schema() -> dict[str, Any]:
    """JSON schema of diagnosis.json; a line `key: words` of a docstring describes that key."""
    made: dict[str, Any] = msgspec.json.schema(Content)
    for name, part in made["$defs"].items():
        about = re.split(r"\n(?=\w+: )", getdoc(PARTS.get(name, Content)) or "")
        for line in about[1:]:
            key, _, words = line.partition(": ")
            part["properties"][key] = {"description": " ".join(words.split())} | part["properties"][key]
    return made


def checked(content: Any) -> Content:
    """The content of a diagnosis.json, as its types say; msgspec.ValidationError says which key is not."""
    return msgspec.convert(content, Content)
