"""A head pulled or pushed at constant speed until the specimen fails, and on: the curve, the bonds, the energy."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from asphalt_nscd.bending import runs
from asphalt_nscd.bending.bending_test import FRAMES, bond_law, framed
from asphalt_nscd.bending.case import Progress, RunOptions
from asphalt_nscd.bending.further_settings import Ramp
from asphalt_nscd.bending.model import Model
from asphalt_nscd.bending.taring import soft_clamp, tared
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.stepping.energy import Energies, EnergyAccount
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.specimen.contents import Content

RAMP = "ramp"  # kind of its file
AMPLITUDES = 20.0  # of usual tests, where no displacement is given


def ramp(
    model: Model,
    law: Burgers | KelvinChain,
    pulled: Ramp,
    progress: Progress = lambda done, total: None,
) -> Content:
    """Arrays and attributes of a ramp from rest; weight is left out, inertia is not.

    Arrays (n,): time_s, displacement_m and force_N of the head, broken_bonds, energy_..._J; broken, in the order of
    breaking; frames/. A run that cannot go on keeps its record, and its attribute `ended` says why.
    """
    began, dt, bonds = time.process_time(), pulled.time_step, bond_law(law)
    system = tared(model)
    share = np.arange(1.0, pulled.steps + 1.0) / pulled.steps
    clamp = 0.0
    if pulled.force_N is None:
        end = pulled.displacement_m or AMPLITUDES * model.geometry.usual_amplitude()
    else:
        clamp = soft_clamp(model, abs(bonds.discrete_modulus(0.5 / pulled.duration_s, 0.0)))
        end = clamp * pulled.force_N
    # the reduced model bears the steps before the first break, the full one all others
    small = ReducedStepper(system.reduced_form[0], bonds, dt, runs.RESIDUAL_TOLERANCE, 0, HeadDevices(clamp))
    march = March(small, Scheme(), bonds, dt)
    march.account = EnergyAccount(bonds, by_force=clamp > 0.0)
    kept = np.unique(np.linspace(0, pulled.steps - 1, pulled.frames).round().astype(int))
    count: list[int] = []
    sums: list[Energies] = []

    def note() -> None:
        now, broken = replace(march.account.sums), len(march.stepper.state.broken)
        # under a commanded force, pieces fly apart once more energy moves than springs hold
        if clamp and broken and now.kinetic > now.springs:
            raise InputError(f"the specimen gives way, {broken} of {counted(model.bonds, 'bond')} broke")
        count.append(broken)
        sums.append(now)

    options = RunOptions(progress, keeps_record=True, to_failure=True)
    run = runs.march_along(march, system, end * share, options, set(kept.tolist()), after=note)
    if not sums:
        raise InputError(f"{model.name}: {run.ended}")
    done = run.force.size
    times = dt * np.arange(1.0, done + 1.0)
    arrays = {
        "time_s": times,
        "displacement_m": end * share[:done] - clamp * run.force,
        "force_N": run.force,
        "broken_bonds": np.array(count),
        **{f"energy_{name}_J": np.array([getattr(each, name) for each in sums]) for name in asdict(sums[0])},
        "broken": np.asarray(run.broken, np.int64),
    }
    if run.frames:
        instants = framed(model, times[kept[: len(run.frames)]], run.frames)
        arrays |= {f"{FRAMES}/{name}": values for name, values in instants.items()}
    peak = int(np.argmax(np.abs(run.force)))
    attributes: dict[str, Any] = {
        "specimen": model.name,
        "bonds": model.bonds,
        "broken_bonds": len(run.broken),  # those of a last step that was not finished too
        "peak_force_N": float(run.force[peak]),
        "displacement_at_peak_m": float(arrays["displacement_m"][peak]),
        "broken_at_peak": count[peak],
        "in_two": not model.is_whole(run.broken),
        "ended": run.ended,
        "time_step_s": dt,
        "full_steps": run.full_steps,
        "residual": small.certificate().largest_residual,
        **sums[-1].columns(),
        "cpu_s": time.process_time() - began,
    }
    return arrays, attributes


def told(columns: Mapping[str, Any]) -> str:
    """Say in one line the peak of a ramp, what broke, and what its account of energy misses."""
    words = (
        f"{columns['specimen']}: the largest force is {columns['peak_force_N']:.4g} N, at "
        f"{1e6 * columns['displacement_at_peak_m']:.4g} um; {columns['broken_bonds']} of "
        f"{counted(columns['bonds'], 'bond')} broke"
    )
    words += ", and it is in two pieces" if columns["in_two"] else ""
    words += f"; of the work the account misses {100.0 * abs(columns['energy_error']):.1g} %"
    return words + (f". It ended early: {columns['ended']}" if columns["ended"] else "")
