"""Other readings of the bonds, against dense matrices and distances taken one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.measurements.twopoint import Geometry, form_factor
from asphalt_nscd.specimen.network import Network, bond_network
from asphalt_nscd.specimen.prism import static_ratio
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen
from studies.paper.other_bonds import (
    crossing,
    farther_plates,
    ratio_without_moments,
    with_mean_radius,
)


def test_without_moments_nothing_turns(beam):
    """The same as bodies that a stiff spring keeps from turning, whose arms are there and do nothing."""
    system = bending_system(beam, 0.35, np.inf, 0.0)
    stiffness = system.stiffness().toarray()
    turns = np.flatnonzero(np.arange(system.mass.size) % 6 >= 3)
    stiffness[turns, turns] += 1e9 * stiffness.max()
    compliance = np.linalg.inv(stiffness)[system.driven, system.driven]
    expected = form_factor(beam.geometry) / compliance
    assert ratio_without_moments(beam, 0.35) == pytest.approx(expected, rel=1e-6)
    assert expected > 2.0 * static_ratio(system, beam.geometry)


def test_bond_through_a_third_sphere(beam):
    """Three spheres in a row: the bond of the outer two passes through the middle one until that stands aside."""
    for aside, passes in ((0.0, True), (0.9e-3, True), (1.1e-3, False)):
        position = np.array([[0.0, 0.0, 3e-3], [aside, 0.0, 6e-3], [0.0, 0.0, 9e-3]])
        radius = np.full(3, 1e-3)
        network = bond_network(position, radius, 1.0, 5e-3)
        row = replace(beam, position=position, radius=radius, network=network)
        between = np.maximum(network.first, network.second) < 3
        outer = (network.first[between] != 1) & (network.second[between] != 1)
        assert outer.sum() == 1
        assert (crossing(row) == (outer & passes)).all()


def test_crossings_of_a_beam_one_by_one(beam):
    n, network = beam.radius.size, beam.network
    expected = []
    for i, j in zip(network.first, network.second, strict=True):
        if max(i, j) >= n:
            continue
        a, b = beam.position[i], beam.position[j]
        points = a + np.linspace(0.0, 1.0, 2001)[:, None] * (b - a)
        others = [k for k in range(n) if k not in (i, j)]
        expected.append(
            any((np.linalg.norm(points - beam.position[k], axis=1) < beam.radius[k]).any() for k in others)
        )
    assert crossing(beam).tolist() == expected


def tiny_specimen():
    """Two spheres of 1 and 3 mm, the larger bonded to the foot (body 3)."""
    geometry = Geometry(b=0.01, B=0.01, e=0.01, h=0.02, mass=1.0, mobile_mass=0.0)
    rows = {
        "first": np.array([0, 3]),
        "second": np.array([1, 1]),
        "frame": np.tile(np.eye(3), (2, 1, 1)),
        "point": np.zeros((2, 3)),
        "gap": np.array([1e-4, 1e-4]),
        "length": np.array([4.1e-3, 3.1e-3]),
        "area": np.pi * np.array([1e-3, 3e-3]) ** 2,
        "cell": np.empty(0),
    }
    position = np.array([[0.0, 0.0, 7e-3], [0.0, 0.0, 3.1e-3]])
    return Specimen(geometry, position, np.array([1e-3, 3e-3]), 1.0, Network(**rows), 0)


def test_the_mean_radius_counts_between_spheres_and_the_spheres_own_at_a_plate():
    area = with_mean_radius(tiny_specimen()).network.area
    np.testing.assert_allclose(area, np.pi * np.array([2e-3, 3e-3]) ** 2)


def test_only_bonds_to_plates_grow_longer():
    assert farther_plates(tiny_specimen(), 5e-3).network.length.tolist() == pytest.approx([4.1e-3, 8.1e-3])
