"""From a table of counts to a specimen file: one short pour, cut and read back."""

from __future__ import annotations

import numpy as np
import pytest
from naive.granular import all_pairs

import asphalt_nscd as an
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.geometry import read_shape
from asphalt_nscd.specimen import preparation, settings
from asphalt_nscd.specimen.cutting import bonded, read_specimen, trim_deposit
from asphalt_nscd.specimen.preparation import deposit, layer_statistics, pour_on
from asphalt_nscd.specimen.settings import Cutting, Pouring, Surfaces, Vibration
from asphalt_nscd.specimen.trimming import layer_height

BOX = (0.06, 0.01, 0.14)
GEOMETRY = {"b_mm": 8, "B_mm": 14, "e_mm": 10, "h_mm": 60, "mass_kg": 0.014, "mobile_mass_kg": 0.005}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("preparation")
    (folder / "counts.csv").write_text("diameter_mm,count\n2,300\n3,160\n4,70\n")
    return folder


def pour(folder, name, seed, told=None):
    deposit(
        folder / "counts.csv",
        Pouring(BOX, seed, vibration=Vibration(1e-3, 30.0, 0.05)),
        folder / name,
        lambda *args: told.append(args) if told is not None else None,
    )
    return load(folder / name, "deposit")


@pytest.fixture(scope="module")
def told():
    return []


@pytest.fixture(scope="module")
def poured(folder, told):
    return pour(folder, "deposit.h5", 1, told)


def test_what_was_poured(poured, told):
    arrays, attributes = poured.arrays, poured.attributes
    position, radius = arrays["position"], arrays["radius"]
    assert [(radius == size).sum() for size in (1e-3, 1.5e-3, 2e-3)] == [300, 160, 70]
    inside = (position > radius[:, None] - 2e-5) & (position < np.array(BOX) - radius[:, None] + 2e-5)
    assert inside.all()
    np.testing.assert_array_equal(arrays["box"], BOX)
    assert attributes["spheres"] == 530 and attributes["seed"] == 1
    assert attributes["layer_height_m"] == pytest.approx(layer_height(position, radius), rel=1e-14)
    assert attributes["highest_point_m"] == pytest.approx((position[:, 2] + radius).max(), rel=1e-14)
    touching = all_pairs(position, radius, np.empty((0, 3)), np.empty((0, 3)), 1e-6)
    assert attributes["coordination"] == 2 * len(touching) / 530 > 2.5
    volume = BOX[0] * BOX[1] * attributes["layer_height_m"]
    solid = (4 / 3 * np.pi * radius**3).sum()
    assert attributes["solid_fraction"] == pytest.approx(solid / volume, rel=1e-13) and solid > 0.45 * volume
    stated = {
        "friction": 0.2, "wall_friction": 0.2, "restitution": 0.0, "stroke_m": 1e-3, "vibration_Hz": 30.0,
        "vibration_s": 0.05, "time_step": 4e-4, "wall_pressure_Pa": 2600.0 * 9.81 * solid / (BOX[0] * BOX[1]),
    }  # fmt: skip
    assert {name: attributes[name] for name in stated} == pytest.approx(stated, rel=1e-12)
    assert "rolling_friction" not in attributes and attributes["largest_overlap_moving_m"] > 0.0
    assert 0.0 <= attributes["largest_overlap_m"] < 2e-5
    assert attributes["weight_balance"] < 1e-3 and attributes["unbalanced_force"] < 1e-3
    assert attributes["poured_weight_balance"] < 1e-3 and attributes["poured_unbalanced_force"] < 1e-3
    assert attributes["periods"] == attributes["periods_with_contact"] == 2  # one and a half
    assert attributes["grains_touched_per_period"] == arrays["course/touched"].mean() > 0.0
    assert attributes["poured_periods"] == 0
    time, height = arrays["course/time"], arrays["course/height"]
    assert (np.diff(time) > 0.0).all()
    assert (height[0], height[-1]) == (attributes["poured_layer_height_m"], attributes["layer_height_m"])
    assert np.isnan(arrays["course/wall"][[0, -1]]).all()
    assert attributes["kinetic_energy_J"] < 2.5e-8  # 50 g at 1 mm/s
    assert arrays["initial_position"][:, 2].max() > 3 * position[:, 2].max()  # it has come down
    assert np.abs(arrays["poured_position"] - position).max() > 1e-5  # and was shaken
    assert attributes["poured_layer_height_m"] == pytest.approx(
        layer_height(arrays["poured_position"], radius), rel=1e-14
    )
    assert {stage for stage, *_ in told} == {"pouring", "settling", "vibrating", "coming to rest"}


