"""Known effects put into a table of moduli, measured or drawn. Its own scatter and structure stay.

    background = Background.read("measured.csv")             # or Background(table)
    table, seal = background.put("phase_offset", 1.5)        # deg
    table, seal = background.put("temperature_bias", -0.8, where=21.0)   # K

Each test's own modulus passes the effect, as it would pass the rig of `rig.respond`; the moduli are ready,
so a channel turns the modulus itself, without the inertia of Eq. (1). An effect that changes temperature
or frequency multiplies a test by law(changed) / law(as labelled), with the law of the background: the true
one of a drawn table, the robust fit of `fitted.fit_law` for a measured one. Nothing here comes from the
package under test.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .causes import CATALOGUE, Effect, Place
from .design import GEOMETRY, form_factor
from .fitted import fit_law
from .laws import Law
from .outside import OUTSIDE
from .rig import Rig, warmed

COLUMNS = ("specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg")
SYNONYMS = {"T_C": "temperature_C", "f_Hz": "frequency_Hz", "phi_deg": "phase_deg", "replicate": "specimen"}
CYLINDERS = "tension-compression"
SHIPPED = Path(__file__).parents[2] / "data/ncat"  # tables of cylinders
AMPLITUDE = 63e-6  # m at the head, where the table gives none
ISOTHERM = 1.5  # K: temperatures closer than this to their neighbour belong to one isotherm


@dataclass(frozen=True)
class Background:
    """A table of moduli into which effects are put.

    table: COLUMNS, and amplitude_m [m], order, cycles where known; known_law: of a drawn table; geometry: of
    the specimens, in the keys of a geometry file, for effects at the head of a two-point bending bench;
    test_type: "bending", or "tension-compression" of shipped tables and of those in a folder of that name.
    """

    table: pd.DataFrame
    known_law: Law | None = None
    geometry: Mapping[str, float] = field(default_factory=lambda: dict(GEOMETRY))
    test_type: str = "bending"

    def without(self, tests: Collection[tuple[str, float, float]]) -> pd.DataFrame:
        """The table without these tests: specimen, isotherm [degC], frequency [Hz]."""
        table, drop = self.table, np.zeros(len(self.table), bool)
        for specimen, isotherm, frequency in tests:
            drop |= (
                (table["specimen"].astype(str) == specimen)
                & (abs(table["temperature_C"] - isotherm) < ISOTHERM)
                & np.isclose(table["frequency_Hz"], frequency)
            )
        return table[~drop]

    @classmethod
    def read(cls, path: str | Path) -> Background:
        """A CSV table with COLUMNS or their usual synonyms; ValueError if it has none."""
        table = pd.read_csv(path, comment="#")
        if "specimen" in table.columns:
            table = table.rename(columns={k: v for k, v in SYNONYMS.items() if v != "specimen"})
        else:
            table = table.rename(columns=SYNONYMS)
        missing = [name for name in COLUMNS if name not in table.columns]
        if missing:
            raise ValueError(f"{Path(path).name} is no table of moduli: no column {', '.join(missing)}")
        folder = Path(path).resolve().parent
        return cls(
            table.assign(specimen=table["specimen"].astype(str)),
            test_type=CYLINDERS if folder == SHIPPED.resolve() or folder.name == CYLINDERS else "bending",
        )

    @cached_property
    def law(self) -> Law:
        """The smooth law along which tests are moved."""
        return self.known_law or fit_law(self.table)

    @cached_property
    def modulus(self) -> NDArray[np.complex128]:
        """E* (n,) [Pa] of each test."""
        phase = np.radians(self.table["phase_deg"].to_numpy(float))
        return 1e6 * self.table["E_MPa"].to_numpy(float) * np.exp(1j * phase)

    @cached_property
    def design(self) -> pd.DataFrame:
        """The tests with the mean temperature of their isotherm, rounded to 0.1 K, and an amplitude."""
        temperature = self.table["temperature_C"].to_numpy(float)
        levels = np.unique(temperature)
        group = np.concatenate([[0], np.cumsum(np.diff(levels) > ISOTHERM)])
        own = group[np.searchsorted(levels, temperature)]
        mean = np.bincount(own, temperature) / np.bincount(own)
        design = self.table.assign(temperature_C=np.round(mean, 1)[own])
        return design if "amplitude_m" in design else design.assign(amplitude_m=AMPLITUDE)

    def effect(self, cause: str) -> Effect:
        return CATALOGUE.get(cause) or OUTSIDE[cause]

    def lacks(self, cause: str) -> str:
        """What the table must have to show the cause and has not; empty if it has all."""
        effect = self.effect(cause)
        column = effect.needs or effect.confined
        there = column is None or (column in self.design and self.design[column].nunique() > 1)
        return "" if there else f"{column} that varies"

    def units(self, cause: str) -> dict[str, float]:
        """The amplitude 1 of a cause in each unit it may be given in."""
        effect = self.effect(cause)
        return {effect.unit: 1.0, **effect.others(1.0, self.design, dict(self.geometry))}

    def put(
        self, cause: str, amplitude: float, where: Place = None, unit: str | None = None, seed: int = 0
    ) -> tuple[pd.DataFrame, dict[str, Any]]:
        """The table with the effect in it, and the seal that says which.

        amplitude: signed, in `unit` (one of `units`), else in that of the effect. where: specimen, temperature
        or frequency of an effect confined to one. seed: of details that an effect draws, as the place of a loss bump.
        """
        if lacking := self.lacks(cause):
            raise ValueError(f"{cause} needs {lacking}")
        effect, units = self.effect(cause), self.units(cause)
        size = float(amplitude) / units[unit or effect.unit]
        place, said = self._place(effect.confined, where)
        details = effect.details(self.design, np.random.default_rng(seed))
        rig = Rig(self.design)
        effect.act(rig, size, place, details)
        modulus = self.through(rig)
        # A phase stays on the branch it was on: 200 deg is not -160 deg.
        phase = self.table["phase_deg"].to_numpy(float) + np.degrees(np.angle(modulus / self.modulus))
        seal = {
            "seed": seed,
            "cause": cause,
            "kind": "catalogue" if cause in CATALOGUE else "outside",
            "amplitude": size,
            "unit": effect.unit,
            "where": said,
            "details": details,
            "equivalents": {name: size * factor for name, factor in units.items()},
        }
        return self.table.assign(E_MPa=1e-6 * np.abs(modulus), phase_deg=phase), seal

    def through(self, rig: Rig) -> NDArray[np.complex128]:
        """E* (n,) [Pa] of each test after everything the rig does to it, in the order of `rig.respond`."""
        design, gamma = self.design, form_factor(dict(self.geometry))
        label, z0 = design["temperature_C"].to_numpy(float), design["amplitude_m"].to_numpy(float)
        labelled = 2.0 * np.pi * design["frequency_Hz"].to_numpy(float)
        omega = labelled * rig.tuning
        modulus = self.modulus
        if rig.heating or rig.warming.any() or (rig.tuning != 1.0).any():
            temperature = warmed(self.law.modulus, rig, omega)
            modulus = modulus * self.law.modulus(omega, temperature) / self.law.modulus(labelled, label)
        modulus = (modulus + sum(branch(omega, label) for branch in rig.branches)) * rig.factor
        modulus = modulus / (1.0 + rig.compliance / gamma * modulus)
        head = rig.spring - rig.mass * omega**2 + 4j * rig.slider / (np.pi * z0)
        channel = np.exp(1j * (omega * rig.delay + rig.offset)) * rig.transfer
        return (modulus + gamma * head) * channel * np.exp(rig.gain)

    def _place(self, column: str | None, where: Place) -> tuple[Place, Place]:
        """The value of the design's column that `where` means, the nearest within 1.5 of a number, and `where`."""
        if column is None:
            return None, None
        values = self.design[column].unique()
        if column == "specimen":
            if str(where) in set(values):
                return str(where), str(where)
        elif where is not None:
            nearest = float(values[np.abs(values - float(where)).argmin()])
            if abs(nearest - float(where)) <= ISOTHERM:
                return nearest, float(where)
        raise ValueError(f"no {column} {where!r}; one of {', '.join(map(str, values))}")
