"""A sawn specimen that falls: its pieces turn, meet the floor and rest there, and its energy is accounted for."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from theory.specimens import QUICK_LAW, jittered_beam

import asphalt_nscd as an
from asphalt_nscd.bending.fall import PARTS, _frame, _row, _told, fell, released
from asphalt_nscd.bending.further_settings import Fall
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.nscd.world import World


@pytest.fixture(scope="module")
def small():
    return jittered_beam(shape=(2, 2, 4), area="facets")


def test_it_starts_at_rest_over_the_floor_in_two_pieces(small):
    world = released(small, QUICK_LAW, Fall(height=3e-3, tilt=90.0, sawn=0.5), Bonds())
    assert (world.position[:, 2] - world.radius).min() == pytest.approx(3e-3)
    x, y, z = small.position.T
    np.testing.assert_allclose(world.position[:, :2], np.stack([z, y], axis=1), atol=1e-15)  # it lies along x
    np.testing.assert_allclose(np.diff(world.position[:, 2]), -np.diff(x), atol=1e-15)
    assert np.abs(world.opening()).max() < 1e-15
    assert world.mass.reshape(-1, 6)[:, 0].sum() == pytest.approx(small.geometry.mass)
    foot = small.position[:, 2] < 0.5 * small.geometry.h
    assert len(set(world.fragments()[foot])) == 1 and len(set(world.fragments().tolist())) == 2
    whole = released(small, QUICK_LAW, Fall(sawn=0.0), Bonds(yield_Pa=3e6, kt_over_kn=0.5))
    inside = np.maximum(small.network.first, small.network.second) < small.radius.size
    assert not whole.broken.any() and whole.bonds.first.tolist() == small.network.first[inside].tolist()
    np.testing.assert_allclose(whole.bonds.strength, 3e6 * small.network.area[inside], rtol=1e-13)
    weight = whole.weight.reshape(-1, 3)
    np.testing.assert_allclose(weight[:, 1:] / weight[:, :1], 0.5, rtol=1e-13)
    clamped = jittered_beam(shape=(2, 2, 12), area="facets", test=Beam.test)
    with pytest.raises(an.InputError, match="plates within it hold its parts together"):
        released(clamped, QUICK_LAW, Fall(), Bonds())
    with pytest.raises(an.InputError, match="sawn = 0.001 meets no bond"):
        released(small, QUICK_LAW, Fall(sawn=0.001), Bonds())
    with pytest.raises(an.InputError, match="it takes at most 1e.06: raise the time step"):
        Fall(duration=100.0, time_step=1e-7)


def test_a_step_without_an_answer_says_when(small, monkeypatch):
    """As of 2 x 2 x 4 spheres with a rolling friction of 3 after 22 ms: couples of contacts do not settle."""

    def fails(self):
        raise ArithmeticError("couples do not settle")

    monkeypatch.setattr(World, "advance", fails)
    with pytest.raises(
        an.InputError, match="^fall: after 0 s couples do not settle; give a shorter time step"
    ):
        fell(small, QUICK_LAW, Fall(duration=0.01, frames=2))


def test_what_is_written_of_an_instant_and_of_the_account():
    """The fastest sphere by its linear velocity; tension is positive; shares are of the energy set free."""
    energies = SimpleNamespace(load=-4.0, error=0.02, **{name: k + 1.0 for k, name in enumerate(PARTS)})
    world = SimpleNamespace(
        time=0.3, energies=energies, position=np.full((2, 3), 5.0), radius=np.ones(2), weight=np.arange(1.0, 7.0),
        velocity=np.array([3.0, 0, 4, 9, 9, 9, 0, 1, 0, 9, 9, 9]), sigma=np.array([-2.0, 3, 4, 5, -6, 7]),
        broken=np.array([True, True]), fragments=lambda: np.array([0, 1]),
    )  # fmt: skip
    row, frame = _row(world), _frame(world, np.full((2, 3), 3.5))
    assert (row["time_s"], row["speed_m_s"], row["load_J"], row["springs_J"]) == (0.3, 5.0, -4.0, 2.0)
    assert frame["bond_force_N"].tolist() == [[2, 6, 12], [-20, -30, 42]]
    assert (frame["displacement_m"] == 1.5).all() and frame["velocity_m_s"].tolist() == [[3, 0, 4], [0, 1, 0]]
    said = _told(world, Fall(time_step=1e-3), 1, 0.7)
    assert (said["broken_bonds"], said["sawn_bonds"], said["fragments"], said["energy_J"]) == (1, 1, 2, 4.0)
    assert [said[f"{name}_percent"] for name in PARTS] == [25.0 * (k + 1) for k in range(len(PARTS))]
    assert (said["error_percent"], said["speed_m_s"], said["duration_s"]) == (0.5, 0.7, 0.3)


@pytest.mark.slow
def test_what_a_fall_sets_free_is_what_named_parts_take(small):
    """In free fall 20 mm set m g h free and all is motion; on the floor, impacts and friction have taken it.

    What the scheme takes is less than a hundredth of that, and each part is computed for itself.
    """
    free = fell(small, QUICK_LAW, Fall(tilt=60.0, duration=0.04, frames=2), Bonds())[1]
    assert free["energy_J"] == pytest.approx(small.geometry.mass * 9.81**2 * 0.04 * 0.0402 / 2, rel=1e-9)
    assert free["kinetic_percent"] == pytest.approx(100 * 200 / 201, rel=1e-6)
    assert free["numerical_percent"] == pytest.approx(100 / 201, rel=1e-6)
    taken = [
        fell(small, QUICK_LAW, Fall(tilt=60.0, duration=0.12, time_step=dt, frames=2), Bonds())[1]
        for dt in (8e-4, 4e-4)
    ]
    for one in taken:
        assert abs(one["error_percent"]) < 1e-6
        assert one["impact_percent"] > 50.0 and one["friction_percent"] > 0.0
        named = [one[f"{name}_percent"] for name in ("kinetic", "springs", "dashpots", "friction", "impact")]
        assert min(named) >= 0.0 and sum(named) == pytest.approx(100.0, abs=1.5)
        assert abs(one["numerical_percent"]) < 0.5


@pytest.mark.slow
def test_both_pieces_come_to_rest(small):
    arrays, said = fell(small, QUICK_LAW, Fall(height=5e-3, duration=0.3, time_step=8e-4, frames=9), Bonds())
    assert said["fragments"] == 2 and said["broken_bonds"] == 0
    assert arrays["speed_m_s"].max() > 0.1 and arrays["speed_m_s"][-1] < 1e-6
    lowest = arrays["frames/position_m"] + arrays["frames/displacement_m"][-1]
    assert lowest[:, 2] == pytest.approx(
        np.maximum(lowest[:, 2], small.radius - 1e-6)
    )  # none is in the floor


def test_instants_are_kept_evenly_and_the_load_is_the_weight_that_came_down(small):
    arrays, said = fell(small, QUICK_LAW, Fall(duration=0.002, frames=3), Bonds(yield_Pa=3e6))
    assert arrays["time_s"] == pytest.approx([0.0, 1e-3, 2e-3]) and said["duration_s"] == pytest.approx(2e-3)
    mass = small.geometry.mass * small.network.cell / small.network.cell.sum()
    came_down = -arrays["frames/displacement_m"][:, :, 2].astype(float) @ mass
    np.testing.assert_allclose(arrays["load_J"], -9.81 * came_down, rtol=1e-5)
    assert came_down[-1] == pytest.approx(small.geometry.mass * 9.81 * 2e-3 * 2.2e-3 / 2, rel=1e-5)
    inside = np.maximum(small.network.first, small.network.second) < small.radius.size
    np.testing.assert_allclose(arrays["frames/area_m2"], small.network.area[inside], rtol=1e-12)
    assert (
        arrays["frames/broken"].shape == (3, inside.sum())
        and said["sawn_bonds"] == arrays["frames/broken"][0].sum()
    )
