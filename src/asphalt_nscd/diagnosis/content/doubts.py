"""Tests and places of diagnosis.json that something speaks against, and the status of a test."""

from __future__ import annotations

from typing import Literal, NotRequired, TypedDict

from asphalt_nscd.diagnosis.content.numbers import Count, Interval, Positive, Probability

# Status of a test:
USED = "used"
DOUBTFUL = "doubtful"  # used, but to be checked first
HELD_BACK = "held back"  # from law.json and what is reported, until a check clears it
LEFT_OUT = "left out"  # cannot be used
ITSELF = "its own isotherm"  # what decides: the other frequencies of the same specimen


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


class Trust(TypedDict):
    """How many tests can be used as they are, how many only after a check, and how many not at all.

    held_back: Those to check that were held back.
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
    interval_95: Of delay_s where it is given, else of phase_deg.
    probability: Of the fault at this place.
    """

    specimen: str
    temperature_C: float | None
    phase_deg: float
    delay_s: NotRequired[float]
    interval_95: Interval
    probability: Probability


class OddTemperature(TypedDict):
    """Odd temperature.

    specimen: Specimen.
    temperature_C: Isotherm, degrees Celsius.
    kelvin: By how much the specimen seems warmer than stated.
    interval_95: Of kelvin.
    probability: Of the fault at this place.
    """

    specimen: str
    temperature_C: float
    kelvin: float
    interval_95: Interval
    probability: Probability


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
