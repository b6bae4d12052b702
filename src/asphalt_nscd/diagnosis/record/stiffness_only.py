"""Tests that give |E*| and no phase: a master curve with its band, and the scatter. Nothing else can be told.

Without a phase causality cannot be held against the tests, and no cause of the catalogue is told from the mix. The
curve is the sigmoid of AASHTO R 84 over the reduced frequency, with a WLF shift. Usual values hold what the tests
leave open.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.special import stdtrit

from asphalt_nscd.diagnosis.observed.observations import Vector
from asphalt_nscd.diagnosis.observed.scatter import SCALE_FREEDOM, SPECIMEN_SCALE
from asphalt_nscd.diagnosis.record.reported import EN_12697_26, IN_A_DECADE, NEAR
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json, write_table
from asphalt_nscd.files.words import counted
from asphalt_nscd.measurements.campaign import Campaign, nominal_temperatures
from asphalt_nscd.measurements.limits import LIMITS
from asphalt_nscd.measurements.reduction import require_enough

LN10 = float(np.log(10.0))
# Usual values of the parameters and how far they stray: lg of the lower modulus [MPa] and of the span, place and slope
# over lg reduced frequency, lg c1 and lg c2 [K].
USUAL = np.array([2.0, 2.4, 0.0, 0.55, np.log10(18.0), np.log10(150.0)])
STRAYS = np.array([1.0, 0.6, 3.0, 0.25, 0.2, 0.2])
FIRST_SCATTER = 0.03  # of ln|E*|, at which the fit begins
ROUNDS = 8


@dataclass(frozen=True)
class StiffnessOnly:
    """A master curve of |E*| with what it leaves.

    parameters: of USUAL; covariance (6, 6); reference [degC]; within, between: standard deviations of ln|E*| of one
    test and of whole specimens; tests: a row for each, with its residual.
    """

    parameters: Vector
    covariance: NDArray
    reference: float
    within: float
    between: float
    freedom: int
    tests: pd.DataFrame
    notes: tuple[str, ...]

    def modulus(self, temperature: Vector, frequency: Vector) -> pd.DataFrame:
        """|E*| of the mix [MPa] with 95 % intervals at temperatures [degC] and frequencies [Hz], (n,) each."""
        value, slope = _log10_modulus(self.parameters, self.reference, temperature, frequency)
        specimens = self.tests["specimen"].nunique()
        variance = np.einsum("ij,jk,ik->i", slope, self.covariance, slope) * LN10**2
        # As in `reported`: the level is a mean over few specimens, and what they differ by is little known.
        freedom = min(self.freedom, SCALE_FREEDOM + specimens - 1)
        spread = np.exp(float(stdtrit(freedom, 0.975)) * np.sqrt(variance))
        modulus = 10.0**value
        return pd.DataFrame(
            {
                "temperature_C": temperature,
                "frequency_Hz": frequency,
                "E_MPa": modulus,
                "E_low_MPa": modulus / spread,
                "E_high_MPa": modulus * spread,
            }
        )

    def master_curve(self) -> pd.DataFrame:
        """|E*| over the band of the tests, at the reference temperature."""
        reduced = self.tests["reduced_frequency_Hz"]
        points = round(IN_A_DECADE * float(np.log10(reduced.max() / reduced.min()))) + 2
        frequency = np.geomspace(reduced.min(), reduced.max(), points)
        return self.modulus(np.full(points, self.reference), frequency)

    @property
    def reported(self) -> dict[str, float | bool]:
        """|E*| at 15 degC and 10 Hz (EN 12697-26), and whether the tests reach there."""
        at = self.modulus(*(np.array([one]) for one in EN_12697_26)).iloc[0]
        isotherm = self.tests["isotherm_C"]
        within = isotherm.min() - NEAR <= EN_12697_26[0] <= isotherm.max() + NEAR
        return {name: float(value) for name, value in at.items()} | {"within_the_tests": bool(within)}

    def __str__(self) -> str:
        tests, specimens = len(self.tests), self.tests["specimen"].nunique()
        at = self.reported
        isotherms = ", ".join(f"{t:g}" for t in sorted(self.tests["isotherm_C"].unique()))
        differ = f"; whole specimens differ by {100.0 * self.between:.1f} %" if specimens > 1 else ""
        worst = self.tests.loc[self.tests["residual_percent"].abs().idxmax()]
        return "\n".join(
            [
                f"Tests       {counted(tests, 'test')} of {counted(specimens, 'specimen')} at {isotherms} degC: |E*| "
                "alone, no phase.",
                "Not judged  Without a phase the tests cannot be held against causality, and no fault of the machine "
                "is told from the mix. Export the phase too for a diagnosis.",
                f"Mix         |E*|(15 degC, 10 Hz) = {at['E_MPa']:.0f} MPa, 95 % interval {at['E_low_MPa']:.0f} to "
                f"{at['E_high_MPa']:.0f} MPa.",
                f"Scatter     One test lies {100.0 * self.within:.1f} % off the master curve (standard deviation)"
                f"{differ}.",
                f"Farthest    {worst['residual_percent']:+.1f} %: specimen {worst['specimen']}, "
                f"{worst['temperature_C']:g} degC, {worst['frequency_Hz']:g} Hz.",
            ]
        )

    def write(self, folder: Path) -> list[str]:
        """Write stiffness.json, stiffness_residuals.csv and master_curve.csv into an existing folder; their names."""
        names = ("delta_log10_MPa", "alpha_log10_MPa", "place_log10_Hz", "slope", "log10_C1", "log10_C2_K")
        write_table(folder / "stiffness_residuals.csv", self.tests)
        write_table(folder / "master_curve.csv", self.master_curve())
        content = {
            "what": "master curve of |E*| from tests without a phase; no diagnosis",
            "parameters": dict(zip(names, self.parameters.tolist(), strict=True)),
            "covariance": self.covariance.tolist(),
            "reference_temperature_C": self.reference,
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
    if np.unique(isotherm).size < 2:
        raise InputError(f"{table.path}: one temperature has no master curve; add the tests at another one.")
    names, number = np.unique(specimen, return_inverse=True)
    isotherms = np.unique(isotherm)
    reference = float(isotherms[isotherms.size // 2])
    observed = np.log10(modulus)
    member = np.eye(names.size)[number]
    size, usual = FIRST_SCATTER / LN10, SPECIMEN_SCALE / LN10

    def residual(x: Vector) -> Vector:
        law, _ = _log10_modulus(x[:6], reference, temperature, frequency)
        of_tests = (observed - law - member @ x[6:]) / size
        return np.concatenate([of_tests, (x[:6] - USUAL) / STRAYS, x[6:] / usual])

    def jacobian(x: Vector) -> NDArray[np.float64]:
        _, slope = _log10_modulus(x[:6], reference, temperature, frequency)
        tests = -np.column_stack([slope, member]) / size
        return np.vstack([tests, np.diag(1.0 / np.concatenate([STRAYS, np.full(names.size, usual)]))])

    x = np.concatenate([USUAL, np.zeros(names.size)])
    # How much usual values count depends on the scatter, and that on the curve they shape.
    for _ in range(ROUNDS):
        x = least_squares(residual, x, jacobian, x_scale="jac").x
        slope = jacobian(x)
        inverse = np.linalg.inv(slope.T @ slope)
        used = float(np.sum((slope[: modulus.size] @ inverse) * slope[: modulus.size]))
        freedom = max(modulus.size - used, 1.0)
        left = residual(x)[: modulus.size] * size
        # A table drawn from its own curve leaves no scatter to divide by.
        size = max(float(np.sqrt(left @ left / freedom)), 1e-5)
    law, _ = _log10_modulus(x[:6], reference, temperature, frequency)
    tests = pd.DataFrame(
        {
            "specimen": specimen,
            "temperature_C": temperature,
            "isotherm_C": isotherm,
            "frequency_Hz": frequency,
            "E_MPa": modulus,
            "reduced_frequency_Hz": frequency * 10.0 ** _shift(x[:6], reference, temperature)[0],
            "curve_E_MPa": 10.0 ** (law + member @ x[6:]),
            "residual_percent": 100.0 * LN10 * left,
        }
    )
    between = LN10 * float(x[6:].std(ddof=min(1, names.size - 1)))
    return StiffnessOnly(
        x[:6], inverse[:6, :6], reference, size * LN10, between, int(freedom), tests, campaign.notes
    )


def _shift(x: Vector, reference: float, temperature: Vector) -> tuple[Vector, NDArray]:
    """lg a_T (n,) of the WLF shift and its derivatives (n, 2) with respect to lg c1 and lg c2."""
    above = temperature - reference
    # A kelvin off the singularity of WLF below the coldest test.
    c1, c2 = 10.0 ** x[4], np.maximum(10.0 ** x[5], 1.0 - above.min())
    shift = -c1 * above / (c2 + above)
    return shift, LN10 * np.column_stack([shift, -shift * c2 / (c2 + above)])


def _log10_modulus(
    x: Vector, reference: float, temperature: Vector, frequency: Vector
) -> tuple[Vector, NDArray]:
    """lg |E*| [MPa] (n,) = x0 + x1 / (1 + exp(-x3 LN10 (lg f_r - x2))), and its derivatives (n, 6)."""
    shift, of_shift = _shift(x, reference, temperature)
    along = LN10 * (np.log10(frequency) + shift - x[2])
    share = 1.0 / (1.0 + np.exp(-x[3] * along))
    steep = x[1] * share * (1.0 - share)
    slopes = [np.ones_like(share), share, -steep * x[3] * LN10, steep * along]
    return x[0] + x[1] * share, np.column_stack([*slopes, (steep * x[3] * LN10)[:, None] * of_shift])
