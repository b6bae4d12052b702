"""What a test must know of its specimen: how it is cut and driven, and how force and displacement become E*.

A test of another kind is one file beside `twopoint.py`, `tension.py` and `fourpoint.py` with a class that inherits
`Shape`, and its usual specimen in `USUAL` of `geometry.py`. Its displacement is that of the head, and its form factor
knows no Poisson's ratio; indirect tension, for example, needs both changed here first. Complex amplitudes go with
exp(+i omega t); the force leads the displacement by its phase.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.csvinput import Limits
from asphalt_nscd.files.errors import InputError

FREE, HELD, DRIVEN = 0, 1, 2  # what a degree of freedom of a plate is


@dataclass(frozen=True)
class Plate:
    """A section that stays plane and stiff, at `height` over the foot [m], with its share of the mobile mass.

    `motion` (6,) is FREE, HELD or DRIVEN for three translations and three rotations; all that are driven move as one.
    """

    height: float
    motion: tuple[int, ...]
    share: float

    @property
    def moves(self) -> bool:
        """Whether one of its degrees of freedom is free or driven."""
        return self.motion != (HELD,) * 6


class Shape(ABC):
    """A specimen between foot (z = 0) and head (z = h), its axis along z; subclasses are dataclasses of m and kg.

    The first key of `limits` tells its geometry from all others.
    """

    test: ClassVar[str]
    limits: ClassVar[Mapping[str, Limits]]  # of its keys, in mm and kg, in the order of the fields
    axis: ClassVar[int]  # along which the head is driven: 0 for x, 2 for z
    down: ClassVar[int] = 2  # against which its weight acts

    h: float  # height [m]
    mass: float  # of the specimen [kg]
    mobile_mass: float  # of the equipment that moves with the head [kg]

    def __post_init__(self) -> None:
        for field in fields(self):  # type: ignore[arg-type]  # of the dataclass that inherits
            value = getattr(self, field.name)
            if not np.isfinite(value) or value < 0 or (value == 0 and field.name != "mobile_mass"):
                raise InputError(f"geometry: {field.name} = {value:g} must be positive; give it in m or kg.")

    @classmethod
    def of(cls, values: Mapping[str, float]) -> Self:
        """The geometry in SI units from values in mm and kg, by the keys of `limits`."""
        return cls(*(values[key] * (1e-3 if key.endswith("_mm") else 1.0) for key in cls.limits))

    def keys(self) -> dict[str, float]:
        """The values in mm and kg by the keys of `limits`."""
        values = zip(self.limits, asdict(self).values(), strict=True)  # type: ignore[call-overload]
        return {key: float(f"{1e3 * x:.10g}") if key.endswith("_mm") else x for key, x in values}

    def attributes(self) -> dict[str, Any]:
        """The shape as attributes of a file; `geometry.shape_of` reads them."""
        return {"geometry": self.test, **asdict(self)}  # type: ignore[call-overload]

    @property
    @abstractmethod
    def width(self) -> float:
        """Largest extent [m] along x, which is the height of the layer that it is cut from."""

    @property
    @abstractmethod
    def thickness(self) -> float:
        """Extent [m] along y."""

    @property
    def plates(self) -> tuple[Plate, ...]:
        """The plates that move, then those that rest: here the head, driven along the axis, and the foot."""
        driven = tuple(DRIVEN if k == self.axis else FREE for k in range(6))
        return Plate(self.h, driven, 1.0), Plate(0.0, (HELD,) * 6, 0.0)

    @abstractmethod
    def faces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Outward normals (p, 3) and offsets (p,) [m] of the planes around the specimen: head, foot, free faces."""

    @abstractmethod
    def gyration(self) -> NDArray[np.float64]:
        """Squared radii of gyration (3,) [m2] of a thin moving plate about its axes."""

    @abstractmethod
    def form_factor(self) -> float:
        """E over the static force and displacement of the head [1/m]."""

    @abstractmethod
    def mass_factor(self) -> float:
        """Mass that moves with the head [kg]."""

    @abstractmethod
    def counted_share(self, poisson: float) -> float:
        """Share, 0 to 1, of the static displacement of the head that the form factor counts."""

    @abstractmethod
    def line(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Static displacement (n,) along the drive in theory at rising heights `x` (n,) [m]; 1 at the head."""

    @abstractmethod
    def usual_amplitude(self) -> float:
        """Amplitude of the head at the strain of usual tests [m]."""

    def complex_modulus(
        self,
        frequency: ArrayLike,
        force_amplitude: ArrayLike,
        displacement_amplitude: ArrayLike,
        phase: ArrayLike,
    ) -> NDArray[np.complex128]:
        """E* [Pa] from peak values, Eqs. (1)-(2): frequency [Hz], F0 [N], z0 [m] and phase Psi [rad].

        The force leads by Psi; all are scalars or arrays of one shape, which is that of the result.
        """
        omega = 2.0 * np.pi * np.asarray(frequency)
        stiffness = (
            np.asarray(force_amplitude) / np.asarray(displacement_amplitude) * np.exp(1j * np.asarray(phase))
        )
        return self.form_factor() * (stiffness + self.mass_factor() * omega**2)
