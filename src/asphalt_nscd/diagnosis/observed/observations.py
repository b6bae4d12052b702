"""Measured complex moduli as arrays, with what a cause may need to know about each test."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
HELD = 3  # tests of an isotherm that may be off by itself


@dataclass(frozen=True)
class Observations:
    """n tests on S specimens, one row each; an optional column is None where the table lacks it.

    `specimen` (n,) indexes `names` (S,). Temperatures in degC (`nominal_temperature`: of the isotherm), `frequency` in
    Hz, apparent `modulus` and `static_modulus` (at long times) in Pa, `amplitude` in m, `time_step` of a simulation in
    s; `form_factor` gamma between force over displacement and E* [1/m]; `inertia` gamma mu [kg/m], of which Eq. (1)
    added omega^2. `whole` is None if these are all rows; `quality` is NaN where the machine gave none.
    """

    specimen: NDArray[np.int64]
    names: tuple[str, ...]
    temperature: Vector
    frequency: Vector
    modulus: Complex
    form_factor: Vector
    inertia: Vector
    amplitude: Vector | None = None
    order: Vector | None = None
    cycles: Vector | None = None
    time_step: Vector | None = None
    static_modulus: float | None = None
    whole: Observations | None = None
    nominal_temperature: Vector | None = None
    strain: Vector | None = None
    quality: Mapping[str, Vector] = field(default_factory=dict)
    test_type: str = "bending"

    @property
    def table(self) -> Observations:
        """All tests, to which the largest amplitude, the last cycle and their like refer."""
        return self.whole or self

    @property
    def size(self) -> int:
        """Number n of tests."""
        return self.temperature.size

    @cached_property
    def logarithm(self) -> Complex:
        """ln E* (n,): its imaginary part is the phase [rad]."""
        return np.log(np.abs(self.modulus)) + 1j * np.angle(self.modulus)

    @cached_property
    def omega(self) -> Vector:
        """Angular frequency [rad/s]."""
        return 2.0 * np.pi * self.frequency

    @property
    def isotherm(self) -> Vector:
        """Nominal temperature (n,) [degC] of the isotherm each test belongs to."""
        return self.temperature if self.nominal_temperature is None else self.nominal_temperature

    @cached_property
    def isotherms(self) -> Vector:
        """Nominal temperatures tested [degC], ascending."""
        return np.unique(self.isotherm)

    @cached_property
    def held_isotherms(self) -> Vector:
        """Those of them [degC] with a few tests at least; of one test alone nothing is told from scatter."""
        values, count = np.unique(self.isotherm, return_counts=True)
        return values[count >= HELD]

    @cached_property
    def frequencies(self) -> Vector:
        """Frequencies tested [Hz], ascending."""
        return np.unique(self.frequency)

    @cached_property
    def cell(self) -> NDArray[np.int64]:
        """(n,) number of the condition (temperature, frequency, amplitude) each row repeats."""
        conditions = [self.isotherm, self.frequency]
        if self.amplitude is not None:
            conditions.append(self.amplitude)
        return np.unique(np.column_stack(conditions), axis=0, return_inverse=True)[1].ravel()

    @property
    def columns(self) -> dict[str, NDArray]:
        """Those of the fields that have a value for each test."""
        found = {one.name: getattr(self, one.name) for one in fields(self)}
        return {name: value for name, value in found.items() if isinstance(value, np.ndarray)}

    def known(self, name: str) -> Vector:
        """An optional column (n,) that the caller knows to be there."""
        column: Vector | None = getattr(self, name)
        assert column is not None, name
        return column

    def subset(self, rows: NDArray) -> Observations:
        """Some of the rows, by mask or index; names stay, so that numbers keep their meaning."""
        columns: dict[str, Any] = {name: column[rows] for name, column in self.columns.items()}
        quality = {name: column[rows] for name, column in self.quality.items()}
        return replace(self, **columns, quality=quality, whole=self.table)