def test_a_seed_stands_for_one_deposit(folder, poured):
    """To the last bit; another seed gives another packing."""
    again, other = pour(folder, "again.h5", 1), pour(folder, "other.h5", 2)
    assert again.arrays.keys() == poured.arrays.keys()
    for name, value in poured.arrays.items():
        assert again.arrays[name].tobytes() == value.tobytes()
    timeless = [record.attributes for record in (poured, again)]
    assert timeless[0] == timeless[1]
    assert other.arrays["position"].tobytes() != poured.arrays["position"].tobytes()


def test_specimen_from_deposit(folder, poured):
    trim_deposit(folder / "deposit.h5", GEOMETRY, Cutting(), folder / "specimen.h5")
    specimen, record = read_specimen(folder / "specimen.h5"), load(folder / "specimen.h5", "specimen")
    assert specimen.geometry.h == pytest.approx(0.06) and specimen.geometry.mobile_mass == 0.005
    assert specimen.density * (4 / 3 * np.pi * specimen.radius**3).sum() == pytest.approx(0.014, rel=1e-13)
    attributes = record.attributes
    assert attributes["spheres"] == specimen.radius.size > 100
    assert attributes["bonds"] == specimen.network.first.size > 3 * specimen.radius.size
    assert attributes["smallest_gap_m"] == specimen.network.gap.min() > 0.0
    assert attributes["gap_max_m"] == 2e-3 > specimen.network.gap.max()
    assert (attributes["volume_reduction"], attributes["area"]) == (0.1, "paper")
    for name in ("seed", "layer_height_m", "solid_fraction"):
        assert attributes[name] == poured.attributes[name]
    assert attributes["loose_grains"] == specimen.loose_grains
    network = specimen.network
    for name, value in network.arrays().items():
        assert record.arrays[f"network/{name}"].tobytes() == value.tobytes()
    # indices survive as integers
    assert network.first.dtype.kind == "i" and specimen.position.shape == (specimen.radius.size, 3)


def test_statistics_of_a_made_up_layer():
    """Four spheres on the floor, one large one above them."""
    radius = np.array([1.0, 1, 1, 1, 2])
    position = np.array([[1.0, 1, 1], [3, 1, 1], [1, 3, 1], [3, 3, 1], [2, 2, 3]])
    contacts = np.array([[0, 1], [0, 2], [0, 7], [3, 7], [4, 3]])  # two with the floor
    found = layer_statistics(position, radius, (4.0, 4.0, 9.0), contacts)
    height = 2 * (4 * 1 + 8 * 3) / 12
    assert found["layer_height_m"] == pytest.approx(height)
    assert found["solid_fraction"] == pytest.approx(4 / 3 * np.pi * 12 / (16 * height))
    assert found["coordination"] == pytest.approx(2 * 3 / 5)
    assert found["segregation"] == pytest.approx(2 / height)


def test_two_threads_pour_the_same_layer(monkeypatch):
    monkeypatch.setattr(settings, "cores", lambda: 2)
    spheres, shaken = (np.array([2e-3, 4e-3]), np.array([120, 20])), Vibration(1e-3, 30.0, 0.02)
    one, two = (
        preparation.pour(spheres, Pouring(BOX, 1, vibration=shaken, threads=threads)) for threads in (1, 2)
    )
    for name, array in one[0].items():
        np.testing.assert_array_equal(array, two[0][name])
    assert one[1] == two[1]


