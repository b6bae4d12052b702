"""Sealed cases: a measurement table with effects hidden in it, and a seal that says which.

    case = draw(7, [Hidden("channel_delay", amplitude=2e-4)])
    case.table, case.geometry     what a diagnosis may see
    case.seal                     seed, law, effects; opened afterwards

Nothing here comes from the package under test. The same seed gives the same mix, scatter, places and
signs whatever the amplitudes, so that one seed can be followed from weak to strong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd

from . import records
from .causes import CATALOGUE, Effect, Place
from .design import GEOMETRY, factorial
from .laws import Law, draw_law
from .outside import OUTSIDE
from .rig import Rig, respond
from .strength import Scatter, amplitude_of, strength, visible_strength

FORMS = ("peaks", "moduli", "records")


@dataclass(frozen=True)
class Hidden:
    """An effect to hide; give exactly one of amplitude, strength and visible_strength.

    amplitude: in the unit of the effect, its size; strength, visible_strength: see strength.py.
    where: specimen, temperature or frequency for effects confined to one, else drawn; sign: +1 or -1,
    drawn where both are physical.
    """

    cause: str
    amplitude: float | None = None
    strength: float | None = None
    visible_strength: float | None = None
    where: Place = None
    sign: int | None = None

    def __post_init__(self) -> None:
        if sum(v is not None for v in (self.amplitude, self.strength, self.visible_strength)) != 1:
            raise ValueError(f"{self.cause}: give one of amplitude, strength, visible_strength")
        if self.cause not in CATALOGUE and self.cause not in OUTSIDE:
            raise ValueError(f"{self.cause} is not known; one of {', '.join([*CATALOGUE, *OUTSIDE])}")


@dataclass(frozen=True)
class Case:
    """table and geometry for the diagnosis; seal (JSON-ready) for the scorer; records by name."""

    table: pd.DataFrame
    geometry: dict[str, float]
    seal: dict[str, Any]
    records: dict[str, pd.DataFrame]


@dataclass(frozen=True)
class _Placed:
    """A hidden effect after its place, sign and details are drawn."""

    cause: str
    effect: Effect
    sign: int
    where: Place
    details: dict[str, Any]

    def act(self, rig: Rig, amplitude: float) -> None:
        self.effect.act(rig, amplitude, self.where, self.details)


def draw(
    seed: int,
    hidden: Sequence[Hidden] = (),
    *,
    design: pd.DataFrame | None = None,
    law: str | None = None,
    scatter: Scatter | None = None,
    form: str = "peaks",
    geometry: dict[str, float] | None = None,
    sampling: records.Sampling | None = None,
) -> Case:
    """A case from a seed; no `hidden` gives an empty one, two a pair.

    design: see design.factorial, the paper's by default; law: a shape of laws.SHAPES, else drawn.
    form "peaks": F0_N, z0_m, psi_deg; "moduli": E_MPa, phase_deg; "records": names of sampled records.
    """
    if form not in FORMS:
        raise ValueError(f"form {form!r}: one of {', '.join(FORMS)}")
    design = (factorial() if design is None else design).reset_index(drop=True)
    geometry = dict(GEOMETRY if geometry is None else geometry)
    scatter = scatter or Scatter()
    law_seed, scatter_seed, hidden_seed, record_seed = np.random.SeedSequence(seed).spawn(4)
    mix = draw_law(np.random.default_rng(law_seed), law)
    rig, effects = Rig(design), []
    for one, own_seed in zip(hidden, hidden_seed.spawn(len(hidden)), strict=True):
        placed = _place(one, design, np.random.default_rng(own_seed))
        measured = _Strength(placed, mix, design, geometry, scatter)
        amplitude = measured.amplitude(one)
        placed.act(rig, amplitude)
        effects.append(_sealed(placed, amplitude, measured, design, geometry))
    rng = np.random.default_rng(scatter_seed)
    rig.factor = rig.factor * records.scatter_factor(design["specimen"], scatter, rng)
    amplitude = design["amplitude_m"] * (1.0 + scatter.displacement * rng.standard_normal(len(design)))
    table, sampled = _measured(
        rig, mix, geometry, amplitude.to_numpy(), form, sampling, np.random.default_rng(record_seed)
    )
    seal = {
        "seed": seed,
        "law": asdict(mix),
        "scatter": asdict(scatter),
        "form": form,
        "tests": len(design),
        "effects": effects,
    }
    return Case(table, geometry, seal, sampled)


def _place(hidden: Hidden, design: pd.DataFrame, rng: np.random.Generator) -> _Placed:
    effect = CATALOGUE.get(hidden.cause) or OUTSIDE[hidden.cause]
    column = effect.needs or effect.confined
    if column is not None and (column not in design or design[column].nunique() < 2):
        raise ValueError(f"{hidden.cause} needs a design in which {column} varies")
    sign, where = (-1, 1)[rng.integers(2)], None
    if effect.confined is not None:
        where = rng.choice(design[effect.confined].unique())
        where = str(where) if effect.confined == "specimen" else float(where)
        where = where if hidden.where is None else hidden.where
        if where not in set(design[effect.confined]):
            raise ValueError(f"{hidden.cause}: the design has no {effect.confined} {where!r}")
    if not effect.signed:
        sign = 1
    return _Placed(hidden.cause, effect, hidden.sign or sign, where, effect.details(design, rng))


class _Strength:
    """Strength of one effect alone, without scatter, as a function of its amplitude."""

    def __init__(
        self, placed: _Placed, law: Law, design: pd.DataFrame, geometry: dict[str, float], scatter: Scatter
    ) -> None:
        self.placed, self.law, self.design, self.geometry, self.scatter = (
            placed,
            law,
            design,
            geometry,
            scatter,
        )
        self.plain = respond(law, Rig(design), geometry).modulus

    def raw(self, amplitude: float) -> float:
        return strength(self._effect(amplitude), self.scatter)

    def visible(self, amplitude: float) -> float:
        return visible_strength(self._effect(amplitude), self.law, self.design, self.scatter)

    def amplitude(self, hidden: Hidden) -> float:
        """The signed amplitude asked for."""
        if hidden.amplitude is not None:
            return self.placed.sign * hidden.amplitude
        start = self.placed.sign * self.placed.effect.step
        if hidden.strength is not None:
            return amplitude_of(hidden.strength, self.raw, start)
        return amplitude_of(hidden.visible_strength, self.visible, start)

    def _effect(self, amplitude: float) -> np.ndarray:
        rig = Rig(self.design)
        self.placed.act(rig, amplitude)
        return np.log(respond(self.law, rig, self.geometry).modulus / self.plain)


def _sealed(
    placed: _Placed, amplitude: float, measured: _Strength, design: pd.DataFrame, geometry: dict[str, float]
) -> dict[str, Any]:
    effect = placed.effect
    return {
        "cause": placed.cause,
        "kind": "catalogue" if placed.cause in CATALOGUE else "outside",
        "amplitude": float(amplitude),
        "unit": effect.unit,
        "equivalents": {effect.unit: float(amplitude), **effect.others(amplitude, design, geometry)},
        "where": placed.where,
        "details": placed.details,
        "strength": measured.raw(amplitude),
        "visible_strength": measured.visible(amplitude),
    }


def _measured(
    rig: Rig,
    law: Law,
    geometry: dict[str, float],
    amplitude: np.ndarray,
    form: str,
    sampling: records.Sampling | None,
    rng: np.random.Generator,
) -> tuple[pd.DataFrame, dict[str, pd.DataFrame]]:
    """The table in the form asked for, and the records it names."""
    design, response = rig.design, respond(law, rig, geometry, amplitude)
    table = design if design["amplitude_m"].nunique() > 1 else design.drop(columns="amplitude_m")
    if form == "peaks":
        values = {
            "F0_N": np.abs(response.ratio) * amplitude,
            "z0_m": amplitude,
            "psi_deg": np.degrees(np.angle(response.ratio)),
        }
        return table.assign(**values), {}
    if form == "moduli":
        phase = np.degrees(np.angle(response.modulus))
        return table.assign(E_MPa=np.abs(response.modulus) * 1e-6, phase_deg=phase), {}
    sampled = records.sample(response, amplitude, rig.slider, sampling or records.Sampling(), rng)
    names = [f"record_{n + 1:04d}.csv" for n in range(len(design))]
    return table.assign(record=names), dict(zip(names, sampled, strict=True))
