"""Single tests that contradict the rest of their isotherm, and isotherms that contradict themselves.

Causality within the specimen's own isotherm decides; quality columns of the machine and replicates are witnesses
beside it. Two replicates that agree are not right for that: replicates alone take no test out. What every specimen
shows at a condition is no single test either: a resonance or a gain of the machine is left to the diagnosis.

Measured: of 600 invented clean tables (2S2P1D, Huet-Sayegh, Havriliak-Negami, Burgers, Zener; 1 %, 0.3 deg) one loses
tests. One fault put into a cold isotherm (below 10 degC) of two real tables is found in 96 % of 260 trials
(4 or 6 deg, 10 or 20 % of |E*|), at 21 degC in 89 % of 180. No other test is taken out. Those missed stand at the
ends of the band, mostly at the lowest frequency, where nothing on one side says what the phase should be.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import logsumexp, stdtr

from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.observed.copies import copied
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import contested, within_isotherm, wrong_values
from asphalt_nscd.diagnosis.screening.exchanged import Exchange
from asphalt_nscd.diagnosis.screening.kramers_kronig import required_phase
from asphalt_nscd.diagnosis.screening.within_isotherm import BEND_WEIGHTS, BENDS, SCATTER, LooPrediction
from asphalt_nscd.files.words import counted

STRONG = 6e-3  # chance, times the number of values, below which causality alone takes a test out
# The same where replicates find it in place, by IN_PLACE or more. Of 296 invented clean tables one then loses a test,
# and seven without it.
DENIED, IN_PLACE = 6e-5, 1.0
NOTABLE = 0.1  # the same for a test that is listed and used
SUPPORTED = 1e-2  # chance of one value, below which it is taken out where a witness agrees
ALONE = 0.03  # the same for a flagged test of one specimen alone, whose scatter is known less
SLIP, NEAR_POWER = np.log(3.0), 0.02  # of ln|E*|, told as a factor; of log10 of that, near a power of ten
FAR = 5e-3  # chance, times the number of values, below which replicates are a witness
LEANING, VERY_FAR = 0.1, 1e-5  # both limits where replicates say more: at the ends causality knows little
PHASES = 0.0, 90.0  # deg, that a passive linear material can have
BROKEN = 0.99  # probability that the phase of an isotherm departs smoothly by 1.5 deg or more
BREAKS = BENDS > np.radians(1.0)
# Standard errors of a phase that |E*| requires, where other isotherms speak against this one too.
TORN_APART = 1.5
TORN_LEAST = 3.0  # deg, the same: isotherms of NCAT that are not broken depart by up to 2.4
FEWEST = 3  # tests whose |E*| requires a phase
LEAST_FREEDOM = 4  # of the replicates of an isotherm
SHARED = "every specimen contradicts its isotherm here in the same way: look for a common cause, not for a bad test"
HALVES = (
    "readings of its sweep contradict each other, and this one is off the level that the specimen has against the "
    "others at other temperatures"
)
ONE_WITNESS = "its modulus and phase agree with the other frequencies"
IN_BROKEN = 1e-3  # factor on STRONG in a broken isotherm, whose departure may be no more than nearly smooth


@dataclass(frozen=True)
class Suspect:
    """A doubtful test, with its row, the reasons why, and whether the diagnosis still uses it."""

    row: int
    reasons: tuple[str, ...]
    used: bool


@dataclass(frozen=True)
class BrokenIsotherm:
    """An isotherm whose phase departs from what |E*| requires by more than single tests explain.

    `temperature` in degC, `frequency` (k,) in Hz; `difference` (k,): phase measured less required, mean over specimens,
    and `std_error` (k,) in degrees.
    """

    temperature: float
    frequency: NDArray[np.float64]
    difference: NDArray[np.float64]
    std_error: NDArray[np.float64]
    specimens: int

    @property
    def sentence(self) -> str:
        """Where the phase leaves the curve, for a reader."""
        low, high = sorted([self.difference.argmin(), self.difference.argmax()])
        ends = " and ".join(
            f"{abs(self.difference[k]):.1f} deg {'above' if self.difference[k] > 0.0 else 'below'} it at "
            f"{self.frequency[k]:g} Hz"
            for k in (low, high)
        )
        mean = f" (mean of {self.specimens} specimens)" if self.specimens > 1 else ""
        return (
            f"At {self.temperature:g} degC modulus and phase contradict each other: |E*| requires a phase, and the "
            f"measured one is {ends}{mean}. No linear material does that. The response is not linear there (the "
            "stress changed with the frequency), or the machine resonates."
        )


def find(observed: Observations, loo: LooPrediction | None = None) -> list[Suspect]:
    """Suspect tests by row, each with the sentences that a reader can check; `loo` if it is already computed."""
    if tens := wrong_values.expected_of_tens(observed):
        # Nothing else is judged beside them: they would bend the others, and the scatter with them.
        kept = np.setdiff1d(np.arange(observed.size), list(tens))
        rest = [replace(one, row=int(kept[one.row])) for one in find(observed.subset(kept))]
        slipped = [Suspect(row, (_decimal_slip(observed, row, size),), False) for row, size in tens.items()]
        return sorted([*rest, *slipped], key=lambda one: one.row)
    loo = loo or within_isotherm.leave_one_out(observed)
    broken = np.isin(observed.isotherm, _broken_temperatures(observed, loo))
    # Modulus, phase and both together of each judged test are looked at (Bonferroni).
    values = loo.chance.shape[1] * max(np.count_nonzero(loo.judged), 1)
    limit = np.where(broken, IN_BROKEN, 1.0) / values
    flags = _singled_out(observed)
    worst, single = loo.chance.min(axis=1), loo.chance[:, :2]
    doubtful = single < SUPPORTED
    alone = np.bincount(observed.cell)[observed.cell] == 1
    against = single < np.where(alone, ALONE, SUPPORTED)[:, None]
    flagged = np.array([bool(sentences) for sentences in flags])
    logarithm = observed.logarithm
    left = np.column_stack([logarithm.real, logarithm.imag]) - loo.expected
    copied_blocks = list(copied(observed))
    copies = np.isin(np.arange(observed.size), [row for one in copied_blocks for row in one.rows])
    apart, chance = _replicate_distance(observed, loo.unexchanged & ~copies)
    denied = (apart != 0.0).any(axis=1) & (chance.min(axis=1) * values > IN_PLACE)
    strong = worst < STRONG * limit
    shared = _shared(observed, loo, strong, left)
    strong &= ~denied | (worst < DENIED * limit)
    out = (strong & ~shared) | (against.any(axis=1) & flagged) | ~loo.unexchanged | copies
    # What is already out is no replicate of the others.
    apart, chance = _replicate_distance(observed, ~out)
    far = chance * values < FAR
    # Where a whole isotherm breaks, causality accuses sound tests too and is no second witness.
    agree = (np.sign(apart) == np.sign(left)) & ~broken[:, None]
    supported = agree & ((doubtful & far) | ((single < LEANING) & (chance * values < VERY_FAR)))
    out |= supported.any(axis=1)
    out, turned = contested.put_right(observed, out)
    hidden = contested.masked(observed, out, worst < LEANING)
    out, turned = out | hidden, turned | hidden
    listed = ((out & loo.unexchanged & ~copies) | (worst < NOTABLE * limit)) & ~turned
    # Beside a wrong phase the modulus seems wrong too: the less likely of the two is named, or the one with a witness.
    wrong = np.where(supported | ~supported.any(axis=1, keepdims=True), single, 1.0).argmin(axis=1)
    found = []
    for row in np.flatnonzero(out | listed | flagged | (far.any(axis=1) & ~turned)):
        block = observed.names[observed.specimen[row]], float(observed.isotherm[row])
        reasons = [one.reason(*block) for one in copied_blocks if row in one.rows]
        reasons += [
            _exchange_reason(observed, one) for one in loo.exchanged if row in one.rows and not turned[row]
        ]
        reasons += [HALVES] * bool(turned[row] and out[row])
        reasons += [_causal_reason(observed, loo, int(row), int(wrong[row]))] if listed[row] else []
        reasons += flags[row] + [ONE_WITNESS] * bool(flagged[row] and loo.judged[row] and not listed[row])
        reasons += [
            _replicate_reason(observed, apart, int(row), int(column))
            for column in np.flatnonzero(far[row] & ~turned[row])
        ]
        reasons += [SHARED] * bool(shared[row])
        found.append(Suspect(int(row), tuple(reasons), not bool(out[row])))
    return found


def _shared(
    observed: Observations, loo: LooPrediction, strong: NDArray[np.bool_], left: NDArray
) -> NDArray[np.bool_]:
    """Tests (n,) of conditions at which every specimen, two at least, contradicts its isotherm in the same way."""
    channel = loo.chance[:, :2].argmin(axis=1)
    sign = np.sign(np.take_along_axis(left, channel[:, None], axis=1)[:, 0])
    way = np.where(strong, sign * (channel + 1.0), 0.0)
    shared = np.zeros(observed.size, bool)
    for cell in np.unique(observed.cell[strong]):
        rows = np.flatnonzero((observed.cell == cell) & loo.judged)
        alike = np.unique(way[rows]).size == 1
        shared[rows] = alike and np.unique(observed.specimen[rows]).size > 1
    return shared


def broken_isotherms(
    observed: Observations, loo: LooPrediction | None = None, torn: Collection[float] = ()
) -> list[BrokenIsotherm]:
    """Isotherms that contradict themselves as a whole, ascending; their single tests are no suspects.

    `torn` are isotherms [degC] that follow no one law with the others, of which less evidence is asked for.
    """
    loo = loo or within_isotherm.leave_one_out(observed)
    required, own_error = _required(observed, loo)
    difference = np.degrees(observed.logarithm.imag - required)
    error = np.degrees(np.hypot(own_error, loo.scatter[:, 1]))
    broken, found = _broken_temperatures(observed, loo), []
    for temperature in np.union1d(broken, list(torn)):
        rows = np.isfinite(required) & loo.unexchanged & (observed.isotherm == temperature)
        if temperature not in broken and not _contradicts(difference[rows], error[rows]):
            continue
        frequency, at = np.unique(observed.frequency[rows], return_inverse=True)
        count = np.bincount(at)
        found.append(
            BrokenIsotherm(
                float(temperature),
                frequency,
                np.bincount(at, difference[rows]) / count,
                np.sqrt(np.bincount(at, error[rows] ** 2)) / count,
                np.unique(observed.specimen[rows]).size,
            )
        )
    return found


def _contradicts(difference: NDArray, error: NDArray) -> bool:
    """Whether phases (k,) lie, in the mean, further from those required than the error that they share; both [deg]."""
    return difference.size > 0 and bool(abs(difference.mean()) > max(TORN_APART * error.mean(), TORN_LEAST))


def _required(observed: Observations, loo: LooPrediction) -> tuple[NDArray, NDArray]:
    """Phase (n,) that |E*| requires and its error [rad], of isotherms of three tests too."""
    required, error = loo.required.copy(), loo.required_error.copy()
    block = within_isotherm.blocks(observed)
    for number in np.unique(block[~loo.judged]):
        rows = np.flatnonzero(block == number)
        if rows.size >= FEWEST:
            one = required_phase(observed.frequency[rows], observed.logarithm.real[rows], SCATTER[0])
            required[rows], error[rows] = one.phase, one.std_error
    return required, error


def one_sided(observed: Observations, loo: LooPrediction) -> str:
    """A sentence where half of the phases or more depart from what |E*| requires as their mean does; else empty."""
    rows = loo.judged & loo.unexchanged
    apart = np.degrees(observed.logarithm.imag - loo.required)[rows]
    far = np.abs(apart) > 2.0 * np.degrees(loo.required_error[rows])
    mean = apart.mean() if apart.size else 0.0
    there = np.count_nonzero(far & (apart * mean > 0.0))
    if not there or 2 * there < apart.size:
        return ""
    side = "higher" if mean > 0.0 else "lower"
    return (
        f"{there} of {apart.size} phases are {side} than |E*| requires (about 90 deg times the slope of log |E*| "
        "against log f), by more than two standard errors. On average all phases are "
        f"{abs(mean):.1f} deg {side} than that."
    )


def table(observed: Observations, record: pd.DataFrame, loo: LooPrediction) -> pd.DataFrame:
    """One row for each test: the phase measured and the one that |E*| alone requires, and its `record`."""
    flagged = {one.row for one in quality.exceeded(observed)}
    rows = range(observed.size)
    return pd.DataFrame(
        {
            "specimen": [observed.names[k] for k in observed.specimen],
            "temperature_C": observed.isotherm,
            "frequency_Hz": observed.frequency,
            "E_MPa": np.abs(observed.modulus) / 1e6,
            "phase_deg": np.degrees(observed.logarithm.imag),
            "phase_required_deg": np.degrees(loo.required),
            "std_error_deg": np.degrees(loo.required_error),
            "quality_flag": [int(row in flagged) for row in rows],
            "status": record["status"],
            "reasons": ["; ".join(one) for one in record["reasons"]],
        }
    )


def _broken_temperatures(observed: Observations, loo: LooPrediction) -> NDArray[np.float64]:
    """Isotherms [degC] whose phase departs smoothly by more than 1 deg, with a probability above BROKEN."""
    block = within_isotherm.blocks(observed)
    broken = []
    for temperature in observed.isotherms:
        rows = np.flatnonzero(loo.judged & (observed.isotherm == temperature))
        _, first = np.unique(block[rows], return_index=True)
        if first.size:
            # All specimens of the isotherm depart by one size, each with a law of its own.
            evidence = logsumexp(loo.log_evidence[rows[first]], axis=1).sum(axis=0) + np.log(BEND_WEIGHTS)
            if np.exp(logsumexp(evidence[BREAKS]) - logsumexp(evidence)) > BROKEN:
                broken.append(temperature)
    return np.array(broken)


def _singled_out(observed: Observations) -> list[list[str]]:
    """For each test, sentences on limits of the standard that it exceeds and most others of its sweep do not."""
    block = within_isotherm.blocks(observed)
    sentences: list[list[str]] = [[] for _ in range(observed.size)]
    above = quality.exceeded(observed)
    for one in above:
        alike = sum(other.column == one.column and block[other.row] == block[one.row] for other in above)
        # What half of a sweep exceeds is its gauges or the control, and accuses no single test.
        if 2 * alike < np.count_nonzero(block == block[one.row]):
            sentences[one.row].append(one.sentence)
    return sentences


def _replicate_distance(observed: Observations, kept: NDArray[np.bool_]) -> tuple[NDArray, NDArray]:
    """How far ln|E*| and phase (n, 2) are from at least two kept replicates, and the chance of that.

    Level and mean phase of each specimen's isotherm are taken off. The scatter is that of the isotherm without the
    test itself (externally studentised), or the usual one of the table where that is larger.
    """
    apart, chance = np.zeros((observed.size, 2)), np.ones((observed.size, 2))
    block, logarithm = within_isotherm.blocks(observed), observed.logarithm
    values = np.column_stack([logarithm.real, logarithm.imag])
    known = (np.bincount(observed.cell[kept], minlength=observed.cell.max() + 1)[observed.cell] >= 3) & kept
    own, opened = np.zeros((observed.size, 2)), np.ones((observed.size, 1))
    freedoms, common = [], []
    judged = np.zeros(observed.size, bool)
    for temperature in observed.isotherms:
        rows = np.flatnonzero(known & (observed.isotherm == temperature))
        if not rows.size:
            continue
        labels = [np.unique(label[rows], return_inverse=True)[1] for label in (block, observed.cell)]
        design = np.hstack([np.eye(label.max() + 1)[label] for label in labels])
        left, size, _ = np.linalg.svd(design, full_matrices=False)
        # By rank: a specimen at one condition gives columns that say the same.
        left = left[:, size > 1e-9 * size[0]]
        freedom = rows.size - left.shape[1]
        if freedom < LEAST_FREEDOM:
            continue
        # A test of leverage one has a row or column of its own: nothing judges it.
        room = np.maximum(1.0 - (left**2).sum(axis=1), 1e-6)[:, None]
        residual = values[rows] - left @ (left.T @ values[rows])
        squares = (residual**2).sum(axis=0)
        own[rows] = np.sqrt(np.maximum(squares - residual**2 / room, 0.0) / (freedom - 1.0) / room)
        apart[rows], opened[rows], judged[rows] = residual / room, np.sqrt(room), True
        freedoms.append(freedom)
        common.append(np.sqrt(squares / freedom))
    if freedoms:
        usual = np.median(common, axis=0)
        z = apart[judged] / np.maximum(np.maximum(own[judged], usual / opened[judged]), 1e-9)
        chance[judged] = 2.0 * stdtr(sum(freedoms), -np.abs(z))
    return apart, chance


def _decimal_slip(observed: Observations, row: int, expected: float) -> str:
    return (
        f"|E*| {abs(observed.modulus[row]) / 1e6:.0f} MPa, expected about {expected / 1e6:.0f} MPa from its phase and "
        "the other frequencies; look for a misplaced decimal point"
    )


def _causal_reason(observed: Observations, loo: LooPrediction, row: int, column: int) -> str:
    """The value that the other frequencies ask for: of |E*| (`column` 0) or of the phase (1)."""
    expected, error = loo.expected[row, column], loo.std_error[row, column]
    if column == 0:
        modulus = abs(observed.modulus[row])
        times = modulus / np.exp(expected)
        slip = abs(np.log(times)) > SLIP and abs(np.log10(times) - np.round(np.log10(times))) < NEAR_POWER
        return (
            f"|E*| {modulus / 1e6:.0f} MPa, expected {np.exp(expected) / 1e6:.0f} MPa from its phase and the other "
            f"frequencies (standard error {100.0 * error:.1f} %)"
            f"{'; look for a misplaced decimal point' * bool(slip)}"
        )
    phase, required = np.degrees(observed.logarithm.imag[row]), np.degrees(expected)
    causal = required - np.degrees(loo.delay * observed.omega[row])
    if not PHASES[0] <= causal <= PHASES[1]:  # nothing to expect where the others make no curve
        return f"phase {phase:.1f} deg does not fit its |E*| and the other frequencies"
    delay = "; both phases as recorded, with the delay" if loo.delay else ""
    return (
        f"phase {phase:.1f} deg, expected {required:.1f} deg from its |E*| and the other frequencies "
        f"(standard error {np.degrees(error):.1f} deg{delay})"
    )


def _exchange_reason(observed: Observations, one: Exchange) -> str:
    names = [("|E*|", "phase")[column] for column in one.columns]
    places = []
    for row in sorted(one.rows, key=lambda row: -observed.frequency[row]):
        phase = np.degrees(observed.logarithm.imag[row])
        said = f"{abs(observed.modulus[row]) / 1e6:.0f} MPa", f"{phase:.1f} deg"
        values = ", ".join(said[column] for column in one.columns)
        places.append(f"{values} at {observed.frequency[row]:g} Hz")
    return (
        f"{' and '.join(names)} {' and '.join(places)}: each would fit in the place of the other; look in the record "
        f"whether the two {'tests' if len(names) > 1 else 'readings'} were exchanged"
    )


def _replicate_reason(observed: Observations, apart: NDArray, row: int, column: int) -> str:
    """By how much |E*| (`column` 0) or the phase (1) is off its replicates."""
    others = np.count_nonzero(observed.cell == observed.cell[row]) - 1
    size = (
        f"{100.0 * abs(np.expm1(apart[row, 0])):.1f} %"
        if column == 0
        else f"{np.degrees(abs(apart[row, 1])):.1f} deg"
    )
    what = "|E*|" if column == 0 else "phase"
    replicates = counted(int(others), "replicate")
    return f"{what} differs from {replicates} by {size}, beyond what the specimens differ by on this isotherm"
