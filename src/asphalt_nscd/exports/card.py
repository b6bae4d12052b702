"""What an export writes: a law, its Prony series with the error, Poisson's ratio and units, and how to say it."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from dataclasses import dataclass, replace
from decimal import ROUND_UP, Context, Decimal
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd import __version__
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.maxwell import MaxwellSeries, series_of
from asphalt_nscd.rheology.maxwell_fitting import Miss, fit_series, miss
from asphalt_nscd.rheology.spectrum_io import student

POISSON = 0.35  # of the bonds of Quezada & Chazallon (2020)
LEAST_LONG_TERM = 1e-6  # of the instantaneous modulus: programs want a solid at infinite time
ROUNDING = 1e-6  # % or deg: an error of arithmetic alone
FAR_OFF = 0.15  # of ln |E*|, root mean square: a law that is no law of these tests
WIDTH = 100  # characters of a line of comment


@dataclass(frozen=True)
class Units:
    """A consistent system of units, whose unit `stress` is `pascals` Pa."""

    name: str
    stress: str
    pascals: float

    def express(self, modulus: float) -> float:
        """A modulus [Pa] in the unit `stress`."""
        return modulus / self.pascals


UNITS = {"SI": Units("m, N, s, Pa", "Pa", 1.0), "mm-N-MPa": Units("mm, N, s, MPa", "MPa", 1e6)}


@dataclass(frozen=True)
class Settings:
    """What the user chooses for an export.

    `allowed` are the largest errors of the series; where `poisson` is None it is assumed; `units` are those of the
    file, `name` that of the material.
    """

    allowed: Miss = Miss(1.0, 0.5)
    poisson: float | None = None
    units: Units = UNITS["SI"]
    name: str = "ASPHALT"


@dataclass(frozen=True)
class Card:
    """A law as a Prony series at `law.temperature`, with its largest errors over the band.

    `exact` says that the series is the law itself.
    """

    law: ExportedLaw
    settings: Settings
    series: MaxwellSeries
    error: Miss
    exact: bool

    @property
    def poisson(self) -> float:
        """The stated ratio, or the assumed one."""
        return POISSON if self.settings.poisson is None else self.settings.poisson

    def solid(self) -> Card:
        """The card with a long-term modulus above zero, as programs for solids want it."""
        # With its own error: a law that flows is missed where the least modulus takes over.
        series = self.series.solid(LEAST_LONG_TERM)
        if series == self.series:
            return self
        return replace(
            self, series=series, error=miss(series, self.law.reference_modulus, *self.law.reduced_band())
        )

    @property
    def half_widths(self) -> NDArray[np.float64] | None:
        """Half of the 95 % intervals of long-term modulus and branches, (1 + m,) [Pa], to first order.

        The moduli are those that follow the law over the band when its parameters move by their covariance, at fixed
        relaxation times. None where the law's file has no covariance, and for an exact series.
        """
        known, low_high = self.law.uncertainty, self.law.reduced_band()
        if known is None or self.exact:
            return None
        omega = np.geomspace(*low_high, 20 * len(self.series.times) + 20)
        turned = 1j * omega[:, None] * np.array(self.series.times)
        modulus = self.law.reference_modulus(omega)
        branches = np.hstack([np.ones((omega.size, 1)), turned / (1.0 + turned)]) / modulus[:, None]
        slopes = self.law.law.log_slopes(omega, np.full(omega.size, self.law.temperature))  # type: ignore[union-attr]
        system, moved = (np.concatenate([part.real, part.imag]) for part in (branches, slopes))
        response = np.linalg.lstsq(system, moved)[0]
        variance = np.einsum("ij,jk,ik->i", response, known.covariance, response)
        return student(min(known.freedom)) * np.sqrt(variance)

    def achieved(self) -> str:
        """Number of terms and largest errors, in words."""
        terms = f"{counted(len(self.series.moduli), 'Prony term')} at {self.law.temperature:g} degC"
        return f"{terms}, largest errors {_short(self.error.percent)} % of |E*| and {_short(self.error.degrees)} deg"

    def poisson_said(self) -> str:
        """Poisson's ratio and where it comes from, in words."""
        stated = "as stated by --poisson" if self.settings.poisson is not None else "assumed, not measured"
        return f"Poisson's ratio {self.poisson:g} ({stated})"

    def told(self) -> str:
        """One line on what was written and how well it follows the law."""
        shift = "" if self.law.shift else ", no shift"
        off = self.law.rms_log_residual or 0.0
        far = (
            f" The law itself misses its tests by {100.0 * off:.0f} %: do not rely on it."
            if off > FAR_OFF
            else ""
        )
        return f"{self.achieved()} over {self.law.band}{shift}; {self.poisson_said()}.{far}"

    def statements(self) -> list[str]:
        """What a reader must know, one sentence an item."""
        law, units = self.law, self.settings.units
        low, high = law.reduced_band()
        said = [
            f"Linear viscoelastic law of an asphalt mix, written by asphalt-nscd {__version__} from {law.path.name}.",
            f"Law: {law.name}; source: {law.source}.",
            "Parameters: " + ", ".join(self._parameter(key) for key in law.parameters) + ".",
            f"{self._tests()} {law.loose()}",
            f"Units: {units.name}; temperature in degC.",
            f"Series: {self.achieved()}, against the law"
            + (" (the law's own exact form)." if self.exact else "."),
            f"Band of these errors: {law.band}"
            + (f", that is {low:.4g} to {high:.4g} rad/s at {law.temperature:g} degC." if law.shift else "."),
            *self._uncertain(),
            f"Instantaneous modulus {self._modulus(self.series.instantaneous)}, long-term modulus "
            f"{self._modulus(self.series.long_term)}." + self._limits(),
            f"{self.poisson_said()}, constant in time: shear and bulk moduli relax alike.",
        ]
        if law.kind == "kelvin_chain":
            said.append("A chain of bonds: its moduli may hold the factor that makes up for a packing.")
        if law.shift is None:
            said.append(f"Holds at {law.temperature:g} degC only: the law has no shift.")
        else:
            said.append(f"Shift: {self._shift()}")
        return said

    def comment(self, sign: str) -> list[str]:
        """The statements as ASCII lines of comment, each of which begins with `sign`."""
        return [
            # ASCII: none of these programs was run, and a name may hold any letter.
            f"{sign} {line}".encode("ascii", "replace").decode()
            for statement in self.statements()
            for line in textwrap.wrap(statement, WIDTH, subsequent_indent="  ")
        ]

    def _parameter(self, key: str) -> str:
        low_high = self.law.intervals.get(key)
        said = f" ({low_high[0]:.4g} to {low_high[1]:.4g})" if low_high else ""
        return f"{key} = {self.law.parameters[key]:.6g}{said}"

    def _uncertain(self) -> list[str]:
        """How sure the law and the moduli of the series are."""
        low, high = self.law.reduced_band()
        band, moduli = self.law.half_widths(np.geomspace(low, high, 30)), self.half_widths
        if band is None or moduli is None:
            return []
        sizes = ", ".join(f"{self.settings.units.express(half):.3g}" for half in moduli)
        return [
            "Behind a parameter: its 95 % interval.",
            f"95 % interval of the law in the band: {100.0 * np.expm1(band.real.min()):.2g} to "
            f"{100.0 * np.expm1(band.real.max()):.2g} % of |E*| to either side, {np.degrees(band.imag.min()):.2g} to "
            f"{np.degrees(band.imag.max()):.2g} deg of the phase.",
            f"95 % intervals of the moduli at these relaxation times, long-term modulus first: +- {sizes} "
            f"{self.settings.units.stress}. Errors of neighbours cancel: together they are those of the law.",
        ]

    def _tests(self) -> str:
        """How far the law itself is from the tests it was fitted to."""
        rms = self.law.rms_log_residual
        if rms is None:
            return "The file does not say how far the law is from tests."
        return f"The law itself is {100.0 * rms:.2g} % (root mean square of |ln E*|) from the tests it was fitted to."

    def _modulus(self, modulus: float) -> str:
        return f"{self.settings.units.express(modulus):.6g} {self.settings.units.stress}"

    def _limits(self) -> str:
        """Why the limits of the series are not those of the law."""
        if self.exact:
            if self.series.long_term == 0.0:
                return " The law flows."
            # 1.01 for rounding: such a series was given just this share.
            flows = self.series.long_term < 1.01 * LEAST_LONG_TERM * self.series.instantaneous
            return (
                f" The law flows; {LEAST_LONG_TERM:g} of the instantaneous modulus stands for none."
                if flows
                else ""
            )
        keys = ("E_glassy_Pa", "E_static_Pa")
        limits = [self.law.parameters.get(key) for key in keys]
        if None in limits:
            return " Outside the band the series does not follow the law."
        glassy, static = (self._modulus(limit) for limit in limits if limit is not None)
        return (
            f" Outside the band the series does not follow the law, whose limits are {glassy} and {static}."
        )

    def _shift(self) -> str:
        wlf = self.law.wlf()
        assert wlf is not None
        form = "log10 a_T = -C1 (T - T0) / (C2 + T - T0), relaxation times are multiplied by a_T"
        constants = f"T0 = {wlf.reference_temperature:g} degC, C1 = {wlf.c1:.6g}, C2 = {wlf.c2:.6g} K"
        if wlf is self.law.shift:
            return f"{form}; {constants}."
        return f"{form}; {constants}, which are the Arrhenius shift of the law written as WLF, without approximation."


