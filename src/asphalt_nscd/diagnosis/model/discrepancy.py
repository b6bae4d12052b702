"""What a table holds beside its law, its causes and its scatter: a discrepancy with a size of its own.

A real table never obeys one law to within its scatter: a hot isotherm is not linear, a machine resonates,
one specimen is odd. Such structure has no name, but it must widen what is said of the causes (Kennedy &
O'Hagan 2001). It enters as Gaussian processes over ln f, for the modulus and for the phase apart: one for
each isotherm, one for each specimen, one common to all tests. Besides, each specimen has a spectrum of its
own, which changes modulus and phase together as causality asks. Their variances are estimated by restricted
likelihood (`likelihood`), with the cause that is tested in the model: without it they would absorb it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import compress

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.criteria import DISCREPANCY
from asphalt_nscd.diagnosis.model.joint import Fitted, Joint
from asphalt_nscd.diagnosis.observed.observations import Observations

Vector = NDArray[np.float64]
Kernel = Callable[[NDArray], NDArray]
# With this length a prototype found offsets put into three real tables again within 0.07 deg.
LENGTH = 1.5  # of ln f, over which the discrepancy of an isotherm changes
# shares of its variance: the same at all frequencies, smooth over ln f, of one condition
LEVEL, SMOOTH, ROUGH = 0.25, 0.6, 0.15
SPECIMEN_LENGTH = 3.0  # of ln f, over which the discrepancy of a specimen changes
ACROSS = 0.5  # of the tested range of temperature, over which it changes
LEFT_OUT = {"isotherm": 1e-3, "all": 1e-3, "specimen": 0.05}  # share of the variance of dropped eigenvectors
OF_TIMES = 4.0  # of ln(relaxation time), over which the spectrum of a specimen departs from that of the mix
LEAST, MOST = 1e-4, 1e7  # variance that is as good as none, and that no table has, in units of the scatter


@dataclass(frozen=True)
class Process:
    """What a process of the discrepancy describes: a `kind` of DISCREPANCY, and what alone it reaches.

    `part` is "modulus", "phase", or "both" where causality ties them; `isotherm` in degC; None where it reaches all.
    """

    kind: str
    part: str
    isotherm: float | None = None
    specimen: str | None = None


@dataclass(frozen=True)
class Processes:
    """The m processes of a table, of unit variance in units of the scatter of one test.

    `roots` (n, rank) are factors of ln E* of each process, real for the modulus and imaginary for the phase; `factor`
    (2n, q) holds all of them whitened, `block` (q,) the process of each column; `usual` (m,) are usual sizes. `spread`
    (m,) is the standard deviation of the logarithm of a size about the usual one, zero of one that is known, infinite
    of one that is mostly zero (half-Cauchy).
    """

    described: tuple[Process, ...]
    roots: tuple[NDArray[np.complex128], ...]
    factor: NDArray
    block: NDArray[np.int64]
    usual: Vector
    spread: Vector

    def selected(self, kept: NDArray[np.bool_]) -> Processes:
        """Some of them (m,) alone."""
        columns = kept[self.block]
        return Processes(
            tuple(compress(self.described, kept)),
            tuple(compress(self.roots, kept)),
            self.factor[:, columns],
            (np.cumsum(kept) - 1)[self.block[columns]],
            self.usual[kept],
            self.spread[kept],
        )

    @cached_property
    def gram(self) -> NDArray:
        """Products (q, q) of the columns of `factor`; they stay the same when the law is fitted again."""
        return np.asarray(self.factor.T @ self.factor)

    @cached_property
    def isotherm(self) -> NDArray[np.int64]:
        """Number (q,) of the isotherm whose processes alone a column overlaps, -1 of one that no or several ones do.

        No column reaches two numbers: what isotherms share is a specimen's or of all tests.
        """
        isotherms = [np.nan if one.isotherm is None else one.isotherm for one in self.described]
        at = np.array(isotherms)[self.block]
        touched = [(self.gram[:, at == t] != 0.0).any(axis=1) for t in np.unique(at[np.isfinite(at)])]
        reached = np.array(touched, bool).reshape(-1, at.size)
        return np.where(reached.sum(axis=0) == 1, np.arange(len(touched)) @ reached, -1)

    @property
    def known(self) -> NDArray[np.bool_]:
        """Which (m,) have their usual size and no other."""
        return self.spread == 0.0

    def prior(self, variances: Vector) -> tuple[float, Vector, Vector]:
        """-2 ln of the prior of the sizes, and its first and second derivatives (m,) along the variances."""
        away = np.log(variances / self.usual**2)
        about = np.isfinite(self.spread)
        s = np.where(self.known | ~about, 1.0, 2.0 * self.spread) ** 2
        # Half-Cauchy on the size: mostly none, with a tail that lets a broken isotherm be as odd as it is.
        value = np.where(about, away**2 / s, 2.0 * np.log1p(variances / self.usual**2))
        rare = 2.0 / (self.usual**2 + variances)
        slope = np.where(about, 2.0 * away / s / variances, rare)
        bend = np.where(about, (2.0 / s / variances - slope) / variances, -0.5 * rare**2)
        return float(value.sum()), slope, bend

    def covariance_factor(self, variances: Vector) -> NDArray:
        """What the processes add to the scatter: factor (2n, r) of the covariance of ln|E*| and of the phase."""
        # Columns of no size would cost as much as others whenever residuals are whitened.
        kept = [
            np.sqrt(variance) * root
            for root, variance in zip(self.roots, variances, strict=True)
            if variance > LEAST
        ]
        stacked = np.hstack(kept) if kept else np.zeros((self.roots[0].shape[0], 0), complex)
        return np.concatenate([stacked.real, stacked.imag])


def processes(joint: Joint, fitted: Fitted) -> Processes:
    """Gaussian processes of a table's discrepancy; what a specimen's own spectrum does is linearised at the fit."""
    observed, noise = joint.observed, joint.noise
    described, roots = list[Process](), []
    # The law of a single specimen is its spectrum.
    if len(observed.names) > 1:
        spectra = noise.sigma[0] * _spectrum_factor(joint, fitted)
        for k, name in enumerate(observed.names):
            described.append(Process("spectrum", "both", specimen=name))
            roots.append(spectra * (observed.specimen == k)[:, None])
    for process, points, kernel in _kernels(observed):
        root = factor_of(points, kernel, LEFT_OUT[process.kind])
        for part, unit in (("modulus", noise.sigma[0]), ("phase", 1j * noise.sigma[1])):
            described.append(replace(process, part=part))
            roots.append(unit * root)
    usual = [DISCREPANCY[process.kind] for process in described]
    factor = np.hstack([noise.whiten(root) for root in roots])
    block = np.repeat(np.arange(len(roots)), [root.shape[1] for root in roots])
    spread = np.full(len(usual), np.inf)  # not known: a half Cauchy prior
    return Processes(tuple(described), tuple(roots), factor, block, np.array(usual), spread)


def _spectrum_factor(joint: Joint, fitted: Fitted) -> NDArray[np.complex128]:
    """What a smooth relative change of the spectrum by one does to ln E*, a factor (n, rank)."""
    log_times = np.log(joint.spectrum.times)[:, None]
    modulus, slope = joint.base.modulus(fitted.law, joint.observed.omega, joint.observed.temperature)
    return (slope[:, : log_times.size] / modulus[:, None]) @ factor_of(
        log_times, lambda apart: np.exp(-0.5 * (apart[0] / OF_TIMES) ** 2), 1e-2
    )


def _kernels(observed: Observations) -> Iterator[tuple[Process, NDArray, Kernel]]:
    """Each process, of either part, with points (n, d) of the tests that it reaches (else NaN) and its correlation."""
    log_f = np.log(observed.frequency)[:, None]

    def along(apart: NDArray) -> NDArray:
        return SMOOTH * np.exp(-0.5 * (apart[0] / LENGTH) ** 2) + ROUGH * (np.abs(apart[0]) < 1e-9)

    # What one isotherm alone has of its own is not told from what is common to all.
    several = observed.isotherms.size > 1 or len(observed.names) == 1
    for t in observed.held_isotherms if several else ():
        at = np.where(observed.isotherm == t, 0.0, np.nan)[:, None]
        yield Process("isotherm", "either", isotherm=float(t)), log_f + at, lambda apart: LEVEL + along(apart)
    if observed.isotherms.size > 1:
        # No level: one common to all tests is the law's, or an offset of the phase, which has a name.
        yield Process("all", "either"), log_f, along
    if len(observed.names) > 1:
        span = ACROSS * max(float(np.ptp(observed.isotherms)), 1.0)
        both = np.hstack([log_f / SPECIMEN_LENGTH, observed.temperature[:, None] / span])
        for k, name in enumerate(observed.names):
            at = np.where(observed.specimen == k, 0.0, np.nan)[:, None]
            yield Process("specimen", "either", specimen=name), both + at, _specimen_factor


def _specimen_factor(apart: NDArray) -> NDArray:
    return 0.5 + 0.5 * np.exp(-0.5 * (apart**2).sum(axis=0))


def factor_of(points: NDArray, kernel: Kernel, left_out: float) -> NDArray:
    """Factor (n, rank) of the correlation between points (n, d), zero where a point is NaN: not reached.

    Tests at one point share a row, so that only distinct points are solved for. `kernel` is a function of the
    differences (d, m, m); `left_out` is the share of the variance of dropped eigenvectors.
    """
    rows = np.flatnonzero(np.isfinite(points).all(axis=1))
    distinct, place, count = np.unique(points[rows], axis=0, return_inverse=True, return_counts=True)
    apart = distinct.T[:, :, None] - distinct.T[:, None, :]
    weight = np.sqrt(count)
    # weighed by the number of tests at a point, so that what is dropped is little in the table's own norm
    value, vector = np.linalg.eigh(weight[:, None] * kernel(apart) * weight)
    value, vector = np.maximum(value[::-1], 0.0), vector[:, ::-1] / weight[:, None]
    rank = int(np.searchsorted(np.cumsum(value), (1.0 - left_out) * value.sum())) + 1
    root = np.zeros((points.shape[0], min(rank, value.size)))
    root[rows] = (vector[:, :rank] * np.sqrt(value[:rank]))[place.ravel()]
    return root
