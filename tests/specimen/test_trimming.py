"""From the layer to the specimen."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.specimen.trimming import layer_height, trim

GEOMETRY = Geometry(b=10e-3, B=20e-3, e=10e-3, h=60e-3, mass=0.02, mobile_mass=0.008)
BOX = np.array([60e-3, 10e-3, 26.4e-3])
REDUCTION, REACH = 0.1, 2e-3


@pytest.fixture()
def layer():
    """A jittered lattice as long and wide as the specimen and 26 mm high; (position, radius)."""
    rng = np.random.default_rng(2)
    cells = np.stack(np.meshgrid(np.arange(18), np.arange(3), np.arange(8), indexing="ij"), -1).reshape(-1, 3)
    radius = rng.uniform(1.2e-3, 1.6e-3, len(cells))
    pitch = BOX / [18, 3, 8]
    return pitch * (cells + 0.5) + rng.uniform(-5e-5, 5e-5, cells.shape), radius


def test_height_of_a_layer_is_twice_that_of_its_centre_of_mass():
    position, radius = np.array([[0, 0, 1.0], [0, 0, 2.0]]), np.array([1.0, 2.0])
    assert layer_height(position, radius) == pytest.approx(2 * (1 + 8 * 2) / 9, rel=1e-14)


def test_specimen_is_the_upright_trapezoid(layer):
    """Length of the layer becomes height, its height becomes the bending direction; nobody is outside,
    and whoever is inside and held by three bonds is there."""
    position, radius = layer
    specimen = trim(position, radius, GEOMETRY, REDUCTION, REACH)
    x, y, z = specimen.position.T
    width = GEOMETRY.B + (GEOMETRY.b - GEOMETRY.B) * z / GEOMETRY.h
    assert (np.abs(x) <= width / 2).all() and (np.abs(y) <= GEOMETRY.e / 2).all()
    assert (z >= 0).all() and (z <= GEOMETRY.h).all()
    assert np.abs(x[z < 5e-3]).max() > 1.5 * np.abs(x[z > 55e-3]).max()  # wide foot, narrow head

    middle = layer_height(position, radius) / 2
    half = 0.5 * (GEOMETRY.B + (GEOMETRY.b - GEOMETRY.B) * position[:, 0] / GEOMETRY.h)
    inside = np.abs(position[:, 2] - middle) <= half
    assert inside.sum() == specimen.radius.size + specimen.loose_grains
    original = np.stack([position[:, 2] - middle, position[:, 1] - GEOMETRY.e / 2, position[:, 0]], axis=1)
    distance = np.abs(specimen.position[:, None] - original[inside]).max(axis=2).min(axis=1)
    assert distance.max() < 1e-16
    bonds = np.bincount(np.concatenate([specimen.network.first, specimen.network.second]))[: x.size]
    assert bonds.min() >= 3


def test_volume_and_mass(layer):
    position, radius = layer
    specimen = trim(position, radius, GEOMETRY, REDUCTION, REACH)
    middle = layer_height(position, radius) / 2
    of = {tuple(np.round(p, 12)): r for p, r in zip(position, radius)}
    for p, r in zip(specimen.position, specimen.radius):
        before = of[tuple(np.round([p[2], p[1] + GEOMETRY.e / 2, p[0] + middle], 12))]
        assert r**3 == pytest.approx(0.9 * before**3, rel=1e-13)
    volume = (4 / 3 * np.pi * specimen.radius**3).sum()
    assert specimen.density * volume == pytest.approx(GEOMETRY.mass, rel=1e-14)


@pytest.fixture()
def hollow(layer):
    """The layer with a hole of 5 mm radius in its middle: (position, radius, centre of the hole)."""
    position, radius = layer
    centre = np.array([30e-3, 5e-3, layer_height(position, radius) / 2])
    far = np.linalg.norm(position - centre, axis=1) > 5e-3
    return position[far], radius[far], centre


def test_a_cluster_that_touches_nobody_is_removed(hollow):
    """Four small grains in the hole, bonded to each other by three bonds each but to nobody else."""
    position, radius, centre = hollow
    corners = 5e-4 * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    filled = np.concatenate([position, centre + corners]), np.append(radius, np.full(4, 3e-4))
    without, specimen = (trim(*of, GEOMETRY, REDUCTION, REACH) for of in ((position, radius), filled))
    assert specimen.radius.size == without.radius.size
    assert specimen.loose_grains == without.loose_grains + 4


@pytest.mark.parametrize(("bonds", "kept"), [(1, False), (2, False), (3, True)])
def test_a_grain_needs_three_bonds(hollow, bonds, kept):
    """A small grain in the hole where it reaches just so many of those around."""
    position, radius, centre = hollow
    small = 2e-4
    for place in centre + np.random.default_rng(bonds).uniform(-4e-3, 4e-3, (5000, 3)):
        gap = np.linalg.norm(position - place, axis=1) - 0.9 ** (1 / 3) * (radius + small)
        if (gap < REACH - 1e-5).sum() == bonds == (gap < REACH + 1e-5).sum() and gap.min() > 1e-4:
            break
    else:
        pytest.fail("no such place")
    filled = np.concatenate([position, [place]]), np.append(radius, small)
    without, specimen = (trim(*of, GEOMETRY, REDUCTION, REACH) for of in ((position, radius), filled))
    assert specimen.radius.size == without.radius.size + kept
    assert specimen.loose_grains == without.loose_grains + (not kept)


def test_a_wider_box_is_cut_to_the_thickness(layer):
    position, radius = layer
    outside = position[:60] + [0, 10e-3, 0]
    specimen = trim(
        np.concatenate([position, outside]), np.append(radius, radius[:60]), GEOMETRY, REDUCTION, REACH
    )
    assert np.abs(specimen.position[:, 1]).max() <= GEOMETRY.e / 2


def test_a_layer_just_as_high_as_the_foot_is_wide_is_enough():
    """Rounding of the mean of heights takes some 1e-17 m off a lattice of four layers of 5 mm."""
    cells = np.stack(np.meshgrid(np.arange(20), np.arange(4), np.arange(4), indexing="ij"), -1).reshape(-1, 3)
    position, radius = 5e-3 * (cells + 0.5), np.full(len(cells), 2.5e-3)
    assert layer_height(position, radius) == pytest.approx(20e-3, rel=1e-12)
    for foot, enough in ((20e-3, True), (20e-3 * (1.0 + 1e-12), True), (20e-3 * (1.0 + 1e-6), False)):
        geometry = Geometry(b=foot, B=foot, e=20e-3, h=100e-3, mass=0.1, mobile_mass=0.0)
        if enough:
            assert trim(position, radius, geometry, REDUCTION, REACH).radius.size == len(cells)
        else:
            with pytest.raises(InputError, match="the deposited layer is 20.0 mm high"):
                trim(position, radius, geometry, REDUCTION, REACH)
