"""The prism in four-point bending: reduction against beams, and specimens of known law through the public calls."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp
from theory.specimens import jittered_beam

import asphalt_nscd as an
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements import fourpoint
from asphalt_nscd.measurements.fourpoint import SHARE_OF_MASS, Beam
from asphalt_nscd.measurements.geometry import read_shape, require_within, shape_of
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.specimen.network import region_of
from asphalt_nscd.specimen.system import bending_system

T321 = {"L_mm": 357.0, "H_mm": 50.0, "B_mm": 63.0, "mass_kg": 2.7, "mobile_mass_kg": 0.5}
LAW = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)


def moment(s: float) -> float:
    """Of a beam of span 1 under two forces of one half."""
    return 0.5 * min(s, 1.0 - s, 1.0 / 3.0)


def test_deflection_is_that_of_a_beam():
    """w'' = -M / (E I), by collocation; then form factor, line and the mass that moves with it."""

    def bent(s, w):
        return np.array([w[1], [-moment(one) for one in s]])

    mesh = np.linspace(0.0, 1.0, 301)
    solved = solve_bvp(bent, lambda a, b: np.array([a[0], b[0]]), mesh, np.zeros((2, mesh.size)), tol=1e-8)
    inner = float(solved.sol(1.0 / 3.0)[0])
    shape = read_shape(T321)
    second = 0.063 * 0.05**3 / 12.0
    assert shape.form_factor() == pytest.approx(inner * 0.357**3 / second, rel=1e-6)
    s = np.linspace(0.0, 1.0, 41)
    np.testing.assert_allclose(shape.line(0.357 * s), solved.sol(s)[0] / inner, atol=1e-6)
    moved = sum(
        quad(lambda s: shape.line(np.array(0.357 * s)) ** 2, *part)[0]
        for part in ((0, 1 / 3), (1 / 3, 2 / 3), (2 / 3, 1))
    )
    assert pytest.approx(moved, rel=1e-9) == SHARE_OF_MASS
    strain = 0.357 / 6.0 * 0.025 * shape.usual_amplitude() / (inner * 0.357**3)  # M c / (E I), of F / (E I)
    assert strain == pytest.approx(50e-6, rel=1e-6)


def test_shear_is_that_of_the_outer_thirds():
    """F/2 over L/3 by k G A, with k of a rectangle without Poisson's ratio 5/6 and G = E/2."""
    shape = read_shape(T321)
    bending, shear = shape.form_factor(), 0.5 / 3.0 * 0.357 / (5.0 / 6.0 * 0.5 * 0.05 * 0.063)
    assert shape.counted_share(0.0) == pytest.approx(bending / (bending + shear))
    assert 0.9 < shape.counted_share(0.35) < shape.counted_share(0.0) < 1.0


def test_keys_say_the_test_and_files_keep_it():
    beam = read_shape(T321)
    assert isinstance(beam, Beam) and shape_of(beam.attributes()) == beam
    assert beam.keys() == pytest.approx(T321)
    assert region_of(beam).volume == pytest.approx(0.357 * 0.05 * 0.063)
    normal, offset = beam.faces()
    assert (np.abs(normal).T @ offset).tolist() == pytest.approx([0.05, 0.063, 0.357])  # from face to face
    assert fourpoint.T321.mass == pytest.approx(2400 * 0.357 * 0.05 * 0.063, rel=2e-3)
    with pytest.raises(InputError, match="key 'h_mm' is not known; give exactly L_mm, H_mm, B_mm"):
        read_shape(T321 | {"h_mm": 10})
    # 36 times a thousandth is more than 0.036
    require_within(read_shape(T321 | {"B_mm": 36}), (0.357, 0.036, 0.01))
    with pytest.raises(InputError, match="357 mm high, but the box only 300 mm long; lower L_mm"):
        require_within(beam, (0.3, 0.1, 0.5))
    with pytest.raises(InputError, match="63 mm thick, but the box only 40 mm wide; lower B_mm"):
        require_within(beam, (0.4, 0.04, 0.5))


