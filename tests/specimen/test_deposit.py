"""Pouring and vibrating: candidates complete, walls respected, energies, determinism of the motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from naive.granular import all_pairs

from asphalt_nscd.specimen.deposit import (
    MANY,
    REST_SPEED,
    Granulate,
    PouringNumerics,
    settle,
    vibrate,
)
from asphalt_nscd.specimen.lattice import random_lattice

BOX = (0.021, 0.016, 0.07)


def silent(*_):
    pass


def granulate(seed=1, friction=0.2) -> Granulate:
    position, radius = random_lattice(
        np.array([2e-3, 3e-3, 5e-3]), np.array([60, 40, 15]), BOX, np.random.default_rng(seed)
    )
    return Granulate.in_box(position, radius, BOX, 2600.0, friction)


@pytest.fixture(scope="module")
def layer():
    """Poured once; copied by those who move it."""
    poured = granulate()
    settle(poured, PouringNumerics(), 1e-3, 2.0, silent, "pouring")
    return poured


def copy(of: Granulate) -> Granulate:
    other = granulate()
    for name in ("position", "velocity", "impulse", "plane_point"):
        setattr(other, name, getattr(of, name).copy())
    other._start, other._other, other._reach = of._start, of._other, of._reach
    other._searched_at, other._planes_at = of._searched_at.copy(), of._planes_at.copy()
    return other


@pytest.mark.parametrize(("time_step", "rain"), [(1e-4, 0.0), (4e-4, 2.0)])
def test_every_pair_that_may_meet_is_on_the_list(time_step, rain):
    """Fast grains and a moving lid: pairs that come within the margin in a step, by brute force, are
    listed although the list is renewed only now and then, or made short where grains rain [m/s]."""
    flock = granulate(4)
    rng = np.random.default_rng(4)
    n, numerics = flock.radius.size, PouringNumerics(time_step=time_step)
    flock.velocity[:n] = rng.normal(0, 0.3, (n, 6))
    flock.velocity[: n // 2, 2] -= rain
    lid = np.zeros((6, 3))
    lid[5, 2] = -0.5
    renewed, met = set(), 0
    for _ in range(60):
        before = flock.position.copy(), flock.plane_point.copy(), flock.velocity[:n, :3].copy()
        flock.advance(numerics, lid)
        renewed.add(id(flock._start))
        position, planes, velocity = before
        speed = velocity + numerics.time_step * flock.gravity
        listed = set(zip(np.repeat(np.arange(n), np.diff(flock._start)).tolist(), flock._other.tolist()))
        for i, j in all_pairs(position, flock.radius, planes, flock.plane_normal, 3e-3):
            if j < n:
                apart = position[j] - position[i]
                distance = np.linalg.norm(apart)
                gap, opening = distance - flock.radius[[i, j]].sum(), (speed[j] - speed[i]) @ apart / distance
            else:
                normal = flock.plane_normal[j - n]
                gap = (position[i] - planes[j - n]) @ normal - flock.radius[i]
                opening = (speed[i] - lid[j - n]) @ normal
            if gap + numerics.time_step * min(opening, 0.0) < numerics.margin:
                assert (i, j) in listed
                met += 1
    assert met > 500
    assert rain or 1 < len(renewed) < 60


def test_poured_layer_is_at_rest_inside_the_box(layer):
    """Penetration below 1 % of the smallest radius under the numerics of the preparation."""
    n = layer.radius.size
    assert np.sqrt((layer.velocity[:n, :3] ** 2).sum(axis=1).mean()) < 1e-3
    inside = (layer.position - layer.radius[:, None] > -1e-5) & (
        layer.position + layer.radius[:, None] < np.array(BOX) + 1e-5
    )
    assert inside.all()
    pairs, gap = layer.contacts(1e-6)
    assert gap.min() > -1e-5
    assert 2.0 < 2 * (pairs < n).all(axis=1).sum() / n < 6.5  # coordination of a frictional packing
    assert layer.top() < 0.5 * BOX[2]
    # mostly the spin of a few loose grains that still roll: 1e-8 to 1e-5 for most seeds
    assert layer.kinetic_energy() < 1e-5 * 9.81 * BOX[2] * (1 / layer.inverse_mass[:n]).sum()
    assert layer.time == pytest.approx(layer.steps * PouringNumerics().time_step)


def test_contacts_are_those_of_brute_force(layer):
    pairs, gap = layer.contacts(1e-4)
    expected = all_pairs(layer.position, layer.radius, layer.plane_point, layer.plane_normal, 1e-4)
    assert [tuple(p) for p in pairs.tolist()] == expected
    for (i, j), g in zip(expected, gap):
        if j < layer.radius.size:
            assert g == pytest.approx(
                np.linalg.norm(layer.position[j] - layer.position[i]) - layer.radius[[i, j]].sum(), abs=1e-17
            )


def test_settling_stops_in_time():
    """At most `longest` seconds, and progress is told in seconds of as many."""
    told = []
    flock = granulate(2)
    settle(flock, PouringNumerics(), 0.0, 0.05, lambda *args: told.append(args), "pouring")
    assert 0.05 <= flock.time < 0.06
    assert told[-1] == ("pouring", 0.05, 0.05)
    assert (np.diff([done for _, done, _ in told]) > 0).all()


def test_vibration_drives_the_lid_as_told(layer):
    """Stroke from crest to crest, half of it above the layer; the lid ends where it began, at rest."""
    shaken = copy(layer)
    top, heights, speeds = shaken.top(), [], []
    advance = shaken.advance

    def watched(numerics, plane_velocity):
        result = advance(numerics, plane_velocity)
        heights.append(shaken.plane_point[5, 2])
        speeds.append(plane_velocity[5, 2])
        return result

    shaken.advance = watched
    numerics = PouringNumerics(time_step=2e-4)
    vibrate(shaken, numerics, stroke=1e-3, frequency=50.0, duration=0.04, progress=silent)
    time = 2e-4 * np.arange(1, len(heights) + 1)
    assert len(heights) == 200
    np.testing.assert_allclose(heights, top + 0.5e-3 * np.cos(2 * np.pi * 50 * time), atol=1e-12)
    assert np.abs(speeds).max() == pytest.approx(0.5e-3 * 2 * np.pi * 50, rel=1e-2)
    assert not shaken.velocity[-1].any()
    np.testing.assert_array_equal(shaken.plane_point[:5], layer.plane_point[:5])
    assert np.abs(shaken.position - layer.position).max() > 1e-5  # the layer felt it


def test_the_same_motion_twice():
    """Same spheres, same numbers to the last bit; another seed differs."""
    numerics, results = PouringNumerics(), []
    for seed in (3, 3, 4):
        flock = granulate(seed)
        for _ in range(150):
            flock.advance(numerics)
        results.append((flock.position.tobytes(), flock.velocity.tobytes(), flock.impulse.tobytes()))
    assert results[0] == results[1] != results[2]


def test_numerics_act(layer):
    """A tighter tolerance takes more sweeps; the margin and skin change the lists, not the physics."""
    sweeps = []
    for numerics in (PouringNumerics(), PouringNumerics(tolerance=1e-6, most_sweeps=600)):
        shaken = copy(layer)
        for _ in range(5):
            shaken.advance(numerics)
        sweeps.append(shaken.sweeps)
    assert sweeps[1] > 2 * sweeps[0]
    positions = []
    for skin in (4e-4, 2e-3):
        shaken = copy(layer)
        shaken._start = None
        for _ in range(20):
            shaken.advance(replace(PouringNumerics(), skin=skin))
        positions.append(shaken.position)
    np.testing.assert_array_equal(*positions)


def test_a_layer_of_more_than_its_sweeps_can_carry_comes_to_rest():
    """Overlaps undone at once, however small, would keep it in motion."""
    few = replace(PouringNumerics(), most_sweeps=4)
    many = np.full(MANY + 1, granulate().radius.min())
    lenient = replace(few, allowed_overlap=PouringNumerics.of(many, 4e-4).allowed_overlap)
    speed = []
    for numerics in few, lenient:
        layer = granulate()
        settle(layer, numerics, REST_SPEED, 1.0, silent, "pouring")
        speed.append(np.sqrt((layer.velocity[: layer.radius.size, :3] ** 2).sum(axis=1).mean()))
    assert speed[1] < REST_SPEED < speed[0]
    assert -layer.contacts(1e-6)[1].min() < 0.01 * layer.radius.min()


def test_the_papers_layer_keeps_the_defaults():
    assert PouringNumerics.of(np.full(14_160, 1e-3), 4e-4) == PouringNumerics()