def make_card(law: ExportedLaw, settings: Settings) -> Card:
    """The card of a law: exact where its series is finite, else fitted within the allowed error.

    Refuses a law that does not relax over its band, and an error that cannot be met.
    """
    low, high = law.reduced_band()
    chain = law.law.kelvin_form() if isinstance(law.law, Burgers) else law.law
    # Without a spring in series the instantaneous modulus has no end, nor has a series of this kind.
    if isinstance(chain, KelvinChain) and chain.spring < float("inf"):
        series = series_of(chain)
        if not series.moduli:
            raise InputError(
                f"{law.path}: this law is a single spring and does not relax; enter its modulus by hand."
            )
        return Card(law, settings, series, miss(series, law.reference_modulus, low, high), exact=True)
    try:
        series, error = fit_series(law.reference_modulus, low, high, settings.allowed)
    except InputError as refusal:
        raise InputError(f"{law.path}: {refusal}") from None
    if not series.moduli:
        raise InputError(
            f"{law.path}: over {law.band} the law does not relax, so that a series would have no term; give the "
            "temperatures and frequencies that were tested."
        )
    return Card(law, settings, series, error, exact=False)


def number(value: float) -> str:
    """A number in ten digits, as all programs read it."""
    # Ten digits: the long-term share of a law that flows, 1e-6, is what the weights leave of one.
    return f"{value:.9E}"


def _short(value: float) -> str:
    """Two digits, rounded up: an error is never understated."""
    if value < ROUNDING:
        return f"less than {ROUNDING:g}"
    return f"{float(Context(prec=2, rounding=ROUND_UP).create_decimal(Decimal(value))):.2g}"


def write_card(
    law: ExportedLaw, settings: Settings, path: Path, text: Callable[[Card], str], solid: bool = False
) -> str:
    """Write the card of a law as text; a line on it. `solid`: the program wants a solid at infinite time."""
    card = make_card(law, settings)
    card = card.solid() if solid else card
    path.write_text(text(card), encoding="utf-8")
    return card.told()
