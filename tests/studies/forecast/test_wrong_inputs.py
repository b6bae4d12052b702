"""Which input of a recipe is wrong: each is named from the forecast's own changes, and nothing from scatter."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from forecast import wrong_inputs
from forecast.wrong_inputs import (
    along_reference,
    changed,
    changes_of,
    densities,
    find,
    limits,
    read_ratio,
)


@pytest.fixture(scope="module")
def changes(recipe, networks):
    return changes_of(recipe, networks)


def test_densities_by_hand(recipe):
    maximum = 100.0 / (5.4 / 1040.0 + 94.6 / 2670.0)
    assert densities(recipe) == pytest.approx([0.94 * maximum, maximum], rel=1e-12)


@pytest.mark.slow
def test_more_air_and_more_binder_soften_and_a_stiffer_binder_stiffens(changes):
    signs = {"air voids": -1, "binder content": -1, "binder stiffness": 1, "dry contacts": 1}
    for name, sign in signs.items():
        up = changes.log[name][changes.size[name] > 0.0]
        assert (sign * up.real > 0.0).all(), name
    assert (changes.density["air voids"][-1] < [0.0, 1e-12]).all()


# Densities say how much voids and binder are off. Nothing does for the others, whose change may be off by all of itself
# (SHAPE = 1): s c is then likeliest to be a change c at s = 1/2, where 2 ln s + (1/s - 1)^2 / 2 is least.
SHARE_FOUND = {"air voids": 0.96, "binder content": 0.95, "binder stiffness": 0.5, "dry contacts": 0.5}


@pytest.mark.parametrize("name", wrong_inputs.SIZES)
def test_a_large_error_is_named_with_its_sign_and_its_size_as_far_as_its_shape_is_sure(changes, name):
    found = find(changes, changes.log[name][-1], changes.density[name][-1])
    assert found.inputs[0] == name
    assert found.size[name] == pytest.approx(SHARE_FOUND[name] * changes.size[name][-1], rel=0.06)


def test_densities_tell_voids_from_binder(changes):
    k = np.flatnonzero(changes.size["air voids"] > 0.02)[0]
    ratio = changes.log["air voids"][k]
    assert find(changes, ratio, changes.density["air voids"][k]).inputs == ("air voids",)
    assert find(changes, ratio).inputs != ("air voids",)


def other_mix(omega):
    """ln E* of a mix that is not the forecast's: a skeleton beside a power law that bends."""
    return np.log(3e7 + 4e9 / (1 + 0.5 * (1j * omega) ** -0.4 + 0.02 * (1j * omega) ** -0.9))


@pytest.fixture(scope="module")
def many(recipe, networks):
    points = replace(recipe, frequency=np.geomspace(1e-4, 50, 20), temperature=np.full(20, 15.0))
    return changes_of(points, networks)


@pytest.mark.slow
@pytest.mark.parametrize("decades", [0.6, -0.45])
def test_a_stiffer_binder_moves_a_mix_along_its_own_curve(many, decades):
    """Whatever the mix: named alone; its size as far as its shape is sure, which is more than by the forecast."""
    reference = other_mix(many.omega)
    ratio = other_mix(many.omega * 10**decades) - reference
    found = find(along_reference(many, reference), ratio, np.zeros(2))
    assert found.inputs == ("binder stiffness",)
    assert found.size["binder stiffness"] == pytest.approx(0.7 * decades, abs=0.0375)  # half a step of FINE


def test_a_stiffer_skeleton_is_no_stiffer_binder(many):
    """Named alone with densities; without them no input but the binder's stiffness is."""
    reference = other_mix(many.omega)
    own = along_reference(many, reference)
    ratio = np.log(np.exp(reference) + 6e7) - reference
    assert find(own, ratio, np.zeros(2)).inputs == ("dry contacts",)
    assert set(find(own, ratio).inputs) == {"dry contacts", "air voids", "binder content"}


def test_nothing_is_named_where_only_the_level_differs(changes):
    ratio = np.full(changes.omega.size, 0.06 + 0.005j)
    assert find(changes, ratio).inputs == ()


def test_half_a_limit_is_not_noticed(changes):
    for name, limit in limits(changes, weighed=True).items():
        if np.isfinite(limit):
            k = int(np.abs(changes.size[name] - 0.2 * limit).argmin())
            assert find(changes, changes.log[name][k], changes.density[name][k]).inputs == (), name


def test_tables_are_compared_where_both_have_points(tmp_path, recipe):
    rows = {
        "temperature_C": [15] * 4,
        "frequency_Hz": [1, 2, 4, 8],
        "E_MPa": [1e3, 2e3, 3e3, 4e3],
        "phase_deg": 20,
    }
    pd.DataFrame(rows).to_csv(tmp_path / "one.csv", index=False)
    pd.DataFrame(rows | {"E_MPa": 1e3, "phase_deg": 15}).iloc[1:].to_csv(tmp_path / "two.csv", index=False)
    asked, ratio, known = read_ratio(tmp_path / "one.csv", tmp_path / "two.csv", recipe)
    assert asked.frequency.tolist() == [2, 4, 8]
    assert np.exp(ratio.real) == pytest.approx([2, 3, 4])
    assert np.degrees(ratio.imag) == pytest.approx(5.0)
    assert np.exp(known.real) == pytest.approx([1e3] * 3) and np.degrees(known.imag) == pytest.approx(15.0)
    with pytest.raises(InputError, match="one.csv: temperature_C differs from 30 degC.*add binder.shift"):
        law = replace(recipe.binder, shift=replace(recipe.binder.shift, reference_temperature=30.0))
        read_ratio(tmp_path / "one.csv", tmp_path / "two.csv", replace(recipe, binder=law))
    pd.DataFrame(rows).iloc[:2].to_csv(tmp_path / "two.csv", index=False)
    with pytest.raises(InputError, match="shares 2 points"):
        read_ratio(tmp_path / "one.csv", tmp_path / "two.csv", recipe)


def test_the_recipe_changes_by_what_is_named(recipe):
    assert changed(recipe, "air voids", 0.01).voids == pytest.approx(0.07)
    assert changed(recipe, "binder content", 0.01).binder_share == pytest.approx(0.064)
    assert changed(recipe, "dry contacts", 1.0) == recipe
