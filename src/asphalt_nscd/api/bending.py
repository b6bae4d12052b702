"""The complex modulus test on a numerical specimen."""

from __future__ import annotations

import warnings
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.pictures import sheet, shown_in_notebooks
from asphalt_nscd.api.results import Result
from asphalt_nscd.api.specimens import Specimen
from asphalt_nscd.bending.bending_test import FRAMES, damage, outcome, told, unsettled
from asphalt_nscd.bending.case import RunOptions, load_case
from asphalt_nscd.bending.condensing import condensed, idle_option_note
from asphalt_nscd.bending.further_settings import Cycling, Hold
from asphalt_nscd.bending.hold import doubt as doubt_of_hold
from asphalt_nscd.bending.hold import hold as of_hold
from asphalt_nscd.bending.model import Model, model_of
from asphalt_nscd.bending.settings import Bonds, Load, Numerics
from asphalt_nscd.files.store import Record
from asphalt_nscd.files.words import counted

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODELS_KEPT = 4


class Test(Result):
    """One test: E* and the record of force and displacement behind it.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        Of the file: time_s, displacement_m and force_N (s,), and the instants that were kept.
    attributes : mapping
        Of the file; names end in their unit: E_MPa, phase_deg, E_law_MPa, phase_law_deg, amplitude_m.
    name : str, optional
        Of the specimen in messages.

    Notes
    -----
    Arrays of s steps, k breaks, t x l times and layers, f frames, n spheres and b bonds::

        time_s, displacement_m, force_N             (s,)         record at the head
        broken                                      (k,)         bonds in the order in which they broke
        profile/velocity_m_s                        (t, l)       mean along the drive by profile/height_m, or NaN
        frames/time_s                               (f,)         from the start of the oscillation
        frames/position_m, frames/radius_m          (n, 3) (n,)  spheres before the test
        frames/displacement_m, frames/velocity_m_s  (f, n, 3)    of spheres; with their weight, which a
                                                                 commanded force tares
        frames/first, frames/second                 (b,)         bodies of a bond; n and above: plates, as n:
                                                                 head, n + 1: foot, or of four clamps
        frames/point_m, frames/area_m2              (b, 3) (b,)  where a bond acts, and on what area
        frames/strength_N                           (b,)         to break it; infinite at head and foot
        frames/bond_force_N                         (f, b, 3)    normal, positive in tension; two shear, on the
                                                                 second body, along network/frame of the
                                                                 specimen; zero if broken

    Examples
    --------
    >>> from asphalt_nscd.api.specimens import Vibration, pour, specimen
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> law = Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    >>> test = bend(specimen(packing, g), law, 10.0, 15.0, load=Load(cycles=2.0))
    >>> list(test.history), len(test.history)  # two cycles of 0.1 s in steps of 50 us
    (['time_s', 'displacement_m', 'force_N'], 4000)
    >>> round(abs(test.complex_modulus) / 1e6 / test.E_MPa, 9)
    1.0
    """

    __test__ = False  # not one of pytest's

    kind = "test"

    @property
    def complex_modulus(self) -> complex:
        """E* by Eqs. (1)-(2), from the harmonic of the last two cycles.

        Returns
        -------
        complex
            E* [Pa].
        """
        return complex(1e6 * self.E_MPa * np.exp(1j * np.radians(self.phase_deg)))

    @property
    def E_MPa(self) -> float:
        """The norm of E*.

        Returns
        -------
        float
            |E*| [MPa].
        """
        return float(self.attributes["E_MPa"])

    @property
    def phase_deg(self) -> float:
        """The phase of E*.

        Returns
        -------
        float
            Phase [degrees].
        """
        return float(self.attributes["phase_deg"])

    @property
    def broken_bonds(self) -> int:
        """How many bonds broke; E* is then that of a damaged specimen.

        Returns
        -------
        int
            Number of bonds.
        """
        return int(self.attributes["broken_bonds"])

    @property
    def history(self) -> pd.DataFrame:
        """The record of the head.

        Returns
        -------
        DataFrame
            One row for each step while it moves: time_s, displacement_m, force_N.
        """
        return pd.DataFrame({name: self.arrays[name] for name in ("time_s", "displacement_m", "force_N")})

    def plot(self) -> Figure:
        """Draw force against displacement: the loop, whose first cycles hold the transient.

        Returns
        -------
        Figure
            A Matplotlib figure; `savefig` writes it.
        """
        from matplotlib.figure import Figure

        figure = Figure(figsize=(3.5, 2.8), layout="constrained")
        axes = figure.subplots()
        axes.plot(1e6 * self.arrays["displacement_m"], self.arrays["force_N"], lw=0.8)
        axes.set_xlabel("displacement of the head (µm)")
        axes.set_ylabel("force (N)")
        return shown_in_notebooks(figure)

    def __repr__(self) -> str:
        return f"Test({told(self.attributes)})"

    def _repr_html_(self) -> str:
        said = self.attributes
        amplitude, bonds = 1e6 * said["amplitude_m"], counted(said["bonds"], "bond")
        kept = self.arrays.get(f"{FRAMES}/time_s", ())
        return sheet(
            f"Test of {said['specimen']} at {said['temperature_C']:g} °C, {said['frequency_Hz']:g} Hz",
            {
                "|E*|": f"{self.E_MPa:.4g} MPa (law {said['E_law_MPa']:.4g} MPa)",
                "phase": f"{self.phase_deg:.2f}° (law {said['phase_law_deg']:.2f}°)",
                "amplitude of the head": f"{amplitude:.3g} µm",
                "broken": f"{self.broken_bonds} of {bonds}",
                "kept of all spheres and bonds": counted(len(kept), "instant"),
            },
        )


