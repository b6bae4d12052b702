"""The energy account: closed to rounding in every kind of run, each term on its own where it can be told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.head import RIGID, HeadDevices
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme

DT, OMEGA = 2.5e-4, 80 * np.pi
RIG = HeadDevices(1e-7, 1e4, 5.0, 0.2)


def march(system, law, name="euler", devices=RIGID, reduced=False) -> March:
    scheme = Scheme.named(name, OMEGA * DT)
    if reduced:
        model = ReducedModel(system, ritz_basis(system, 12))
        stepper = ReducedStepper(model, law, DT / scheme.a, 1e-6, devices=devices)
    else:
        stepper = CondensedStepper(system, law, DT / scheme.a, CondensedState.at_rest(system, law), devices)
    return March(stepper, scheme, law, DT)


def drive(run, amplitude, steps=100):
    for n in range(20 + steps):
        run.move_to(amplitude * np.sin(OMEGA * DT * max(0, n - 19)))
        yield run.account.sums


@pytest.mark.parametrize("devices", [RIGID, RIG])
@pytest.mark.parametrize("name", ["euler", "fitted"])
@pytest.mark.parametrize("reduced", [False, True])
def test_breaking_bonds(beam_system, quick_law, name, reduced, devices):
    """Closed to 1e-11 of the work at every step; fracture counts where bonds broke, and only there."""
    run, before = march(beam_system, quick_law, name, devices, reduced), 0.0
    broken = 0
    for sums in drive(run, 8e-5):
        assert abs(sums.error) < 1e-11 * max(abs(sums.actuator), 1e-9)
        assert (sums.fracture > before) == (len(run.stepper.state.broken) > broken)
        before, broken = sums.fracture, len(run.stepper.state.broken)
    assert broken > 2 and sums.fracture > 5e-3 * sums.actuator
    assert sums.impact == 0.0 and (sums.friction > 0.0) == (devices is RIG)


@pytest.mark.parametrize("devices", [RIGID, RIG])
@pytest.mark.parametrize("name", ["euler", "fitted"])
def test_closing_gaps(beam_system, quick_law, name, devices):
    """Gaps a thousand times narrower: impacts dissipate, and a slider that holds while contacts press."""
    narrow = replace(
        beam_system, gap=1e-3 * beam_system.gap, strength=np.full_like(beam_system.strength, np.inf)
    )
    run = march(narrow, quick_law, name, devices)
    for sums in drive(run, 3e-5):
        assert abs(sums.error) < 1e-11 * max(abs(sums.actuator), 1e-9)
    assert sums.impact > 0.0
    gap = narrow.gap + narrow.operator[::3] @ run.stepper.state.displacement
    assert gap.min() > -1e-11


def test_terms_of_elastic_bonds(beam_system):
    """Without dashpots all work is stored, or lost to the scheme: |y+ - y|^2 / 2 of motion and springs."""
    system, law = (
        replace(beam_system, load=np.zeros_like(beam_system.load)),
        BondLaw(1e10, np.inf, np.array([]), np.array([])),
    )
    run, lost = march(system, law), 0.0
    for sums in drive(run, 1e-6, 30):  # noqa: B007 - the last one is read below
        step = {name: run.now.values[name] - run.earlier.values[name] for name in ("velocity", "sigma")}
        lost += (
            0.5 * system.mass @ step["velocity"] ** 2 + 0.5 * system.weight @ step["sigma"] ** 2 / law.spring
        )
    stored = 0.5 * system.weight @ run.now.values["sigma"] ** 2 / law.spring
    assert sums.springs == pytest.approx(stored, rel=1e-12)
    assert sums.kinetic == pytest.approx(0.5 * system.mass @ run.now.values["velocity"] ** 2, rel=1e-12)
    assert sums.numerical == pytest.approx(lost, rel=1e-9) and sums.dashpots == 0.0
    assert sums.actuator == pytest.approx(stored + sums.kinetic + lost, rel=1e-9)


def test_dissipation_of_a_cycle(beam_system, quick_law):
    """Steady oscillation by the fitted scheme: pi F0 z0 sin(psi) in the dashpots, cycle by cycle."""
    weightless = replace(beam_system, load=np.zeros_like(beam_system.load))
    run = march(weightless, quick_law, "fitted", reduced=True)
    dissipated = [(sums.dashpots, sums.actuator) for sums in drive(run, 1e-6, 600)]
    (first, worked), (last, work) = dissipated[-101], dissipated[-1]
    stiffness = driving_force(beam_system, quick_law.discrete_modulus(OMEGA, 0.0), OMEGA)
    cycle = np.pi * stiffness.imag * 1e-12
    assert work - worked == pytest.approx(cycle, rel=1e-6)
    assert last - first == pytest.approx(cycle, rel=1e-6)
