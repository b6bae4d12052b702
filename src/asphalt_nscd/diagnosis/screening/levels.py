"""Isotherms of one specimen that are odd in |E*| or phase, and specimens that are odd in phase as a whole.

A wrong diameter, gain or unit of one test series leaves modulus and phase in agreement with each other, so that
causality says nothing of it; nor of a phase that is off by as much at every frequency. The specimen's other isotherms
and the other specimens do.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.scatter import median_by
from asphalt_nscd.diagnosis.written import interval_text
from asphalt_nscd.files.words import specimen_named

Vector = NDArray[np.float64]
Place = tuple[int, float]  # number of the specimen, isotherm [degC]

LEAST = 3  # specimens of an isotherm, and isotherms of a specimen: of two, neither is the odd one
FAR, DEVIATIONS = 0.2, 5.0  # of ln|E*|, and times the usual deviation, above which a level is odd
NEAR = 0.08  # of ln|E*|: enough where the other levels leave no doubt
FAR_PHASE = 2.0  # deg above which the phase of one isotherm of a specimen is odd
FAR_SPECIMEN = 1.0  # the same for a specimen off at all isotherms; none in 549 drawn tables without one
MOST = 3  # odd phases looked for at once; of |E*| one, since specimens that wobble by themselves would pass for two
EXCHANGED = 0.25  # of ln|E*|, within which two departures are equal and opposite
ALIKE = 2.0  # factor between the temperatures by |E*| and by phase, within which one error of both is told
LEAST_FREEDOM = 2  # degrees of freedom of the levels that judge one
ALPHA_PER_TABLE = 0.003  # share of the tables without an odd level in which the levels name one by chance
NORMAL = 1.4826  # standard deviation over the median absolute deviation
LEAST_PHASE = 0.1  # deg: the logarithm of a phase needs one above zero
OF_BOTH = ", which explains both: check that first"
OF_SPECIMEN = "its gauges, channels and mounting"
ONE_MIX = 25.0  # percent by which specimens of one mix hardly differ; T 378 expects some 13


def odd(observed: Observations) -> list[dict[str, Any]]:
    """Isotherms whose |E*| is off the level of their specimen: specimen, temperature_C and factor of each."""
    level = _levels(observed, observed.logarithm.real)
    found = _far_levels(level) | _told_apart(level, NEAR, 1)
    return [
        {"specimen": observed.names[k], "temperature_C": t, "factor": float(np.exp(value))}
        for (k, t), value in sorted(found.items())
    ]


def odd_phases(observed: Observations) -> list[dict[str, Any]]:
    """Isotherms and specimens whose phase is off: specimen, temperature_C (None: a whole specimen), phase_deg.

    A departure in proportion to the phase, as of another mix, belongs to a specimen: it is no odd isotherm.
    """
    phase = np.degrees(observed.logarithm.imag)
    level = _levels(observed, phase)
    in_proportion = _told_apart(_levels(observed, np.log(np.maximum(phase, LEAST_PHASE))), 0.0)
    whole = dict(_departures(level))
    found = [
        (*place, value)
        for place, value in sorted(_told_apart(level, FAR_PHASE).items())
        if place in in_proportion and place[0] not in whole
    ]
    return [
        {"specimen": observed.names[k], "temperature_C": t, "phase_deg": value}
        for k, t, value in [*((k, None, value) for k, value in whole.items()), *found]
    ]


def odd_temperatures(
    observed: Observations, levels: list[dict[str, Any]], phases: list[dict[str, Any]]
) -> list[dict[str, Any]]:
    """Where an odd |E*| and an odd phase are those of one wrong temperature: specimen, temperature_C and kelvin.

    kelvin is by how much the specimen seems warmer than stated; both changes ask for a temperature of one sign, within
    ALIKE of each other. The arguments are those of `odd` and `odd_phases`.
    """
    found = []
    for level in levels:
        for phase in phases:
            if (level["specimen"], level["temperature_C"]) != (phase["specimen"], phase["temperature_C"]):
                continue
            by_modulus, by_phase = (
                change / slope
                for change, slope in zip(
                    (np.log(level["factor"]), phase["phase_deg"]),
                    _isotherm_slopes(observed, level["temperature_C"]),
                    strict=True,
                )
            )
            if 1.0 / ALIKE < by_modulus / by_phase < ALIKE:
                kelvin = 0.5 * (by_modulus + by_phase)
                found.append(
                    {"specimen": level["specimen"], "temperature_C": level["temperature_C"], "kelvin": kelvin}
                )
    return found


def merge_confined(
    phases: list[dict[str, Any]], temperatures: list[dict[str, Any]], confined: Sequence[Mapping[str, Any]]
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Odd phases and temperatures, those told beside the last fit in place of others of the same place."""
    channels, sweeps = ([dict(one) for one in confined if key in one] for key in ("phase_deg", "kelvin"))
    whole = {one["specimen"] for one in channels}
    told = {(one["specimen"], one["temperature_C"]) for one in sweeps}
    return (
        [*channels, *(one for one in phases if one["specimen"] not in whole)],
        [*sweeps, *(one for one in temperatures if (one["specimen"], one["temperature_C"]) not in told)],
    )


