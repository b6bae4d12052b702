"""What diagnosis.json says of the measurements: how they were read, their scatter, files and versions."""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypedDict

from asphalt_nscd.diagnosis.content.numbers import NotNegative, Positive, Variation


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
    frequencies_Hz: Frequencies tested, Hz.
    off_target: Isotherms of a specimen that were measured further from their target than T 378 allows; absent if none
        was.
    quality_columns: Quality columns of the machine that the files give.
    limits_exceeded: Tests whose quality column is above the limit of AASHTO T 378, in the unit that its name carries.
    notes: Sentences on how files and columns were read.
    not_tested: Specimens without tests at a temperature at which most others have some, in words.
    files_without_tests: A sentence for each folder some of whose files hold no test, and for each table some of whose
        tests lack a phase.
    """

    test_type: Literal["bending", "tension-compression", "four-point bending", "indirect tension", "unknown"]
    specimens: list[str]
    isotherms_C: list[float]
    frequencies_Hz: list[Positive]
    off_target: list[OffTarget]
    quality_columns: list[str]
    limits_exceeded: list[LimitExceeded]
    notes: list[str]
    not_tested: list[str]
    files_without_tests: list[str]


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

    specimen: Name of the numerical specimen; none where the tests are of another kind than its own.
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


class VariationAt(TypedDict):
    """Variation at.

    temperature_C: Isotherm, degrees Celsius.
    between: Specimens at one frequency.
    within: Tests of one specimen about its own level.
    """

    temperature_C: float
    between: Variation | None
    within: Variation | None


class Furthest(TypedDict):
    """The specimen that stands out most against the others, by mean |E*| or by the temperature that would explain it.

    specimen: Its name.
    E_percent: Mean difference of its |E*| from that of the others, percent.
    kelvin: How much warmer it would have to be, K.
    E_over_usual: The difference over what specimens of one laboratory usually differ by.
    kelvin_over_usual: The same of the temperature.
    E_percent_told: Difference that would be told in 95 % of tables, percent.
    kelvin_told: The same of the temperature, K.
    """

    specimen: str
    E_percent: float
    kelvin: float
    E_over_usual: NotNegative
    kelvin_over_usual: NotNegative
    E_percent_told: Positive
    kelvin_told: Positive


class Repeatability(TypedDict):
    """The scatter as a laboratory quotes it, of the tests used; null where nothing was repeated.

    between: Specimens at one temperature and frequency, all isotherms.
    within: Tests of one specimen about its own level, all isotherms, without tests held back.
    by_isotherm: The same for each isotherm.
    furthest: The specimen that stands out most; null where nothing compares them.
    """

    between: Variation | None
    within: Variation | None
    by_isotherm: list[VariationAt]
    furthest: Furthest | None


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
