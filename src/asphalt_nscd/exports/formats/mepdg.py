"""AASHTOWare Pavement ME: |E*| in psi at the standard temperatures and frequencies, and its sigmoid.

log10 |E*| = delta + alpha / (1 + exp(beta + gamma log10 t_r)), with |E*| in psi and t_r = 1 / (f a_T) in
seconds at 70 degF (NCHRP 1-37A, part 2, chapter 2). The table holds values of the law, not of the sigmoid.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import least_squares

from asphalt_nscd.exports.card import comment, statements
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.units import PSI, celsius_of_fahrenheit

ENDINGS = (".csv",)
TEMPERATURES_F = (14.0, 40.0, 70.0, 100.0, 130.0)
FREQUENCIES = (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)  # Hz
REFERENCE_F = 70.0  # of the shift in the sigmoid, by NCHRP 1-37A
ROUNDING = 1e-6  # relative, of the ends of the tested band
FIRST = (4.0, 2.5, -1.0, 0.5)  # delta, alpha, beta, gamma

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Table:
    """|E*| by temperature (rows) and frequency (columns): `modulus` (t, f) [psi].

    `outside` says of each value if it is beyond the tests: "f" in reduced frequency, "T" in temperature, "fT" in both;
    `sigmoid` is delta, alpha, beta, gamma, with the largest error `error_percent` in |E*|; `log_shift` (t,) is log10
    a_T from 70 degF; `spread` (t, f) is the factor of the 95 % interval to either side, NaN or None where not known.
    """

    law: ExportedLaw
    modulus: Vector
    outside: list[list[str]]
    sigmoid: tuple[float, float, float, float]
    error_percent: float
    log_shift: Vector
    spread: Vector | None


def write(law: ExportedLaw, settings: ExportSettings, path: Path) -> str:
    """Write the table of |E*| in psi, whatever the settings; a line on it."""
    table = make_table(law)
    path.write_text(text(table), encoding="utf-8")
    return said(table)


def sigmoid(parameters: Vector, log_time: Vector) -> Vector:
    """log10 |E*| of the sigmoid delta, alpha, beta, gamma at log10 of reduced times [s], of the shape of `log_time`."""
    delta, alpha, beta, gamma = parameters
    return delta + alpha / (1.0 + np.exp(beta + gamma * log_time))


def make_table(law: ExportedLaw) -> Table:
    """The table of a law and the sigmoid nearest to it; refuses a law of one temperature or no shift at 70 degF."""
    if law.shift is None:
        raise InputError(
            f"{law.path}: a law of one temperature, {law.temperature:g} degC, but this table has five; "
            "give a law of all temperatures, such as law.json of a diagnosis."
        )
    celsius = celsius_of_fahrenheit(np.array(TEMPERATURES_F))
    frequency = np.array(FREQUENCIES)
    defined = law.defined(celsius)
    if not defined[TEMPERATURES_F.index(REFERENCE_F)]:
        raise InputError(
            f"{law.path}: its WLF shift is not defined at {REFERENCE_F:g} degF; give a law of colder tests."
        )
    factor = np.full(celsius.size, np.nan)
    factor[defined] = law.factor(celsius[defined])
    reduced = 2.0 * np.pi * frequency * factor[:, None]
    modulus = np.full(reduced.shape, np.nan)
    modulus[defined] = np.abs(law.reference_modulus(reduced[defined])) / PSI
    spread = None
    if law.uncertainty is not None:
        spread = np.full(reduced.shape, np.nan)
        at = np.repeat(celsius[defined], frequency.size)
        omega = np.tile(2.0 * np.pi * frequency, int(defined.sum()))
        half = law.uncertainty.half(law.law, omega, at)  # type: ignore[arg-type]
        # A factor to either side, since the interval is of ln |E*|.
        spread[defined] = np.exp(half.real).reshape(-1, frequency.size)
    # From 70 degF, wherever the law has its own reference.
    log_shift = np.log10(factor / factor[TEMPERATURES_F.index(REFERENCE_F)])
    # t_r = 1 / (f a_T), so both count against it.
    log_time = -(np.log10(frequency) + log_shift[:, None])

    def misfit(x: Vector) -> Vector:
        return (sigmoid(x, log_time[defined]) - np.log10(modulus[defined])).ravel()

    found = least_squares(misfit, FIRST, x_scale=(1.0, 1.0, 1.0, 0.3), max_nfev=2000)
    low, high = law.reduced_band()
    warmest, coldest = law.band.temperature.max(), law.band.temperature.min()
    outside = [
        [
            _outside(reduced[row, column], low, high) + _outside_temperature(t, coldest, warmest)
            for column in range(frequency.size)
        ]
        for row, t in enumerate(celsius)
    ]
    error = float(100.0 * np.abs(10.0 ** misfit(found.x) - 1.0).max())
    delta, alpha, beta, gamma = (float(value) for value in found.x)
    return Table(law, modulus, outside, (delta, alpha, beta, gamma), error, log_shift, spread)


def _outside(reduced: float, low: float, high: float) -> str:
    """`f` where the reduced frequency is beyond those of the tests, and where there is none."""
    return "" if low * (1.0 - ROUNDING) <= reduced <= high * (1.0 + ROUNDING) else "f"


def _outside_temperature(celsius: float, coldest: float, warmest: float) -> str:
    """`T` where the shift itself is extrapolated, by more than half a kelvin."""
    # 130 degF are 54.4 degC, which laboratories test as 54.
    return "" if coldest - 0.5 <= celsius <= warmest + 0.5 else "T"


def said(table: Table) -> str:
    """One line on the table: how many values are extrapolated, and how well the sigmoid follows."""
    beyond = sum(bool(cell) for row in table.outside for cell in row)
    return (
        f"30 values of |E*| in psi, {beyond} of them extrapolated beyond {table.law.band}; "
        f"sigmoid within {table.error_percent:.2g} % of them."
    )


def text(table: Table) -> str:
    """The table as CSV; lines that begin with # are comment."""
    found = zip(TEMPERATURES_F, table.outside, strict=True)
    said = statements(
        "mepdg.j2",
        table=table,
        law=table.law,
        shifts=list(zip(TEMPERATURES_F, table.log_shift, strict=True)),
        undefined=bool(np.isnan(table.log_shift).any()),
        beyond=[(t, f, why) for t, row in found for f, why in zip(FREQUENCIES, row, strict=True) if why],
    )
    columns = [f"E_psi_at_{f:g}_Hz" for f in FREQUENCIES]
    index = pd.Index([f"{t:g}" for t in TEMPERATURES_F], name="temperature_F")
    moduli = pd.DataFrame(table.modulus, index, columns)
    lines = [comment("#", said)]
    if table.spread is not None:
        low, high = moduli / table.spread, moduli * table.spread
        lines.append("# 95 % interval of |E*| of the law, psi, in the order of the table:")
        for t in index:
            ends = zip(low.loc[t], high.loc[t], strict=True)
            cells = [f"{a:.0f} to {b:.0f}" if np.isfinite(a) else "" for a, b in ends]
            lines.append(f"# {t}, {', '.join(cells)}")
    return "\n".join([*lines, moduli.to_csv(float_format="%.0f", lineterminator="\n")])