def test_forces_of_contacts_push_and_bear_the_layer(poured):
    arrays = poured.arrays
    bodies, force, position = arrays["contacts/bodies"], arrays["contacts/force"], arrays["position"]
    n = arrays["radius"].size
    weight = 2600.0 * 9.81 * 4.0 / 3.0 * np.pi * arrays["radius"] ** 3
    assert -force[bodies[:, 1] >= n].sum(axis=0)[2] == pytest.approx(weight.sum(), rel=0.01)
    between = bodies[:, 1] < n
    apart = position[bodies[between, 1]] - position[bodies[between, 0]]
    assert ((apart * force[between]).sum(axis=1) > 0.0).all()
    resultant = np.zeros((n, 3))
    np.add.at(resultant, bodies[:, 0], -force)
    np.add.at(resultant, bodies[between, 1], force[between])
    resultant[:, 2] -= weight
    assert np.linalg.norm(resultant, axis=1).mean() < 0.01 * np.linalg.norm(force, axis=1).mean()


def test_a_layer_at_rest_that_is_poured_on_stays_where_it_is(folder, poured):
    still = Pouring(BOX, vibration=Vibration(duration=0.0))
    deposit(folder / "deposit.h5", still, folder / "again.h5")
    again = load(folder / "again.h5", "deposit")
    assert np.array_equal(again.arrays["initial_position"], poured.arrays["position"])
    moved = np.linalg.norm(again.arrays["position"] - poured.arrays["position"], axis=1)
    assert np.median(moved) < 1e-5  # a loose grain may roll
    assert again.attributes["layer_height_m"] == pytest.approx(poured.attributes["layer_height_m"], rel=1e-3)
    position, radius = poured.arrays["position"], poured.arrays["radius"]
    within = (float(position[:, 0].max()) + 1e-6, *BOX[1:])  # of all centres, but not of the spheres
    for box in ((0.03, 0.01, 0.14), within, (*BOX[:2], float(position[:, 2].max()))):
        with pytest.raises(InputError, match="spheres of the packing lie outside"):
            deposit(folder / "deposit.h5", Pouring(box), folder / "again.h5")
    beside = np.array([[0.02, 0.005, 0.02], [0.001 - 1.5e-3 * preparation.DEEP, 0.005, 0.02]])
    with pytest.raises(
        InputError, match="spheres of the packing lie outside"
    ):  # by more than a small one may
        preparation.pour_on(beside, np.array([4e-3, 1e-3]), still)
    position = np.where(np.arange(radius.size)[:, None] == 3, np.nan, position)
    with pytest.raises(InputError, match="sphere 4 is not finite"):
        preparation.pour_on(position, radius, still)


def test_a_sphere_that_rebounds_rests_later_by_what_theory_says():
    """From a height h it bounces for t (1 + e)/(1 - e), t = sqrt(2 h/g), instead of t."""
    height, taken = 0.02, []
    for restitution in (0.0, 0.5):
        surfaces = Surfaces(restitution=restitution)
        pouring = Pouring((0.01, 0.01, 0.1), surfaces=surfaces, vibration=Vibration(duration=0.0))
        start = np.array([[0.005, 0.005, 2e-3 + height]]), np.array([2e-3])
        _, said = preparation.pour_on(*start, pouring)
        taken.append(said["steps"] * said["time_step"])
    assert taken[1] - taken[0] == pytest.approx(2.0 * np.sqrt(2.0 * height / 9.81), abs=0.011)