def freedoms(system: BondedSystem) -> np.ndarray:
    """Bodies by six: the number of each in the system, -1 where it is held."""
    assert system.place is not None and system.position is not None
    table = np.full(6 * len(system.position), -1)
    table[system.place] = np.arange(system.mass.size)
    return table.reshape(-1, 6)


def test_clamps_hold_drive_and_turn():
    beam = jittered_beam(shape=(3, 2, 12), area="facets", test=Beam.test)
    system = bending_system(beam, 0.35, np.inf, 0.7)
    lower, upper, foot, top = freedoms(system)[beam.radius.size :]
    assert lower[0] == system.driven and (lower >= 0).all()
    assert upper[0] == -1 and (upper[1:] >= 0).all()  # its drive is that of the other
    assert (foot >= 0).tolist() == [False, False, False, True, True, False]
    assert (top >= 0).tolist() == [False, False, True, True, True, False]
    assert system.mass[system.driven] == pytest.approx(beam.geometry.mobile_mass)
    assert system.mass[lower[1]] == system.mass[upper[1]] == pytest.approx(beam.geometry.mobile_mass / 2)
    spheres = np.arange(6 * beam.radius.size).reshape(-1, 6)
    assert system.load[spheres[:, 0]].sum() == pytest.approx(
        -9.81 * beam.geometry.mass
    )  # across the lying span
    assert not system.load[spheres[:, 2]].any()


def test_a_translation_along_the_drive_opens_no_bond_but_those_of_the_outer_clamps():
    beam = jittered_beam(shape=(3, 2, 13), area="facets", test=Beam.test)
    system, n = bending_system(beam, 0.35, np.inf, 0.7), beam.radius.size
    motion = np.zeros(system.mass.size)
    motion[freedoms(system)[: n + 1, 0]] = 1.0
    opening = np.abs(system.operator @ motion).reshape(-1, 3).max(axis=1)
    outer = np.maximum(beam.network.first, beam.network.second) >= n + 2
    assert opening[~outer].max() < 1e-13 and opening[outer].min() > 0.5


def test_what_it_cannot_be_is_said():
    packing = an.pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=an.Vibration(duration=0.0))
    small = {"L_mm": 100, "H_mm": 16, "B_mm": 20, "mass_kg": 0.07, "mobile_mass_kg": 0.0}
    with pytest.raises(InputError, match="four-point bending clamps the specimen between its ends"):
        an.specimen(packing, small, area="paper")
    specimen = an.specimen(packing, small, area="facets")
    with pytest.raises(InputError, match="four-point bending turns the specimen at its clamps; give free"):
        an.bend(specimen, LAW, 10.0, 15.0, bonds=an.Bonds(head="blocked"))


@pytest.mark.slow
def test_a_specimen_has_the_modulus_of_its_law_but_for_its_facets():
    """Facets have no moment of their own: N over the depth take 1/N^2. The phase is the law's whatever N."""
    packing = an.pour({5.0: 900}, (0.12, 0.03, 0.4), vibration=an.Vibration(duration=0.0), seed=3)
    shape = {"L_mm": 120, "H_mm": 24, "B_mm": 30, "mass_kg": 0.2, "mobile_mass_kg": 0.1}
    specimen = an.specimen(packing, shape, area="facets")
    for frequency in (1.0, 25.0):
        numerics = an.Numerics(1.0 / frequency / 200, 100, scheme="fitted")
        test = an.bend(specimen, LAW, frequency, 15.0, numerics=numerics)
        said = test.attributes
        assert said["amplitude_m"] == pytest.approx(specimen.geometry.usual_amplitude())
        assert said["E_MPa"] / said["E_law_MPa"] == pytest.approx(1.0 - 5.0**-2, abs=0.03)
        assert test.phase_deg == pytest.approx(said["phase_law_deg"], abs=0.02)
