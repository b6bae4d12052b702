"""Effects hidden inside NSCD runs: the rig, or the law of the bonds, is wrong while the steps are computed.

The mix is one of ours, turned into Kelvin chains for the bonds; the records are reduced by our own
least squares, and scatter is added as for the other cases.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.bending.bending_test import bond_law, run_test
from asphalt_nscd.bending.case import LoadCase
from asphalt_nscd.bending.model import Model, read_model
from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.bending.settings import Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.conversion import kelvin_chain

from .causes import CATALOGUE
from .design import factorial
from .laws import draw_law
from .plan import INSIDE, Case
from .records import measure
from .sealed import REFUSED, at_limit, open_case
from .strength import Scatter

NOTHING = "nothing"
RATIO = 4.0  # times the detection limit
AMPLITUDE = 1e-5  # m: no bond breaks
CYCLES, TIME_STEP, REST = 4.0, 5e-5, 1000
BAND = (0.3, 400.0)  # Hz, that the chains follow
TO_RIG = {
    "channel_delay": ("channel_delay", 1.0),
    "phase_offset": ("phase_offset", np.pi / 180.0),
    "moving_mass": ("head_mass", 1.0),
    "guide_friction": ("guide_friction", 1.0),
    "loose_clamp": ("clamp_compliance", 1.0),
}


def run(effect: str, models: Sequence[Path], empty: Mapping[str, Any] | None, seed: int) -> dict[str, Any]:
    """One line as of `sealed.run`; empty: the line of `nothing`, whose limits scale the effect."""
    specimens = {path.stem: read_model(path) for path in models}
    geometry = _geometry(next(iter(specimens.values())))
    design = factorial(list(specimens), amplitudes=(AMPLITUDE,))
    number = (NOTHING, *INSIDE).index(effect)
    effects = []
    if effect != NOTHING:
        random = np.random.default_rng([seed, number])
        effects.append(_placed(effect, empty["diagnosis"]["detection_limits"], design, geometry, random))
    # The packings themselves make the samples differ.
    law, scatter = draw_law(np.random.default_rng(seed), "havriliak_negami"), Scatter(specimen=0.0)
    histories = [
        _history(specimens[row.specimen], row, law, effects) for row in design.itertuples(index=False)
    ]
    tests = design.drop(columns="amplitude_m")
    table = measure(tests, histories, geometry, seed + number, scatter)
    seal = {
        "seed": seed,
        "law": asdict(law),
        "scatter": asdict(scatter),
        "form": "nscd",
        "tests": len(tests),
        "effects": effects,
        "packing_ratio": _packing_ratios(specimens),
    }
    case = Case(seed, "nscd", tuple(e["cause"] for e in effects), RATIO, form="nscd", shape=law.shape)
    try:
        found = open_case(table, geometry)
    except InputError as error:  # an isotherm so far off that it is stiffer than a colder one
        if not effects:
            raise
        found = REFUSED | {"notes": [str(error)]}
    return {"case": asdict(case), "seal": seal, "diagnosis": found}


def _packing_ratios(models: Mapping[str, Model]) -> dict[str, float]:
    """Static stiffness of each sample under one law, over that of the median sample: small packings differ."""
    stiffness = {
        name: float((model.system.weight * (model.system.operator @ model.basis[:, 0]) ** 2).sum())
        for name, model in models.items()
    }
    middle = float(np.median(list(stiffness.values())))
    return {name: value / middle for name, value in stiffness.items()}


def _placed(
    cause: str, limits, design: pd.DataFrame, geometry, random: np.random.Generator
) -> dict[str, Any]:
    hidden = at_limit(cause, RATIO, limits, design, geometry, random)
    effect = CATALOGUE[cause]
    return {
        "cause": cause, "kind": "catalogue", "amplitude": hidden.amplitude, "unit": effect.unit,
        "equivalents": {effect.unit: hidden.amplitude, **effect.others(hidden.amplitude, design, geometry)},
        "where": hidden.where, "details": {}, "strength": np.nan, "visible_strength": np.nan, "ratio": RATIO,
    }  # fmt: skip


def _history(model: Model, row: Any, law, effects: Sequence[Mapping[str, Any]]):
    temperature, rig = row.temperature_C, {}
    for effect in effects:
        if effect["where"] not in (None, row.specimen, row.temperature_C):
            continue
        if effect["cause"] == "temperature_bias":
            temperature += effect["amplitude"]
        else:
            name, unit = TO_RIG[effect["cause"]]
            rig[name] = unit * effect["amplitude"]
    low, high = 2.0 * np.pi * np.array(BAND)
    chain, _ = kelvin_chain(lambda omega: law.modulus(omega, temperature), low, high)
    case = LoadCase(row.frequency_Hz, AMPLITUDE, CYCLES, Rig(**rig))
    record = run_test(model, bond_law(chain), case, Numerics(TIME_STEP, REST))
    return record.time, record.force, record.displacement


def _geometry(model: Model) -> dict[str, float]:
    g = model.geometry
    lengths = {f"{name}_mm": 1e3 * getattr(g, name) for name in ("b", "B", "e", "h")}
    return lengths | {"mass_kg": g.mass, "mobile_mass_kg": g.mobile_mass}
