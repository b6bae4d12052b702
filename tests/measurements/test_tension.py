"""The cylinder in tension-compression: reduction, faces, and a specimen of known law through the public calls."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

import asphalt_nscd as an
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements import tension
from asphalt_nscd.measurements.geometry import read_geometry, read_shape, shape_of
from asphalt_nscd.measurements.shape import DRIVEN, FREE, HELD, Plate
from asphalt_nscd.measurements.tension import Cylinder
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.specimen.network import region_of

AMPT = {"d_mm": 100.0, "h_mm": 150.0, "mass_kg": 2.8, "mobile_mass_kg": 0.5}
TRAPEZOID = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
LAW = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)


def test_a_bar_of_known_modulus_is_found_again():
    """Exact bar fixed at its foot: F/z = E A k cot(k h), with the plate's inertia; E* misses O((omega/resonance)^4)."""
    shape, modulus = Cylinder(0.1, 0.15, 2.8, 0.5), 10e9 * np.exp(0.4j)
    area = np.pi * 0.05**2
    density = 2.8 / (area * 0.15)
    for frequency in (10.0, 100.0, 200.0):
        omega = 2 * np.pi * frequency
        k = omega * np.sqrt(density / modulus)
        stiffness = modulus * area * k / np.tan(k * 0.15) - 0.5 * omega**2
        found = shape.complex_modulus(frequency, abs(stiffness), 1.0, np.angle(stiffness))
        assert found == pytest.approx(modulus, rel=0.03 * abs(k * 0.15) ** 4 + 1e-14)
        assert found != pytest.approx(modulus, rel=0.01 * abs(k * 0.15) ** 4)


def test_faces_enclose_the_section_of_the_circle():
    region = region_of(shape := read_shape(AMPT))
    assert region.volume == pytest.approx(np.pi * 0.05**2 * 0.15, rel=1e-12)
    np.testing.assert_allclose(np.linalg.norm(region.normal, axis=1), 1.0, rtol=1e-14)
    assert region.normal[0, 2] == 1.0 and region.offset[0] == shape.h and region.normal[1, 2] == -1.0


def test_gyration_is_that_of_thin_plates():
    disc, plate = read_shape(AMPT).gyration(), read_shape(TRAPEZOID | {"e_mm": 40}).gyration()
    beam = read_shape({"L_mm": 357, "H_mm": 50, "B_mm": 63, "mass_kg": 2.7, "mobile_mass_kg": 0.5}).gyration()
    second = quad(lambda r: r**3 / 0.05**2, 0.0, 0.05)[0]  # mean of x^2 over a disc: half of the mean of r^2
    assert disc == pytest.approx([second, second, 2 * second])
    for found, x2, y2 in ((plate, 0.025**2 / 12, 0.04**2 / 12), (beam, 0.05**2 / 12, 0.063**2 / 12)):
        assert found == pytest.approx([y2, x2, x2 + y2])


def test_the_cylinder_of_t_378():
    ampt = tension.AMPT
    assert ampt.mass == pytest.approx(2400 * np.pi * 0.05**2 * 0.15, rel=2e-3)
    assert ampt.usual_amplitude() == pytest.approx(0.5 * 100e-6 * 0.15)
    assert ampt.line(np.array([0.0, 0.075, 0.15])).tolist() == pytest.approx([0.0, 0.5, 1.0])
    assert ampt.counted_share(0.35) == 1.0
    along = (FREE, FREE, DRIVEN, FREE, FREE, FREE)
    assert ampt.plates == (Plate(0.15, along, 1.0), Plate(0.0, (HELD,) * 6, 0.0))
    assert [plate.moves for plate in ampt.plates] == [True, False]


def test_keys_say_the_test_and_files_keep_it():
    cylinder, trapezoid = read_shape(AMPT), read_shape(TRAPEZOID)
    assert isinstance(cylinder, Cylinder) and isinstance(trapezoid, Geometry)
    for shape, keys in ((cylinder, AMPT), (trapezoid, TRAPEZOID)):
        assert shape_of(shape.attributes()) == shape
        assert shape.keys() == pytest.approx(keys)
    for wrong, sentence in (
        (AMPT | {"d_mm": 0.1}, r"d_mm = 0.1 is not a number from 10 to 300; give the diameter in mm"),
        (AMPT | {"e_mm": 25}, "key 'e_mm' is not known; give exactly d_mm, h_mm, mass_kg, mobile_mass_kg"),
        ({"d_mm": 100}, "key 'h_mm' is missing"),
    ):
        with pytest.raises(InputError, match=sentence):
            read_shape(wrong)
    with pytest.raises(InputError, match="key 'b_mm' is missing"):  # what was measured by Eq. (1)
        read_geometry(AMPT, ["s1"])


@pytest.mark.slow
def test_a_specimen_has_the_modulus_of_its_law():
    """As in bending with facets, but without a share of shear: to 2e-4 and 0.01 degrees."""
    packing = an.pour({5.0: 700, 7.0: 200}, (0.06, 0.04, 0.4), vibration=an.Vibration(duration=0.0), seed=3)
    shape = {"d_mm": 40, "h_mm": 60, "mass_kg": 0.18, "mobile_mass_kg": 0.3}
    specimen = an.specimen(packing, shape, area="facets")
    assert repr(specimen).endswith("by facets, d = 40, h = 60 mm)")
    for frequency in (1.0, 25.0):
        numerics = an.Numerics(1.0 / frequency / 200, 100, scheme="fitted")
        test = an.bend(specimen, LAW, frequency, 15.0, numerics=numerics)
        assert test.attributes["amplitude_m"] == pytest.approx(50e-6 * 0.06)
        assert test.E_MPa == pytest.approx(test.attributes["E_law_MPa"], rel=2e-4)
        assert test.phase_deg == pytest.approx(test.attributes["phase_law_deg"], abs=0.01)
    profile = test.arrays["profile/velocity_m_s"]
    filled = test.arrays["profile/spheres"] > 0
    fastest = np.abs(profile[:, filled]).max(axis=0)
    height = test.arrays["profile/height_m"][filled]
    assert np.corrcoef(fastest, height)[0, 1] > 0.99  # all move along the axis, as a bar does
