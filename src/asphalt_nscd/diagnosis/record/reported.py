"""What a laboratory reports: tests after the named corrections, and E* of the mix where standards ask for it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.observed.scatter import SCALE_FREEDOM
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.simulation.extension import effect_taken_off
from asphalt_nscd.rheology.spectrum import Spectrum
from asphalt_nscd.rheology.spectrum_io import Uncertainty, student

EN_12697_26 = (15.0, 10.0)  # degC, Hz
# AASHTO R 84, the input of MEPDG programs.
R_84_CELSIUS = (-10.0, 4.4, 21.1, 37.8, 54.4)
R_84_HERTZ = (25.0, 10.0, 5.0, 1.0, 0.5, 0.1)
NEAR = 2.0  # K beyond the tests, and the factor of their reduced frequencies, that is no extrapolation
IN_A_DECADE = 8  # points of the master curve
LEFT_OUT = "left out"


@dataclass(frozen=True)
class Reported:
    """|E*| and phase of the mix at some conditions: estimates and standard errors of ln |E*| and the phase [rad].

    freedom: degrees of freedom of the two standard errors.
    """

    temperature: NDArray[np.float64]
    frequency: NDArray[np.float64]
    logarithm: NDArray[np.complex128]
    std_error: NDArray[np.complex128]
    tested: NDArray[np.bool_]  # whether the tests reach there
    freedom: tuple[float, float]

    def beyond(self, law: Spectrum, uncertainty: Uncertainty) -> Reported:
        """With the values and the band of a law where the tests do not reach."""
        omega = 2.0 * np.pi * self.frequency
        star = law.complex_modulus(omega, self.temperature)
        half = uncertainty.half(law, omega, self.temperature)
        of_modulus, of_phase = map(student, self.freedom)
        return replace(
            self,
            logarithm=np.where(self.tested, self.logarithm, np.log(np.abs(star)) + 1j * np.angle(star)),
            std_error=np.where(
                self.tested, self.std_error, half.real / of_modulus + 1j * half.imag / of_phase
            ),
        )

    def table(self) -> pd.DataFrame:
        """One row for each condition, with the 95 % intervals."""
        e, p = np.exp(self.logarithm.real) * 1e-6, np.degrees(self.logarithm.imag)
        of_modulus, of_phase = map(student, self.freedom)
        spread = np.exp(of_modulus * self.std_error.real)
        off = of_phase * np.degrees(self.std_error.imag)
        return pd.DataFrame(
            {
                "temperature_C": self.temperature,
                "frequency_Hz": self.frequency,
                "E_MPa": e,
                "E_low_MPa": e / spread,
                "E_high_MPa": e * spread,
                "phase_deg": p,
                "phase_low_deg": p - off,
                "phase_high_deg": p + off,
                "within_the_tests": self.tested,
            }
        )


def mix_modulus(
    diagnosis: Diagnosis, temperature: NDArray[np.float64], frequency: NDArray[np.float64]
) -> Reported:
    """ln E* of the mix without the named causes with standard errors, by the last fit of the free curve.

    At `temperature` (n,) [degC] and `frequency` (n,) [Hz]; the result tells where the tests reach. Its covariance holds
    the scatter of single tests, that between specimens, and what the causes leave open; errors by propagation of first
    order. |E*| is as uncertain as few specimens leave it, so that its intervals are of Student's t with their degrees
    of freedom.
    """
    observed = diagnosis.observed
    base, fitted = diagnosis.law_of_all()
    law = fitted.law
    modulus, slope = base.modulus(law, 2.0 * np.pi * frequency, temperature)
    along = slope / modulus[:, None]
    covariance = fitted.covariance[: law.size, : law.size]
    coldest, warmest = observed.temperature.min() - NEAR, observed.temperature.max() + NEAR
    within = (temperature >= coldest) & (temperature <= warmest)
    reduced = frequency * np.exp(base.log_shift(law, temperature)[0])
    tested = observed.frequency * np.exp(base.log_shift(law, observed.temperature)[0])
    within &= (reduced >= tested.min() / NEAR) & (reduced <= tested.max() * NEAR)
    return Reported(
        temperature,
        frequency,
        np.log(np.abs(modulus)) + 1j * np.angle(modulus),
        standard_errors(along.real, covariance) + 1j * standard_errors(along.imag, covariance),
        within,
        freedom_of(diagnosis),
    )


def standard_errors(slope: NDArray[np.float64], covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Standard errors (n,) of quantities with a `slope` (n, p) along p parameters of a `covariance` (p, p)."""
    values, vectors = np.linalg.eigh(covariance)
    # Where a parameter is all but free, rounding makes the least eigenvalues negative, and would a variance.
    return np.linalg.norm(slope @ (vectors * np.sqrt(np.maximum(values, 0.0))), axis=1)


