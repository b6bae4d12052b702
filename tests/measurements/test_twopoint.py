"""Eqs. (1)-(5): limits, an independent quadrature, and the exact inverse."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.twopoint import (
    Geometry,
    bending_share,
    complex_modulus,
    form_factor,
    head_response,
    mass_factor,
)

PAPER = Geometry(b=25e-3, B=56e-3, e=25e-3, h=250e-3, mass=0.6, mobile_mass=0.235)


def with_foot(foot: float) -> Geometry:
    return Geometry(b=25e-3, B=foot, e=25e-3, h=250e-3, mass=0.6, mobile_mass=0.235)


def test_mass_that_moves_with_the_head_of_a_prism():
    """By the kinetic energy of a cantilever in its static deflection, (3 x^2 h - x^3) / (2 h^3)."""
    prism = replace(PAPER, b=0.05, B=0.05)
    x = np.linspace(0.0, 1.0, 100_001)
    share = np.trapezoid((1.5 * x**2 - 0.5 * x**3) ** 2, x)
    assert mass_factor(prism) == pytest.approx(share * prism.mass + prism.mobile_mass, rel=1e-9)
    assert mass_factor(replace(PAPER, b=0.0499, B=0.05)) == mass_factor(PAPER)


def test_form_and_mass_factor_of_the_paper():
    assert form_factor(PAPER) * 1e-3 == pytest.approx(25.0957774, rel=1e-8)  # 1/mm
    assert mass_factor(PAPER) == pytest.approx(0.316, rel=1e-12)


@pytest.mark.parametrize("foot", [0.056, 0.030, 0.0264, 0.0263, 0.0251, 0.025 * (1 + 1e-9), 0.025])
def test_form_factor_is_the_deflection_of_a_tapered_cantilever(foot):
    """gamma = E z/F = integral of x^2/I(x) dx from the head, I the local second moment of area."""
    geometry = with_foot(foot)

    def second_moment(x: float) -> float:
        width = geometry.b + (geometry.B - geometry.b) * x / geometry.h
        return geometry.e * width**3 / 12

    deflection, _ = quad(lambda x: x**2 / second_moment(x), 0, geometry.h, epsrel=1e-13)
    assert form_factor(geometry) == pytest.approx(deflection, rel=1e-11)


@pytest.mark.parametrize("foot", [0.056, 0.025])
def test_what_is_not_bending_is_the_shear_of_a_timoshenko_beam(foot):
    """E z/F of shear = integral of 2 (1 + nu) / (k area) dx, k of a rectangle by Cowper."""
    geometry, nu = with_foot(foot), 0.35
    k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)

    def compliance(x: float) -> float:
        width = geometry.b + (geometry.B - geometry.b) * x / geometry.h
        return 2.0 * (1.0 + nu) / (k * geometry.e * width)

    shear, _ = quad(compliance, 0, geometry.h, epsrel=1e-13)
    bending = form_factor(geometry)
    assert bending_share(geometry, nu) == pytest.approx(bending / (bending + shear), rel=1e-11)


def test_a_specimen_of_twice_the_size_is_moved_twice_as_far():
    twice = Geometry(b=50e-3, B=112e-3, e=50e-3, h=500e-3, mass=4.8, mobile_mass=0.235)
    assert twice.usual_amplitude() == pytest.approx(2.0 * PAPER.usual_amplitude(), rel=1e-12)
    assert PAPER.usual_amplitude() == pytest.approx(63e-6, rel=1e-12)


def test_printed_equations_in_their_own_units():
    """Eqs. (1)-(2) as printed, in N, mm, g, MPa, where the factor 1e-6 belongs."""
    force, displacement_mm, psi, frequency = 60.0, 63e-3, np.radians(20.0), 25.0
    gamma_mm, mu_g, omega = 25.0957774, 316.0, 2 * np.pi * frequency
    e1 = gamma_mm * (force / displacement_mm * np.cos(psi) + 1e-6 * mu_g * omega**2)
    e2 = gamma_mm * force / displacement_mm * np.sin(psi)
    modulus = complex_modulus(PAPER, frequency, force, displacement_mm * 1e-3, psi)
    assert modulus * 1e-6 == pytest.approx(e1 + 1j * e2, rel=1e-7)


def test_head_response_inverts_complex_modulus():
    frequency = np.array([3.0, 6, 10, 25, 40])
    modulus = np.array([39e9, 20e9, 5e9, 1e9, 50e6]) * np.exp(1j * np.radians([1.0, 10, 30, 45, 80]))
    force, phase = head_response(PAPER, frequency, modulus, 63e-6)
    assert phase[-1] > np.pi / 2  # soft and fast: inertia outweighs the stiffness
    np.testing.assert_allclose(complex_modulus(PAPER, frequency, force, 63e-6, phase), modulus, rtol=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"h": 0.0}, "h = 0"),
        ({"mass": -1.0}, "mass = -1"),
        ({"e": np.nan}, "e = nan"),
        ({"b": 0.06}, "exchange b and B"),
    ],
)
def test_impossible_geometry_is_refused(change, words):
    values = {"b": 0.025, "B": 0.056, "e": 0.025, "h": 0.25, "mass": 0.6, "mobile_mass": 0.235}
    with pytest.raises(InputError, match=words):
        Geometry(**(values | change))


def test_each_face_holds_four_corners_and_has_the_others_behind_it():
    x, y = (0.025, 0.056), (-0.0125, 0.0125)
    corners = np.array([(s * w / 2, e, z) for w, z in zip(x, (0.25, 0.0)) for s in (-1, 1) for e in y])
    normal, offset = PAPER.faces()
    behind = offset - corners @ normal.T
    assert (np.abs(behind) < 1e-15).sum(axis=0).tolist() == [4] * 6 and behind.min() > -1e-15
    assert np.linalg.norm(normal, axis=1) == pytest.approx(np.ones(6), rel=1e-14)


@pytest.mark.parametrize("foot", [1.0, 2.24])
def test_elastic_line_is_that_of_the_second_moment_of_area(foot):
    """w'' = M/EI with I = e w^3/12 of a width that grows to `foot` times that of the head, by quadrature."""
    shape = replace(PAPER, B=foot * PAPER.b)

    def curvature(x):
        width = shape.B + (shape.b - shape.B) * x / shape.h
        return (shape.h - x) / (shape.e * width**3 / 12.0)

    def deflection(at):
        return quad(lambda x: (at - x) * curvature(x), 0.0, at)[0]

    x = np.linspace(0.0, shape.h, 2001)
    expected = [deflection(at) / deflection(shape.h) for at in x[[500, 1000, 1500]]]
    assert shape.line(x)[[500, 1000, 1500]] == pytest.approx(expected, rel=1e-5)