def _isotherm_slopes(observed: Observations, temperature: float) -> tuple[float, float]:
    """Change of ln|E*| and of the phase [deg] per kelvin at an isotherm, between those beside it."""
    at = int(np.searchsorted(observed.isotherms, temperature))
    ends = observed.isotherms[[max(at - 1, 0), min(at + 1, observed.isotherms.size - 1)]]
    cold, warm = (observed.isotherm == t for t in ends)
    shared = np.intersect1d(observed.frequency[cold], observed.frequency[warm])
    means = [
        [
            values[here & np.isin(observed.frequency, shared)].mean()
            for values in (observed.logarithm.real, np.degrees(observed.logarithm.imag))
        ]
        for here in (cold, warm)
    ]
    slopes = (np.array(means[1]) - means[0]) / (ends[1] - ends[0])
    return float(slopes[0]), float(slopes[1])


def _levels(observed: Observations, values: Vector) -> dict[Place, float]:
    """Median over the frequencies of how far a specimen's isotherm lies from the middle of its conditions."""
    apart = values - median_by(values, observed.cell)
    level: dict[Place, float] = {}
    for t in observed.isotherms:
        at = observed.isotherm == t
        specimens = np.unique(observed.specimen[at])
        if specimens.size >= LEAST:
            # The median bears one bad test of the sweep.
            level |= {
                (int(k), float(t)): float(np.median(apart[at & (observed.specimen == k)])) for k in specimens
            }
    return level


def _far_levels(level: Mapping[Place, float]) -> dict[Place, float]:
    """Levels FAR from the median of their specimen's, and DEVIATIONS times as far as is usual."""
    own = {k: [value for (other, _), value in level.items() if other == k] for k, _ in level}
    left = {
        place: value - float(np.median(own[place[0]]))
        for place, value in level.items()
        if len(own[place[0]]) >= LEAST
    }
    # By the median, which the odd levels themselves do not enlarge.
    usual = NORMAL * float(np.median(np.abs(list(left.values())))) if left else 0.0
    return {place: value for place, value in left.items() if abs(value) > max(FAR, DEVIATIONS * usual)}


def _told_apart(level: Mapping[Place, float], least: float, most: int = MOST) -> dict[Place, float]:
    """Levels further than this from what all others predict, sure by DEVIATIONS and beyond chance.

    The most striking are left out one after another, since one may hide another (generalized ESD test of Rosner 1983);
    then each is held against those that stay.
    """
    rest, out, sure = dict(level), list[Place](), 0
    while len(out) < most and (judged := list(_predicted(rest))):
        _, place, _, passes = max((abs(errors), place, value, ok) for place, value, errors, ok in judged)
        del rest[place]
        out.append(place)
        # Rosner's rule: the last that passes makes all before it odd too, since one may mask another.
        sure = len(out) if passes else sure
    rest |= {place: level[place] for place in out[sure:]}
    return {
        place: value
        for one in out[:sure]
        for place, value, _, passes in _predicted(rest | {one: level[one]}, [one])
        if passes and abs(value) > least
    }