def test_a_layer_that_is_not_at_rest_is_told_and_grains_within_each_other_are_refused(monkeypatch):
    still = {"weight_balance": 0.0099, "unbalanced_force": 0.0099}
    assert preparation.unrest(still) == ""
    said = [preparation.unrest(still | {name: 0.023}) for name in still]
    assert "differs by 2.3% from its weight" in said[0] and "bear 2.3% of a contact force" in said[1]
    stage = {"largest_overlap_m": 0.0}
    monkeypatch.setattr(preparation, "_stage", lambda *_: stage)
    start, rest = (np.array([[0.03, 0.005, 2e-3]]), np.array([2e-3])), Vibration(duration=0.0)
    stage["largest_overlap_m"] = 0.99e-4
    pour_on(*start, Pouring(BOX, vibration=rest))
    stage["largest_overlap_m"] = 1.01e-4
    with pytest.raises(InputError, match="grains overlap by 0.1 mm at rest"):
        pour_on(*start, Pouring(BOX, vibration=rest))


def test_smooth_walls_bear_a_layer_from_below_alone():
    """Between grains as rough as ever: the sides push, and hold nothing up. Rough walls hold up a part of it."""
    spheres, borne = (np.array([2e-3, 4e-3]), np.array([400, 60])), []
    for wall_friction in (0.0, None):
        surfaces = Surfaces(0.3, wall_friction)
        arrays, said = preparation.pour(spheres, Pouring(BOX, 1, surfaces, vibration=Vibration(duration=0.0)))
        assert said["wall_friction"] == (0.3 if wall_friction is None else 0.0)
        n, bodies, force = arrays["radius"].size, arrays["contacts/bodies"], arrays["contacts/force"]
        side = np.isin(bodies[:, 1], [n, n + 1, n + 3, n + 4])
        along = np.linalg.norm(force[side], axis=1) - np.abs(force[side][:, :2]).max(axis=1)
        assert (along.max() > 0.0) == (wall_friction is None)
        between = bodies[:, 1] < n
        apart = arrays["position"][bodies[between, 1]] - arrays["position"][bodies[between, 0]]
        normal = (apart * force[between]).sum(axis=1) / np.linalg.norm(apart, axis=1)
        assert (np.linalg.norm(force[between], axis=1) > 1.01 * normal).any()  # grains rub as ever
        borne.append(-force[side][:, 2].sum() / -force[bodies[:, 1] >= n][:, 2].sum())
    assert abs(borne[0]) < 1e-12 and borne[1] > 1e-3


GRID = np.indices((8, 4, 4)).reshape(3, -1).T * 7e-3 + 4e-3
BOX_OF_GRID = np.array([0.07, 0.03, 0.03])


@pytest.mark.parametrize(
    "wrong, said",
    [
        ({"radius": np.where(np.arange(128) == 4, -3e-3, 3e-3)}, "sphere 5 has a radius of zero or less"),
        ({"radius": np.zeros(128)}, "sphere 1 has a radius of zero or less"),
        ({"radius": np.full(127, 3e-3)}, r"positions \(128, 3\) and radii \(127,\); give numbers x, y, z"),
        ({"position": GRID[:, :2]}, r"positions \(128, 2\) and radii \(128,\)"),
        ({"position": np.where(GRID == GRID[7], np.nan, GRID)}, "sphere 1 is not finite"),
        ({"position": np.empty((0, 3)), "radius": np.empty(0)}, "holds no sphere"),
        ({"radius": np.array(["3 mm"] * 128)}, "give numbers x, y, z"),
        ({"box": np.array([0.07, 0.03])}, "give length, width and height"),
    ],
)
def test_arrays_that_are_no_spheres_are_refused_wherever_they_enter(wrong, said):
    """A radius below zero had the search write outside of its arrays: the process ended."""
    arrays = {"position": GRID, "radius": np.full(128, 3e-3), "box": BOX_OF_GRID} | wrong
    with pytest.raises(InputError, match=said):
        an.Packing(arrays, {})
    if "box" not in wrong:
        with pytest.raises(InputError, match=said):
            pour_on(arrays["position"], arrays["radius"], Pouring(tuple(BOX_OF_GRID)))
        with pytest.raises(InputError, match=said):
            bonded((arrays, {}), read_shape(GEOMETRY | {"h_mm": 50}), Cutting())
    with pytest.raises(InputError, match="no array 'radius'"):
        an.Packing({"position": GRID, "box": BOX_OF_GRID}, {})
