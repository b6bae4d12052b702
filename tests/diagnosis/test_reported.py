"""What goes into a laboratory's report: E* of the mix with its interval, and tests after the corrections."""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd
import pytest

import asphalt_nscd as an
from asphalt_nscd.diagnosis.record.mixture import standard_errors
from asphalt_nscd.diagnosis.record.reported import tested as within_the_tests
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

MIX = HuetSayegh(60e6, 33e9, k=0.21, h=0.6, delta=2.3, tau=0.15, shift=WLF(18.0, 150.0, 15.0))
DELAY = 2e-3  # s


@pytest.fixture(scope="module")
def diagnosis():
    random = np.random.default_rng(5)
    rows = []
    for specimen in "ABC":
        level = random.normal(0.0, 0.03)
        for t, f in product((4.0, 12.0, 20.0, 30.0, 40.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)):
            star = complex(MIX.complex_modulus(2 * np.pi * f, t))
            modulus = abs(star) * 1e-6 * np.exp(level + random.normal(0.0, 0.01))
            phase = np.degrees(np.angle(star)) + 360.0 * f * DELAY + random.normal(0.0, 0.2)
            rows.append((specimen, t, f, modulus, phase))
    names = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
    return an.diagnose(
        pd.DataFrame(rows, columns=names), measured_in="tension-compression", draws=an.Draws(500)
    )


def test_a_covariance_that_rounding_leaves_indefinite_has_real_errors():
    stiff, free = np.array([1.0, 1e-9]), np.array([0.0, 1.0])
    covariance = np.diag([-1e-12, 1e12])  # the first: zero, rounded
    assert standard_errors(np.stack([stiff, free]), covariance) == pytest.approx([1e-3, 1e6], rel=1e-12)
    whole = np.array([[4.0, 1.0], [1.0, 9.0]])
    assert standard_errors(np.array([[1.0, 1.0]]), whole) == pytest.approx([15.0**0.5], rel=1e-14)


@pytest.mark.parametrize(("apart", "least", "most"), [(0.2, 0.01, 0.5), (2.0, 4.8, 5.2)])
def test_the_phase_is_known_no_better_than_specimens_agree(apart, least, most):
    """Three specimens of whose phases two are `apart` [deg] from the third: an interval of the mean by Student's t."""
    rows = [
        (s, t, f, np.abs(star) * 1e-6, np.degrees(np.angle(star)) + off)
        for (s, off), t, f in product(
            (("A", -apart), ("B", 0.0), ("C", apart)), (4.0, 12.0, 20.0, 30.0), (0.1, 1.0, 10.0)
        )
        for star in [complex(MIX.complex_modulus(2 * np.pi * f, t))]
    ]
    names = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
    table = pd.DataFrame(rows, columns=names)
    found = an.diagnose(table, measured_in="tension-compression", draws=an.Draws(500)).content["reported"]
    assert least < 0.5 * (found["phase_high_deg"] - found["phase_low_deg"]) < most


def test_the_mix_at_15_degrees_and_10_hertz(diagnosis):
    said = diagnosis.content["reported"]
    star = complex(MIX.complex_modulus(2 * np.pi * 10.0, 15.0))
    assert said["E_low_MPa"] < abs(star) * 1e-6 < said["E_high_MPa"]
    assert said["phase_low_deg"] < np.degrees(np.angle(star)) < said["phase_high_deg"]
    # Three specimens that differ by 3 %: no better than 2 %, no worse than 10 %.
    assert 1.02 < said["E_high_MPa"] / said["E_MPa"] < 1.10
    assert said["within_the_tests"]
    table = diagnosis.outcome.to_report["reported"]
    assert table.drop(columns=["asked_by", "averaged_over"]).iloc[0].to_dict() == said
    far = table[(table["temperature_C"] == -10.0) & (table["frequency_Hz"] == 25.0)].iloc[0]
    assert (
        not far["within_the_tests"] and far["E_high_MPa"] / far["E_MPa"] > said["E_high_MPa"] / said["E_MPa"]
    )


