"""Forces of bonds that a test keeps: pulled bonds have tension, on the side that bends outwards."""

from __future__ import annotations

import numpy as np
import pytest
from theory.specimens import save_specimen

import asphalt_nscd as an
from asphalt_nscd.bending.case import LoadCase
from asphalt_nscd.bending.settings import Numerics


@pytest.fixture(scope="module")
def test(beam, tmp_path_factory):
    path = tmp_path_factory.mktemp("bonds") / "beam.h5"
    save_specimen(path, beam)
    law = an.Law.burgers(
        Em_Pa=24.3e9, eta_m_Pa_s=3.71e11, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e11, temperature_C=15
    )
    load = an.Load(amplitude_m=1e-6, cycles=2.0, frames=8)
    return an.bend(path, law, 20.0, 15.0, load=load, numerics=an.Numerics(time_step=1e-4)).arrays


def test_instants_are_spread_over_the_last_cycle_alone():
    """Thirty steps in three cycles of 10 ms: five instants are every second step of the last ten."""
    numerics = Numerics(time_step=1e-3)
    assert LoadCase(100.0, 1e-6, 3.0).framed(numerics, 5).tolist() == [21, 23, 25, 27, 29]


def test_bonds_that_grow_longer_are_in_tension(test):
    """A nearly elastic law: force along a bond rises with the distance of its spheres, in proportion to its area."""
    n = test["frames/radius_m"].size
    first, second = test["frames/first"], test["frames/second"]
    inside = (first < n) & (second < n)
    first, second = first[inside], second[inside]
    between = test["frames/position_m"][second] - test["frames/position_m"][first]
    length = np.linalg.norm(between, axis=1)
    for force, moved in zip(test["frames/bond_force_N"], test["frames/displacement_m"]):
        longer = ((moved[second] - moved[first]) * between).sum(axis=1) / length
        pulled = force[inside, 0].astype(float)
        stress = pulled / test["frames/area_m2"][inside]
        # Spheres also turn against each other, so that the proportion is not exact.
        assert np.corrcoef(stress, longer / length)[0, 1] > 0.6
        strong = np.abs(pulled) > 0.2 * np.abs(pulled).max()
        assert (np.sign(pulled) == np.sign(longer))[strong].mean() > 0.9


def test_the_side_away_from_the_head_is_pulled(test):
    """Head moved to +x: bonds along the height at the lower end are longer on the side of -x."""
    k = int(np.argmax(test["frames/displacement_m"][:, np.argmax(test["frames/position_m"][:, 2]), 0]))
    point, tension = test["frames/point_m"], test["frames/bond_force_N"][k, :, 0].astype(float)
    low = point[:, 2] < np.quantile(point[:, 2], 0.5)
    x = point[:, 0] - np.median(point[:, 0])
    assert np.corrcoef(tension[low], x[low])[0, 1] < -0.3
