"""Fatigue of a numerical specimen."""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.bending import warn_of
from asphalt_nscd.api.specimens import Specimen
from asphalt_nscd.bending import fatigue as test
from asphalt_nscd.bending.condensing import idle_option_note
from asphalt_nscd.bending.further_settings import FatigueLaw
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.nscd.bonds.fatigue import FatigueHistory


@checked
def fatigue(
    specimen: Specimen | str | Path,
    strain: float,
    *,
    law: FatigueLaw = FatigueLaw(),  # noqa: B008  frozen, and the next
    bonds: Bonds = Bonds(),  # noqa: B008
) -> FatigueHistory:
    """Tire a trapezoid at constant displacement of its head until half of its stiffness is left (docs/fatigue.md).

    Parameters
    ----------
    specimen : Specimen or path
        A trapezoid of bonded spheres.
    strain : float
        Largest amplitude of strain in bending theory, as 100e-6.
    law : FatigueLaw
        How fast a bond tires.
    bonds : Bonds
        Poisson's ratio of bonds, and how the head is held.

    Returns
    -------
    FatigueHistory
        life() in cycles; cycles, stiffness (over the first) and lost bonds at each jump (j,); damage of the bonds (b,)
        at the end.

    Raises
    ------
    InputError
        With one sentence, for a strain out of range or a specimen that is no trapezoid.

    Warns
    -----
    UserWarning
        If a choice of `bonds` has no effect.

    Examples
    --------
    >>> from asphalt_nscd.api.specimens import Vibration, pour, specimen
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> beam = specimen(packing, g, area="facets")
    >>> lives = [fatigue(beam, strain).life() for strain in (100e-6, 200e-6)]
    >>> round(lives[0] / lives[1], 1)  # twice the strain: a life by 2^5 shorter
    32.0
    """
    given = specimen if isinstance(specimen, Specimen) else Specimen.read(specimen)
    warn_of([idle_option_note(bonds, given.bonded.area)])
    return test.fatigue(given.bonded, strain, law, bonds)