def _predicted(
    level: Mapping[Place, float], wanted: Collection[Place] | None = None
) -> Iterator[tuple[Place, float, float, bool]]:
    """Departure of levels from what the others predict: place, departure, in standard errors, whether that is sure.

    The others are fitted by a value of each specimen and one of each isotherm.
    """
    places, values = list(level), np.array(list(level.values()))
    labels = [np.array([place[part] for place in places]) for part in (0, 1)]
    design = np.hstack([label[:, None] == np.unique(label) for label in labels]).astype(float)
    for row, place in enumerate(places):
        few = min(int((label == label[row]).sum()) for label in labels) < LEAST
        if few or (wanted is not None and place not in wanted):
            continue
        others = np.arange(values.size) != row
        freedom = int(others.sum() - np.linalg.matrix_rank(design[others]))
        if freedom < LEAST_FREEDOM:
            continue
        # Specimen and isotherm columns share the constant, so that the design lacks a rank.
        back = np.linalg.pinv(design[others])
        residual = values[others] - design[others] @ (back @ values[others])
        departure = float(values[row] - design[row] @ (back @ values[others]))
        # The error of a prediction: that of one more level, and of the fit it is predicted by.
        spread = np.sqrt(residual @ residual / freedom * (1.0 + np.sum((design[row] @ back) ** 2)))
        errors = departure / max(float(spread), 1e-12)
        # Two-sided, and shared by all levels of the table (Bonferroni).
        by_chance = float(stdtrit(freedom, 1.0 - 0.5 * ALPHA_PER_TABLE / values.size))
        yield place, departure, errors, abs(errors) > max(DEVIATIONS, by_chance)


def _departures(level: Mapping[Place, float]) -> Iterator[tuple[int, float]]:
    """Specimens on one side of the mean of all others, DEVIATIONS times as far as these lie apart; and how far."""
    for k in sorted({k for k, _ in level}):
        apart, spread, freedom = [], 0.0, 0
        for t in [t for other, t in level if other == k]:
            others = np.array([value for (other, at), value in level.items() if at == t and other != k])
            if others.size >= LEAST - 1:
                apart.append(level[k, t] - float(others.mean()))
                spread += float(np.sum((others - others.mean()) ** 2))
                freedom += others.size - 1
        # On one side everywhere: a specimen that changes sides has mountings that scatter.
        if apart and abs(np.sign(apart).sum()) == len(apart):
            middle = float(np.median(apart))  # the mean could be the doing of one isotherm
            if abs(middle) > max(FAR_SPECIMEN, DEVIATIONS * float(np.sqrt(spread / freedom))):
                yield k, middle


def rows(observed: Observations, found: Iterable[Mapping[str, Any]]) -> NDArray[np.bool_]:
    """Rows (n,) of the isotherms and specimens that `odd` or `odd_phases` found."""
    out = np.zeros(observed.size, bool)
    for one in found:
        here = observed.specimen == observed.names.index(one["specimen"])
        out |= here if one["temperature_C"] is None else here & (observed.isotherm == one["temperature_C"])
    return out


def sentences(levels: list[dict[str, Any]], phases: list[dict[str, Any]]) -> list[str]:
    """What is odd and what to check, a sentence each without its full stop, isotherms in |E*| first."""
    return [f"{what}: check {check}" for what, check in map(described, [*levels, *phases])]


def temperature_notes(found: Iterable[Mapping[str, Any]]) -> list[str]:
    """What `odd_temperatures` found and what to check first, a sentence each without its full stop."""
    return [
        f"at {one['temperature_C']:g} degC {specimen_named(one['specimen'])} seems {_size(one, 'kelvin', '.2g')} K "
        f"{'warmer' if one['kelvin'] > 0.0 else 'colder'} than stated"
        + (": check its conditioning and the record" if "interval_95" in one else OF_BOTH)
        for one in found
    ]


