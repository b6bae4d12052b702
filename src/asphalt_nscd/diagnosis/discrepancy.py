"""What a table holds beside its law, its causes and its scatter: a discrepancy with a size of its own.

A real table never obeys one law to within its scatter: a hot isotherm is not linear, a machine resonates,
one specimen is odd. Such structure has no name, but it must widen what is said of the causes (Kennedy &
O'Hagan 2001). It enters as Gaussian processes over ln f, for the modulus and for the phase apart: one for
each isotherm, one for each specimen, one common to all tests. Besides, each specimen has a spectrum of its
own, which changes modulus and phase together as causality asks. Their variances are estimated by restricted
likelihood, with the cause that is tested in the model: without it they would absorb it.

With V0 the covariance of scatter and law (its prior included), U the factors of the processes and v their
variances, V = V0 + U diag(v) U^T. Everything is reduced to the columns of U once (Woodbury), so that the
estimate for one more cause costs milliseconds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dpotrf, dpotrs, dtrtri

from asphalt_nscd.diagnosis.criteria import DISCREPANCY
from asphalt_nscd.diagnosis.joint import Fitted, Joint
from asphalt_nscd.diagnosis.observations import Observations

Vector = NDArray[np.float64]
Kernel = Callable[[NDArray], NDArray]
LENGTH = 1.5  # of ln f, over which the discrepancy of an isotherm changes
LEVEL, SMOOTH, ROUGH = (
    0.25,
    0.6,
    0.15,
)  # shares of its variance: all frequencies, smooth over ln f, one condition
SPECIMEN_LENGTH = 3.0  # of ln f, over which the discrepancy of a specimen changes
ACROSS = 0.5  # of the tested range of temperature, over which it changes
LEFT_OUT = {"isotherm": 1e-3, "all": 1e-3, "specimen": 0.05}  # share of the variance of dropped eigenvectors
OF_TIMES = 4.0  # of ln(relaxation time), over which the spectrum of a specimen departs from that of the mix
UNKNOWN = 2.0  # standard deviation of the ln v that a table tells nothing of
ITERATIONS = 25
CONVERGED = 0.05  # change of -2 ln likelihood
LEAST, MOST = 1e-4, 1e7  # variance that is as good as none, and that no table has, in units of the scatter


@dataclass(frozen=True)
class Process:
    """What a process of the discrepancy describes.

    Parameters
    ----------
    kind : str
        Of DISCREPANCY.
    part : str
        "modulus", "phase", or "both" where causality ties them.
    isotherm : float, optional
        What alone it reaches [degC]; None where it reaches all.
    specimen : str, optional
        What alone it reaches; None where it reaches all.
    """

    kind: str
    part: str
    isotherm: float | None = None
    specimen: str | None = None


@dataclass(frozen=True)
class Processes:
    """The m processes of a table, of unit variance in units of the scatter of one test.

    Parameters
    ----------
    described : tuple of Process (m,)
        What each is about.
    roots : tuple of ndarray of complex (n, rank)
        Factors of ln E* of each process, real for the modulus and imaginary for the phase.
    factor : ndarray (2n, q)
        All of them whitened.
    block : ndarray of int (q,)
        Process of each column.
    usual : ndarray (m,)
        Usual sizes.
    spread : ndarray (m,)
        Standard deviation of the logarithm of a size that is about the usual one, infinite of one that is
        mostly zero (half-Cauchy).
    """

    described: tuple[Process, ...]
    roots: tuple[NDArray[np.complex128], ...]
    factor: NDArray
    block: NDArray[np.int64]
    usual: Vector
    spread: Vector

    def prior(self, variances: Vector) -> tuple[float, Vector, Vector]:
        """-2 ln of the prior of the sizes.

        Parameters
        ----------
        variances : ndarray (m,)
            Of the processes.

        Returns
        -------
        float
            Its value.
        ndarray (m,)
            First derivatives along the variances.
        ndarray (m,)
            Second derivatives.
        """
        away = np.log(variances / self.usual**2)
        about = np.isfinite(self.spread)
        s = np.where(about, 2.0 * self.spread, 1.0) ** 2
        value = np.where(about, away**2 / s, 2.0 * np.log1p(variances / self.usual**2))
        rare = 2.0 / (self.usual**2 + variances)
        slope = np.where(about, 2.0 * away / s / variances, rare)
        bend = np.where(about, (2.0 / s / variances - slope) / variances, -0.5 * rare**2)
        return float(value.sum()), slope, bend

    def beside(self, variances: Vector) -> NDArray:
        """What the processes add to the scatter.

        Parameters
        ----------
        variances : ndarray (m,)
            Of the processes.

        Returns
        -------
        ndarray (2n, r)
            Factor of the covariance of ln|E*| and of the phase.
        """
        kept = [
            np.sqrt(variance) * root
            for root, variance in zip(self.roots, variances, strict=True)
            if variance > LEAST
        ]
        stacked = np.hstack(kept) if kept else np.zeros((self.roots[0].shape[0], 0), complex)
        return np.concatenate([stacked.real, stacked.imag])


def processes(joint: Joint, fitted: Fitted) -> Processes:
    """The processes that a table may hold; what a specimen's own spectrum does is linearised at the fit.

    Parameters
    ----------
    joint : Joint
        Model of the table.
    fitted : Fitted
        Where it stands.

    Returns
    -------
    Processes
        Of unit variance.
    """
    observed, noise = joint.observed, joint.noise
    described, roots = list[Process](), []
    if len(observed.names) > 1:
        spectra = noise.sigma[0] * _of_spectrum(joint, fitted)
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
    rare = np.full(len(usual), np.inf)
    return Processes(tuple(described), tuple(roots), factor, block, np.array(usual), rare)


def _of_spectrum(joint: Joint, fitted: Fitted) -> NDArray[np.complex128]:
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
        yield Process("all", "either"), log_f, along
    if len(observed.names) > 1:
        span = ACROSS * max(float(np.ptp(observed.isotherms)), 1.0)
        both = np.hstack([log_f / SPECIMEN_LENGTH, observed.temperature[:, None] / span])
        for k, name in enumerate(observed.names):
            at = np.where(observed.specimen == k, 0.0, np.nan)[:, None]
            yield Process("specimen", "either", specimen=name), both + at, _of_specimen


def _of_specimen(apart: NDArray) -> NDArray:
    return 0.5 + 0.5 * np.exp(-0.5 * (apart**2).sum(axis=0))


def factor_of(points: NDArray, kernel: Kernel, left_out: float) -> NDArray:
    """Factor of the correlation between points.

    Tests at one point share a row, so that only distinct points are solved for.

    Parameters
    ----------
    points : ndarray (n, d)
        NaN where a process does not reach.
    kernel : callable
        Of the differences (d, m, m).
    left_out : float
        Share of the variance of dropped eigenvectors.

    Returns
    -------
    ndarray (n, rank)
        Zero where a point is NaN.
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


