"""The energy account of runs with breaking bonds, closing gaps, devices and either scheme."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.head import RIGID, HeadDevices
from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.energy import Energies
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from theory.marches import OMEGA, beam, march
from theory.specimens import QUICK_LAW, elastic, mixed

DT = 2.5e-4
CLOSES = 1e-10  # of the actuator's work: rounding; 1e-6 is what is asked for
ACCOUNT = "dt F z' = stores + dissipation, see nscd.energy"


def account(
    system: BondedSystem,
    amplitude: float,
    method: str,
    name: str,
    devices: HeadDevices = RIGID,
    cycles: float = 1.0,
    law: AnyLaw = QUICK_LAW,
) -> tuple[Energies, float]:
    """(energies at the end, largest error of the account in any step over the work at the end)."""
    run, worst = march(system, law, DT, name, method, devices), 0.0
    # ten steps at rest first, in which the weight comes to bear
    for n in range(10 + round(100 * cycles)):
        run.move_to(amplitude * np.sin(OMEGA * DT * max(0, n - 9)))
        worst = max(worst, abs(run.account.sums.error))
    return run.account.sums, worst / abs(run.account.sums.actuator)


@pytest.mark.slow
def test_closure(row):
    # so narrow that gaps close, and so strong that no bond breaks before
    narrow = replace(beam(), gap=1e-3 * beam().gap, strength=np.full_like(beam().strength, np.inf))
    rig = HeadDevices(1e-7, 1e4, 5.0, 0.2)
    for what, system, amplitude, devices, methods in (
        ("breaking bonds", beam(), 8e-5, RIGID, ("condensed", "reduced")),
        ("closing gaps and a rig with a slider", narrow, 3e-5, rig, ("condensed",)),
    ):
        for method in methods:
            for name in ("euler", "fitted"):
                sums, error = account(system, amplitude, method, name, devices)
                assert (sums.impact > 0.0) == (system is narrow) and (sums.fracture > 0.0) == (
                    system is beam()
                )
                row(f"energy account, {method}, {name}, {what}", 0.0, error, CLOSES, ACCOUNT)
        _, error = account(system, amplitude, "condensed", "fitted", devices, law=mixed(system))
        row(f"energy account, bonds of three laws, fitted, {what}", 0.0, error, CLOSES, ACCOUNT)


def test_terms(row):
    weightless = replace(beam(), load=np.zeros(beam().mass.size))
    # the difference is the fifth cycle alone: transients die within two (QUICK_LAW)
    long, short = (account(weightless, 1e-6, "reduced", "fitted", cycles=cycles)[0] for cycles in (5.0, 4.0))
    loss = np.pi * 1e-12 * driving_force(beam(), QUICK_LAW.discrete_modulus(OMEGA, 0.0), OMEGA).imag
    stored = account(weightless, 1e-6, "condensed", "euler", cycles=0.25, law=elastic(1e10))[0].springs
    still = 0.5e-12 * driving_force(beam(), 1e10, 0.0).real
    work, dissipated = long.actuator - short.actuator, long.dashpots - short.dashpots
    row("work of the actuator in a cycle (J)", loss, work, 1e-6, "pi F0 z0 sin(psi)")
    row("dissipation of the dashpots in a cycle (J)", loss, dissipated, 1e-6, "all of that work")
    row("energy of elastic bonds at the crest (J)", still, stored, 1e-5, "F0 z0/2, but for inertia")
