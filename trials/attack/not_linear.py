"""Mixes that are not linear where they are soft, and true offsets of the phase, which look much alike.

At its softest test such a mix loses a tenth of |E*| and gains 2.5 degrees; towards stiff tests that fades in one of
FORMS. Campaigns are those of `laboratory`, with errors of every day, of four isotherms or more, gauges sound.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from .faults import Fault, put
from .judge import names
from .laboratory import Campaign, sound_campaigns, written
from .mixes import Complex, Vector
from .plan import LEAST_PHASE
from .rates import line
from .trial import diagnosed

SEED = 20281107  # set before the diagnosis knew of such mixes
TABLES = 40
LOST, GAINED = 0.10, 2.5  # of |E*|; deg, at the softest test
OFFSET = 2.0  # deg
ROUNDING = 0.005  # deg
CAREFUL = 1.0 / 3.0  # of the everyday errors, that a careful laboratory has
LEAST_ISOTHERMS = 4
Random = np.random.Generator
Fading = tuple[Vector, Vector]  # weights of what |E*| loses and the phase gains
OF_THE_MIX = ("film_softening", "drifting_reading")  # names that blame the mix, or how its drift is read


def _softness(log_modulus: Complex) -> Vector:
    """From zero at the stiffest to one at the softest test."""
    soft = log_modulus.real.max() - log_modulus.real
    return np.asarray(soft / soft.max())


def _by_softness(log_modulus: Complex, tests: pd.DataFrame, rng: Random) -> Fading:
    weight = _softness(log_modulus) ** rng.uniform(0.5, 3.0)
    return weight, weight


def _beyond(log_modulus: Complex, tests: pd.DataFrame, rng: Random) -> Fading:
    """Linear as long as it is stiffer than some bound."""
    bound = rng.uniform(0.3, 0.6)
    weight = np.maximum(_softness(log_modulus) - bound, 0.0) / (1.0 - bound)
    return weight, weight


def _by_temperature(log_modulus: Complex, tests: pd.DataFrame, rng: Random) -> Fading:
    t = tests["temperature_C"].to_numpy(float)
    weight = np.exp((t - t.max()) / rng.uniform(8.0, 20.0))
    return weight, weight


def _clock(log_modulus: Complex, tests: pd.DataFrame, rng: Random) -> Fading:
    """Films flow faster under load: |E*| falls with the slope n of ln|E*| over ln f, the phase rises with n^2."""
    n = log_modulus.imag / log_modulus.imag.max()
    return n, n**2


def _steep(log_modulus: Complex, tests: pd.DataFrame, rng: Random) -> Fading:
    """More at low frequencies, where strains last."""
    f = tests["frequency_Hz"].to_numpy(float)
    weight = _softness(log_modulus) ** 1.5 * (f / f.min()) ** -rng.uniform(0.0, 0.15)
    return weight, weight


def _stress(log_modulus: Complex, tests: pd.DataFrame, rng: Random) -> Fading:
    """|E*| and phase fade at rates of their own."""
    soft = _softness(log_modulus)
    return soft ** rng.uniform(0.8, 1.5), soft ** rng.uniform(2.0, 4.0)


FORMS: dict[str, Callable[[Complex, pd.DataFrame, Random], Fading]] = {
    "with softness": _by_softness,
    "beyond a bound": _beyond,
    "with temperature": _by_temperature,
    "faster clock": _clock,
    "at low frequencies": _steep,
    "at two rates": _stress,
}


def campaigns(first: int, seed: int = SEED, tables: int = TABLES) -> Iterator[Campaign]:
    """Sound campaigns of four isotherms or more, from number `first` on; by a careful laboratory, then a usual one."""
    several = (one for one in sound_campaigns(seed, first) if len(one.isotherms) >= LEAST_ISOTHERMS)
    for k, campaign in enumerate(islice(several, tables)):
        yield campaign if k % 2 else careful(campaign)


def careful(campaign: Campaign) -> Campaign:
    """With a third of the everyday errors."""

    def response(warming: Vector, tuning: Vector) -> Complex:
        return campaign.response(warming - (1.0 - CAREFUL) * campaign.warmer, tuning)

    return replace(campaign, response=response, own=CAREFUL * campaign.own, warmer=CAREFUL * campaign.warmer)


def not_linear(campaign: Campaign, form: str, rng: Random) -> pd.DataFrame:
    """The table of a mix that is not linear."""
    linear = campaign.unmoved()
    lost, gained = FORMS[form](linear, campaign.tests, rng)
    moved = np.log1p(-LOST * lost / lost.max()) + 1j * np.radians(GAINED) * gained / gained.max()
    return written(campaign, linear + moved)


def offset(campaign: Campaign, rng: Random) -> tuple[pd.DataFrame, float]:
    """A table whose phases are all off, and by how much [deg]."""
    size = OFFSET * float(rng.choice((-1.0, 1.0)))
    table = put(campaign, (Fault("phase_offset", size),))
    if table["phase_deg"].min() < LEAST_PHASE:
        size = -size
        table = put(campaign, (Fault("phase_offset", size),))
    return table, size


def tables(seed: int = SEED, number: int = TABLES) -> Iterator[tuple[Campaign, pd.DataFrame, str, float]]:
    """Campaign, table, form (empty of an offset) and offset [deg] of each: mixes first, then offsets."""
    for k, campaign in enumerate(campaigns(0, seed, number)):
        form = list(FORMS)[(k // 2) % len(FORMS)]  # each by a careful laboratory, then by a usual one
        yield campaign, not_linear(campaign, form, np.random.default_rng([seed, k, 3])), form, 0.0
    for k, campaign in enumerate(campaigns(1000, seed, number)):
        table, size = offset(campaign, np.random.default_rng([seed, k, 4]))
        yield campaign, table, "", size


def tried(campaign: Campaign, table: pd.DataFrame, form: str, size: float) -> dict[str, Any]:
    """What was put in, and what was said: a name with "!" is established; `turned_deg`: most by corrected.csv."""
    found = diagnosed(table, campaign.bench)
    with tempfile.TemporaryDirectory() as folder:
        found.write(folder)
        corrected = pd.read_csv(Path(folder, "corrected.csv"))
    entries = names(found.content)
    told = [name for entry in entries for name in (entry["cause"], *entry["as_good"])]
    return {
        "table": campaign.name, "bench": campaign.bench, "form": form, "offset_deg": size,
        "names": " ".join(entry["cause"] + "!" * bool(entry["established"]) for entry in entries),
        "alike": " ".join(name for entry in entries for name in entry["as_good"]),
        "fault_established": any(e["established"] for e in entries if e["cause"] not in OF_THE_MIX),
        "turned_deg": float((corrected["phase_deg"] - corrected["recorded_phase_deg"]).abs().max()),
        "offset_told": "phase_offset" in told,
    }  # fmt: skip


def cases(part: int = 0, parts: int = 1) -> pd.DataFrame:
    """Those of the tables of a part."""
    return pd.DataFrame([tried(*each) for each in islice(tables(), part, None, parts)])


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Rates of mixes that are not linear and of true offsets."""
    mixes = rows["form"].fillna("") != ""
    blamed, turned = (rows.loc[mixes, name] for name in ("fault_established", "turned_deg"))
    return pd.DataFrame(
        [
            line("mixes that are not linear: a fault of the machine established", "none", blamed, high=0.0),
            line("the same: phases turned in corrected.csv", "none", turned > ROUNDING, high=0.0),
            line("offsets of 2 deg: told, alone or as one of a class", ">= 90 %",
                 rows.loc[~mixes, "offset_told"], low=0.9),
        ]
    )  # fmt: skip
