"""What an export writes: a law, its Prony series with the error, Poisson's ratio and units, and how to say it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import ROUND_UP, Context, Decimal
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd import __version__
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import UNITS, ExportSettings, Units
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.templates import items, template
from asphalt_nscd.files.words import counted
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.maxwell import MaxwellSeries, series_of
from asphalt_nscd.rheology.maxwell_fitting import Miss, fit_series, miss
from asphalt_nscd.rheology.shift import ZERO_CELSIUS
from asphalt_nscd.rheology.spectrum_io import student

POISSON = 0.35  # of the bonds of Quezada & Chazallon (2020)
LEAST_LONG_TERM = 1e-6  # of the instantaneous modulus: programs want a solid at infinite time
ROUNDING = 1e-6  # % or deg: an error of arithmetic alone
FAR_OFF = 0.15  # of ln |E*|, root mean square: a law that is no law of these tests
WIDTH = 100  # characters of a line of comment


@dataclass(frozen=True)
class Card:
    """A law as a Prony series at `law.temperature`, with its largest errors over the band.

    `exact` says that the series is the law itself.
    """

    law: ExportedLaw
    settings: ExportSettings
    series: MaxwellSeries
    error: Miss
    exact: bool

    @property
    def units(self) -> Units:
        """The units of the file."""
        return UNITS[self.settings.units]

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
        """Half of the 95 % intervals of the long-term modulus and m branches (1 + m,) [Pa], to first order.

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
        """What a reader must know, one sentence or more an item."""
        return statements(
            "statements.j2",
            card=self,
            law=self.law,
            modulus=lambda pascals: f"{self.units.express(pascals):.6g} {self.units.stress}",
            band_of=lambda low, high: np.geomspace(low, high, 30),
            percent_of=lambda half: tuple(100.0 * np.expm1([half.min(), half.max()])),
            degrees_of=lambda half: tuple(np.degrees([half.min(), half.max()])),
            least=LEAST_LONG_TERM,
        )

    def text(self, name: str) -> str:
        """The card by a template of this folder, in which `comment` makes comments of the statements."""
        series = self.series
        return template(f"exports/{name}", {"number": number}).render(
            card=self,
            series=series,
            terms=list(zip(series.weights, series.times, strict=True)),
            moduli=list(zip(series.moduli, series.times, strict=True)),
            wlf=self.law.wlf(),
            express=self.units.express,
            comment=lambda sign: comment(sign, self.statements()),
            zero_celsius=ZERO_CELSIUS,
        )


def statements(name: str, **content: Any) -> list[str]:
    """The statements of a template, each without line breaks."""
    return items(template(f"exports/{name}").render(version=__version__, **content))


def comment(sign: str, said: Sequence[str]) -> str:
    """Statements as ASCII lines of comment, each of which begins with `sign`."""
    lines = (line for one in said for line in textwrap.wrap(one, WIDTH, subsequent_indent="  "))
    # ASCII: none of these programs was run, and a name may hold any letter.
    return "\n".join(f"{sign} {line}" for line in lines).encode("ascii", "replace").decode()


def make_card(law: ExportedLaw, settings: ExportSettings) -> Card:
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
        series, error = fit_series(
            law.reference_modulus, low, high, Miss(settings.error_percent, settings.error_deg)
        )
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
    """A number in two digits, rounded up: an error is never understated."""
    if value < ROUNDING:
        return f"less than {ROUNDING:g}"
    return f"{float(Context(prec=2, rounding=ROUND_UP).create_decimal(Decimal(value))):.2g}"


def write_card(law: ExportedLaw, settings: ExportSettings, path: Path, name: str, solid: bool = False) -> str:
    """Write the card of a law by a template; a line on it. `solid`: the program wants a solid at infinite time."""
    card = make_card(law, settings)
    card = card.solid() if solid else card
    path.write_text(card.text(name), encoding="utf-8")
    return card.told()