@checked
def bend(
    specimen: Specimen | str | Path,
    law: Law | str | Path,
    frequency_Hz: float,
    temperature_C: float,
    *,
    load: Load = Load(),  # noqa: B008  frozen, and the next
    bonds: Bonds = Bonds(),  # noqa: B008
    numerics: Numerics | None = None,
) -> Test:
    """Test a specimen at one frequency [Hz] and temperature [degC]: a trapezoid in two-point bending, Eqs. (1)-(5).

    A cylinder is pulled and pushed along its axis instead, a prism bent between four clamps (docs/geometries.md).

    Parameters
    ----------
    specimen : Specimen or path
        Bonded spheres.
    law : Law or path
        Of the bonds. Of a law of all temperatures, bonds follow a Kelvin chain that is within 0.1 % of it.
    frequency_Hz, temperature_C : float
        Of the test [Hz], [degC].
    load : Load
        Amplitude of the head, or of a commanded force, cycles, rig; frames=24 keeps 24 instants of the last cycle for
        ParaView.
    bonds : Bonds
        Poisson's ratio, strength and friction of bonds, and how the head is held.
    numerics : Numerics, optional
        Time step [s], method and scheme. Without it `Numerics.usual`.

    Returns
    -------
    Test
        E*, and the record of force and displacement behind it. Of a specimen that breaks in two E* is NaN, the record
        goes up to the break, and attributes["ended"] says when and why.

    Raises
    ------
    InputError
        With one sentence, where the law does not hold at this temperature, or the specimen cannot be tested so.

    Warns
    -----
    UserWarning
        If bonds break: E* is then that of a damaged specimen, or the record ends early. If sweeps did not settle, or a
        choice of `bonds` has no effect.

    Examples
    --------
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
    case, options = load_case(load, frequency_Hz, given.geometry), RunOptions(frames=load.frames)
    numerics = numerics or Numerics.usual(frequency_Hz, given.geometry)
    followed = law.of_bonds(frequency_Hz, temperature_C).bonds
    test = Test(
        *outcome(model_in_memory(given, bonds), followed, temperature_C, case, numerics, options), given.name
    )
    doubts = [idle_option_note(bonds, given.bonded.area), unsettled(test.attributes)]
    if "ended" in test.attributes:
        doubts.append(told(test.attributes))
    elif test.broken_bonds:
        doubts.append(damage(test.attributes))
    warn_of(doubts)
    return test


@checked
def hold(
    specimen: Specimen | str | Path,
    law: Law | str | Path,
    temperature_C: float,
    *,
    held: Hold = Hold(),  # noqa: B008  frozen, and the next
    bonds: Bonds = Bonds(),  # noqa: B008
) -> pd.DataFrame:
    """Hold a force on a specimen (creep) or a displacement (relaxation), and set the law's closed form beside.

    Parameters
    ----------
    specimen : Specimen or path
        Bonded spheres. Their weight is left out.
    law : Law or path
        Of the bonds. Of a law of all temperatures, bonds follow a Kelvin chain that is within 0.1 % of it.
    temperature_C : float
        Of the test [degC].
    held : Hold
        Duration [s], steps, and the force [N] or the displacement [m].
    bonds : Bonds
        Poisson's ratio, strength and friction of bonds, and how the head is held.

    Returns
    -------
    DataFrame
        One row a step (n,): time_s, displacement_m, force_N; of creep D_1_GPa and D_law_1_GPa, of relaxation E_MPa and
        E_law_MPa, by the form factor of the test. attrs: broken_bonds, residual, and ended, which says why there are
        fewer steps than asked, else empty.

    Raises
    ------
    InputError
        With one sentence, where the law does not hold at this temperature, or no step could be made.

    Warns
    -----
    UserWarning
        If the specimen breaks in two: the table goes up to there. If the steps are too long for the law, or a choice of
        `bonds` has no effect.

    Examples
    --------
    >>> from asphalt_nscd.api.specimens import Vibration, pour, specimen
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> law = Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    >>> creep = hold(specimen(packing, g, area="facets"), law, 15.0, held=Hold(1.0, force_N=2.0))
    >>> list(creep)
    ['time_s', 'displacement_m', 'force_N', 'D_1_GPa', 'D_law_1_GPa']
    """
    given = specimen if isinstance(specimen, Specimen) else Specimen.read(specimen)
    law = law if isinstance(law, Law) else Law.read(law)
    lowest, highest = held.band
    table = of_hold(model_in_memory(given, bonds), law.of_bonds(lowest, temperature_C, highest).bonds, held)
    warn_of([idle_option_note(bonds, given.bonded.area), doubt_of_hold(table)])
    return table


@checked
def cycle(
    specimen: Specimen | str | Path,
    law: Law | str | Path,
    frequency_Hz: float,
    temperature_C: float,
    *,
    cycling: Cycling = Cycling(),  # noqa: B008  frozen, and the next
    bonds: Bonds = Bonds(),  # noqa: B008
) -> pd.DataFrame:
    """Press a specimen whose grains touch, from rest: Hertz contacts with Mindlin's friction beside the bonds.

    Parameters
    ----------
    specimen : Specimen or path
        Bonded spheres. Their weight is left out, and bonds do not break.
    law : Law or path
        Of the bonds. Of a law of all temperatures, bonds follow a Kelvin chain that is within 0.1 % of it.
    frequency_Hz, temperature_C : float
        Of the test [Hz], [degC].
    cycling : Cycling
        Amplitude, pressure on the grains [Pa], their friction, cycles, and how the record is read.
    bonds : Bonds
        Poisson's ratio of bonds, and how the head is held.

    Returns
    -------
    DataFrame
        One row a step (n,): time_s, force_N, displacement_m, pressing. attrs: E_MPa and phase_deg as read; E_stuck_MPa
        and phase_stuck_deg if no contact slipped; contacts; energy_error.

    Raises
    ------
    InputError
        With one sentence, where the law does not hold at this temperature, no grains touch, or contacts find no
        balance.

    Warns
    -----
    UserWarning
        If a choice of `bonds` has no effect.

    Examples
    --------
    >>> from asphalt_nscd.api.specimens import Vibration, pour, specimen
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> law = Law.burgers(Em_Pa=2.4e9, eta_m_Pa_s=0.4e9, Ek_Pa=4.8e9, eta_k_Pa_s=0.08e9, temperature_C=40)
    >>> test = cycle(specimen(packing, g, area="facets"), law, 10.0, 40.0, cycling=Cycling(all_cycles=5))
    >>> test.attrs["contacts"] > 100, abs(test.attrs["energy_error"]) < 0.01
    (True, True)
    """
    from asphalt_nscd.bending.cycles import (
        cycle as of_cycles,
    )  # kernels of the contacts take a second to load

    given = specimen if isinstance(specimen, Specimen) else Specimen.read(specimen)
    law = law if isinstance(law, Law) else Law.read(law)
    warn_of([idle_option_note(bonds, given.bonded.area)])
    followed = law.of_bonds(frequency_Hz / cycling.all_cycles, temperature_C, frequency_Hz).bonds
    return of_cycles(_model(_Once(given), bonds), followed, frequency_Hz, cycling)


def warn_of(sentences: list[str]) -> None:
    """Warn the user of a function that is `checked` and calls this.

    Parameters
    ----------
    sentences : list of str
        Those that are empty are left out.
    """
    for sentence in filter(None, sentences):
        # 4: past this and `checked`, so that the warning shows the user's own line.
        warnings.warn(sentence, stacklevel=4)


class _Once:
    """A specimen as a key: the same object is condensed once."""

    def __init__(self, specimen: Specimen) -> None:
        self.specimen = specimen

    def __hash__(self) -> int:
        # Its arrays have no hash; the same object has the same bonds.
        return id(self.specimen)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Once) and self.specimen is other.specimen


def model_in_memory(specimen: Specimen, bonds: Bonds) -> Model:
    """The specimen condensed; of the last ones the same again.

    Parameters
    ----------
    specimen : Specimen
        Bonded spheres.
    bonds : Bonds
        What they are beside their law.

    Returns
    -------
    Model
        Ready for tests.
    """
    return _model(_Once(specimen), bonds)


@lru_cache(maxsize=MODELS_KEPT)
def _model(once: _Once, bonds: Bonds) -> Model:
    return model_of(Record(*condensed(once.specimen.bonded, once.specimen.name, bonds), ""))
