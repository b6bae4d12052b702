"""A force or a displacement of the head held from rest: creep and relaxation, beside the closed form of the law."""

from __future__ import annotations

import numpy as np
import pandas as pd

from asphalt_nscd.bending import runs
from asphalt_nscd.bending.bending_test import bond_law, ended
from asphalt_nscd.bending.case import RunOptions
from asphalt_nscd.bending.further_settings import Hold
from asphalt_nscd.bending.model import Model
from asphalt_nscd.bending.taring import soft_clamp, tared
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.statics import static_stiffness
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.maxwell import series_of

COARSE = 0.05  # of the law: an error at the end that is told
MOST_BROKEN = 0.02  # of the bonds; beyond, the specimen no longer follows its law


def hold(model: Model, law: Burgers | KelvinChain, held: Hold) -> pd.DataFrame:
    """Hold a force or a displacement of the head from rest, and set the closed form of the law beside.

    The form factor of the test is used; weight is left out, inertia is not. Each step has time_s, displacement_m,
    force_N; of creep D_1_GPa and D_law_1_GPa, of relaxation E_MPa and E_law_MPa. `attrs`: broken_bonds, residual of
    the full equations, error_at_end against the law by statics; `ended`, empty or why the table is shorter than asked:
    the specimen is in two pieces or, once the full equations go on, more than `MOST_BROKEN` of its bonds broke, or so
    many of its gaps closed that strains are no longer small. InputError where no step could be made.
    """
    chain = law.kelvin_form() if isinstance(law, Burgers) else law
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
    options = RunOptions(most_broken=MOST_BROKEN, keeps_record=True)
    try:
        run = runs.path_run(tared(model), bond_law(chain), HeadDevices(clamp), dt, path, options)
    except ArithmeticError as error:
        raise InputError(f"{model.name}: {error}; hold less, or for a shorter time.") from None
    done = slice(run.force.size)
    if run.ended and not run.force.size:
        raise InputError(run.ended)
    times, path = times[done], path[done]
    table = pd.DataFrame({"time_s": times, "displacement_m": path - clamp * run.force, "force_N": run.force})
    modulus = geometry.form_factor() * table["force_N"] / table["displacement_m"]
    if held.force_N is not None:
        table["D_1_GPa"], table["D_law_1_GPa"] = 1e9 / modulus, 1e9 * chain.creep_compliance(times)
    else:
        table["E_MPa"], table["E_law_MPa"] = modulus / 1e6, series_of(chain).relaxation_modulus(times) / 1e6
    # bonds of one law show that law times a constant of statics, whose motion is column 0 of the basis
    constant = geometry.form_factor() * static_stiffness(model.system, model.basis[:, 0])
    # columns 3 and 4: the compliance or modulus of the specimen, and that of the law
    shown = float(table.iloc[-1, 3] / table.iloc[-1, 4])
    off = abs((shown / constant if held.force_N is None else shown * constant) - 1.0)
    table.attrs = {"specimen": model.name, "broken_bonds": len(run.broken), "residual": run.residual}
    table.attrs["error_at_end"] = off
    table.attrs["ended"] = ended(run.ended, times, held.duration_s) if run.ended else ""
    return table


def doubt(table: pd.DataFrame) -> str:
    """A sentence on a hold that ended early, or whose steps are too long for the law; empty where neither holds."""
    if table.attrs["ended"]:
        return f"hold: {table.attrs['ended']}"
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
