"""Each test held against the other tests of its own specimen and isotherm, by causality and before any law.

Modulus and phase of one isotherm are jointly normal (`kramers_kronig`) with three additions: scatter of single
tests; a constant by which all phases may be off; and a smooth departure from causality, of a size that the isotherm
chooses, since the response of a hot isotherm is often not linear. What is left of one value, after all others of its
isotherm have said what it should be, is scatter or a fault. No other specimen is asked what is right. The other
specimens and isotherms only tell how large scatter, departure and ripple of the law usually are.

A delay between the channels turns the phase of all tests, most at the highest frequency. It would hide a fault there,
or make one. Each isotherm gives a delay of its own; their weighted median is taken off first, where it is sure.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc, logsumexp, stdtr

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import exchanged, wrong_values
from asphalt_nscd.diagnosis.screening.exchanged import Exchange
from asphalt_nscd.diagnosis.screening.kramers_kronig import WEIGHTS, covariances, required_phase

Vector = NDArray[np.float64]
LEAST = 4  # tests of an isotherm: of three, none is redundant
# Wide against what campaigns have (-0.1 to 3.3 deg in NCAT's), so that an offset of a whole isotherm accuses no test.
OFFSET = np.radians(5.0)  # standard deviation of what all phases of an isotherm are off by
# Up to what hot isotherms of real tables show: 20 deg at 25 Hz and 54 degC in FD_Mix1, not shipped.
BENDS = np.radians([0.0, 0.5, 1.5, 5.0, 15.0])  # sizes of the smooth departure of the phase [rad]
BEND_WEIGHTS = (0.60, 0.18, 0.10, 0.07, 0.05)  # before the data speak
BEND_LENGTH = 2.5  # of ln f
SCATTER = 0.01, np.radians(0.3)  # of ln|E*| and phase, first guess
LEAST_SCATTER = 1e-3, np.radians(0.05)  # no two tests repeat better
UNEVEN = 0.5, 3.0  # scatter of an isotherm over the common one; more is no scatter but a broken isotherm
KNOWN = 0.4  # share of the values that is left for the scatter, the laws of the isotherms take the rest
CALIBRATED = 2.5  # on the degrees of freedom: 1 % of 300 clean tables then have a least chance below 1 %
TABLE_WORTH, SPECIMEN_WORTH = 3.0, 2.0  # isotherms that the weights above, and those of the table, are worth
CLIP = 2.0  # standard deviations, beyond which a value does not widen the scatter (Huber's second proposal)
NORMAL_CLIPPED = 0.9205  # mean of min(z^2, 4) of a normal z
ROUNDS = 8, 5  # of the scatter's iteration: at first, and when doubtful values are set aside
DOUBTFUL = 1e-2  # chance below which a value does not judge its neighbours
LEAST_DELAYED = 4  # isotherms that must tell of a delay, at two temperatures at least
SURE = 3.0  # standard errors of a delay that is taken off
MOST_DOUBTFUL = 3  # one of so many tests of an isotherm at most
GROSS = 3.0  # times the first guess of the scatter, that no table's scatter exceeds
ASIDE = 100.0  # variance that takes a value out


@dataclass
class LooPrediction:
    """What the isotherms say of each value; columns 0 and 1 are ln|E*| and phase [rad].

    `judged` (n,): whether the isotherm has LEAST tests; `expected`, `std_error` (n, 2): by the rest of the isotherm,
    with the scatter of one test; `chance` (n, 3): of a departure as large in ln|E*|, phase, or both, neither asked for
    the other; `required`, `required_error` (n,): phase by |E*| alone [rad]; `log_evidence` (n, 4, 5): of each ripple
    and bend; `scatter` (n, 2): of one test; `delay` between channels [s], which `expected` holds. If readings were
    `exchanged`, everything else is of the readings put right.
    """

    judged: NDArray[np.bool_]
    expected: NDArray
    std_error: NDArray
    chance: NDArray
    required: Vector
    required_error: Vector
    log_evidence: NDArray
    scatter: NDArray
    delay: float = 0.0
    exchanged: tuple[Exchange, ...] = ()

    @property
    def unexchanged(self) -> NDArray[np.bool_]:
        """(n,) tests whose readings are not exchanged."""
        return ~np.isin(np.arange(self.judged.size), [row for one in self.exchanged for row in one.rows])


@dataclass(frozen=True)
class _Group:
    """b isotherms of k equal frequencies: rows (b, k) of tests, prior covariance (m, 2k, 2k) by ripple and bend."""

    rows: NDArray[np.int64]
    covariance: NDArray

    @property
    def first(self) -> NDArray[np.int64]:
        return self.rows[:, 0]


class _Table:
    """The values of a table, and what is known so far of its scatter and of the weights."""

    def __init__(self, observed: Observations) -> None:
        logarithm = observed.logarithm
        self.readings = np.column_stack([logarithm.real, logarithm.imag])
        self.values = self.readings.copy()  # of which a delay is taken off
        self.specimen, self.isotherm = observed.specimen, observed.isotherm
        self.groups = _groups(observed)
        n = observed.size
        self.judged = np.zeros(n, bool)
        for group in self.groups:
            self.judged[group.rows] = True
        self.scatter = np.tile(SCATTER, (n, 1))
        self.freedom = np.full((n, 2), 10.0)  # of the t distribution: the scatter is itself estimated
        self.aside = np.zeros((n, 2), bool)
        # Sharpness of each prediction, and its clipped squared error in standard deviations times that.
        self.weight, self.squares = np.ones((n, 2)), np.ones((n, 2))
        # Ripple and bend are independent before the data speak: one is of the mix, the other of how it was tested.
        self.weights = np.tile(np.log(np.multiply.outer(WEIGHTS, BEND_WEIGHTS)), (n, 1, 1))

    def leave_one_out(self) -> LooPrediction:
        """Each value by the others of its isotherm, with scatter and weights as they are; NaN where not judged."""
        n = self.judged.size
        none, evidence = np.full((n, 2), np.nan), np.full((n, len(WEIGHTS), BENDS.size), np.nan)
        loo = LooPrediction(
            self.judged,
            none,
            none.copy(),
            np.ones((n, 3)),
            none[:, 0].copy(),
            none[:, 0].copy(),
            evidence,
            self.scatter,
        )
        for group in self.groups:
            self._leave_out_group(group, loo)
        return loo

    def _leave_out_group(self, group: _Group, loo: LooPrediction) -> None:
        """Enter the isotherms of a group into `loo`, and what they tell of the scatter into this table."""
        rows, k = group.rows, group.rows.shape[1]
        out = _side_by_side(ASIDE * self.aside, rows)
        precision, pull, evidence = self._evidence(group, _side_by_side(self.scatter**2, rows) + out)
        # Leave-one-out by one inverse (Rasmussen & Williams 2006, Eq. 5.12) in place of 2k refits.
        own = np.einsum("bmii->bmi", precision)
        # Evidence without one value, whose departure and variance are in closed form.
        weighed = evidence + self.weights[group.first].reshape(rows.shape[0], -1)
        left, spread = pull / own, 1.0 / own
        others = weighed[:, :, None] + 0.5 * left**2 / spread + 0.5 * np.log(spread)
        share = np.exp(others - logsumexp(others, axis=1, keepdims=True))
        # A value set aside is judged by its own scatter, not by the variance that takes it out.
        spread = spread - out[:, None]
        mean = (share * left).sum(axis=1)
        error = np.sqrt((share * (spread + (left - mean[:, None]) ** 2)).sum(axis=1))
        freedom = _side_by_side(self.freedom, rows)[:, None]
        chance = (share * 2.0 * stdtr(freedom, -np.abs(left) / np.sqrt(spread))).sum(axis=1)
        weight = (share / spread).sum(axis=1)
        squares = (share / spread * np.minimum(left**2 / spread, CLIP**2)).sum(axis=1)
        for column, part in enumerate((slice(0, k), slice(k, None))):
            self.weight[rows, column], self.squares[rows, column] = weight[:, part], squares[:, part]
            loo.expected[rows, column] = self.values[rows, column] - mean[:, part]
            loo.std_error[rows, column] = error[:, part]
            loo.chance[rows, column] = chance[:, part]
        loo.chance[rows, 2] = self._both(group, precision, pull, weighed)
        loo.log_evidence[rows] = evidence.reshape(-1, 1, len(WEIGHTS), BENDS.size)

    def _evidence(self, group: _Group, variance: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """Precision (b, m, 2k, 2k), that times the values (b, m, 2k), and ln evidence (b, m), of each ripple and bend.

        variance (b, 2k): of single values.
        """
        # Centred: the level has its prior about zero, and ln of 10 GPa in Pa is 23.
        values = _side_by_side(self.values - np.array([self.values[self.judged, 0].mean(), 0.0]), group.rows)
        precision = np.linalg.inv(group.covariance + variance[:, None, :, None] * np.eye(values.shape[1]))
        pull = np.einsum("bmij,bj->bmi", precision, values)
        evidence = 0.5 * np.linalg.slogdet(precision)[1] - 0.5 * np.einsum("bmi,bi->bm", pull, values)
        return precision, pull, evidence

    def _both(self, group: _Group, precision: NDArray, pull: NDArray, weighed: NDArray) -> NDArray:
        """Chance (b, k) that ln|E*| and phase of a test are both this far from what the other tests ask for."""
        k = group.rows.shape[1]
        pair = np.array([np.arange(k), np.arange(k) + k]).T
        own = precision[:, :, pair[:, :, None], pair[:, None, :]]
        out = ASIDE * self.aside[group.rows][:, None, :, :, None] * np.eye(2)
        spread = np.linalg.inv(own)
        left = np.einsum("bmkij,bmkj->bmki", spread, pull[:, :, pair])
        others = weighed[:, :, None] + 0.5 * np.einsum("bmki,bmkij,bmkj->bmk", left, own, left)
        others -= 0.5 * np.linalg.slogdet(own)[1]
        share = np.exp(others - logsumexp(others, axis=1, keepdims=True))
        inside = np.linalg.inv(spread - out)
        squares = np.einsum("bmki,bmkij,bmkj->bmk", left, inside, left)
        # A pair is as uncertain as the less known of its two scatters.
        freedom = self.freedom[group.rows].min(axis=2)[:, None]
        return (share * fdtrc(2.0, freedom, 0.5 * squares)).sum(axis=1)

    def common_delay(self, omega: Vector) -> float:
        """Delay [s] between the channels that most isotherms show, zero where it is not sure; omega (n,) [rad/s]."""
        delay, error = np.hstack([self._delays(group, omega) for group in self.groups])
        first = np.concatenate([group.first for group in self.groups])
        if first.size < LEAST_DELAYED or np.unique(self.isotherm[first]).size < 2:
            return 0.0
        # A median, since isotherms that hold the bad tests tell delays of their own.
        order, weight = np.argsort(delay), 1.0 / error
        below = np.cumsum(weight[order])
        median = float(delay[order][np.searchsorted(below, 0.5 * below[-1])])
        apart = 1.4826 * float(np.median(np.abs(delay - median) / error))  # 1 if the errors are true
        # A median of normal values errs sqrt(pi/2) times as far as their mean.
        of_median = np.sqrt(0.5 * np.pi) * max(apart, 1.0) / np.sqrt((error**-2).sum())
        return median if abs(median) > SURE * of_median else 0.0

    def _delays(self, group: _Group, omega: Vector) -> NDArray:
        """Delay of each isotherm and its standard error (2, b) [s]."""
        rows, k = group.rows, group.rows.shape[1]
        values = _side_by_side(self.values - np.array([self.values[self.judged, 0].mean(), 0.0]), rows)
        variance = _side_by_side(self.scatter**2 + ASIDE * self.aside, rows)
        precision = np.linalg.inv(group.covariance + variance[:, None, :, None] * np.eye(2 * k))
        pull = np.einsum("bmij,bj->bmi", precision, np.hstack([np.zeros(rows.shape), omega[rows]]))
        information = np.einsum("bmi,bi->bm", pull[:, :, k:], omega[rows])
        delay = np.einsum("bmi,bi->bm", pull, values) / information
        evidence = np.linalg.slogdet(precision)[1] - np.einsum("bi,bmij,bj->bm", values, precision, values)
        # Each ripple and bend weighs by its evidence with the delay integrated out, under a flat prior.
        evidence += delay**2 * information - np.log(information)
        weighed = 0.5 * evidence + self.weights[group.first].reshape(rows.shape[0], -1)
        share = np.exp(weighed - logsumexp(weighed, axis=1, keepdims=True))
        mean = (share * delay).sum(axis=1)
        spread = (share * (1.0 / information + (delay - mean[:, None]) ** 2)).sum(axis=1)
        return np.array([mean, np.sqrt(spread)])

    def learn(self, rounds: int) -> None:
        """Scatter of each isotherm, and how common each ripple and bend is, from all values.

        Values set aside count as clipped ones: a scatter without them would be too small, and more would seem far.
        """
        for _ in range(rounds):
            loo = self.leave_one_out()
            self._learn_scatter()
            self._learn_weights(loo)

    def _learn_scatter(self) -> None:
        """Scatter of each isotherm, its own drawn to the common one, and the degrees of freedom of that."""
        labels, at = np.unique(self.isotherm[self.judged], return_inverse=True)

        def summed(columns: NDArray) -> NDArray:
            return np.column_stack([np.bincount(at, column) for column in columns[self.judged].T])

        # Weighed by sharpness as in maximum likelihood: ends, where the law is open, tell little of the scatter.
        weight = summed(self.weight)
        count = weight**2 / summed(self.weight**2)
        size = summed(self.squares) / weight / NORMAL_CLIPPED
        now = np.array([self.scatter[self.judged][at == k][0] for k in range(labels.size)])
        own = np.log(now * np.clip(np.sqrt(size), 0.3, 3.0))
        chance = 0.5 / (KNOWN * count)  # variance of the logarithm by chance
        common = (own / chance).sum(axis=0) / (1.0 / chance).sum(axis=0)
        spread = ((own - common) ** 2 / chance).sum(axis=0) - (labels.size - 1.0)
        certainty = (1.0 / chance).sum(axis=0)
        room = certainty - (1.0 / chance**2).sum(axis=0) / certainty
        # Variance of the logarithm between isotherms (DerSimonian & Laird 1986).
        beyond = np.maximum(spread, 0.0) / np.maximum(room, 1e-9)
        share = beyond / (beyond + chance)
        # Shrunk towards the common scatter by how little the isotherm itself knows (empirical Bayes).
        scatter = np.exp(common + np.clip(share * (own - common), *np.log(UNEVEN)))
        # The logarithm of a scatter of nu degrees of freedom has a variance of about 1/(2 nu).
        freedom = 0.5 * CALIBRATED / (share * chance + (1.0 - share) ** 2 / certainty)
        for label, value, known in zip(labels, scatter, freedom, strict=True):
            self.scatter[self.isotherm == label] = np.maximum(value, LEAST_SCATTER)
            self.freedom[self.isotherm == label] = known

    def _learn_weights(self, loo: LooPrediction) -> None:
        """ln weights of ripple and bend before an isotherm speaks: by all isotherms, bends by other specimens too."""
        first = np.concatenate([group.first for group in self.groups])
        weighed = loo.log_evidence[first] + self.weights[first]
        share = np.exp(weighed - logsumexp(weighed, axis=(1, 2), keepdims=True))
        ripple, bend = share.sum(axis=2), share.sum(axis=1)
        # Means of Dirichlet posteriors: a small table stays near the weights of the module, a large one learns its own.
        of_table = TABLE_WORTH + first.size
        ripples = (TABLE_WORTH * np.array(WEIGHTS) + ripple.sum(axis=0)) / of_table
        bends = (TABLE_WORTH * np.array(BEND_WEIGHTS) + bend.sum(axis=0)) / of_table
        isotherm, specimen = self.isotherm[first], self.specimen[first]
        for temperature, name in np.unique(np.column_stack([isotherm, specimen]), axis=0):
            # Bends belong to an isotherm: where other specimens bend at this temperature, this one may be expected to.
            others = (isotherm == temperature) & (specimen != name)
            usual = SPECIMEN_WORTH * bends + bend[others].sum(axis=0)
            rows = (self.isotherm == temperature) & (self.specimen == name)
            self.weights[rows] = np.log(np.multiply.outer(ripples, usual / usual.sum()))

    def put_right(self) -> tuple[Exchange, ...]:
        """Exchange readings that stand in each other's place, at most one pair an isotherm; those that then stand."""
        found = self._exchanges()
        if not found:
            return ()
        for one in found.values():
            self._exchange(one)
        self.learn(ROUNDS[1])
        stand = self._stand(found)
        if len(stand) < len(found):
            for one in set(found.values()) - set(stand):
                self._exchange(one)
            self.learn(ROUNDS[1])
        return stand

    def _exchange(self, one: Exchange) -> None:
        """Exchange two readings; a second time puts them back."""
        first, second = one.rows
        for column in one.columns:
            moved = self.readings[second, column] - self.readings[first, column]
            for table in (self.readings, self.values):
                table[first, column] += moved
                table[second, column] -= moved

    def _exchanges(self) -> dict[tuple[int, ...], Exchange]:
        """What seems exchanged, by number of the isotherm, of the columns, and of the pair of tests."""
        found: dict[tuple[int, ...], Exchange] = {}
        # An exchange makes the scatter of its isotherm larger, that usual in the table hardly.
        scatter = np.minimum(self.scatter, self._usual_scatter())
        for number, (rows, gain, rival) in enumerate(self._gains(scatter)):
            columns, pair = np.unravel_index(int(gain.argmax()), gain.shape)
            if gain[columns, pair] > max(self._least_gain(), rival + exchanged.RIVAL):
                first, second = (int(rows[place[pair]]) for place in exchanged.pairs(rows.size))
                at = number, int(columns), int(pair)
                beyond = float(gain[columns, pair] - rival)
                found[at] = Exchange((first, second), exchanged.COLUMNS[columns], beyond)
        return found

    def _stand(self, found: dict[tuple[int, ...], Exchange]) -> tuple[Exchange, ...]:
        """Exchanges that stand: undone they would cost what one must gain, and readings and isotherm are in order."""
        chance, most = self.leave_one_out().chance, UNEVEN[1] * self._usual_scatter()
        gain = [gain for _, gain, _ in self._gains(self.scatter)]
        return tuple(
            one
            for (number, *at), one in found.items()
            if gain[number][tuple(at)] < -self._least_gain()
            and one.beyond > exchanged.least_beyond(chance[list(one.rows)].min())
            # Where there is no order, some exchange always helps.
            and (self.scatter[one.rows[0]] < most).all()
        )

    def _usual_scatter(self) -> Vector:
        """Scatter (2,) of ln|E*| and phase [rad] that half of the isotherms do not exceed."""
        labels, first = np.unique(self.isotherm[self.judged], return_index=True)
        scatter: Vector = np.sort(self.scatter[self.judged][first], axis=0)[(labels.size - 1) // 2]
        return scatter

    def _least_gain(self) -> float:
        return exchanged.least_gain(np.array([rows.size for group in self.groups for rows in group.rows]))

    def _gains(self, scatter: NDArray) -> Iterator[tuple[NDArray[np.int64], NDArray, float]]:
        """Of each isotherm: rows (k,), ln evidence gained by exchanges (3, p), and by wrong values; scatter (n, 2)."""
        for group in self.groups:
            precision, pull, weighed = self._weighed(group, scatter)
            gain = exchanged.gains(precision, pull, weighed, self.readings[group.rows])
            wrong = wrong_values.likeliest(precision, pull, weighed, most_doubtful(group.rows.shape[1]))
            # An exchange is as rare as one wrong value; two of them, which pass for an exchange of others, are rarer.
            yield from zip(group.rows, gain, (odds - wrong_values.RARE for odds, _ in wrong), strict=True)

    def _weighed(self, group: _Group, scatter: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """As `_evidence`, but ln evidence (b, m) with the learned weights of ripple and bend; scatter (n, 2)."""
        precision, pull, evidence = self._evidence(group, _side_by_side(scatter**2, group.rows))
        return precision, pull, evidence + self.weights[group.first].reshape(evidence.shape)

    def set_gross_aside(self) -> None:
        """Take out what is wrong whatever the scatter, lest it make all others seem so."""
        self._set_wrong_aside(GROSS * self.scatter)

    def set_doubtful_aside(self) -> None:
        """Take out the most doubtful values of each isotherm, again and again, lest they accuse their neighbours."""
        self.aside[:] = False
        self._set_wrong_aside(self.scatter)
        changed = True
        while changed:
            changed, loo = False, self.leave_one_out()
            for rows in (rows for group in self.groups for rows in group.rows):
                chance = np.where(self.aside[rows], 1.0, loo.chance[rows, :2])
                test, column = np.unravel_index(int(chance.argmin()), chance.shape)
                room = self.aside[rows].any(axis=1).sum() < most_doubtful(rows.size)
                if chance[test, column] < DOUBTFUL and room:
                    self.aside[rows[test], column] = changed = True

    def _set_wrong_aside(self, scatter: NDArray) -> None:
        """Take out the likeliest set of wrong values of each isotherm where it is sure; scatter (n, 2)."""
        for group in self.groups:
            k = group.rows.shape[1]
            found = wrong_values.likeliest(*self._weighed(group, scatter), most_doubtful(k))
            for rows, (odds, values) in zip(group.rows, found, strict=True):
                if odds > wrong_values.SURE:
                    self.aside[rows[values % k], values // k] = True


def most_doubtful(tests: int) -> int:
    """How many tests of an isotherm may be doubtful, a third, one at least: with more, none is known to be sound."""
    return max(1, tests // MOST_DOUBTFUL)


def leave_one_out(observed: Observations) -> LooPrediction:
    """Each value of the table held against the rest of its isotherm."""
    table = _Table(observed)
    if not table.groups:
        return table.leave_one_out()
    table.set_gross_aside()
    table.learn(ROUNDS[0])
    # Left in, a delay let two bad tests of an AMPT table pass and doubted the right one; names were 0.25 ms off.
    delay = table.common_delay(observed.omega)
    if delay:
        # Begun anew: scatter and values set aside were learned with the delay in the phases.
        table = _Table(observed)
        table.values[:, 1] -= delay * observed.omega
        table.set_gross_aside()
        table.learn(ROUNDS[0])
    # Before doubtful values are sought: two readings in each other's place hide each other there.
    in_each_others_place = table.put_right()
    table.set_doubtful_aside()
    table.learn(ROUNDS[1])
    loo = table.leave_one_out()
    loo.delay, loo.exchanged = delay, in_each_others_place
    loo.expected[:, 1] += delay * observed.omega
    for rows in (rows for group in table.groups for rows in group.rows):
        # A value set aside must not bend the phase that |E*| requires either.
        scatter = np.sqrt(table.scatter[rows, 0] ** 2 + ASIDE * table.aside[rows, 0])
        required = required_phase(observed.frequency[rows], table.values[rows, 0], scatter)
        loo.required[rows], loo.required_error[rows] = required.phase, required.std_error
    return loo


def blocks(observed: Observations) -> NDArray[np.int64]:
    """Number (n,) of the specimen, isotherm and amplitude of each test together."""
    columns = [observed.specimen, observed.isotherm]
    if observed.amplitude is not None:
        columns.append(observed.amplitude)
    return np.unique(np.column_stack(columns), axis=0, return_inverse=True)[1].ravel()


def _groups(observed: Observations) -> list[_Group]:
    """Isotherms of LEAST tests or more, together where their frequencies are equal."""
    block = blocks(observed)
    alike: dict[tuple[float, ...], list[NDArray[np.int64]]] = {}
    order = np.lexsort([observed.frequency, block])
    for rows in np.split(order, np.flatnonzero(np.diff(block[order])) + 1):
        if rows.size >= LEAST:
            alike.setdefault(tuple(observed.frequency[rows]), []).append(rows)
    # Isotherms of equal frequencies share twenty covariances, four ripples by five bends.
    groups = []
    for frequencies, members in alike.items():
        causal, departing = covariances(frequencies), _departures(np.log(frequencies))
        both = (causal[:, None] + departing).reshape(-1, *causal.shape[1:])
        groups.append(_Group(np.array(members), both))
    return groups


def _departures(log_f: Vector) -> NDArray:
    """Covariance (5, 2k, 2k) of what phases are off by, for each of BENDS."""
    k = log_f.size
    smooth = np.exp(-0.5 * ((log_f[:, None] - log_f) / BEND_LENGTH) ** 2)
    covariance = np.zeros((BENDS.size, 2 * k, 2 * k))
    covariance[:, k:, k:] = OFFSET**2 + BENDS[:, None, None] ** 2 * smooth
    return covariance


def _side_by_side(columns: NDArray, rows: NDArray[np.int64]) -> NDArray:
    """(n, 2) to (b, 2k): ln|E*| of an isotherm, then its phases."""
    return np.concatenate([columns[rows, 0], columns[rows, 1]], axis=1)
