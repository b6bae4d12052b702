"""One cycle of the full-size two-point bending test by every method, and bonded spheres in YADE.

python benchmarks/cycle.py sweeps|condensed|reduced|yade|chain MODEL LAW --specimen FILE --output ROW.csv
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
from rows import Clock, absent, run, write_rows

from asphalt_nscd.bending.bending_test import Record, bond_law, run_test
from asphalt_nscd.bending.case import LoadCase
from asphalt_nscd.bending.model import read_model
from asphalt_nscd.bending.settings import Numerics
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper
from asphalt_nscd.rheology.laws_io import read_bond_law
from asphalt_nscd.specimen.cutting import read_specimen

TOPIC = "cycle of 10 Hz"
FREQUENCY, AMPLITUDE, TIME_STEP = 10.0, 63e-6, 5e-5
STEPS = round(1.0 / FREQUENCY / TIME_STEP)
REPEATED = 20  # whole cycles of the reduced system, each of which takes a moment
MEASURED = 20  # steps from which the whole cycle is scaled
SWEEPS = 50
HERE = Path(__file__).parent


def reduced(model, law: BondLaw) -> dict[str, object]:
    """The whole cycle, the mean of several; the kernels are loaded by a first one."""

    def cycle() -> Record:
        return run_test(model, law, LoadCase(FREQUENCY, AMPLITUDE, 1.0), Numerics(TIME_STEP, 0))

    record, clock = cycle(), Clock()
    for _ in range(REPEATED):
        cycle()
    row = clock.row()
    row["cpu_s"] /= REPEATED
    return row | {"remark": f"{record.time.size} steps, residual {record.residual:.0e}"}


def stepped(model, law: BondLaw, method: str) -> dict[str, object]:
    """Steps of the full system, scaled to the cycle; the first, which factorises or compiles, on top."""
    clock, state = Clock(), CondensedState.rest_state(model.system, law)
    if method == "condensed":
        stepper = CondensedStepper(model.system, law, TIME_STEP, state)
    else:
        stepper = SweepingStepper(model.system, law, TIME_STEP, state, 0.0, SWEEPS)
    velocity = 2.0 * np.pi * FREQUENCY * AMPLITUDE
    stepper.advance(velocity)
    first = clock.row()
    clock = Clock()
    for _ in range(MEASURED):
        stepper.advance(velocity)
    step = clock.row()["cpu_s"] / MEASURED
    remark = f"scaled from {MEASURED} steps of {1e3 * step:.0f} ms; start {first['cpu_s']:.1f} s"
    if method == "sweeps":
        remark += f"; {SWEEPS} sweeps a step, far from converged"
    return first | {"cpu_s": first["cpu_s"] + step * STEPS, "remark": remark}


def chain(model, law: BondLaw) -> dict[str, object]:
    """A chain of eight Kelvin elements instead of the one of Burgers' law."""
    elements = np.arange(8.0)
    return reduced(
        model,
        BondLaw(
            law.spring,
            law.dashpot,
            8.0 * law.kelvin_springs[0] * 1.1**elements,
            8.0 * law.kelvin_dashpots[0] * 2.0**-elements,
        ),
    )


def yade(specimen_file: Path) -> dict[str, object]:
    """Bonds of E = 24.3 GPa between the same spheres at YADE's critical time step."""
    specimen = read_specimen(specimen_file)
    network, n = specimen.network, specimen.radius.size
    between = np.maximum(network.first, network.second) < n
    with tempfile.TemporaryDirectory() as name:
        np.savez(
            Path(name, "specimen.npz"),
            position=specimen.position,
            radius=specimen.radius,
            first=network.first[between],
            second=network.second[between],
            density=specimen.density,
        )
        _, memory, said = run(["yade", "-n", "-x", "-j1", str(HERE / "yade_bonds.py")], name)
    told = next(line.split()[1:] for line in said.splitlines() if line.startswith("per-step"))
    cost, step, bonds = float(told[0]), float(told[1]), int(told[2])
    remark = (
        f"scaled from {1e3 * cost:.0f} ms a step of {bonds} bonds, elastic and at rest, "
        "with the critical time step of a plane wave: each favours it"
    )
    return {
        "time_step_s": step,
        "cpu_s": cost / FREQUENCY / step,
        "memory_MB": memory,
        "remark": remark,
        "spheres": n,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("method", choices=["sweeps", "condensed", "reduced", "chain", "yade"])
    parser.add_argument("model", type=Path)
    parser.add_argument("law", type=Path)
    parser.add_argument("--specimen", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    name = {"chain": "reduced, 8 Kelvin elements", "reduced": "reduced, Burgers"}.get(
        told.method, told.method
    )
    row = absent(TOPIC, name, "yade") if told.method == "yade" else None
    if row is None and told.method == "yade":
        row = yade(told.specimen)
    elif row is None:
        model, law = read_model(told.model), bond_law(read_bond_law(told.law))
        row = {"reduced": reduced, "chain": chain}.get(told.method, lambda *a: stepped(*a, told.method))(
            model, law
        )
        row |= {"spheres": model.sphere_height.size, "time_step_s": TIME_STEP}
    write_rows(told.output, [{"topic": TOPIC, "case": name} | row])


if __name__ == "__main__":
    main()
