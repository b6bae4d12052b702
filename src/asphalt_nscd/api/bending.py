"""The complex modulus test on a numerical specimen."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.results import Result
from asphalt_nscd.api.specimens import Specimen
from asphalt_nscd.bending.bending_test import outcome
from asphalt_nscd.bending.case import LoadCase, Numerics
from asphalt_nscd.bending.model import Model, condensed, model_of
from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.specimen.system import HEADS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PAPER_AMPLITUDE = 63e-6  # m, of a head 250 mm above a foot 56 mm wide
MODELS_KEPT = 4


@dataclass(frozen=True)
class Bonds:
    """What bonds are beside their law, and whether the head rotates.

    head: "free" or "blocked". poisson: nu of Eqs. (8)-(11), for bonds by area "paper"; kt_over_kn: tangential over
    normal stiffness, for "facets". yield_Pa: stress at which a bond breaks. friction: where its gap then closes.
    """

    head: str = "free"
    poisson: float = 0.35
    kt_over_kn: float = 1.0
    yield_Pa: float = 2.7e6
    friction: float = 0.7


class Test(Result):
    """One test: E* and the record of force and displacement behind it."""

    __test__ = False  # not one of pytest's

    kind = "test"

    @property
    def complex_modulus(self) -> complex:
        """E* [Pa] by Eqs. (1)-(2), from the harmonic of the last two cycles."""
        return complex(1e6 * self.E_MPa * np.exp(1j * np.radians(self.phase_deg)))

    @property
    def E_MPa(self) -> float:
        """|E*| [MPa]."""
        return float(self.attributes["E_MPa"])

    @property
    def phase_deg(self) -> float:
        """Phase of E* [degrees]."""
        return float(self.attributes["phase_deg"])

    @property
    def broken_bonds(self) -> int:
        """How many bonds broke; E* is then that of a damaged specimen."""
        return int(self.attributes["broken_bonds"])

    @property
    def history(self) -> pd.DataFrame:
        """time_s, displacement_m and force_N of the head, one row for each step while it moves."""
        return pd.DataFrame({name: self.arrays[name] for name in ("time_s", "displacement_m", "force_N")})

    def plot(self) -> Figure:
        """Force against displacement: the loop, whose first cycles hold the transient."""
        from matplotlib.figure import Figure

        from asphalt_nscd.api.pictures import shown_in_notebooks

        figure = Figure(figsize=(3.5, 2.8), layout="constrained")
        axes = figure.subplots()
        axes.plot(1e6 * self.arrays["displacement_m"], self.arrays["force_N"], lw=0.8)
        axes.set_xlabel("displacement of the head (µm)")
        axes.set_ylabel("force (N)")
        return shown_in_notebooks(figure)

    def __repr__(self) -> str:
        said = self.attributes
        broken = f", {self.broken_bonds} of {said['bonds']} bonds broke" if self.broken_bonds else ""
        return (
            f"Test({said['temperature_C']:g} degC, {said['frequency_Hz']:g} Hz: |E*| = {self.E_MPa:.4g} MPa, phase "
            f"{self.phase_deg:.2f} deg; law {said['E_law_MPa']:.4g} MPa, {said['phase_law_deg']:.2f} deg{broken})"
        )


def bend(
    specimen: Specimen | str | Path, law: Law | str | Path, frequency_Hz: float, temperature_C: float, *,
    amplitude_m: float | None = None, cycles: float = 5.0, bonds: Bonds = Bonds(),  # noqa: B008  frozen
    numerics: Numerics = Numerics(), rig: Rig = Rig(),  # noqa: B008  frozen
) -> Test:  # fmt: skip
    """Bend a specimen at one frequency [Hz] and temperature [degC]: two-point bending, Eqs. (1)-(5).

    law: of one temperature, or of all; bonds then follow its Kelvin chain within 0.1 %. amplitude_m: of the head;
    without it the strain is that of the paper's 63 um on its own specimen. numerics: Numerics(time_step [s],
    rest_steps, method, scheme). rig: what stands at the head and in the measuring channel. A warning says so where
    bonds broke.

    >>> from asphalt_nscd.api.specimens import Vibration, pour, specimen
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> law = Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    >>> test = bend(specimen(packing, g, area="facets"), law, 10.0, 15.0)
    >>> abs(test.phase_deg - test.attributes["phase_law_deg"]) < 0.5, test.broken_bonds
    (True, 0)
    """
    given = specimen if isinstance(specimen, Specimen) else Specimen.read(specimen)
    law = law if isinstance(law, Law) else Law.read(law)
    if bonds.head not in HEADS:
        raise InputError(f"head {bonds.head!r} is not known; give one of {', '.join(HEADS)}.")
    if not frequency_Hz > 0.0:
        raise InputError(f"frequency_Hz = {frequency_Hz}: give a frequency greater than zero.")
    if amplitude_m is None:
        amplitude_m = usual_amplitude(given.geometry)
    elif not amplitude_m > 0.0:
        raise InputError(f"amplitude_m = {amplitude_m}: give an amplitude greater than zero.")
    case = LoadCase(frequency_Hz, amplitude_m, cycles, rig)
    followed = law.of_bonds(frequency_Hz, temperature_C).bonds
    try:
        arrays, attributes = outcome(_model(_Once(given), bonds), followed, temperature_C, case, numerics)
    except ArithmeticError as error:
        raise InputError(
            f"{frequency_Hz:g} Hz: {error}; lower the amplitude or choose another method."
        ) from None
    test = Test(arrays, attributes, given.name)
    if test.broken_bonds:
        warnings.warn(
            f"{test.broken_bonds} of {attributes['bonds']} bonds broke at an amplitude of {1e6 * amplitude_m:.3g} um: "
            "E* is that of a damaged specimen; lower amplitude_m or raise yield_Pa.",
            stacklevel=2,
        )
    return test


def usual_amplitude(geometry: Geometry) -> float:
    """Amplitude [m] of the head that strains a cantilever as the paper's 63 um strain its specimen: as h^2 / B."""
    return PAPER_AMPLITUDE * (geometry.h**2 / geometry.B) / (0.25**2 / 0.056)


class _Once:
    """A specimen as a key: the same object is condensed once."""

    def __init__(self, specimen: Specimen) -> None:
        self.specimen = specimen

    def __hash__(self) -> int:
        return id(self.specimen)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Once) and self.specimen is other.specimen


@lru_cache(maxsize=MODELS_KEPT)
def _model(once: _Once, bonds: Bonds) -> Model:
    content = condensed(
        once.specimen.bonded, once.specimen.name, bonds.head, bonds.poisson, bonds.yield_Pa, bonds.friction,
        bonds.kt_over_kn,
    )  # fmt: skip
    return model_of(Record(*content, ""))