@dataclass(frozen=True)
class Reduced:
    """Scatter and law taken out, with A = V0^-1 and data y.

    Parameters
    ----------
    processes : Processes
        Of the table.
    gram : ndarray (q, q)
        U^T A U.
    along : ndarray (q,)
        U^T A y.
    """

    processes: Processes
    gram: NDArray
    along: Vector

    def only(self, kept: NDArray[np.bool_]) -> Reduced:
        """With some of the processes alone.

        Parameters
        ----------
        kept : ndarray of bool (m,)
            Which.

        Returns
        -------
        Reduced
            Of these.
        """
        found, columns = self.processes, kept[self.processes.block]
        less = Processes(
            tuple(one for one, stays in zip(found.described, kept, strict=True) if stays),
            tuple(root for root, stays in zip(found.roots, kept, strict=True) if stays),
            found.factor[:, columns],
            (np.cumsum(kept) - 1)[found.block[columns]],
            found.usual[kept],
            found.spread[kept],
        )
        return Reduced(less, self.gram[np.ix_(columns, columns)], self.along[columns])


@dataclass(frozen=True)
class Direction:
    """Directions d (2n, k) in the same form.

    Parameters
    ----------
    cross : ndarray (q, k)
        U^T A d.
    own : ndarray (k, k)
        d^T A d.
    along : ndarray (k,)
        d^T A y.
    """

    cross: NDArray
    own: NDArray
    along: Vector

    def column(self, k: int) -> Direction:
        """One of them alone.

        Parameters
        ----------
        k : int
            Which.

        Returns
        -------
        Direction
            Of one column.
        """
        return Direction(self.cross[:, [k]], self.own[[k]][:, [k]], self.along[[k]])


