"""A specimen pulled or pushed until it fails."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.bending import model_in_memory, warn_of
from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.pictures import shown_in_notebooks
from asphalt_nscd.api.results import Result
from asphalt_nscd.api.specimens import Specimen
from asphalt_nscd.bending.condensing import idle_option_note
from asphalt_nscd.bending.further_settings import Ramp
from asphalt_nscd.bending.ramp import RAMP, told
from asphalt_nscd.bending.ramp import ramp as of_ramp
from asphalt_nscd.bending.settings import Bonds

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Failure(Result):
    """What a ramp leaves: the curve up to the break and on, broken bonds and the account of energy.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        Of the file: time_s, displacement_m, force_N, broken_bonds and energies (n,), broken (k,) in the order of
        breaking, and the instants that were kept.
    attributes : mapping
        Of the file: peak_force_N, displacement_at_peak_m, broken_bonds, in_two, energy_error (of the work), and ended,
        which says why the record is shorter than asked, else empty.
    name : str, optional
        Of the specimen in messages.

    Examples
    --------
    >>> arrays = {"time_s": np.array([1.0]), "displacement_m": np.array([1e-6]), "force_N": np.array([2.0])}
    >>> list(Failure(arrays, {}).history)
    ['time_s', 'displacement_m', 'force_N']
    """

    kind = RAMP

    @property
    def history(self) -> pd.DataFrame:
        """The curve.

        Returns
        -------
        DataFrame
            One row a step: time_s, displacement_m, force_N, broken_bonds, and energies in J.
        """
        from asphalt_nscd.packings.outgoing import history

        return history(self.arrays)

    def plot(self) -> Figure:
        """Draw force and broken bonds against the displacement of the head.

        Returns
        -------
        Figure
            A Matplotlib figure; `savefig` writes it.
        """
        from matplotlib.figure import Figure

        figure = Figure(figsize=(3.5, 2.8), layout="constrained")
        axes = figure.subplots()
        micrometres = 1e6 * np.abs(self.arrays["displacement_m"])
        axes.plot(micrometres, np.abs(self.arrays["force_N"]), lw=1.0)
        axes.set_xlabel("displacement of the head (µm)")
        axes.set_ylabel("force (N)")
        bonds = axes.twinx()
        bonds.step(micrometres, self.arrays["broken_bonds"], where="post", lw=0.8, color="0.6")
        bonds.set_ylabel("broken bonds")
        return shown_in_notebooks(figure)

    def __repr__(self) -> str:
        return f"Failure({told(self.attributes)})"


@checked
def ramp(
    specimen: Specimen | str | Path,
    law: Law | str | Path,
    temperature_C: float,
    *,
    pulled: Ramp = Ramp(),  # noqa: B008  frozen, and the next
    bonds: Bonds = Bonds(),  # noqa: B008
) -> Failure:
    """Pull or push the head of a specimen at constant speed until it fails, and on.

    Parameters
    ----------
    specimen : Specimen or path
        Bonded spheres. Their weight is left out.
    law : Law or path
        Of the bonds. Of a law of all temperatures, bonds follow a Kelvin chain that is within 0.1 % of it.
    temperature_C : float
        Of the test [degC].
    pulled : Ramp
        Duration [s], steps, and the displacement [m] or the force [N] at the end.
    bonds : Bonds
        Strength and friction of bonds, and how the head is held.

    Returns
    -------
    Failure
        The curve, which is kept whatever breaks.

    Raises
    ------
    InputError
        With one sentence, where the law does not hold at this temperature or no step could be made.

    Warns
    -----
    UserWarning
        If a choice of `bonds` has no effect.

    Examples
    --------
    >>> from asphalt_nscd.api.specimens import Vibration, pour, specimen
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> law = Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    >>> pulled = Ramp(duration_s=0.02, steps=40, displacement_m=150e-6)
    >>> broken = ramp(specimen(packing, g), law, 15.0, pulled=pulled)
    >>> broken.attributes["broken_bonds"] > 0, len(broken.history)
    (True, 40)
    """
    given = specimen if isinstance(specimen, Specimen) else Specimen.read(specimen)
    law = law if isinstance(law, Law) else Law.read(law)
    warn_of([idle_option_note(bonds, given.bonded.area)])
    lowest, highest = pulled.band
    followed = law.of_bonds(lowest, temperature_C, highest).bonds
    arrays, attributes = of_ramp(model_in_memory(given, bonds), followed, pulled)
    return Failure(arrays, {**attributes, "temperature_C": temperature_C}, given.name)
