"""Specimens whose grains touch: which contacts they have, and what a test reads of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from theory.specimens import as_if_poured, jittered_beam

from asphalt_nscd.bending import cycles
from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.cycles import cycle, run_cycles, skeleton_of, stuck_stiffness
from asphalt_nscd.bending.further_settings import Cycling
from asphalt_nscd.bending.model import model_of
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record
from asphalt_nscd.rheology.as_run import Programme
from asphalt_nscd.rheology.burgers import Burgers

LAW = Burgers(0.24e9, 0.04e9, 0.48e9, 0.008e9)
GRAINS = jittered_beam(shape=(3, 2, 13), area="facets")
LEAST = np.min((GRAINS.network.gap / GRAINS.network.length)[GRAINS.network.second < GRAINS.radius.size])
BEAM = as_if_poured(GRAINS)
CONTENT = condensed(BEAM, "beam", Bonds())


def test_contacts_are_the_least_gaps_and_their_forces_carry_the_pressure():
    """p = sum F l / (3 V), V of the centres; stuck, they stand beside the bonds of the beam, by a dense matrix."""
    model = model_of(Record(*CONTENT, ""))
    first, second, radius = (model.shape[name] for name in ("first", "second", "radius_m"))
    position, n, system = model.shape["position_m"], model.spheres, model.system
    pairs = np.flatnonzero((first < n) & (second < n))
    length = np.linalg.norm(position[first[pairs]] - position[second[pairs]], axis=1)
    gap = system.gap[pairs] / length
    near = gap < gap.min() + 0.005
    found = skeleton_of(model, 3e5, 0.4)
    assert found.bonds.tolist() == pairs[near].tolist() and found.friction == 0.4
    one, two = radius[first[found.bonds]], radius[second[found.bonds]]
    np.testing.assert_allclose(found.radius, 1.0 / (1.0 / one + 1.0 / two), rtol=1e-13)
    carried = found.normal_force(found.overlap) @ length[near]
    assert carried == pytest.approx(3.0 * 3e5 * ConvexHull(position).volume, rel=1e-12)
    law, omega = bond_law(LAW), 60.0
    weight = system.weight * law.discrete_modulus(omega, 0.0)
    weight[found.rows] += found.stiffness(found.overlap)
    rows = system.operator.toarray()
    whole = rows.T @ (weight[:, None] * rows) - omega**2 * np.diag(system.mass)
    expected = 1.0 / np.linalg.inv(whole)[system.driven, system.driven]
    assert stuck_stiffness(system, law, found, omega) == pytest.approx(expected, rel=1e-8)


def test_a_pair_that_overlaps_hides_no_contacts_and_grains_that_are_apart_have_none():
    def contacts(least: float) -> int:
        """How many there are if all grains touched but two, whose gap over their distance is `least`."""
        model = model_of(Record(*CONTENT, ""))
        gap = LEAST * np.linalg.norm(np.diff(model.system.position[pairs], axis=1)[:, 0], axis=1)
        gap[0] *= least / LEAST
        changed = model.system.gap.copy()
        changed[between] = gap
        return skeleton_of(replace(model, system=replace(model.system, gap=changed)), 1e4, 0.5).bonds.size

    between = np.flatnonzero(GRAINS.network.second < GRAINS.radius.size)
    pairs = np.column_stack([GRAINS.network.first, GRAINS.network.second])[between]
    assert contacts(LEAST) == contacts(0.1 * LEAST) == between.size
    poured = replace(BEAM, volume_reduction=0.0)
    with pytest.raises(InputError, match="no two grains are known to have touched"):
        cycle(model_of(Record(*condensed(poured, "beam", Bonds()), "")), LAW, 10.0, Cycling())


def test_a_beam_bends_with_contacts(monkeypatch):
    monkeypatch.setattr(cycles, "TOUCHING", 0.1)  # grains of this beam are apart
    model = model_of(Record(*CONTENT, ""))
    slight, strong = (
        cycle(model, LAW, 10.0, Cycling(amplitude_m=a, haversine=False, all_cycles=4, read_cycles=2))
        for a in (1e-9, 1e-4)
    )
    assert slight.attrs["contacts"] > 10 and abs(strong.attrs["energy_error"]) < 0.01
    assert slight.attrs["E_MPa"] == pytest.approx(slight.attrs["E_stuck_MPa"], rel=0.01)
    assert strong.attrs["phase_deg"] > strong.attrs["phase_stuck_deg"] + 0.01
    omega, shape = 20.0 * np.pi, model.geometry
    stuck = strong.attrs["E_stuck_MPa"] * 1e6 * np.exp(1j * np.radians(strong.attrs["phase_stuck_deg"]))
    stuck = stuck / shape.form_factor() - shape.mass_factor() * omega**2
    np.testing.assert_allclose(strong["time_s"], np.arange(129) / 320.0, atol=1e-15)
    pressing = 1e-4 * abs(stuck) * np.sin(omega * strong["time_s"])
    np.testing.assert_allclose(strong["force_N"], pressing, atol=1e-9 * abs(stuck * 1e-4))
    usual = Cycling(haversine=False, all_cycles=1, read_cycles=1)
    one = cycle(model, LAW, 10.0, usual)
    assert one["force_N"].max() == pytest.approx(shape.usual_amplitude() * abs(stuck), rel=1e-9)
    assert abs(one.attrs["energy_error"]) < 0.02
    chain, skeleton = bond_law(LAW), skeleton_of(model, 10e3, 0.5)
    programme = Programme(False, 4, 2, True, 32)
    test = run_cycles(model.system, chain, skeleton, 10.0, 1e-4 * abs(stuck), programme)
    loop = np.trapezoid(test.force[-33:], test.displacement[-33:])  # the last cycle alone
    assert test.work == pytest.approx(loop, rel=0.02) and test.taken == pytest.approx(loop, rel=0.02)
    weak = replace(model, system=replace(model.system, strength=1e-9 * model.system.strength))
    programme = Cycling(amplitude_m=1e-4, haversine=False, all_cycles=4, read_cycles=2)
    assert cycle(weak, LAW, 10.0, programme).equals(strong)  # bonds of such a test do not break
