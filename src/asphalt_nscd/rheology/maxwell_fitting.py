"""The generalised Maxwell model with the fewest branches that follows a law within a stated error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, nnls

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.maxwell import MaxwellSeries

Vector = NDArray[np.float64]
Modulus = Callable[[Vector], NDArray[np.complex128]]

MOST_TERMS = 60
REACH = np.geomspace(0.1, 10.0, 16)  # factors by which times reach beyond the band, tried in turn
FITTED, TESTED = 12, 60  # frequencies in a decade for the fit, and for the error
ROUNDS = 8  # of reweighting, which turns least squares towards the least largest error
NEGLIGIBLE = 1e-9  # of the largest modulus: a branch that least squares left by rounding
SMALLEST = 1e-6  # long-term modulus over the sum, from which a logarithm can start


@dataclass(frozen=True)
class Miss:
    """Largest errors of a series: of |E*| in percent, and of the phase in degrees."""

    percent: float
    degrees: float

    def is_within(self, allowed: Miss) -> bool:
        """Whether neither error is larger than the one allowed."""
        return self.percent <= allowed.percent and self.degrees <= allowed.degrees


def miss(series: MaxwellSeries, modulus: Modulus, lowest_omega: float, highest_omega: float) -> Miss:
    """Largest errors of a series against a law, E* [Pa] of angular frequencies [rad/s], over a band [rad/s]."""
    omega = _grid(lowest_omega, highest_omega, TESTED)
    return _miss_of(series, modulus(omega), omega)


def fit_series(
    modulus: Modulus, lowest_omega: float, highest_omega: float, allowed: Miss
) -> tuple[MaxwellSeries, Miss]:
    """The series of the fewest branches found that stays within the allowed errors over a band [rad/s], and its errors.

    `modulus` gives E* [Pa] at (n,) rad/s. Relaxation times start evenly spaced on a logarithmic scale, with positive
    moduli (so the series is passive) from non-negative least squares. Then branches are taken away while times and
    moduli, refined together, still meet the error. Outside the band the series is whatever follows from within.
    """
    if not 0.0 < lowest_omega <= highest_omega < np.inf:
        raise InputError(
            f"band from {lowest_omega:g} to {highest_omega:g} rad/s: give a lowest frequency that is "
            "positive and not above the highest."
        )
    if not (allowed.percent > 0.0 and allowed.degrees > 0.0):
        raise InputError("error of a Prony series: give a positive error in % of |E*| and in degrees.")
    omega, dense = (_grid(lowest_omega, highest_omega, count) for count in (FITTED, TESTED))
    target, tested = modulus(omega), modulus(dense)
    found: tuple[MaxwellSeries, Miss] | None = None
    starts: dict[int, MaxwellSeries] = {}
    for terms in range(1, MOST_TERMS + 1):
        tries = [_spaced(omega, target, terms, reach, allowed) for reach in REACH]
        starts[terms] = min(tries, key=lambda series: _size(_miss_of(series, tested, dense), allowed))
        error = _miss_of(starts[terms], tested, dense)
        if error.is_within(allowed):
            found = starts[terms], error
            break
    if found is None:
        best = min((_miss_of(series, tested, dense) for series in starts.values()), key=lambda m: m.percent)
        raise InputError(
            f"no Prony series of {MOST_TERMS} terms or fewer follows the law to {allowed.percent:g} % and "
            f"{allowed.degrees:g} deg from {lowest_omega:g} to {highest_omega:g} rad/s, the best to "
            f"{best.percent:.2g} % and {best.degrees:.2g} deg; allow a larger error."
        )
    terms = len(found[0].moduli)
    while terms > 0:
        series = _refined(starts[terms], omega, target, allowed)
        error = _miss_of(series, tested, dense)
        if not error.is_within(allowed):
            break
        found = series, error
        terms = len(series.moduli) - 1
    return found


def _spaced(
    omega: Vector, target: NDArray[np.complex128], terms: int, reach: float, allowed: Miss
) -> MaxwellSeries:
    """Series of evenly spaced relaxation times; moduli by non-negative least squares."""
    # One at least: a narrow band times a reach below one would turn the order of the times.
    middle, half = np.sqrt(omega[0] * omega[-1]), max(np.sqrt(omega[-1] / omega[0]) * reach, 1.0)
    times = np.geomspace(1.0 / half, half, terms) / middle if terms > 1 else np.array([1.0 / middle])
    turned = 1j * omega[:, None] * times
    # parts over the modulus: their sum is to be one, whatever the law's size
    relative = np.hstack([np.ones((omega.size, 1)), turned / (1.0 + turned)]) / target[:, None]
    scale = np.array([_scales(allowed)]).T.repeat(omega.size, axis=1).ravel()
    system = np.vstack([relative.real, relative.imag]) / scale[:, None]
    wanted = np.concatenate([np.ones(omega.size), np.zeros(omega.size)]) / scale
    # Columns of equal length, as in `conversion`: NNLS holds all gradients against one tolerance.
    size = np.linalg.norm(system, axis=0)
    values = nnls(system / size, wanted)[0] / size
    kept = values[1:] > NEGLIGIBLE * values.max()
    return MaxwellSeries(float(values[0]), tuple(values[1:][kept].tolist()), tuple(times[kept].tolist()))


def _refined(
    start: MaxwellSeries, omega: Vector, target: NDArray[np.complex128], allowed: Miss
) -> MaxwellSeries:
    """Series with times and moduli moved together, towards the least largest error over what is allowed.

    Coordinates are logarithms, so that all values stay positive. Weights grow where the error is
    large (Lawson 1961).
    """
    terms = len(start.moduli)
    # logarithms keep moduli and times positive without bounds
    first = np.log([max(start.long_term, SMALLEST * sum(start.moduli)), *start.moduli, *start.times])
    scales = _scales(allowed)
    weight = np.ones(2 * omega.size)

    def parts(x: Vector) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        turned = 1j * omega[:, None] * np.exp(x[terms + 1 :])
        branches = np.exp(x[1 : terms + 1]) * turned / (1.0 + turned)
        return branches, branches / (1.0 + turned)

    def residual(x: Vector) -> Vector:
        off = np.log((np.exp(x[0]) + parts(x)[0].sum(axis=1)) / target)
        return np.concatenate([off.real / scales[0], off.imag / scales[1]])

    def slope(x: Vector) -> Vector:
        branches, by_time = parts(x)
        total = np.exp(x[0]) + branches.sum(axis=1)
        columns = np.hstack([np.full((omega.size, 1), np.exp(x[0])), branches, by_time]) / total[:, None]
        return np.vstack([columns.real / scales[0], columns.imag / scales[1]])

    best, x = (np.inf, first), first
    for _ in range(ROUNDS):
        root = np.sqrt(weight)
        x = least_squares(
            lambda x, root=root: root * residual(x),
            x,
            jac=lambda x, root=root: root[:, None] * slope(x),
            max_nfev=100,
        ).x
        left = np.abs(residual(x))
        best = min(best, (float(left.max()), x), key=lambda pair: pair[0])
        # Lawson's method: where the error is large the weight grows, until the largest error is as small as
        # it gets
        weight *= left / left.max()
        # a weight of zero never comes back, though the error there may
        weight = np.maximum(weight / weight.mean(), 1e-4)
    values = np.exp(best[1])
    order = np.argsort(values[terms + 1 :])
    return MaxwellSeries(
        float(values[0]),
        tuple(values[1 : terms + 1][order].tolist()),
        tuple(values[terms + 1 :][order].tolist()),
    )


def _scales(allowed: Miss) -> tuple[float, float]:
    """Allowed errors of ln |E*| and of the phase [rad]."""
    return float(np.log1p(allowed.percent / 100.0)), float(np.radians(allowed.degrees))


def _size(found: Miss, allowed: Miss) -> float:
    return max(found.percent / allowed.percent, found.degrees / allowed.degrees)


def _miss_of(series: MaxwellSeries, target: NDArray[np.complex128], omega: Vector) -> Miss:
    ratio = series.complex_modulus(omega) / target
    return Miss(
        float(100.0 * np.abs(np.abs(ratio) - 1.0).max()), float(np.degrees(np.abs(np.angle(ratio)).max()))
    )


def _grid(low: float, high: float, in_a_decade: int) -> Vector:
    return np.geomspace(low, high, max(3, round(in_a_decade * np.log10(high / low)) + 1))
