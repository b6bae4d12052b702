"""Faults inside NSCD runs: the rig is wrong, or the bonds are warmer than stated, while the steps are computed.

The bonds follow a mix of ours by a Kelvin chain for each temperature. Force and displacement are reduced by our own
least squares; everyday errors are added as to the other campaigns.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from drawn.design import factorial

from asphalt_nscd.bending.bending_test import bond_law, run_test
from asphalt_nscd.bending.case import LoadCase, Numerics
from asphalt_nscd.bending.model import Model, read_model
from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.rheology.conversion import kelvin_chain

from . import judge, plan
from .faults import FORM_FACTOR, Fault
from .laboratory import BENDING, DESIGNS, Campaign, everyday, written
from .mixes import SHIFTS, Complex, Mix, Vector
from .trial import answered

MIXES = 2
CAUSES = ("channel_delay", "phase_offset", "moving_mass", "guide_friction", "loose_clamp", "temperature_bias")
AMPLITUDE = 1e-5  # m: no bond breaks
CYCLES, STEPS, REST = 4.0, 100, 50  # steps in a cycle, and under gravity before the head moves
REDUCED = 2.0  # cycles, the last ones
BAND = (0.3, 400.0)  # Hz, that the chains follow
MOVING = 0.135 * 0.6 + 0.235  # kg, of the paper's specimen with the head, Eq. (1)
# What a size in its unit is in the rig: a slider is measured by its first harmonic at the amplitude.
TO_RIG = {
    "channel_delay": ("channel_delay", 1.0),
    "phase_offset": ("phase_offset", np.pi / 180.0),
    "moving_mass": ("head_mass", 1.0),
    "guide_friction": ("guide_friction", np.pi * AMPLITUDE / (4.0 * FORM_FACTOR)),
    "loose_clamp": ("clamp_compliance", FORM_FACTOR),
}


def tried(number: int, models: Sequence[Path]) -> Iterator[dict[str, Any]]:
    """Rows of `judge.judged`: mix `number` in the paper's specimens without a fault, then with each of CAUSES."""
    specimens = {path.stem: read_model(path) for path in models}
    rng = np.random.default_rng([plan.SEED, number, 3])
    mix = Mix.draw("Havriliak-Negami", list(SHIFTS)[number % len(SHIFTS)], rng)
    campaign = _campaign(f"inside {number + 1}", list(specimens), mix, rng)
    content, answer = answered(_table(campaign, specimens, mix), BENDING)
    yield from judge.judged(campaign, plan.Case("nothing"), content, answer)
    limits = content["detection_limits"]
    for cause in CAUSES:
        fault = plan.at_three_limits(campaign, cause, limits, rng)
        if fault is not None:
            case = plan.Case("inside", (fault,), plan.AT_ONCE)
            content, answer = answered(_table(campaign, specimens, mix, fault), BENDING)
            yield from judge.judged(campaign, case, content, answer)


def _campaign(name: str, specimens: Sequence[str], mix: Mix, rng: np.random.Generator) -> Campaign:
    """Five temperatures by four frequencies; of everyday errors those that are no temperature and no time."""
    tests = factorial(specimens, *DESIGNS[BENDING][2])
    campaign = everyday(name, BENDING, tests, mix, rng)
    t, f = (tests[column].to_numpy(float) for column in ("temperature_C", "frequency_Hz"))

    def response(warming: Vector, tuning: Vector) -> Complex:
        return mix.log_modulus(f * tuning, t + warming)

    return replace(campaign, response=response, warmer=np.zeros(len(tests)))


def _table(
    campaign: Campaign, specimens: dict[str, Model], mix: Mix, fault: Fault | None = None
) -> pd.DataFrame:
    """The table of all tests simulated, with the fault in those that it hits."""
    hit = np.zeros(len(campaign.tests), bool) if fault is None else fault.rows(campaign)
    laws: dict[float, BondLaw] = {}
    modulus = np.empty(len(campaign.tests), complex)
    for k, test in enumerate(campaign.tests.itertuples()):
        temperature, rig = test.temperature_C, {}
        if hit[k] and fault.kind == "temperature_bias":
            temperature += fault.size
        elif hit[k]:
            name, unit = TO_RIG[fault.kind]
            rig[name] = unit * fault.size
        if temperature not in laws:
            laws[temperature] = _law(mix, temperature)
        modulus[k] = _recorded(specimens[test.specimen], laws[temperature], test.frequency_Hz, Rig(**rig))
    return written(campaign, np.log(modulus) + campaign.own)


def _law(mix: Mix, temperature: float) -> BondLaw:
    low, high = 2.0 * np.pi * np.array(BAND)
    chain, _ = kelvin_chain(
        lambda omega: np.exp(mix.log_modulus(omega / (2.0 * np.pi), np.array(temperature))), low, high
    )
    return bond_law(chain)


def _recorded(model: Model, law: BondLaw, frequency: float, rig: Rig) -> complex:
    """E* [Pa] of one simulated test by Eqs. (1)-(3)."""
    numerics = Numerics(1.0 / (STEPS * frequency), REST, scheme="fitted")
    record = run_test(model, law, LoadCase(frequency, AMPLITUDE, CYCLES, rig), numerics)
    last = slice(-round(REDUCED * STEPS), None)
    force, displacement = (
        _phasor(record.time[last], signal[last], frequency) for signal in (record.force, record.displacement)
    )
    return FORM_FACTOR * (force / displacement + MOVING * (2.0 * np.pi * frequency) ** 2)


def _phasor(time: Vector, signal: Vector, frequency: float) -> complex:
    """Complex amplitude by least squares beside an offset and a drift."""
    angle = 2.0 * np.pi * frequency * time
    basis = np.stack([np.sin(angle), np.cos(angle), np.ones_like(angle), np.linspace(-1.0, 1.0, angle.size)])
    sine, cosine, *_ = np.linalg.lstsq(basis.T, signal, rcond=None)[0]
    return complex(sine, cosine)
