"""A force or a displacement of the head held from rest: creep and relaxation, beside the closed form of the law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from asphalt_nscd.bending import runs
from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.case import MOST_STEPS, RunOptions
from asphalt_nscd.bending.model import Model
from asphalt_nscd.bending.taring import soft_clamp, tared
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Ranged, within
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.statics import static_stiffness
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.maxwell import of_chain

COARSE = 0.05  # of the law: an error at the end that is told
MOST_BROKEN = 0.02  # of the bonds; beyond, the specimen no longer follows its law


@dataclass(frozen=True)
class Hold(Ranged):
    """What is held, for how long, in how many equal steps.

    Parameters
    ----------
    duration_s : float
        Of the test [s].
    steps : int
        Of equal length.
    force_N : float, optional
        Held on the head [N]: creep.
    displacement_m : float, optional
        Held at the head [m]: relaxation. Without either it is relaxation too, at the amplitude of usual
        tests.

    Raises
    ------
    InputError
        For force and displacement together, or a zero held.

    Examples
    --------
    >>> Hold(duration_s=10.0, steps=500, force_N=300.0).time_step
    0.02
    """

    duration_s: float = within(10.0, low=1e-6, high=1e9)
    steps: int = within(1000, low=10, high=MOST_STEPS)
    force_N: float | None = within(None, low=-1e9, high=1e9)
    displacement_m: float | None = within(None, low=-1.0, high=1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.force_N is not None and self.displacement_m is not None:
            raise InputError("hold: give force_N for creep or displacement_m for relaxation, not both.")
        if 0.0 in (self.force_N, self.displacement_m):
            raise InputError("hold: nothing is held; give a force or a displacement other than zero.")

    @property
    def time_step(self) -> float:
        """Length of a step.

        Returns
        -------
        float
            [s].
        """
        return self.duration_s / self.steps

    @property
    def band(self) -> tuple[float, float]:
        """Frequencies that a law must hold for.

        Returns
        -------
        tuple of float
            [Hz]: 1 / (2 pi t) at the last and at the first time t.
        """
        return 0.5 / np.pi / self.duration_s, 0.5 / np.pi / self.time_step


def hold(model: Model, law: Burgers | KelvinChain, held: Hold) -> pd.DataFrame:
    """Hold a force or a displacement of the head from rest, and set the closed form of the law beside.

    The form factor of the test is used; inertia and weight are left out. Each step has time_s, displacement_m,
    force_N; of creep D_1_GPa and D_law_1_GPa, of relaxation E_MPa and E_law_MPa. `attrs`: broken_bonds, residual of
    the full equations, error_at_end against the law by statics. Raises InputError where the specimen breaks in two
    or, once the full equations go on, more than `MOST_BROKEN` of its bonds break, or so many of its gaps close that
    strains are no longer small.
    """
    chain = law.as_chain() if isinstance(law, Burgers) else law
    dt, geometry = held.time_step, model.geometry
    times = dt * np.arange(1.0, held.steps + 1.0)
    clamp = 0.0
    if held.force_N is not None:
        # soft against the stiffest the specimen ever is, its modulus after the first step; later it only
        # creeps
        clamp = soft_clamp(model, 1.0 / float(chain.creep_compliance(dt)))
        path = np.full(held.steps, clamp * held.force_N, float)
    else:
        # held from the first step on, as in the closed forms: no ramp
        path = np.full(held.steps, held.displacement_m or geometry.usual_amplitude(), float)
    # a load beyond the strength would break bond after bond, and the contacts of each be solved: minutes
    options = RunOptions(most_broken=MOST_BROKEN)
    try:
        run = runs.by_path(tared(model), bond_law(chain), HeadDevices(clamp), dt, path, options)
    except ArithmeticError as error:
        raise InputError(f"{model.name}: {error}; hold less, or for a shorter time.") from None
    table = pd.DataFrame({"time_s": times, "displacement_m": path - clamp * run.force, "force_N": run.force})
    modulus = geometry.form_factor() * table["force_N"] / table["displacement_m"]
    if held.force_N is not None:
        table["D_1_GPa"], table["D_law_1_GPa"] = 1e9 / modulus, 1e9 * chain.creep_compliance(times)
    else:
        table["E_MPa"], table["E_law_MPa"] = modulus / 1e6, of_chain(chain).relaxation_modulus(times) / 1e6
    # bonds of one law show that law times a constant of statics, whose motion is column 0 of the basis
    constant = geometry.form_factor() * static_stiffness(model.system, model.basis[:, 0])
    shown = float(table.iloc[-1, 3] / table.iloc[-1, 4])
    off = abs((shown / constant if held.force_N is None else shown * constant) - 1.0)
    table.attrs = {"specimen": model.name, "broken_bonds": len(run.broken), "residual": run.residual}
    table.attrs["error_at_end"] = off
    return table


def coarse(table: pd.DataFrame) -> str:
    """A sentence on steps too long for the law of a hold; empty where they are short enough, or bonds broke."""
    off = table.attrs["error_at_end"]
    if table.attrs["broken_bonds"] or off <= COARSE:
        return ""
    return (
        f"hold: at its end {table.columns[3][0]} is {off:.0%} off what statics make of the law: steps are too long for "
        "it, or the specimen still swings; give more steps, or another duration."
    )


def told(table: pd.DataFrame) -> str:
    """Say in one line the compliance or modulus at the end of a hold, that of the law, and how many bonds broke."""
    last, name = table.iloc[-1], table.columns[3]
    unit = "1/GPa" if name.startswith("D") else "MPa"
    words = (
        f"after {last['time_s']:g} s: {name[0]} = {last.iloc[3]:.4g} {unit}, law {last.iloc[4]:.4g} {unit}"
    )
    broken = table.attrs["broken_bonds"]
    return words + (f", {broken} bonds broke" if broken else "")
