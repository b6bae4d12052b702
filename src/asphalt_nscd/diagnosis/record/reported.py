"""What a laboratory reports: tests after the established corrections, and E* of the mix where standards ask for it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.content.doubts import LEFT_OUT
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.observed.observations import Complex, Observations, Vector
from asphalt_nscd.diagnosis.record.law import LawOfMix
from asphalt_nscd.diagnosis.record.mixture import Mixture, averaged_over
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.rheology.spectrum import Spectrum
from asphalt_nscd.rheology.spectrum_io import Uncertainty

EN_12697_26 = (15.0, 10.0)  # degC, Hz
# AASHTO R 84, the input of MEPDG programs.
R_84_CELSIUS = (-10.0, 4.4, 21.1, 37.8, 54.4)
R_84_HERTZ = (25.0, 10.0, 5.0, 1.0, 0.5, 0.1)
TESTS, R_84 = "the tests", "AASHTO R 84"  # in the column `asked_by`
NEAR = 2.0  # K beyond the tests, and the factor of their reduced frequencies, that is no extrapolation
IN_A_DECADE = 8  # points of the master curve


def mix_modulus(mix: Mixture, temperature: Vector, frequency: Vector) -> tuple[Complex, Complex, Complex]:
    """ln E* (n,) of the mix by the free curve, and both ends of its 95 % interval, of ln|E*| and of the phase [rad].

    At `temperature` (n,) [degC] and `frequency` (n,) [Hz]. It knows the scatter of single tests, that between
    specimens, and what named and possible causes leave open; errors by propagation of first order. |E*| is as uncertain
    as few specimens leave it, so that its intervals are of Student's t with their degrees of freedom.
    """
    values, errors = mix.parts(2.0 * np.pi * frequency, temperature)
    return (mix.weights @ values, *mix.interval_95(values, errors))


def tested(mix: Mixture, temperature: Vector, frequency: Vector) -> NDArray[np.bool_]:
    """Whether the tests reach these conditions (n,), by temperature and by reduced frequency."""
    tests, base, law = mix.tests, mix.base, mix.law
    coldest, warmest = tests.temperature.min() - NEAR, tests.temperature.max() + NEAR
    within = (temperature >= coldest) & (temperature <= warmest)
    reduced = frequency * np.exp(base.log_shift(law, temperature)[0])
    there = tests.frequency * np.exp(base.log_shift(law, tests.temperature)[0])
    return np.asarray(within & (reduced >= there.min() / NEAR) & (reduced <= there.max() * NEAR))


def table_of(temperature: Vector, frequency: Vector, ends: tuple[Complex, Complex, Complex]) -> pd.DataFrame:
    """One row for each condition, of ln E* and both ends of its interval."""
    columns = {"temperature_C": temperature, "frequency_Hz": frequency}
    for part, unit, of in (
        ("E", "MPa", lambda x: np.exp(x.real) * 1e-6),
        ("phase", "deg", lambda x: np.degrees(x.imag)),
    ):
        columns |= {
            f"{part}{end}_{unit}": of(value) for end, value in zip(("", "_low", "_high"), ends, strict=True)
        }
    table = pd.DataFrame(columns)
    return table.assign(phase_low_deg=table["phase_low_deg"].clip(lower=0.0))  # no mix leads its load


def standard_values(mix: Mixture, law: LawOfMix | None) -> pd.DataFrame:
    """E* of the mix with 95 % intervals: for EN 12697-26, over the grid of AASHTO R 84, and where tests were made.

    Beyond the tests the free curve knows no mix: there the law of law.json holds with its priors and its band, or
    nothing but the first row.
    """
    tests = sorted(set(zip(mix.tests.isotherm.tolist(), mix.tests.frequency.tolist(), strict=True)))
    asked = {
        "EN 12697-26": [EN_12697_26],
        R_84: [(t, f) for t in R_84_CELSIUS for f in R_84_HERTZ],
        TESTS: [(t, f) for t, f in tests],
    }
    temperature, frequency = np.array(
        [condition for conditions in asked.values() for condition in conditions]
    ).T
    there, known = tested(mix, temperature, frequency), None if law is None else law.uncertainty
    free = mix_modulus(mix, temperature, frequency)
    if law is not None and known is not None:
        taken, beyond = there, law_with_band(law.law, known, temperature, frequency)
    else:
        taken, beyond = there | (np.arange(there.size) == 0), (np.full(there.size, np.nan + 1j * np.nan),) * 3
    one, low, high = (np.where(taken, *pair) for pair in zip(free, beyond, strict=True))
    table = table_of(temperature, frequency, (one, low, high))
    asked_by = np.repeat(list(asked), [len(conditions) for conditions in asked.values()])
    return table.assign(within_the_tests=there, asked_by=asked_by, averaged_over=averaged_over(mix))


def law_with_band(
    law: Spectrum, uncertainty: Uncertainty | None, temperature: Vector, frequency: Vector
) -> tuple[Complex, Complex, Complex]:
    """ln E* (n,) of a law and both ends of its band, NaN where that is not known."""
    omega = 2.0 * np.pi * frequency
    star = law.complex_modulus(omega, temperature)
    value = np.log(np.abs(star)) + 1j * np.angle(star)
    half = np.nan * value if uncertainty is None else uncertainty.half(law, omega, temperature)
    return value, value - half, value + half


def master_curve(mix: Mixture, at: float | None = None, law: LawOfMix | None = None) -> pd.DataFrame:
    """E* of the mix with its intervals over the band of the tests, at `at` [degC] or the reference temperature.

    Columns law_... have `law` beside it, and its 95 % interval where that is known.
    """
    base, of_likeliest, tests = mix.base, mix.law, mix.tests
    at = base.reference_temperature if at is None else at
    reduced = tests.frequency * np.exp(base.log_shift(of_likeliest, tests.temperature)[0])
    reduced /= float(np.exp(base.log_shift(of_likeliest, np.array([at]))[0][0]))
    decades = float(np.log10(reduced.max() / reduced.min()))
    frequency = np.geomspace(reduced.min(), reduced.max(), round(IN_A_DECADE * decades) + 2)
    temperature = np.full(frequency.size, at)
    curve = table_of(temperature, frequency, mix_modulus(mix, temperature, frequency))
    if law is not None:
        ends = law_with_band(law.law, law.uncertainty, temperature, frequency)
        beside = table_of(temperature, frequency, ends)
        curve = curve.join(beside.drop(columns=["temperature_C", "frequency_Hz"]).add_prefix("law_"))
    return curve.assign(averaged_over=averaged_over(mix))


def corrected(diagnosis: Diagnosis, whole: Observations, mix: Mixture, record: pd.DataFrame) -> pd.DataFrame:
    """Each test as recorded and less the faults that are established (NaN if it was left out), with its record.

    What the mix does itself stays in the tests, however sure it is.
    """
    ladder, used = diagnosis.ladder, record["status"].to_numpy() != LEFT_OUT
    sure = {rung.candidate.key for rung in ladder.rungs if diagnosis.established(rung)}
    active = tuple(one for one in ladder.fitted.active if one.key in sure and one.cause.alters_tests)
    law = ladder.fitted.law
    after = np.full(whole.size, np.nan + 0j)
    shown = ladder.joint.apparent(law, active)[0] / ladder.joint.apparent(law, ())[0]
    after[used] = diagnosis.observed.modulus / shown
    taken = {one.key for one in active}
    left = [rung.candidate for rung in ladder.rungs if rung.candidate.key not in taken]
    shift = mix.base.log_shift(mix.law, whole.temperature)[0]
    return pd.DataFrame(
        {
            "specimen": record["specimen"],
            "nominal_temperature_C": whole.isotherm,
            "temperature_C": whole.temperature,
            "frequency_Hz": whole.frequency,
            "E_MPa": np.abs(after) * 1e-6,
            "phase_deg": np.degrees(np.angle(after)),
            "recorded_E_MPa": np.abs(whole.modulus) * 1e-6,
            "recorded_phase_deg": np.degrees(np.angle(whole.modulus)),
            "reduced_frequency_Hz": whole.frequency * np.exp(shift),
            "corrected_for": list(_causes_by_test(whole, used, active)),
            "not_corrected_for": list(_causes_by_test(whole, used, left)),
            "status": record["status"],
            # No semicolon, which a reader of the file might take for the mark between columns.
            "reasons": [", ".join(one).replace("; ", ", ") for one in record["reasons"]],
            "decided_by": record["decided_by"],
        }
    )


def _causes_by_test(
    whole: Observations, used: NDArray[np.bool_], causes: Sequence[Candidate]
) -> Iterator[str]:
    """Names of the causes that act on each test."""
    at = [(one.cause.name, used & one.cause.rows(whole, one.place)) for one in causes]
    for row in range(whole.size):
        yield " + ".join(name for name, rows in at if rows[row])
