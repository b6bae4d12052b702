"""Which faults are put into which campaign. A cause of the catalogue comes at multiples of the limit stated for it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .faults import CATALOGUE, UNITS, Fault, put
from .laboratory import AMPLITUDES_EVERY, ORDER_EVERY, Campaign

SEED = 20310417  # set after the last change of the diagnosis, before any of its tables was drawn
TABLES, EMPTY = 24, 0  # campaigns with faults put in and without, if nothing else is asked for
RATIOS = (1.0, 2.0, 3.0)
REAL_RATIOS = (2.0, 3.0)
AT_ONCE = 3.0  # times the limit, each of a pair
REAL_CAUSES = ("phase_offset", "channel_delay", "specimen_geometry", "temperature_bias")
OUTSIDE = (
    "offset of one specimen", "offset of one isotherm", "temperature of one specimen on one isotherm",
    "exchanged specimens", "aliasing", "zero drift", "delay of one specimen", "gain with temperature",
    "copied block", "wrong top frequency", "low-pass filter", "exchanged isotherms", "resonance",
)  # fmt: skip
OF_ONE_PLACE = (
    "offset of one specimen", "delay of one specimen", "offset of one isotherm",
    "temperature of one specimen on one isotherm",
)  # fmt: skip
SLIPS = ("single bad test", "slip of ten", "wrong recorded temperature")
MASKED = "masked pair of bad tests"
LARGEST = {
    "temperature_bias": 8.0, "specimen_geometry": 1.5, "self_heating": 12.0, "damage": 0.7, "strain_softening": 0.7,
}  # fmt: skip
# Of so many campaigns one can have the cause.
EVERY = {
    "strain_softening": AMPLITUDES_EVERY, "damage": ORDER_EVERY, "loose_clamp": 2.0, "guide_friction": 2.0,
    "moving_mass": 2.0,
}  # fmt: skip
LEAST_PHASE = 0.2  # deg
LARGEST_PHASE = 10.0  # deg, of an offset
ONE_SIGN = "self_heating loose_clamp guide_friction strain_softening damage secondary_process".split()

Limits = Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True)
class Case:
    """suite: nothing, catalogue, pair, outside, place, slip or inside (an NSCD run).

    ratio: size over its limit, NaN where none counts.
    """

    suite: str
    faults: tuple[Fault, ...] = ()
    ratio: float = np.nan


def cases(campaign: Campaign, number: int, limits: Limits, of_one_place: Limits) -> Iterator[Case]:
    """What follows the campaign without a fault, whose diagnosis states the limits, those of one place apart."""
    rng = np.random.default_rng([SEED, number, 1])
    real = "measured" in campaign.about
    pool = REAL_CAUSES if real else CATALOGUE
    shown = _balanced(campaign, pool, limits, np.random.default_rng([SEED, number, 3]))
    for cause in shown[: 2 if real else 1]:
        fault = _limit(campaign, str(cause), limits, rng)
        for ratio in REAL_RATIOS if real else RATIOS:
            if _scaled(fault, ratio) is not None:
                yield Case("catalogue", (_scaled(fault, ratio),), ratio)
    if not real and len(shown) > 1:
        both = [_limit(campaign, str(cause), limits, rng) for cause in rng.choice(shown, 2, replace=False)]
        pair = tuple(one for fault in both if (one := _scaled(fault, AT_ONCE)) is not None)
        if len(pair) == 2:
            yield Case("pair", pair, AT_ONCE)
    for turn in range(2):
        kind = OUTSIDE[(2 * number + turn) % len(OUTSIDE)]
        yield Case("outside", (_outside(campaign, kind, limits, rng),))
    kind = OF_ONE_PLACE[number % len(OF_ONE_PLACE)]
    fault = None if real else _of_one_place(campaign, kind, of_one_place, [SEED, number, 2])
    if fault is not None:
        yield Case("place", (fault,), AT_ONCE)
    yield Case("slip", (_slip(campaign, SLIPS[number % len(SLIPS)], rng),))
    if len(campaign.tests["frequency_Hz"].unique()) > 3:
        yield Case("slip", (_slip(campaign, MASKED, rng),))


def at_three_limits(campaign: Campaign, cause: str, limits: Limits, rng: np.random.Generator) -> Fault | None:
    """A cause at three limits; None where it has no limit or that is not physical."""
    if not _drawable(campaign, cause, limits):
        return None
    return _scaled(_limit(campaign, cause, limits, rng), AT_ONCE)


def _balanced(campaign: Campaign, pool: Sequence[str], limits: Limits, rng: np.random.Generator) -> list[str]:
    """Causes that can be drawn, by chance; those that few campaigns can have come first so much more often."""
    shown = [cause for cause in pool if _drawable(campaign, cause, limits)]
    if not shown:
        return []
    weight = np.array([EVERY.get(cause, 1.0) for cause in shown])
    return rng.choice(shown, len(shown), replace=False, p=weight / weight.sum()).tolist()


def _drawable(campaign: Campaign, cause: str, limits: Limits) -> bool:
    needed = {"strain_softening": "amplitude_m", "damage": "order"}.get(cause)
    known = cause in limits and limits[cause]["unit"] == UNITS[cause]
    return known and (needed is None or needed in campaign.tests)


def _limit(campaign: Campaign, cause: str, limits: Limits, rng: np.random.Generator) -> Fault:
    """A cause at its limit, at a place where three limits are physical if there is one."""
    limit, sign = limits[cause], 1.0 if cause in ONE_SIGN else float(rng.choice((-1.0, 1.0)))
    shape = ()
    if cause == "secondary_process":
        peak = -np.log(campaign.omega).mean()
        energy, middle = float(rng.uniform(40e3, 90e3)), float(np.median(campaign.isotherms))
        peak -= energy / 8.314 * (1.0 / (middle + 273.15) - 1.0 / 293.15)
        shape = (float(peak + rng.uniform(-1.0, 1.0)), energy, float(rng.uniform(0.4, 0.8)))
    if "places" not in limit:
        return _physical(campaign, Fault(cause, sign * limit["value"], shape=shape))
    most = LARGEST.get(cause, np.inf)
    within = [place for place, size in limit["places"].items() if AT_ONCE * size <= most]
    place = str(rng.choice(within)) if within else min(limit["places"], key=limit["places"].get)
    size = sign * limit["places"][place]
    if limit["confined_to"] == "specimen":
        return Fault(cause, size, specimen=place)
    return Fault(cause, size, temperature=min(campaign.isotherms, key=lambda t: abs(t - float(place))))


def _physical(campaign: Campaign, fault: Fault, ratio: float = AT_ONCE) -> Fault:
    """The fault, of the other sign if that would leave phases below zero, which no laboratory would hand over."""
    least = put(campaign, (replace(fault, size=ratio * fault.size),))["phase_deg"].min()
    return fault if least > LEAST_PHASE or fault.kind in ONE_SIGN else replace(fault, size=-fault.size)


def _scaled(fault: Fault, ratio: float) -> Fault | None:
    """The fault times ratio; None where that is not physical."""
    size = ratio * fault.size
    if abs(size) > LARGEST.get(fault.kind, np.inf) or (fault.kind == "specimen_geometry" and size < -0.6):
        return None
    return replace(fault, size=size)


def _outside(campaign: Campaign, kind: str, limits: Limits, rng: np.random.Generator) -> Fault:
    """A fault that the catalogue of the first version lacks. Channels: three limits of the same in all tests."""
    sign, u = float(rng.choice((-1.0, 1.0))), lambda low, high: float(rng.uniform(low, high))
    specimens, sound = campaign.specimens, _sound(campaign)
    name, t = str(rng.choice(specimens)), float(rng.choice(sound))
    frequencies = campaign.tests["frequency_Hz"].to_numpy()
    top = float(frequencies.max())
    if kind in ("offset of one specimen", "offset of one isotherm"):
        size = sign * float(np.clip(AT_ONCE * limits.get("phase_offset", {"value": 0.5})["value"], 1.0, 5.0))
        here = {"specimen": name} if "specimen" in kind else {"temperature": t}
        return _physical(campaign, Fault(kind, size, **here), 1.0)
    if kind == "delay of one specimen":
        degrees = 360.0 * top * AT_ONCE * limits.get("channel_delay", {"value": 1e-4})["value"]
        size = sign * float(np.clip(degrees, 3.0, 10.0)) / 360.0 / top
        return _physical(campaign, Fault(kind, size, specimen=name), 1.0)
    if kind == "temperature of one specimen on one isotherm":
        return Fault(kind, sign * u(1.0, 3.0), specimen=name, temperature=t)
    if kind == "exchanged isotherms":
        first = int(rng.integers(len(sound) - 1))
        return Fault(kind, specimen=name, temperature=sound[first], other=sound[first + 1])
    if kind in ("exchanged specimens", "copied block"):
        apart = campaign.unmoved().real
        level = {s: float(apart[campaign.at(s)].mean()) for s in specimens}
        ends = min(level, key=level.__getitem__), max(level, key=level.__getitem__)
        return Fault(kind, specimen=ends[0], temperature=t, other=ends[1])
    sizes = {
        "gain with temperature": sign * u(0.2, 0.5),
        "aliasing": u(20.0, 45.0),
        "wrong top frequency": u(0.55, 0.75) if sign < 0.0 else u(1.35, 1.8),
        "zero drift": sign * u(0.05, 0.15),
        "low-pass filter": top * u(6.0, 15.0),
        "resonance": top * u(1.15, 1.6),
    }
    confined = (top,) if kind in ("aliasing", "wrong top frequency") else ()
    return Fault(kind, sizes[kind], frequencies=confined)


def _of_one_place(campaign: Campaign, kind: str, limits: Limits, seed: list[int]) -> Fault | None:
    """A fault at three of its own limits, at a place where that is physical; None where there is none."""
    rng = np.random.default_rng(seed)
    places = limits.get(kind, {"places": []})["places"]
    most = LARGEST["temperature_bias"] if "temperature" in kind else np.inf
    most = LARGEST_PHASE if "offset" in kind else most
    at = [dict(one) for one in places if AT_ONCE * one["value"] <= most]
    for one in at:
        if (t := one["temperature_C"]) is not None:
            one["temperature_C"] = min(campaign.isotherms, key=lambda own: abs(own - t))
    at = [one for one in at if campaign.broken is None or one["temperature_C"] != campaign.broken]
    if not at:
        return None
    one = at[int(rng.integers(len(at)))]
    size = AT_ONCE * one["value"] * float(rng.choice((-1.0, 1.0)))
    fault = Fault(kind, size, specimen=one["specimen"], temperature=one["temperature_C"])
    return fault if "temperature" in kind else _physical(campaign, fault, 1.0)


def _slip(campaign: Campaign, kind: str, rng: np.random.Generator) -> Fault:
    sign, name = float(rng.choice((-1.0, 1.0))), str(rng.choice(campaign.specimens))
    t = float(rng.choice(_sound(campaign)))
    sweep = campaign.tests.loc[campaign.at(name, t), "frequency_Hz"].unique()
    if kind == "wrong recorded temperature":
        return Fault(kind, sign * float(rng.uniform(1.5, 1.9)), specimen=name, temperature=t)
    if kind == "slip of ten":
        return Fault(kind, sign, name, t, (float(rng.choice(sweep)),))
    if kind == "single bad test":
        return Fault(kind, sign * float(rng.uniform(0.2, 0.4)), name, t, (float(rng.choice(sweep)),))
    first = int(rng.integers(sweep.size - 1))
    two = tuple(float(f) for f in np.sort(sweep)[first : first + 2])
    return Fault(kind, 0.3, name, t, two)


def _sound(campaign: Campaign) -> list[float]:
    return [t for t in campaign.isotherms if t != campaign.broken]