@dataclass(frozen=True)
class Estimate:
    """Variances of the processes, and the amplitude of the cause that was in the model.

    Parameters
    ----------
    variances : ndarray (m,)
        v.
    misfit : float
        -2 ln of the penalised likelihood, the cause at its best.
    amplitude : float
        Of the cause, in units of its direction; zero without one.
    std_error : float
        Of the amplitude; infinite without a cause.
    """

    variances: Vector
    misfit: float
    amplitude: float = 0.0
    std_error: float = np.inf

    @property
    def z(self) -> float:
        """Amplitude in standard errors."""
        return self.amplitude / self.std_error


def reduce(found: Processes, fitted: Fitted) -> Reduced:
    """The model linearised at a fit, whitened by the scatter alone.

    Parameters
    ----------
    found : Processes
        Processes of the table.
    fitted : Fitted
        Where the model stands.

    Returns
    -------
    Reduced
        All that an estimate needs of the table.
    """
    gram = _projected(fitted, found.factor, found.factor)
    return Reduced(found, 0.5 * (gram + gram.T), _data(fitted, found.factor))


def directions(model: Reduced, fitted: Fitted, d: NDArray) -> Direction:
    """Whitened directions of causes.

    Parameters
    ----------
    model : Reduced
        Of `reduce`.
    fitted : Fitted
        Where the model stands.
    d : ndarray (2n, k)
        Directions.

    Returns
    -------
    Direction
        In the same form.
    """
    return Direction(
        _projected(fitted, model.processes.factor, d), _projected(fitted, d, d), _data(fitted, d)
    )


def moved(model: Reduced, cause: Direction, amount: float) -> tuple[Reduced, Direction]:
    """The same with so much of an effect added to the data.

    Parameters
    ----------
    model : Reduced
        Of `reduce`.
    cause : Direction
        One direction.
    amount : float
        Of it.

    Returns
    -------
    Reduced
        Moved.
    Direction
        Moved.
    """
    return (
        replace(model, along=model.along + amount * cause.cross[:, 0]),
        replace(cause, along=cause.along + amount * cause.own[:, 0]),
    )


def _projected(fitted: Fitted, left: NDArray, right: NDArray) -> NDArray:
    """left^T A right: what the law may follow is taken out."""
    j = fitted.jacobian
    return left.T @ right - (left.T @ j) @ np.linalg.solve(fitted.precision, j.T @ right)


def _data(fitted: Fitted, left: NDArray) -> Vector:
    """left^T A y, also where the fit is not the best one by this measure."""
    to_best = np.linalg.solve(fitted.precision, fitted.gradient)
    return left.T @ (fitted.residual - fitted.jacobian @ to_best)


