"""The binder of a recipe: a law of its Young's modulus from what people know of it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from scipy.optimize import brentq, least_squares
from scipy.special import expit, logit

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.rheometer import TableReader, read_rheometer
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF, ZERO_CELSIUS, Arrhenius
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum

UNSTATED = 15.0  # degC, what an unstated reference temperature is called
GLASSY, RHEOLOGICAL_INDEX = 1e9, 1.8  # Pa; Christensen & Anderson (1992), middle of paving grades
THICKEST = 1e40  # Pa s; a grade has up to 1e35 by its line, at -60 degC
SOFTENED = 1300.0  # Pa s: viscosity at the softening point (MEPDG)
LARGEST_MISFIT = 1.0  # rms of ln G* of a law about its table: more is no binder
SCATTER, LEAST_SETPOINTS = (
    1.0,
    3,
)  # K that readings of one set temperature differ by at most; temperatures that a shift needs
POOR_MISFIT = 0.15  # of the same: more than that is told
LEAST_ABOVE = 5.0  # K of a table above the temperature at which its WLF shift is singular
LAW_KEYS = {  # of a recipe: parameter of TwoS2P1D, and the unit of the key in SI
    "E00_MPa": ("static_modulus", 1e6),
    "E0_MPa": ("glassy_modulus", 1e6),
    "delta": ("delta", 1.0),
    "k": ("k", 1.0),
    "h": ("h", 1.0),
    "beta": ("beta", 1.0),
    "tau_s": ("tau", 1.0),
}
# A and VTS of RTFO-aged binders of a performance grade, by its high temperature [degC]: defaults of the MEPDG (NCHRP
# 1-37A, Part 2, chapter 2, 2004). The report was not at hand. The viscosities of data/mixes50 confirm 58-22, 58-28,
# 64-16, 64-22, 64-28, 70-28 and 76-22; of the others a test holds that all pairs obey one rule to their last digit.
GRADES = {
    46: {-34: (11.504, -3.901), -40: (10.101, -3.393), -46: (8.755, -2.905)},
    52: {-10: (13.386, -4.570), -16: (13.305, -4.541), -22: (12.755, -4.342), -28: (11.840, -4.012),
         -34: (10.707, -3.602), -40: (9.496, -3.164), -46: (8.310, -2.736)},
    58: {-10: (12.316, -4.172), -16: (12.248, -4.147), -22: (11.787, -3.981), -28: (11.010, -3.701),
         -34: (10.035, -3.350), -40: (8.976, -2.968)},
    64: {-10: (11.432, -3.842), -16: (11.375, -3.822), -22: (10.980, -3.680), -28: (10.312, -3.440),
         -34: (9.461, -3.134), -40: (8.524, -2.798)},
    70: {-10: (10.690, -3.566), -16: (10.641, -3.548), -22: (10.299, -3.426), -28: (9.715, -3.217),
         -34: (8.965, -2.948), -40: (8.129, -2.648)},
    76: {-10: (10.059, -3.331), -16: (10.015, -3.315), -22: (9.715, -3.208), -28: (9.200, -3.024),
         -34: (8.532, -2.785)},
    82: {-10: (9.514, -3.128), -16: (9.475, -3.114), -22: (9.209, -3.019), -28: (8.750, -2.856),
         -34: (8.151, -2.642)},
}  # fmt: skip


class Shift(Protocol):
    """How frequency and temperature stand for each other."""

    @property
    def reference_temperature(self) -> float:
        """Temperature [degC] at which the factor is one."""

    def factor(self, temperature: np.ndarray) -> np.ndarray:
        """Reduced frequency over frequency at temperatures [degC]."""


class BinderLaw(Protocol):
    """E* of a binder at all temperatures and frequencies, or at one temperature."""

    @property
    def shift(self) -> Shift:
        """Shift of its frequencies with temperature."""

    def complex_modulus(self, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        """E* [Pa] at angular frequencies [rad/s] and temperatures [degC], broadcast together."""


@dataclass(frozen=True)
class Binder:
    """A law, whether it holds at all temperatures, whether it states one, and what a reader of it must know.

    `measured` [degC] are the lowest and highest temperature of a table; None where there is none.
    """

    law: BinderLaw
    shifted: bool
    temperature_stated: bool = True
    caution: str = ""
    measured: tuple[float, float] | None = None


@dataclass(frozen=True)
class ViscosityShift:
    """Shift of a binder of viscosity eta [cP], log10 log10 eta = A + VTS log10 T, at T [deg Rankine] (ASTM D2493)."""

    a: float
    vts: float
    reference_temperature: float = UNSTATED

    def crossover(self, temperature: np.ndarray) -> np.ndarray:
        """Angular frequency [rad/s] at which the phase is 45 degrees, at temperatures [degC]."""
        at, place = np.unique(np.asarray(temperature, float), return_inverse=True)
        return np.array([crossover_of(self.viscosity(t)) for t in at])[place].reshape(np.shape(temperature))

    def viscosity(self, temperature: float) -> float:
        """Viscosity [Pa s] at a temperature [degC]."""
        rankine = 1.8 * (temperature + ZERO_CELSIUS)
        with np.errstate(over="ignore"):  # `crossover_of` refuses an infinite one
            return float(1e-3 * 10.0**10.0 ** (self.a + self.vts * np.log10(rankine)))

    def factor(self, temperature: np.ndarray) -> np.ndarray:
        """Reduced frequency over frequency at temperatures [degC]."""
        reference = self.crossover(np.array([self.reference_temperature]))[0]
        return reference / self.crossover(temperature)


@dataclass(frozen=True)
class ViscosityLaw:
    """E* of a binder known by its viscosity: Christensen & Anderson (1992), about three times G*."""

    shift: ViscosityShift

    def complex_modulus(self, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        """E* [Pa] at angular frequencies [rad/s] and temperatures [degC], broadcast together."""
        return 3.0 * shear_modulus(np.asarray(omega, float), self.shift.crossover(temperature))


@dataclass(frozen=True)
class Blend:
    """Two binders, `share` of the second: logarithms of the modulus mix by volume (Arrhenius' rule)."""

    first: BinderLaw
    second: BinderLaw
    share: float

    @property
    def shift(self) -> Shift:
        """Shift of the first binder."""
        return self.first.shift

    def complex_modulus(self, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        """E* [Pa] at angular frequencies [rad/s] and temperatures [degC], broadcast together."""
        first, second = (law.complex_modulus(omega, temperature) for law in (self.first, self.second))
        return first ** (1.0 - self.share) * second**self.share


def shear_modulus(
    omega: np.ndarray, crossover: np.ndarray | float, index: float = RHEOLOGICAL_INDEX
) -> np.ndarray:
    """G* (n,) [Pa] of a binder (Christensen & Anderson 1992) that crosses over at an angular frequency [rad/s]."""
    power = np.log10(2.0) / index
    size = GLASSY * (1.0 + (crossover / omega) ** power) ** (-1.0 / power)
    return size * np.exp(0.5j * np.pi / (1.0 + (omega / crossover) ** power))


def crossover_of(viscosity: float, index: float = RHEOLOGICAL_INDEX) -> float:
    """Angular frequency [rad/s] of the binder whose viscosity [Pa s] is |G*| / 10 (1 / sin delta)^4.8628 at 10 rad/s.

    So the MEPDG (2004) makes the viscosity of a grade from its tests by a rheometer.
    """
    if viscosity > THICKEST:
        raise InputError(
            f"the binder would have a viscosity of {viscosity:.3g} Pa s, more than any; correct A and VTS, or ask for "
            "a warmer mix."
        )

    def misfit(log: float) -> float:
        at = shear_modulus(np.array(10.0), 10.0**log, index)
        return float(np.log(np.abs(at) / 10.0 * np.sin(np.angle(at)) ** -4.8628 / viscosity))

    # Far below its glass transition a binder crosses over slower than 1e-20 rad/s.
    slowest = -20.0 if misfit(-20.0) > 0.0 else -60.0
    return float(10.0 ** brentq(misfit, slowest, 20.0))


def read_binder(content: Mapping[str, Any], path: str | Path, read_table: TableReader = read_csv) -> Binder:
    """The binder of a recipe, in the form that its keys tell; `path` is the recipe's."""
    if "table" in content:
        return _measured(Path(path).parent / content["table"], read_table)
    if "grade" in content:
        return _graded(content["grade"], path)
    if "A" in content:
        return _viscous(content["A"], content["VTS"])
    if "penetration_dmm" in content:
        return _viscous(*_viscosity_line(content, path))
    values = {name: scale * content[key] for key, (name, scale) in LAW_KEYS.items()}
    refusal = TwoS2P1D.refusal(values)
    if refusal:
        raise InputError(f"{path}: binder: {refusal}; correct it.")
    law = TwoS2P1D(**values, shift=_shift(content))
    return Binder(law, "shift" in content, "reference_temperature_C" in content)


def _viscous(a: float, vts: float) -> Binder:
    return Binder(ViscosityLaw(ViscosityShift(a, vts)), shifted=True)


def _graded(grade: str, path: str | Path) -> Binder:
    """A binder with the usual A and VTS of a grade, as "PG 64-22", or with a letter for traffic (AASHTO M 332)."""
    given = re.fullmatch(r"(?:PG)?\s*(\d+)\s*([SHVE]?)\s*-\s*(\d+)", grade.strip().upper())
    high, traffic, low = given.groups() if given else ("0", "", "0")
    usual = GRADES.get(int(high), {}).get(-int(low))
    if usual is None:
        known = ", ".join(f"{h}{min(lows, key=abs)} to {h}{max(lows, key=abs)}" for h, lows in GRADES.items())
        european = re.fullmatch(r"\d+\s*/\s*\d+", grade.strip())
        mend = (
            "of a grade of EN 12591 give penetration_dmm and softening_point_C in place of grade"
            if european
            else f"give one of PG {known} in steps of 6, or A and VTS, or penetration_dmm and softening_point_C"
        )
        raise InputError(f"{path}: binder.grade: no usual viscosity of {grade!r} is known; {mend}.")
    caution = (
        f"PG {high}{traffic}-{low} is taken for PG {high}-{low}: its letter asks for less flow at {high} °C, so that a "
        f"warm mix may be stiffer than told; a table of a rheometer tells."
    )
    return replace(_viscous(*usual), caution=caution if traffic in tuple("HVE") else "")


def _viscosity_line(content: Mapping[str, float], path: str | Path) -> tuple[float, float]:
    """A and VTS from penetration at 25 degC and softening point, by the MEPDG's viscosities at both."""
    log = float(np.log10(content["penetration_dmm"]))
    viscosity = 0.1 * 10.0 ** (10.5012 - 2.2601 * log + 0.00389 * log**2)  # Pa s; the MEPDG has poises
    soft = content["softening_point_C"]
    if soft <= 30.0:
        raise InputError(
            f"{path}: binder.softening_point_C: {soft:g} °C; give that of ring and ball, above 30."
        )
    temperature = np.log10(1.8 * (np.array([25.0, soft]) + ZERO_CELSIUS))
    known = np.log10(np.log10(1e3 * np.array([viscosity, SOFTENED])))
    vts = float(np.diff(known)[0] / np.diff(temperature)[0])
    if vts >= 0.0:
        raise InputError(
            f"{path}: binder: at a penetration of {content['penetration_dmm']:g} it is soft at 25 °C already, so "
            f"softening_point_C is no {soft:g}; correct one of them."
        )
    return float(known[0] - vts * temperature[0]), vts


def _shift(content: Mapping[str, Any]) -> WLF | Arrhenius:
    """Shift of the law of a recipe; without its key the law is asked at the reference temperature alone."""
    reference = content.get("reference_temperature_C", UNSTATED)
    of = content.get("shift", {"activation_energy_J_mol": 150e3})  # without one no other temperature is asked
    if "wlf_C1" in of:
        return WLF(of["wlf_C1"], of["wlf_C2_K"], reference)
    return Arrhenius(of["activation_energy_J_mol"], reference)


def _measured(path: Path, read_table: TableReader) -> Binder:
    """2S2P1D law with a WLF shift of E = 3 G, as of all binders here, fitted to the table of a rheometer."""
    temperature, omega, shear = read_rheometer(path, read_table)
    known = np.unique(temperature)
    if (there := _setpoints(known)) < LEAST_SETPOINTS:
        raise InputError(
            f"{path}: the shift of a binder needs at least {LEAST_SETPOINTS} temperatures, and its tests have {there}; "
            "add some, or give A and VTS."
        )
    modulus, glassy = 3.0 * shear, 3.0 * GLASSY
    try:
        start = fit_spectrum(omega, temperature, modulus, float(known[known.size // 2]), Form()).law
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    law, miss = _flowing(start, max(glassy, 1.1 * float(np.abs(modulus).max())), omega, temperature, modulus)
    if miss > LARGEST_MISFIT:
        raise InputError(
            f"{path}: no law of a binder comes nearer to modulus and phase than {100 * miss:.0f} %; check columns and "
            f"units."
        )
    caution = f"The law of the binder misses its table by {100 * miss:.0f} %." if miss > POOR_MISFIT else ""
    return Binder(law, True, True, caution, (float(known[0]), float(known[-1])))


def _setpoints(temperature: np.ndarray) -> int:
    """How many temperatures a rheometer was set to; readings (n,) [degC], rising, scatter about each."""
    count, first = 0, -np.inf
    for reading in temperature:
        if reading > first + SCATTER:
            count, first = count + 1, reading
    return count


def _flowing(
    start: Any, glassy: float, omega: np.ndarray, temperature: np.ndarray, modulus: np.ndarray
) -> tuple[TwoS2P1D, float]:
    """The 2S2P1D law of a liquid of known glassy modulus [Pa], and its root mean square of ln E* about a table.

    Fits of mixes have a static modulus of a millionth of the largest at least, which is that of a hot binder.
    """
    reference = start.shift.reference_temperature
    singular = reference - float(temperature.min()) + LEAST_ABOVE  # K

    def law_of(x: np.ndarray) -> TwoS2P1D:
        delta, tau, beta, c1, c2 = np.exp(x[:5])
        h = float(expit(x[5]))
        shift = WLF(float(c1), singular + float(c2), reference)
        return TwoS2P1D(0.0, glassy, h * float(expit(x[6])), h, float(delta), float(tau), float(beta), shift)

    def misfit(x: np.ndarray) -> np.ndarray:
        away = np.log(law_of(x).complex_modulus(omega, temperature) / modulus)
        return np.concatenate([away.real, away.imag])

    logs = np.log([start.delta, start.tau, start.beta, start.shift.c1, max(start.shift.c2 - singular, 1.0)])
    exponents = logit(np.clip([start.h, start.k / start.h], 0.01, 0.99))
    found = least_squares(misfit, np.concatenate([logs, exponents]), x_scale="jac")
    return law_of(found.x), float(np.sqrt(2.0 * (found.fun**2).mean()))
