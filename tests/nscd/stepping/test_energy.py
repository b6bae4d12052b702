"""The energy account: closed to rounding in every kind of run, each term on its own where it can be told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from theory.marches import OMEGA, march

from asphalt_nscd.nscd.bonds.head import RIGID, HeadDevices
from asphalt_nscd.nscd.bonds.law import BondLaw

DT = 2.5e-4
RIG = HeadDevices(1e-7, 1e4, 5.0, 0.2)


def drive(run, amplitude, steps=100):
    for n in range(20 + steps):
        run.move_to(amplitude * np.sin(OMEGA * DT * max(0, n - 19)))
        yield run.account.sums


@pytest.mark.parametrize("devices", [RIGID, RIG])
@pytest.mark.parametrize("name", ["euler", "fitted"])
@pytest.mark.parametrize("method", ["condensed", "reduced"])
def test_breaking_bonds(beam_system, quick_law, name, method, devices):
    """Closed to 1e-11 of the work at every step; fracture counts where bonds broke, and only there."""
    run, before = march(beam_system, quick_law, DT, name, method, devices), 0.0
    broken = 0
    for sums in drive(run, 8e-5):
        assert abs(sums.error) < 1e-11 * max(abs(sums.actuator), 1e-9)
        assert (sums.fracture > before) == (len(run.stepper.state.broken) > broken)
        before, broken = sums.fracture, len(run.stepper.state.broken)
    assert broken > 2 and sums.fracture > 5e-3 * sums.actuator
    assert sums.impact == 0.0 and (sums.friction > 0.0) == (devices is RIG)


def test_terms_of_elastic_bonds(beam_system):
    """Without dashpots all work is stored, or lost to the scheme: |y+ - y|^2 / 2 of motion and springs."""
    system, law = (
        replace(beam_system, load=np.zeros_like(beam_system.load)),
        BondLaw(1e10, np.inf, np.array([]), np.array([])),
    )
    run, lost = march(system, law, DT), 0.0
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
