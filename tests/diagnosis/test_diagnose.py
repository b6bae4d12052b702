"""Effects hidden in drawn measurements are found, named and sized; empty tables stay unnamed."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.record.report import diagnosis_content
from asphalt_nscd.diagnosis.screening import suspects
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.diagnosis.simulation.simulated import read_specimen
from asphalt_nscd.measurements.twopoint import Geometry, form_factor
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

pytestmark = pytest.mark.slow

LAW = TwoS2P1D(1e6, 42.58e9, 0.199, 0.604, 1.644, 0.14, 28.5, WLF(11.69, 79.86, 15.0))
GAMMA = form_factor(Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235))
SCATTER = 0.01, np.radians(0.3), 0.03


def table(seed, effect=lambda modulus, specimen, temperature, omega: modulus):
    random = np.random.default_rng(seed)
    grids = np.meshgrid(np.arange(4), [-10.0, 0, 10, 15, 20, 30], [3.0, 6, 10, 25, 40], indexing="ij")
    specimen, temperature, frequency = (grid.ravel() for grid in grids)
    omega = 2 * np.pi * frequency
    modulus = effect(LAW.complex_modulus(omega, temperature), specimen, temperature, omega)
    noise = SCATTER[0] * random.standard_normal(120) + 1j * SCATTER[1] * random.standard_normal(120)
    noise += SCATTER[2] * random.standard_normal(4)[specimen]
    return Observations(
        specimen,
        tuple("abcd"),
        temperature,
        frequency,
        modulus * np.exp(noise),
        np.full(120, GAMMA),
        np.zeros(120),
    )


EFFECTS = {
    ("channel_delay", None): (-7e-5, lambda e, s, t, w: e * np.exp(-7e-5j * w)),
    ("phase_offset", None): (1.2, lambda e, s, t, w: e * np.exp(1j * np.radians(1.2))),
    ("moving_mass", None): (0.35, lambda e, s, t, w: e - GAMMA * 0.35 * w**2),
    ("guide_friction", None): (2.5e8, lambda e, s, t, w: e + 2.5e8j),
    ("loose_clamp", "b"): (3.5e-12, lambda e, s, t, w: np.where(s == 1, e / (1 + 3.5e-12 * e), e)),
    ("temperature_bias", 15.0): (
        2.0,
        lambda e, s, t, w: LAW.complex_modulus(w, t + np.where(t == 15, 2.0, 0)),
    ),
}


@cache
def diagnosed(name):
    return diagnose(table(3, EFFECTS[name][1]))


NAMED = [name for name in EFFECTS if name[0] not in ("phase_offset", "guide_friction")]


@pytest.mark.parametrize("name", NAMED, ids=lambda name: name[0])
def test_a_hidden_effect_is_named_alone_with_its_size(name):
    size, diagnosis = EFFECTS[name][0], diagnosed(name)
    assert [rung.candidate.key for rung in diagnosis.ladder.rungs] == [name]
    assert diagnosis.verdict == "explained" and diagnosis.relaxation_spectrum
    rung = diagnosis.ladder.rungs[0]
    found = rung.candidate.values[0]
    error = np.sqrt(rung.after.covariance[-1, -1]) * rung.candidate.typical[0]
    assert abs(found - size) < 3.5 * error and error < 0.15 * abs(size)


def test_a_cause_that_was_named_is_not_said_to_be_untestable():
    diagnosis = diagnosed(("loose_clamp", "b"))
    named = diagnosis.ladder.rungs[0].candidate
    other = replace(named, place="c")
    unsure = replace(diagnosis, ladder=replace(diagnosis.ladder))
    unsure.ladder._detection_limits = diagnosis.ladder.limits, [named, other], diagnosis.ladder.alike
    content = diagnosis_content(unsure, read_specimen())
    untestable = [row["cause"] for row in content["not_testable"]]
    assert "loose_clamp @ c" in untestable and "loose_clamp @ b" not in untestable
    assert content["largest_pattern_left"]["z"] ** 2 == pytest.approx(diagnosis.ladder.remaining.gain)
    noise = diagnosis.noise
    sizes = 100.0 * noise.sigma[0], np.degrees(noise.sigma[1]), 100.0 * noise.scale
    names = "modulus_percent", "phase_deg", "specimens_percent"
    assert [content["scatter"][name] for name in names] == pytest.approx(sizes)
    burgers = [list(one.values()) for one in content["baseline"]["parameters"].values()]
    assert list(content["baseline"]["parameters"]) == ["-10", "0", "10", "15", "20", "30"]
    assert np.ravel(burgers) == pytest.approx(np.exp(diagnosis.baseline.law))
    assert [*content["baseline"]["parameters"]["15"]] == ["Em_Pa", "eta_m_Pa_s", "Ek_Pa", "eta_k_Pa_s"]


def test_an_empty_table_names_the_spectrum_only():
    diagnosis = diagnose(table(4))
    assert diagnosis.ladder.rungs == [] and diagnosis.relaxation_spectrum
    assert diagnosis.verdict == "explained"


def test_an_effect_outside_the_catalogue_gets_no_name():
    diagnosis = diagnose(table(5, lambda e, s, t, w: np.where(np.abs(w - 50 * np.pi) < 1, 1.03 * e, e)))
    assert diagnosis.ladder.rungs == [] and diagnosis.verdict == "unexplained_structure"
    assert diagnosis.ladder.remaining.pattern == "25 Hz, modulus"


@pytest.mark.parametrize("static", [0.0, 1e6])
def test_a_true_static_modulus_makes_no_misfit_where_the_tests_stay_far_from_it(static):
    diagnosis = diagnose(replace(table(3), static_modulus=static))
    assert diagnosis.verdict == "explained" and not diagnosis.ladder.rungs
    assert ("guide_stiffness", None) not in diagnosis.ladder.limits


def test_one_bad_test_of_three_specimens_is_set_aside():
    three = table(3).subset(np.arange(90))
    modulus = three.modulus.copy()
    modulus[17] *= 1.6
    found = suspects.find(replace(three, modulus=modulus))
    assert [one.row for one in found if not one.used] == [17]


def test_replicates_closer_than_tests_can_be_are_given_a_floor():
    exact = table(3)
    same = LAW.complex_modulus(exact.omega, exact.temperature) * (1.0 + 1e-3 * exact.specimen)
    diagnosis = diagnose(replace(exact, modulus=same))
    assert diagnosis.noise.sigma == pytest.approx((scatter.FLOOR, scatter.FLOOR))
    assert any("Check that they are separate tests" in note for note in diagnosis.notes)