def swap_notes(levels: Sequence[Mapping[str, Any]], temperatures: Sequence[Mapping[str, Any]]) -> list[str]:
    """Sweeps that look as if each stood in the other's place, a sentence each without its full stop."""
    found = []
    for one, other in combinations(temperatures, 2):
        apart = other["temperature_C"] - one["temperature_C"]
        seem = (one["kelvin"] / apart, -other["kelvin"] / apart) if apart else (0.0, 0.0)
        if one["specimen"] == other["specimen"] and all(1.0 / ALIKE < share < ALIKE for share in seem):
            found.append(
                f"{specimen_named(one['specimen'])}: the sweeps at {one['temperature_C']:g} and "
                f"{other['temperature_C']:g} degC look exchanged: check the record"
            )
    for one, other in combinations(levels, 2):
        inverse = abs(np.log(one["factor"] * other["factor"])) < EXCHANGED * abs(np.log(one["factor"]))
        if one["temperature_C"] == other["temperature_C"] and inverse:
            low, high = sorted((one, other), key=lambda of: of["factor"])
            found.append(
                f"at {one['temperature_C']:g} degC {specimen_named(low['specimen'])} is as far below its level of |E*| "
                f"as {specimen_named(high['specimen'])} is above: check whether their files were exchanged"
            )
    return found


def described(one: Mapping[str, Any]) -> tuple[str, str]:
    """What is odd, and what to check, of one of `odd` or `odd_phases`; an interval is told where a fit gives it."""
    others = "what its other temperatures and the other specimens say"
    if "factor" in one:
        return (
            f"{place(one)}: |E*| {one['factor']:.2f} times {others}",
            "gauges, gain, unit and entered dimensions of these tests",
        )
    if "delay_s" in one:
        late = "after" if one["delay_s"] > 0.0 else "before"
        return (
            f"{place(one)}: displacement recorded {_size(one, 'delay_s', '.2g', 1e3)} ms {late} the force, "
            f"{abs(one['phase_deg']):.1f} deg at the highest frequency",
            "filters and settings of its channels",
        )
    side = "above" if one["phase_deg"] > 0.0 else "below"
    size = f"{place(one)}: phase {_size(one, 'phase_deg', '.1f')} deg {side}"
    if "interval_95" in one:
        return f"{size} what its |E*| and the other specimens say, in all its tests", OF_SPECIMEN
    if one["temperature_C"] is None:
        return f"{size} the mean of the other specimens", OF_SPECIMEN
    return f"{size} {others}", "gauges, channels and temperature of these tests"


def _size(one: Mapping[str, Any], key: str, digits: str, factor: float = 1.0) -> str:
    """Absolute value times a factor, with its interval where there is one."""
    value = factor * abs(one[key])
    if "interval_95" not in one:
        return f"{value:{digits}}"
    low, high = one["interval_95"]
    return interval_text(value, 0.5 * factor * (high - low))


def if_sound(one: Mapping[str, Any]) -> str:
    """What new tests show if not the specimen but its tests were odd: a clause on |E*| or on the phase."""
    if "factor" in one:
        return f"|E*| is about {1.0 / one['factor']:.2f} times the old one"
    return f"phase is about {abs(one['phase_deg']):.1f} deg {'lower' if one['phase_deg'] > 0.0 else 'higher'}"


def place(one: Mapping[str, Any]) -> str:
    """An odd isotherm or specimen (temperature_C None) in words, for example specimen 2 at 30 degC."""
    at = "" if one["temperature_C"] is None else f" at {one['temperature_C']:g} degC"
    return specimen_named(one["specimen"]) + at


def places(levels: list[dict[str, Any]], phases: list[dict[str, Any]]) -> list[str]:
    """Each odd isotherm or specimen of `odd` and `odd_phases` once, in words."""
    return list(dict.fromkeys(map(place, [*levels, *phases])))