def estimate(model: Reduced, cause: Direction | None = None, start: Vector | None = None) -> Estimate:
    """Penalised restricted likelihood: multiplicative steps (Zhou et al. 2019), extrapolated (SQUAREM).

    Parameters
    ----------
    model : Reduced
        Of `reduce`.
    cause : Direction, optional
        One direction that is in the model, or none.
    start : ndarray (m,), optional
        Variances to start from; the usual ones if None.

    Returns
    -------
    Estimate
        Variances, and the amplitude of the cause.
    """
    lowest, highest = np.log(LEAST), np.log(MOST)
    usual = model.processes.usual
    log_v = np.log(usual**2 if start is None else np.maximum(start, LEAST))
    now = _point(model, cause, log_v)
    # SQUAREM: two multiplicative steps, then a long one along both, taken back where it does not gain
    for _ in range(ITERATIONS):
        first = np.clip(log_v + now.step, lowest, highest)
        middle = _point(model, cause, first)
        second = np.clip(first + middle.step, lowest, highest)
        one, change = first - log_v, second - 2.0 * first + log_v
        reach = float(np.clip(np.linalg.norm(one) / np.maximum(np.linalg.norm(change), 1e-12), 1.0, 20.0))
        far = np.clip(log_v + 2.0 * reach * one + reach**2 * change, lowest, highest)
        trial = _point(model, cause, far)
        if not trial.objective <= middle.objective:
            far, trial = second, _point(model, cause, second)
        if not np.isfinite(trial.objective):
            break
        gained, log_v, now = now.objective - trial.objective, far, trial
        if gained < CONVERGED:
            break
    return Estimate(np.exp(log_v), now.misfit, now.amplitude, now.std_error)


def with_uncertain_sizes(model: Reduced, cause: Direction, found: Estimate) -> Estimate:
    """The same with a standard error that holds what is not known of the variances (Kackar and Harville 1984).

    Their covariance is that of the curvature of the objective; what the table does not tell is held to a
    factor.

    Parameters
    ----------
    model : Reduced
        Of `reduce`.
    cause : Direction
        One direction.
    found : Estimate
        Of `estimate`.

    Returns
    -------
    Estimate
        With a larger standard error.
    """
    curvature, along = _curvature(model, cause, found.variances)
    value, vector = np.linalg.eigh(0.5 * curvature)  # half of it, for -2 ln likelihood
    spread = (vector.T @ along) ** 2 / (np.maximum(value, 0.0) + UNKNOWN**-2)
    return replace(found, std_error=float(np.sqrt(found.std_error**2 + spread.sum())))


def _curvature(model: Reduced, cause: Direction, variances: Vector) -> tuple[NDArray, Vector]:
    """Second derivatives (m, m) of the objective along ln v, and first ones (m,) of the amplitude.

    With P the inverse covariance, law and cause taken out, dP/dv_k = -P U_k U_k^T P.
    """
    found, m = model.processes, variances.size
    block, s = found.block, np.sqrt(variances)[found.block]
    lower, failed = _factor(model, s)
    if failed:
        return np.zeros((m, m)), np.zeros(m)
    inverse = dtrtri(lower, lower=1)[0]
    left = (np.eye(s.size) - inverse.T @ inverse) / s[:, None] / s  # U^T P U
    right = s[:, None] * np.column_stack([model.along, cause.cross[:, 0]])
    solved = dpotrs(lower, right, lower=1)[0]
    pull, sensed = (solved / s[:, None]).T
    information = max(float(cause.own[0, 0] - right[:, 1] @ solved[:, 1]), 1e-12)
    pull = pull - sensed * float(cause.along[0] - right[:, 1] @ solved[:, 0]) / information
    left = left - np.outer(sensed, sensed) / information
    member = np.eye(m)[block]
    _, slope, bend = found.prior(variances)
    gradient = np.bincount(block, np.diag(left) - pull**2, m) + slope
    second = member.T @ (2.0 * pull[:, None] * left * pull - left**2) @ member
    second[range(m), range(m)] += gradient / variances + bend
    along = -variances * np.bincount(block, sensed * pull, m) / information
    return variances[:, None] * second * variances, along


@dataclass(frozen=True)
class _Point:
    """objective: of the restricted likelihood; misfit: the same without the size of the cause's interval."""

    objective: float
    misfit: float
    step: Vector  # of ln v
    amplitude: float
    std_error: float


