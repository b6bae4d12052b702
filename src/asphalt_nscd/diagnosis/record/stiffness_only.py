"""Tests that give |E*| and no phase: a master curve with its band, and the scatter. Nothing else can be told.

Without a phase causality cannot be held against the tests, and no cause of the catalogue is told from the mix. The
curve is the sigmoid of AASHTO R 84 over the reduced frequency. Usual values hold what the tests leave open.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.observed.observations import Vector
from asphalt_nscd.diagnosis.observed.scatter import SCALE_FREEDOM, SPECIMEN_SCALE
from asphalt_nscd.diagnosis.record.reported import EN_12697_26, IN_A_DECADE, NEAR, law_with_band, table_of
from asphalt_nscd.diagnosis.words.sentences import numbers
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json, write_table
from asphalt_nscd.files.words import counted
from asphalt_nscd.measurements.campaign import Campaign, nominal_temperatures
from asphalt_nscd.measurements.limits import LIMITS
from asphalt_nscd.measurements.reduction import require_enough
from asphalt_nscd.rheology.fitting import Fit
from asphalt_nscd.rheology.priors import prior_of
from asphalt_nscd.rheology.spectrum import Spectrum
from asphalt_nscd.rheology.spectrum_fitting import LEAST_TEMPERATURES, Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import Uncertainty, fit_content

SCATTER, NO_PHASE = 0.03, 1e6  # of ln|E*| at which the fit begins; of a phase that nobody measured [rad]


@dataclass(frozen=True)
class StiffnessOnly:
    """A master curve of |E*| with what it leaves.

    within, between: standard deviations of ln|E*| of one test and of whole specimens; tests: a row for each, with its
    residual.
    """

    fit: Fit[Spectrum]
    uncertainty: Uncertainty
    within: float
    between: float
    tests: pd.DataFrame
    notes: tuple[str, ...]

    def modulus(self, temperature: Vector, frequency: Vector) -> pd.DataFrame:
        """|E*| of the mix [MPa] with 95 % intervals at temperatures [degC] and frequencies [Hz], (n,) each."""
        ends = law_with_band(self.fit.law, self.uncertainty, temperature, frequency)
        return table_of(temperature, frequency, ends).filter(regex="_C$|_Hz$|_MPa$")

    def master_curve(self) -> pd.DataFrame:
        """|E*| over the band of the tests, at the reference temperature."""
        reduced = self.tests["reduced_frequency_Hz"]
        points = round(IN_A_DECADE * float(np.log10(reduced.max() / reduced.min()))) + 2
        frequency = np.geomspace(reduced.min(), reduced.max(), points)
        return self.modulus(np.full(points, self.fit.law.shift.reference_temperature), frequency)

    @property
    def reported(self) -> dict[str, float | bool]:
        """|E*| at 15 degC and 10 Hz (EN 12697-26), and whether the tests reach there."""
        at = self.modulus(*(np.array([one]) for one in EN_12697_26)).iloc[0]
        isotherm = self.tests["isotherm_C"]
        within = isotherm.min() - NEAR <= EN_12697_26[0] <= isotherm.max() + NEAR
        return {name: float(value) for name, value in at.items()} | {"within_the_tests": bool(within)}

    @property
    def rows(self) -> list[tuple[str, str]]:
        """Label and sentence of each row of the answer."""
        tests, specimens, at = len(self.tests), self.tests["specimen"].nunique(), self.reported
        differ = f"; whole specimens differ by {100.0 * self.between:.1f} %" if specimens > 1 else ""
        worst = self.tests.loc[self.tests["residual_percent"].abs().idxmax()]
        return [
            (
                "Tests",
                f"{counted(tests, 'test')} of {counted(specimens, 'specimen')} at "
                f"{numbers(sorted(self.tests['isotherm_C'].unique()))} degC: |E*| alone, no phase.",
            ),
            (
                "Not judged",
                "Without a phase the tests cannot be held against causality, and no fault of the machine is told from "
                "the mix. Export the phase too for a diagnosis.",
            ),
            (
                "Mix",
                f"|E*|(15 degC, 10 Hz) = {at['E_MPa']:.0f} MPa, 95 % interval {at['E_low_MPa']:.0f} to "
                f"{at['E_high_MPa']:.0f} MPa.",
            ),
            (
                "Scatter",
                f"One test lies {100.0 * self.within:.1f} % off the master curve (standard deviation){differ}.",
            ),
            (
                "Farthest",
                f"{worst['residual_percent']:+.1f} %: specimen {worst['specimen']}, {worst['temperature_C']:g} degC, "
                f"{worst['frequency_Hz']:g} Hz.",
            ),
        ]

    def __str__(self) -> str:
        return "\n".join(f"{label:12}{said}" for label, said in self.rows)

    def write(self, folder: Path) -> list[str]:
        """Write stiffness.json, stiffness_residuals.csv and master_curve.csv into an existing folder; their names."""
        write_table(folder / "stiffness_residuals.csv", self.tests)
        write_table(folder / "master_curve.csv", self.master_curve())
        content = {
            "what": "master curve of |E*| from tests without a phase; no diagnosis",
            "law": fit_content(self.fit, "fitted to |E*| alone", self.uncertainty),
            "scatter_percent": 100.0 * self.within,
            "specimens_percent": 100.0 * self.between,
            "reported": self.reported,
            "notes": list(self.notes),
        }
        write_json(folder / "stiffness.json", content)
        return ["stiffness.json", "stiffness_residuals.csv", "master_curve.csv"]


def has_no_phase(campaign: Campaign) -> bool:
    """Whether a campaign gives |E*| alone, without a column of phases."""
    return "E_MPa" in campaign.table.columns and "phase_deg" not in campaign.table.columns


def fit_stiffness(campaign: Campaign) -> StiffnessOnly:
    """The master curve of a campaign without phases; specimens differ by a factor each, as usual ones do."""
    table = campaign.table
    columns = ("temperature_C", "frequency_Hz", "E_MPa")
    temperature, frequency, modulus = (table.numbers(name, LIMITS[name]) for name in columns)
    specimen = np.array(table.text("specimen"))
    isotherm = nominal_temperatures(table, temperature)
    require_enough(modulus.size, np.unique(frequency).size)
    isotherms = np.unique(isotherm)
    if isotherms.size < 2:
        raise InputError(f"{table.path}: one temperature has no master curve; add the tests at another one.")
    names, number = np.unique(specimen, return_inverse=True)
    shift = "wlf" if isotherms.size >= LEAST_TEMPERATURES["wlf"] else "arrhenius"
    fit = fit_spectrum(
        2.0 * np.pi * frequency,
        temperature,
        1e6 * modulus,
        float(isotherms[isotherms.size // 2]),
        Form("sigmoid", shift),
        prior=prior_of("sigmoid"),
        weights=(SCATTER, NO_PHASE),
    )
    curve = np.abs(fit.law.complex_modulus(2.0 * np.pi * frequency, temperature)) * 1e-6
    off, member = np.log(modulus / curve), np.eye(names.size)[number]
    freedom = max(modulus.size - names.size - len(fit.covariance if fit.covariance is not None else ()), 1)
    # The level of a specimen is known from its tests, and drawn towards none as far as these scatter.
    left, within = off, SCATTER
    for _ in range(3):
        level = (member.T @ off) / (member.sum(axis=0) + (within / SPECIMEN_SCALE) ** 2)
        left = off - member @ level
        within = max(float(np.sqrt(left @ left / freedom)), 1e-5)
    shared = within**2 * np.eye(modulus.size) + SPECIMEN_SCALE**2 * member @ member.T
    none = np.zeros((modulus.size, modulus.size))
    known = fit.restate(np.block([[shared, none], [none, none]]))
    # As in `reported`: the level is a mean over few specimens, and what they differ by is little known.
    of_modulus = float(min(freedom, SCALE_FREEDOM + names.size - 1))
    ends = float(temperature.min()), float(temperature.max())
    covariance = np.zeros((0, 0)) if known.covariance is None else known.covariance
    return StiffnessOnly(
        known,
        Uncertainty(covariance, (of_modulus, np.inf), tested=ends),
        within,
        float(level.std(ddof=min(1, names.size - 1))),
        pd.DataFrame(
            {
                "specimen": specimen,
                "temperature_C": temperature,
                "isotherm_C": isotherm,
                "frequency_Hz": frequency,
                "E_MPa": modulus,
                "reduced_frequency_Hz": frequency * fit.law.shift.factor(temperature),
                "curve_E_MPa": curve * np.exp(member @ level),
                "residual_percent": 100.0 * np.expm1(left),
            }
        ),
        campaign.notes,
    )
