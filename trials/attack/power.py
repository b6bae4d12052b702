"""Sizes, in units that a laboratory knows, at which each cause is named in half and in nineteen of twenty tables.

Three usual campaigns of three specimens, by usual laboratories and by careful ones with a third of the everyday errors.
Each table without a fault states the limit of each cause, which is named there in 19 of 20 cases; from it follows the
chance that a given size is named in this table. `tried` asks whether it is: an isotherm or a clamp of a laboratory that
has scatter alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

import numpy as np
import pandas as pd
from drawn.design import factorial
from scipy.optimize import brentq
from scipy.special import ndtr

from .faults import UNITS, Fault, put
from .judge import names, right
from .laboratory import BENDING, CYLINDER, Campaign, everyday
from .mixes import LAWS, SHIFTS, Complex, Mix, Vector
from .not_linear import careful
from .rates import line
from .trial import diagnosed

SEED = 20310523  # set after the last change of the diagnosis, before any of its tables was drawn
MIXES = 8  # of each campaign and each kind of laboratory
CAMPAIGNS = {
    "AASHTO T 342": (CYLINDER, (-10.0, 4.0, 21.0, 37.0, 54.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)),
    "AASHTO T 378": (CYLINDER, (4.0, 20.0, 40.0), (0.1, 1.0, 10.0)),
    "EN 12697-26": (BENDING, (-10.0, 0.0, 10.0, 15.0, 20.0, 30.0), (3.0, 6.0, 10.0, 25.0, 30.0, 40.0)),
}
SPECIMENS = "S1", "S2", "S3"
CAUSES = (
    "phase_offset", "channel_delay", "temperature_bias", "specimen_geometry", "self_heating", "loose_clamp",
    "guide_friction", "moving_mass",
)  # fmt: skip
SHOWN = {"s": ("ms", 1e3), "1": ("%", 100.0), "1/Pa": ("1/TPa", 1e12), "Pa": ("MPa", 1e-6)}
THRESHOLD, Z_95 = 3.7, 1.645  # standard errors that a name takes, and that 19 of 20 cases stay above
HALF, MOST = 0.5, 0.95
LEAST_SHOWN = 0.75  # of the tables, in which a cause must have a limit

# Specimens, scatter of |E*| and of the phase [deg]; else nothing.
VERY_CAREFUL = 4, (0.004, 0.01), (0.06, 0.2)
TABLES = 40
ISOTHERM, CLAMP = 1.2, 3e-12  # K; 1/Pa


def campaigns() -> Iterator[tuple[str, str, Campaign]]:
    """Name, laboratory and campaign."""
    for row, (name, (bench, temperatures, frequencies)) in enumerate(CAMPAIGNS.items()):
        for number in range(MIXES):
            rng = np.random.default_rng([SEED, row, number])
            mix = Mix.draw(list(LAWS)[number % len(LAWS)], list(SHIFTS)[number % len(SHIFTS)], rng)
            tests = factorial(SPECIMENS, temperatures, frequencies)
            usual = everyday(name, bench, tests, mix, rng)
            yield name, "usual", usual
            yield name, "careful", careful(usual)


def limits(part: int = 0, parts: int = 1) -> pd.DataFrame:
    """The limit that each table of a part states of each cause, in its unit; the median of its places."""
    rows = []
    for name, laboratory, campaign in islice(campaigns(), part, None, parts):
        stated = diagnosed(put(campaign, ()), campaign.bench).content["detection_limits"]
        for cause in CAUSES:
            places = stated.get(cause, {}).get("places", {"": stated.get(cause, {}).get("value", np.inf)})
            value = float(np.median(list(places.values())))
            rows.append({"campaign": name, "laboratory": laboratory, "cause": cause, "limit": value})
    return pd.DataFrame(rows)


def sizes(stated: pd.DataFrame) -> pd.DataFrame:
    """Size at which each cause is named in half and in 19 of 20 tables, in the unit of `shown`."""
    rows = []
    keys = ["campaign", "laboratory", "cause"]
    for key, part in stated.groupby(keys, sort=False):
        limit, unit = part["limit"].to_numpy(), UNITS[key[-1]]
        if np.isfinite(limit).mean() < LEAST_SHOWN:
            continue
        unit, factor = SHOWN.get(unit, (unit, 1.0))
        named = {f"named_{share:.0%}": factor * _size_named(limit, share) for share in (HALF, MOST)}
        rows.append(dict(zip(keys, key)) | {"unit": unit, **named})
    return pd.DataFrame(rows)


def _size_named(limit: np.ndarray, share: float) -> float:
    """Size that is named in a share of the tables with these limits; infinite where fewer tables show the cause."""
    error = limit / (THRESHOLD + Z_95)

    def beyond(size: float) -> float:
        return float(ndtr(size / error - THRESHOLD).mean()) - share

    most = 3.0 * float(limit[np.isfinite(limit)].max())
    return float(brentq(beyond, 0.0, most)) if beyond(most) > 0.0 else np.inf


def very_careful(number: int) -> tuple[Campaign, np.random.Generator]:
    """A bending campaign with scatter and levels of specimens alone."""
    specimens, modulus, phase = VERY_CAREFUL
    bench, temperatures, frequencies = CAMPAIGNS["EN 12697-26"]
    rng = np.random.default_rng([SEED, 9, number])
    mix = Mix.draw(list(LAWS)[number % len(LAWS)], list(SHIFTS)[(number // 2) % len(SHIFTS)], rng)
    tests = factorial([f"S{k + 1}" for k in range(specimens)], temperatures, frequencies)
    n, t, f = len(tests), tests["temperature_C"].to_numpy(), tests["frequency_Hz"].to_numpy()
    scatter = rng.uniform(*modulus) * rng.standard_normal(n)
    scatter = scatter + 1j * np.radians(rng.uniform(*phase)) * rng.standard_normal(n)
    level = 0.03 * rng.standard_normal(specimens)
    own = scatter + np.repeat(level, n // specimens)
    none = np.zeros(n)

    def response(warming: Vector, tuning: Vector) -> Complex:
        return mix.log_modulus(f * tuning, t + warming)

    return Campaign(f"table {number + 1}", bench, tests, response, own, none), rng


def tried(number: int) -> list[dict[str, Any]]:
    """Rows of one very careful table: as it is, and with an isotherm, or in turn a clamp, at fault."""
    campaign, rng = very_careful(number)
    sign = float(rng.choice((-1.0, 1.0)))
    warm = Fault("temperature_bias", sign * ISOTHERM, temperature=float(rng.choice(campaign.isotherms[1:-1])))
    loose = Fault("loose_clamp", CLAMP, specimen=str(rng.choice(campaign.specimens)))
    rows = []
    for faults in ((), ((warm, loose)[number % 2],)):
        content = diagnosed(put(campaign, faults), campaign.bench).content
        told = names(content)
        rows.append(
            {
                "table": campaign.name, "fault": faults[0].kind if faults else "nothing",
                "names": " ".join(one["cause"] + "!" * bool(one["established"]) for one in told),
                "named": any(right(one, fault, content) for one in told for fault in faults),
            }
        )  # fmt: skip
    return rows


def cases(part: int = 0, parts: int = 1) -> pd.DataFrame:
    """Those of the very careful tables of a part."""
    return pd.DataFrame([row for number in range(part, TABLES, parts) for row in tried(number)])


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Rates of very careful laboratories."""
    empty, told = rows["fault"] == "nothing", rows["names"].fillna("") != ""
    return pd.DataFrame(
        [
            line("an isotherm 1.2 K off, or a clamp of 3 per TPa: named", ">= 95 %",
                 rows.loc[~empty, "named"], low=0.95),
            line("the same tables without a fault: a name", "none", told[empty], high=0.0),
        ]
    )  # fmt: skip