def _point(model: Reduced, cause: Direction | None, log_v: Vector) -> _Point:
    """With B = 1 + S G S, S = sqrt(v): S^-1 (1 - B^-1) S^-1 is what is left of G, S^-1 B^-1 S y of the data."""
    found = model.processes
    block, m, v = found.block, log_v.size, np.exp(log_v)
    s = np.sqrt(v)[block]
    lower, failed = _factor(model, s)
    if failed:
        return _Point(np.inf, np.inf, np.zeros(m), 0.0, np.inf)
    data = s * model.along
    right = data[:, None] if cause is None else np.column_stack([data, s * cause.cross[:, 0]])
    solved = dpotrs(lower, right, lower=1)[0]
    # the diagonal of U^T P U from the triangular inverse alone: the whole matrix would cost several times as
    # much
    diagonal = (1.0 - (dtrtri(lower, lower=1)[0] ** 2).sum(axis=0)) / s**2
    pull = solved[:, 0] / s
    misfit = 2.0 * float(np.log(np.diag(lower)).sum()) - float(data @ solved[:, 0])
    amplitude, std_error, interval = 0.0, np.inf, 0.0
    if cause is not None:
        information = max(float(cause.own[0, 0] - right[:, 1] @ solved[:, 1]), 1e-12)
        along = float(cause.along[0] - right[:, 1] @ solved[:, 0])
        # ln information is what restricted likelihood pays for the amplitude, as for the law
        amplitude, std_error, interval = along / information, information**-0.5, np.log(information)
        misfit -= along * amplitude
        sensed = solved[:, 1] / s
        diagonal = diagonal - sensed**2 / information
        pull = pull - sensed * amplitude
    prior, slope, _ = found.prior(v)
    misfit += prior
    trace = np.bincount(block, np.maximum(diagonal, 0.0), m) + np.maximum(slope, 0.0)
    square = np.bincount(block, pull**2, m) + np.maximum(-slope, 0.0)
    # the multiplicative step keeps variances positive; its power of a half makes it monotone (minorise-
    # maximise)
    step = 0.5 * np.log(np.maximum(square, 1e-12) / trace)
    return _Point(misfit + interval, misfit, step, amplitude, std_error)


def _factor(model: Reduced, s: Vector) -> tuple[NDArray, bool]:
    """Lower factor of 1 + S G S, and whether there is none: rounding, where a size is absurd."""
    # I + S G S, whose eigenvalues are 1 at least: its factor exists even where variances vanish
    whole = s[:, None] * model.gram * s
    whole[np.diag_indices(s.size)] += 1.0
    lower, failed = dpotrf(whole, lower=1)
    return lower, bool(failed)


def correlation(model: Reduced, all_directions: Direction, variances: Vector) -> tuple[NDArray, Vector]:
    """How directions hang together where nothing is hidden.

    Parameters
    ----------
    model : Reduced
        Of `reduce`.
    all_directions : Direction
        k of them.
    variances : ndarray (m,)
        Of the processes.

    Returns
    -------
    ndarray (k, k)
        Correlation of their z.
    ndarray (k,)
        Their standard errors.
    """
    information, _ = weighed(model, all_directions, variances)
    size = np.sqrt(np.maximum(np.diag(information), 1e-300))
    return information / size[:, None] / size, 1.0 / size


def weighed(model: Reduced, all_directions: Direction, variances: Vector) -> tuple[NDArray, Vector]:
    """What a table says of the amplitudes of directions, law and discrepancy integrated out.

    Parameters
    ----------
    model : Reduced
        Of `reduce`.
    all_directions : Direction
        k of them.
    variances : ndarray (m,)
        Of the processes.

    Returns
    -------
    ndarray (k, k)
        Information.
    ndarray (k,)
        Score.
    """
    s = np.sqrt(variances)[model.processes.block]
    lower, _ = _factor(model, s)
    half = solve_triangular(lower, s[:, None] * all_directions.cross, lower=True, check_finite=False)
    data = solve_triangular(lower, s * model.along, lower=True, check_finite=False)
    return all_directions.own - half.T @ half, all_directions.along - half.T @ data
