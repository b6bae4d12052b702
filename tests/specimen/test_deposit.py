"""Pouring and vibrating: candidates complete, walls respected, energies, determinism of the motion."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from naive.granular import all_pairs

from asphalt_nscd.nscd.spheres.granular import near_pairs
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.specimen import granular_bed as granular_bed
from asphalt_nscd.specimen.deposit import REST_SPEED, PouringHistory, balance, settle, vibrate
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.settings import Pouring, Surfaces, Vibration

BOX = (0.021, 0.016, 0.07)


def silent(*_):
    pass


def granular_layer(seed=1, friction=0.2) -> GranularBed:
    position, radius = random_lattice(
        np.array([2e-3, 3e-3, 5e-3]), np.array([60, 40, 15]), BOX, np.random.default_rng(seed)
    )
    return GranularBed.spheres_in_box(position, radius, BOX, 2600.0, ContactLaw(friction, friction))


@pytest.fixture(scope="module")
def layer():
    """Poured once; copied by those who move it."""
    poured = granular_layer()
    settle(poured, PouringNumerics.of(poured.radius, 4e-4), 1e-3, 2.0, silent, "pouring")
    return poured


def copy(of: GranularBed) -> GranularBed:
    other = granular_layer()
    for name in ("position", "velocity", "plane_point"):
        setattr(other, name, getattr(of, name).copy())
    other._list(of._start, of._other)
    other.impulse = of.impulse
    other._reach = of._reach
    other._plane_reach, other._extra = of._plane_reach, of._extra
    other._searched_at, other._planes_at = of._searched_at.copy(), of._planes_at.copy()
    return other


@pytest.mark.parametrize(("time_step", "rain"), [(1e-4, 0.0), (4e-4, 2.0)])
def test_every_pair_that_may_meet_is_on_the_list(time_step, rain):
    """Fast grains and a moving lid: pairs that come within the margin in a step, by brute force, are
    listed although the list is renewed only now and then, or made short where grains rain [m/s]."""
    flock = granular_layer(4)
    rng = np.random.default_rng(4)
    n, numerics = flock.radius.size, PouringNumerics(time_step=time_step)
    flock.velocity[:n] = rng.normal(0, 0.3, (n, 6))
    flock.velocity[: n // 2, 2] -= rain
    lid = np.zeros((6, 3))
    lid[5, 2] = -0.5
    flock.velocity[n:, :3] = lid
    renewed, met = set(), 0
    for _ in range(60):
        before = flock.position.copy(), flock.plane_point.copy(), flock.velocity[:n, :3].copy()
        flock.advance(numerics)
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


def test_grains_that_rain_at_5_m_s_do_not_enter_each_other():
    """2 mm a step, as far as the smallest grain is wide: none goes through another, and no pair that meets,
    by brute force, was left out. An impact on a grain at rest drives it on within the step."""
    flock = granular_layer(5)
    n, numerics, deepest = flock.radius.size, PouringNumerics.of(flock.radius, 4e-4), 0.0
    settle(flock, numerics, REST_SPEED, 1.0, silent, "pouring")
    high = granular_layer(6)
    flock = GranularBed.spheres_in_box(
        np.concatenate([flock.position, high.position + [0.0, 0.0, 0.02]]),
        np.concatenate([flock.radius, high.radius]),
        (BOX[0], BOX[1], 0.1),
        2600.0,
        ContactLaw(0.2, 0.2),
    )
    flock.velocity[n : 2 * n, 2] = -5.0
    for _ in range(100):
        before = flock.position.copy()
        flock.advance(numerics)
        gap = flock.contacts(0.0)[1].min(initial=0.0)
        listed = near_pairs(
            flock.position,
            flock.radius,
            flock.plane_point,
            flock.plane_normal,
            flock._start,
            flock._other,
            0.0,
        )[2].min(initial=0.0)
        assert gap == pytest.approx(listed, abs=1e-9)
        deepest = max(deepest, -gap)
        for i in range(2 * n):  # nor did two change sides
            between, then = flock.position - flock.position[i], before - before[i]
            near = np.linalg.norm(then, axis=1) < 8e-3
            assert ((between * then).sum(axis=1)[near] >= 0.0).all()
    assert 0.0 < deepest < 0.2 * flock.radius.min()


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
    flock = granular_layer(2)
    settle(flock, PouringNumerics(), 0.0, 0.05, lambda *args: told.append(args), "pouring")
    assert 0.05 <= flock.time < 0.06
    assert told[-1] == ("pouring", 0.05, 0.05)
    assert (np.diff([done for _, done, _ in told]) > 0).all()


def test_rest_is_four_calm_looks_in_a_row():
    """Root mean square of the linear velocities of spheres alone; looks are 5 ms apart."""
    speeds = iter([0.0, 1.3e-3, 1.3e-3, 1.5e-3, 1.3e-3, 0.0, 1.3e-3, 1.3e-3])
    bed = SimpleNamespace(radius=np.ones(2), velocity=np.ones((3, 6)), time=0.0, steps=0)

    def advance(numerics):
        bed.time, bed.steps = bed.time + numerics.time_step, bed.steps + 1
        if bed.steps % 10 == 0:
            bed.velocity[:2, :3] = [[0.0, 0.0, next(speeds)], [0.0] * 3]

    bed.advance = advance
    settle(bed, PouringNumerics(time_step=5e-4), 1e-3, 1.0, silent, "")
    assert bed.steps == 80


def test_numerics_of_a_pouring_are_shares_of_the_smallest_radius():
    """On them rest all published layers."""
    assert PouringNumerics.of(np.array([2e-3, 1e-3]), 3e-4) == PouringNumerics(
        time_step=3e-4, tolerance=2e-3, most_sweeps=300, falling_sweeps=9, penetration=2e-5,
        falling_penetration=1e-4, skin=4e-4, margin=2e-5, recovery_speed=0.02, allowed_overlap=5e-6,
    )  # fmt: skip


def test_energy_weight_and_heights_of_two_spheres():
    position, radius = np.array([[0.0, 0, 0.003], [0, 0, 0.01]]), np.array([2e-3, 1e-3])
    bed = GranularBed.spheres_in_box(position, radius, BOX, 2600.0, ContactLaw())
    mass = 2600.0 * 4 / 3 * np.pi * radius**3
    bed.velocity[:2] = [[1.0, 2.0, 2.0, 0.0, 3.0, 4.0], [0.0, 0.0, -5.0, 1.0, 0.0, 0.0]]
    bed.velocity[2:] = 9.0  # planes do not count
    assert bed.kinetic_energy() == pytest.approx(0.5 * (mass @ [9.0 + 0.4 * 25.0, 25.0 + 0.4]), rel=1e-13)
    assert bed.weight() == pytest.approx(9.81 * mass.sum(), rel=1e-13)
    assert (bed.top(), bed.layer_height()) == pytest.approx((0.011, 2 * (8 * 0.003 + 0.01) / 9), rel=1e-13)


@pytest.mark.parametrize("strong", [1.0, 30.0])
def test_vibration_follows_the_layer_and_forces_no_grain_through_another(layer, strong):
    """In each period the wall rises as far as its stroke says above the layer, comes down on it and pushes
    with no more than its pressure; grains overlap by 10 % of the smallest radius at most, also under 30 layers."""
    shaken = copy(layer)
    area, n = BOX[0] * BOX[1], shaken.radius.size
    vibration = Vibration(1e-3, 50.0, 0.2)
    tops, walls, pushes, touching, mass = [], [], [], [], 0.01 * shaken.weight() / 9.81
    advance = shaken.advance

    def watched(numerics):
        tops.append(shaken.top())
        result = advance(numerics)
        walls.append(shaken.plane_point[5, 2])
        lid = shaken._other == n + 5
        pushes.append(shaken.impulse[lid, 2].sum() / numerics.time_step)
        touching.append(set(shaken.touching_wall().tolist()))
        assert shaken.drive[1] == pytest.approx(strong * shaken.weight() * 2e-4, rel=1e-12)
        assert 1.0 / shaken.inverse_mass[-1] == pytest.approx(mass, rel=1e-12)
        return result

    shaken.advance = watched
    history, numerics = PouringHistory(), PouringNumerics.of(shaken.radius, 2e-4)
    vibrate(shaken, numerics, vibration, strong * shaken.weight() / area, history, silent)
    tops, walls = np.array(tops).reshape(10, 100), np.array(walls).reshape(10, 100)
    periods = [len(set().union(*touching[100 * k : 100 * (k + 1)])) for k in range(10)]
    assert history.touched == periods and min(periods) > 0
    np.testing.assert_allclose(np.diff(history.time), 5e-3, rtol=1e-9)
    np.testing.assert_array_equal(history.wall, walls.ravel()[24::25])
    tenth = tops[:, 0] + 0.5e-3 * np.cos(0.2 * np.pi)
    np.testing.assert_allclose(walls[:, 9], tenth, atol=1e-9)  # it kept up
    assert (walls.min(axis=1) < tops[:, 0]).all()  # and came down on the layer
    assert (np.array([height for height in history.wall]) >= walls.min()).all()
    # all it can give: its drive, and its momentum of a step; a little faster where it catches up with its drive
    most = 1.02 * strong * shaken.weight() + mass * 2 * np.pi * 50.0 * 0.5e-3 / 2e-4
    assert 0.2 * strong * shaken.weight() < np.abs(pushes).max() < most
    assert 0.0 < shaken.overlap < 0.1 * shaken.radius.min()
    assert not shaken.velocity[-1].any() and shaken.inverse_mass[-1] == 0.0
    assert shaken.plane_point[5, 2] == shaken.top() + 0.5e-3
    np.testing.assert_array_equal(shaken.plane_point[:5], layer.plane_point[:5])


def test_a_wall_thrown_at_a_grain_meets_it_within_the_step():
    """From rest, by 2 mm in a step, on a grain that lies 1 mm below: the list of pairs asks what the drive may do."""
    bed = GranularBed.spheres_in_box(
        np.array([[0.01, 0.01, 2e-3]]), np.array([2e-3]), BOX, 2600.0, ContactLaw()
    )
    bed.hang_wall(5e-3, 1e-3)
    bed.drive[:] = -5.0, 5e-3
    bed.advance(PouringNumerics.of(bed.radius, 4e-4))
    assert bed.plane_point[5, 2] == pytest.approx(4e-3, abs=2e-5)


def test_vibrated_layers_sink():
    """By 0.1 mm on average of four; where one lies dense already, it rises by 1 % of the smallest radius at most."""
    sunk = []
    for seed in range(1, 5):
        shaken = granular_layer(seed)
        settle(shaken, PouringNumerics.of(shaken.radius, 4e-4), REST_SPEED, 2.0, silent, "pouring")
        poured = shaken.layer_height()
        numerics, pressure = PouringNumerics.of(shaken.radius, 2e-4), shaken.weight() / (BOX[0] * BOX[1])
        vibrate(shaken, numerics, Vibration(1e-3, 50.0, 0.2), pressure, PouringHistory(), silent)
        sunk.append(poured - shaken.layer_height())
    assert min(sunk) > -1e-5
    assert 2e-5 < np.mean(sunk) < 1e-3


def test_at_rest_forces_balance(layer):
    """Floor and walls carry the weight, no sphere is pushed about; both told from the list of impulses."""
    still, numerics = copy(layer), PouringNumerics.of(layer.radius, 4e-4)
    n = still.radius.size
    told = []
    assert max(balance(still, numerics, 0.3, lambda *said: told.append(said), "settling")) < 5e-4
    assert (
        told[0] == ("settling", pytest.approx(4.8e-3), 0.3) and told[-1][1] < 0.3
    )  # looks are 12 steps apart
    weight, unbalanced = still.imbalance(4e-4)
    force = -9.81 / still.inverse_mass[:n, None] * [0.0, 0.0, 1.0]
    floor, sizes = 0.0, []
    first = np.repeat(np.arange(n), np.diff(still._start))
    for i, j, impulse in zip(first, still._other, still.impulse / 4e-4):
        force[i] -= impulse
        if j < n:
            force[j] += impulse
        else:
            floor -= impulse[2]
        sizes += [np.linalg.norm(impulse)] if impulse.any() else []
    assert weight == pytest.approx(abs(floor / still.weight() - 1.0), rel=1e-6, abs=1e-12)
    assert unbalanced == pytest.approx(np.linalg.norm(force, axis=1).mean() / np.mean(sizes), rel=1e-9)
    still.impulse *= 0.99
    assert still.imbalance(4e-4)[0] == pytest.approx(0.01, rel=0.1)


def test_rain_that_is_not_searched_falls_the_same():
    """To 1e-9 m, which is what sweeps to 1e-10 leave, far into the pile; and far grains are left out."""
    both = granular_layer(5), granular_layer(5)
    both[1].let_fall()
    numerics, involved = PouringNumerics(time_step=2e-4, tolerance=1e-10, most_sweeps=3000), []
    for _ in range(250):
        for flock in both:
            flock.advance(numerics)
        involved.append(both[1]._involved)
    np.testing.assert_allclose(both[1].position, both[0].position, rtol=0, atol=1e-9)
    landed = both[1].velocity[: both[1].radius.size, 2] != both[1].velocity[both[1].radius.size - 1, 2]
    assert landed.sum() > 30
    assert involved[0] < involved[125] < involved[-1]
    assert involved[0] < 0.5 * both[0].radius.size
    assert (np.diff(involved) >= 0).all()


def one_slab(team, position, start, other, last_body):
    """In place of slabs_of: the order of visits does not hang on how long the list is."""
    first, pair = (
        np.repeat(np.arange(start.size - 1), np.diff(start)),
        np.argsort(other == last_body, kind="stable"),
    )
    begin = np.array([0, (other != last_body).sum(), other.size])
    bodies = np.stack([first[pair], other[pair]], axis=1)
    return begin, pair.astype(np.int32), bodies.astype(np.int32)


def test_numerics_act(layer, monkeypatch):
    """A tighter tolerance takes more sweeps; the margin and skin change the lists, not the physics."""
    sweeps = []
    for numerics in (PouringNumerics(), PouringNumerics(tolerance=1e-6, most_sweeps=600)):
        shaken = copy(layer)
        for _ in range(5):
            shaken.advance(numerics)
        sweeps.append(shaken.sweeps)
    assert sweeps[1] > 2 * sweeps[0]
    positions = []
    monkeypatch.setattr(granular_bed, "slabs_of", one_slab)
    for skin in (4e-4, 2e-3):
        shaken = copy(layer)
        shaken._start = None
        for _ in range(20):
            shaken.advance(replace(PouringNumerics(), skin=skin))
        positions.append(shaken.position)
    np.testing.assert_array_equal(*positions)


def test_a_layer_of_more_than_its_sweeps_can_carry_comes_to_rest():
    """Overlaps undone at once, however small, would keep it in motion."""
    few = PouringNumerics(most_sweeps=3)
    lenient = replace(few, allowed_overlap=PouringNumerics.of(granular_layer().radius, 4e-4).allowed_overlap)
    speed = []
    for numerics in few, lenient:
        layer = granular_layer()
        settle(layer, numerics, REST_SPEED, 1.0, silent, "pouring")
        speed.append(np.sqrt((layer.velocity[: layer.radius.size, :3] ** 2).sum(axis=1).mean()))
    assert speed[1] < REST_SPEED < speed[0]
    assert -layer.contacts(1e-6)[1].min() < 0.01 * layer.radius.min()


def test_who_states_nothing_pours_as_these_tests_and_shakes_as_the_paper():
    """Its CPU time and its overlaps stand in docs/benchmarks.md."""
    assert Pouring(BOX) == Pouring(BOX, 0, Surfaces(0.2, None, 0.0, 0.0), Vibration(6e-3, 30.0, 1.0), 4e-4, 1)


@pytest.mark.parametrize("spheres", [500, 14_160, 200_000])
def test_one_rule_for_overlaps_at_every_size(spheres):
    radius = np.full(spheres, 2e-3)
    radius[0] = 1e-3
    assert PouringNumerics.of(radius, 4e-4).allowed_overlap == pytest.approx(5e-6)


def test_fixed_spheres_stay_and_bear_a_third():
    """Two of no inverse mass that overlap are no contact: 1/0 made NaN of every motion."""
    radius = np.full(3, 4e-3)
    position = np.array([[0.012, 0.012, 0.004], [0.0195, 0.012, 0.004], [0.01575, 0.012, 0.0115]])
    bed = GranularBed.spheres_in_box(position, radius, (0.03, 0.03, 0.03), 2600.0, ContactLaw(0.5, 0.5))
    bed.inverse_mass[:2] = 0.0
    numerics = PouringNumerics.of(radius, 4e-4)
    for _ in range(200):
        bed.advance(numerics)
    np.testing.assert_array_equal(bed.position[:2], position[:2])
    assert bed.position[2, 2] == pytest.approx(0.004 + np.sqrt(0.008**2 - 0.00375**2), abs=1e-4)
    assert np.abs(bed.velocity).max() < 1e-3


@pytest.mark.parametrize("size", [3.9e-3, 4e-3, 4.1e-3])
def test_a_fixed_sphere_is_a_part_of_the_walls(size):
    """On rough walls a smooth sphere rolls off it, whichever comes first in the pair: (7/10) m v^2."""
    radius, apart = np.array([4e-3, size]), (4e-3 + size) * np.array([np.sin(0.3), 0.0, np.cos(0.3)])
    bed = GranularBed.spheres_in_box(
        0.02 + np.array([0.0 * apart, apart]), radius, (0.04,) * 3, 2600.0, ContactLaw(0.0, 1.0)
    )
    bed.inverse_mass[0] = 0.0
    for _ in range(200):
        bed.advance(PouringNumerics.of(radius, 4e-5))
    speed, spin = np.linalg.norm(bed.velocity[1, :3]), np.linalg.norm(bed.velocity[1, 3:])
    assert spin == pytest.approx(speed, rel=1e-3) and speed > 0.01
    assert bed.kinetic_energy() == pytest.approx(0.7 * speed**2 / bed.inverse_mass[1], rel=1e-3)