def test_few_specimens_widen_the_interval(diagnosis):
    """Three specimens and what is usual, worth eight degrees of freedom: Student's t of ten, 2.228, and not 1.96."""
    _, ((here,),) = diagnosis.outcome.mix.parts(2 * np.pi * np.array([10.0]), np.array([15.0]))
    said = diagnosis.content["reported"]
    factor = np.log(said["E_high_MPa"] / said["E_MPa"]) / here.real
    assert factor == pytest.approx(2.228, abs=1e-3)
    of_phase = np.radians(said["phase_high_deg"] - said["phase_deg"]) / here.imag
    assert 1.96 < of_phase < 2.01


@pytest.mark.parametrize(
    ("temperature", "frequency", "celsius", "factor"),
    [(40.0, 0.1, 1.0, 0.5), (4.0, 25.0, -1.0, 2.0)],  # the softest test and the stiffest one
)
def test_the_tests_reach_2_kelvin_and_a_factor_of_2_beyond_the_last_of_them(
    diagnosis, temperature, frequency, celsius, factor
):
    def reached(t, f):
        return within_the_tests(diagnosis.outcome.mix, np.array([t]), np.array([f]))[0]

    assert reached(temperature, frequency * factor**0.95)
    assert not reached(temperature, frequency * factor**1.05)
    inner = frequency / factor**2  # of which a temperature beyond makes no reduced frequency beyond
    assert reached(temperature + 1.9 * celsius, inner)
    assert not reached(temperature + 2.1 * celsius, inner)


def test_the_master_curve_is_that_of_the_mix(diagnosis):
    curve = diagnosis.outcome.to_report["master_curve"]
    omega = 2.0 * np.pi * curve["frequency_Hz"].to_numpy()
    star = MIX.complex_modulus(omega, curve["temperature_C"].to_numpy())
    assert np.abs(np.log(curve["E_MPa"] * 1e6 / np.abs(star))).max() < 0.12
    assert ((curve["E_low_MPa"] < curve["E_MPa"]) & (curve["E_MPa"] < curve["E_high_MPa"])).all()


def test_corrected_tests_are_those_without_the_delay_and_name_nothing_new(diagnosis, tmp_path):
    assert list(diagnosis.ladder["cause"]) == ["relaxation_spectrum", "channel_delay"]
    diagnosis.write(tmp_path)
    table = pd.read_csv(tmp_path / "corrected.csv")
    used = table[table["status"] == "used"]
    taken = used["recorded_phase_deg"] - used["phase_deg"]
    assert taken.to_numpy() == pytest.approx(360.0 * used["frequency_Hz"].to_numpy() * DELAY, rel=0.05)
    assert set(used["corrected_for"]) == {"channel_delay"}
    again = an.diagnose(tmp_path / "corrected.csv", measured_in="tension-compression", draws=an.Draws(500))
    assert set(again.ladder["cause"]) <= {"relaxation_spectrum"}
    assert again.content["tests"] == len(used)


def test_beyond_the_tests_the_grid_is_law_json_with_its_band(diagnosis):
    grid, law = diagnosis.outcome.to_report["reported"], diagnosis.law
    beyond = grid[~grid["within_the_tests"]]
    assert set(beyond["temperature_C"]) >= {-10.0, 54.4}
    at = beyond["frequency_Hz"].to_numpy(), beyond["temperature_C"].to_numpy()
    star = law.complex_modulus(*at)
    assert beyond["E_MPa"].to_numpy() == pytest.approx(np.abs(star) * 1e-6, rel=1e-9)
    assert beyond["phase_deg"].to_numpy() == pytest.approx(np.degrees(np.angle(star)), rel=1e-9)
    cold = beyond[beyond["temperature_C"] == -10.0]
    assert (cold["phase_deg"] > 1.0).all()  # the free curve gave 0.01 there