def freedom_of(diagnosis: Diagnosis) -> tuple[float, float]:
    """Degrees of freedom of the standard errors of the mix: of |E*| and of the phase."""
    freedom = diagnosis.noise.freedom
    # Taken for known, the scatter of two to four specimens held the mix in 88 to 89 % of drawn tables, not 95.
    return min(freedom, SCALE_FREEDOM + len(diagnosis.observed.names) - 1), freedom


def standard_values(
    diagnosis: Diagnosis, law: Spectrum | None, uncertainty: Uncertainty | None
) -> pd.DataFrame:
    """E* of the mix with 95 % intervals at 15 degC and 10 Hz (EN 12697-26), and over the grid of AASHTO R 84.

    Beyond the tests the free curve knows no mix: there the `law` of law.json holds with its priors, or nothing.
    """
    conditions = [EN_12697_26, *((t, f) for t in R_84_CELSIUS for f in R_84_HERTZ)]
    temperature, frequency = np.array(conditions).T
    grid = mix_modulus(diagnosis, temperature, frequency)
    if law is not None and uncertainty is not None:
        return grid.beyond(law, uncertainty).table()
    asked_for = grid.tested | (np.arange(temperature.size) == 0)
    return grid.table()[asked_for].reset_index(drop=True)


def master_curve(diagnosis: Diagnosis, at: float | None = None) -> pd.DataFrame:
    """E* of the mix with its intervals over the band of the tests, at `at` [degC] or the reference temperature."""
    base, fitted = diagnosis.law_of_all()
    law, observed = fitted.law, diagnosis.observed
    at = base.reference_temperature if at is None else at
    reduced = observed.frequency * np.exp(base.log_shift(law, observed.temperature)[0])
    reduced /= float(np.exp(base.log_shift(law, np.array([at]))[0][0]))
    decades = float(np.log10(reduced.max() / reduced.min()))
    frequency = np.geomspace(reduced.min(), reduced.max(), round(IN_A_DECADE * decades) + 2)
    curve = mix_modulus(diagnosis, np.full(frequency.size, at), frequency).table()
    return curve.drop(columns="within_the_tests")


def add_law_columns(curve: pd.DataFrame, law: Spectrum, uncertainty: Uncertainty | None) -> pd.DataFrame:
    """The master curve with columns law_... of a law beside it, and its 95 % interval where that is known."""
    omega, temperature = 2.0 * np.pi * curve["frequency_Hz"].to_numpy(), curve["temperature_C"].to_numpy()
    star = law.complex_modulus(omega, temperature)
    modulus, phase = np.abs(star) * 1e-6, np.degrees(np.angle(star))
    columns = {"law_E_MPa": modulus, "law_phase_deg": phase}
    if uncertainty is not None:
        half = uncertainty.half(law, omega, temperature)
        by, off = np.exp(half.real), np.degrees(half.imag)
        columns |= {"law_E_low_MPa": modulus / by, "law_E_high_MPa": modulus * by}
        columns |= {"law_phase_low_deg": phase - off, "law_phase_high_deg": phase + off}
    return curve.assign(**columns)


def corrected(diagnosis: Diagnosis) -> pd.DataFrame:
    """Each test as recorded and as corrected (NaN if it was left out), and why any was left out."""
    whole = diagnosis.observed if diagnosis.whole is None else diagnosis.whole
    doubts = {one.row: one for one in diagnosis.suspects} if diagnosis.whole is not None else {}
    aside = {row for row, one in doubts.items() if not one.used}
    used = np.array([row not in aside for row in range(whole.size)])
    after = np.full(whole.size, np.nan + 0j)
    after[used] = diagnosis.observed.modulus / effect_taken_off(diagnosis)
    named = [rung.candidate for rung in diagnosis.ladder.rungs if diagnosis.taken_off(rung)]
    applied = [
        " + ".join(one.cause.name for one in named if used[row] and one.cause.rows(whole, one.place)[row])
        for row in range(whole.size)
    ]
    # No semicolon, which a reader of the file might take for the mark between columns.
    reasons = {row: ", ".join(one.reasons).replace("; ", ", ") for row, one in doubts.items()}
    base, fitted = diagnosis.law_of_all()
    shift = base.log_shift(fitted.law, whole.temperature)[0]
    return pd.DataFrame(
        {
            "specimen": np.array(whole.names)[whole.specimen],
            "temperature_C": whole.temperature,
            "frequency_Hz": whole.frequency,
            "E_MPa": np.abs(after) * 1e-6,
            "phase_deg": np.degrees(np.angle(after)),
            "recorded_E_MPa": np.abs(whole.modulus) * 1e-6,
            "recorded_phase_deg": np.degrees(np.angle(whole.modulus)),
            "reduced_frequency_Hz": whole.frequency * np.exp(shift),
            "corrected_for": applied,
            "status": np.where(used, "used", LEFT_OUT),
            "doubts": [reasons.get(row, "") for row in range(whole.size)],
        }
    )
