"""A lubricated contact against its limits, and against elastic half-spaces alone."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.forecasting.contact import RINGS, contact_stiffness


def stiffness(shear, gap, bulk=1e12):
    return contact_stiffness(np.full((1, RINGS), shear, complex), np.full((1, RINGS), bulk, complex), gap)[0]


@pytest.mark.parametrize("shear", [1e-7, 1e-6])
def test_without_a_gap_elasticity_limits_the_squeezed_medium(shear):
    """k = 5.475 G^(1/3) E'^(2/3) R: by boundary elements, 240 rings out to 30 times the width of the spot."""
    assert stiffness(shear, 0.0).real == pytest.approx(5.475 * shear ** (1 / 3), rel=0.015)


def test_stiff_spheres_squeeze_as_reynolds_says():
    """6 pi G R^2 / h, less what lies beyond the rim: p ~ (R / h)^2."""
    gap, shear = 0.003, 1e-12
    beyond = (gap / (gap + 0.5)) ** 2
    assert stiffness(shear, gap).real == pytest.approx(6 * np.pi * shear / gap * (1 - beyond), rel=0.02)


def test_a_medium_that_cannot_flow_is_a_punch_of_the_spheres():
    """Flat and stiff over R: k = 2 E' R (Johnson 1985); rings of constant pressure come within 3 %."""
    assert stiffness(1e9, 0.0).real == pytest.approx(2.0, rel=0.03)


def test_a_thin_gap_of_a_compressible_medium_is_a_layer():
    """Stiff spheres, no flow: the integral of K / h over the facet."""
    gap, bulk = 0.05, 1e-9
    assert stiffness(1e3, gap, bulk).real == pytest.approx(2 * np.pi * bulk * np.log(1 + 0.5 / gap), rel=0.01)


def test_a_contact_of_a_lossy_medium_lags_by_a_third_of_it():
    found = stiffness(1e-6 * np.exp(1.2j), 0.0)
    assert np.angle(found) == pytest.approx(0.4, abs=0.005)
