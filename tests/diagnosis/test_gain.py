"""Errors before and after, by their definitions on moduli and phases."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.simulation import gain

TEMPERATURE = np.array([0.0, 0.0, 20.0, 20.0, 40.0, 40.0])
MEASURED = np.array([20e9, 18e9, 8e9, 7e9, 1e9, 0.8e9]) * np.exp(
    1j * np.array([0.1, 0.12, 0.4, 0.42, 0.6, 0.55])
)
SIMULATED = (
    MEASURED
    * np.array([1.5, 0.7, 1.2, 1.1, 0.5, 2.0])
    * np.exp(1j * np.array([0.02, -0.03, 0.05, 0.1, -0.2, 0.1]))
)


@pytest.fixture
def diagnosis():
    observed = SimpleNamespace(
        isotherm=TEMPERATURE, temperature=TEMPERATURE, frequency=np.tile([1.0, 10.0], 3), names=("A",),
        specimen=np.zeros(6, int), cell=np.arange(6), logarithm=np.log(MEASURED),
    )  # fmt: skip
    return SimpleNamespace(observed=observed, noise=SimpleNamespace(sigma=(0.02, 0.01)))


def test_errors_of_single_tests_are_relative_to_what_was_measured(diagnosis):
    found = gain.compare_errors(diagnosis, np.log(SIMULATED), np.log(MEASURED))
    off = np.abs(np.abs(SIMULATED) - np.abs(MEASURED)) / np.abs(MEASURED)
    turned = np.abs(np.angle(SIMULATED) - np.angle(MEASURED)) / np.angle(MEASURED)
    assert found["mre_E_percent"]["before"] == pytest.approx(100.0 * off.mean(), rel=1e-9)
    assert found["mre_phase_percent"]["before"] == pytest.approx(100.0 * turned.mean(), rel=1e-9)
    left = np.log(MEASURED / SIMULATED)
    squares = np.concatenate([(left.real / 0.02) ** 2, (left.imag / 0.01) ** 2])
    assert found["rms_over_scatter"]["before"] == pytest.approx(np.sqrt(squares.mean()), rel=1e-9)
    assert all(
        found[name]["after"] == 0.0 for name in ("mre_E_percent", "mre_phase_percent", "rms_over_scatter")
    )


def test_inner_errors_leave_out_the_isotherms_at_the_ends(diagnosis):
    found = gain.compare_errors(diagnosis, np.log(SIMULATED), np.log(MEASURED), inner=True)
    assert found["mre_E_percent"]["before"] == pytest.approx(100.0 * (0.2 + 0.1) / 2.0, rel=1e-9)


def test_a_phase_below_its_own_scatter_is_nothing_to_divide_by(diagnosis):
    diagnosis.observed.logarithm = np.log(np.abs(MEASURED)) + 0.001j
    found = gain.compare_errors(diagnosis, np.log(np.abs(MEASURED)) + 0.003j, np.log(MEASURED))
    assert found["mre_phase_percent"]["before"] == pytest.approx(100.0 * 0.002 / 0.01, rel=1e-9)


def test_averages_by_temperature_are_those_of_the_moduli(diagnosis):
    found = gain.averages(diagnosis, np.log(SIMULATED), np.log(MEASURED))
    off = np.abs(np.abs(SIMULATED) / np.abs(MEASURED) - 1.0)
    assert list(found) == ["0", "20", "40"]
    for k, name in enumerate(found):
        error = found[name]["mre_E_percent"]
        assert error["before"] == pytest.approx(100.0 * off[2 * k : 2 * k + 2].mean(), rel=1e-9)
        assert error["after"] == pytest.approx(0.0, abs=1e-9)


def test_what_one_of_them_lacks_counts_in_neither(diagnosis):
    before = np.log(SIMULATED)
    before[0] = np.nan
    found = gain.averages(diagnosis, before, np.log(SIMULATED))
    assert found["0"]["mre_E_percent"]["before"] == pytest.approx(100.0 * 0.3, rel=1e-9)
    assert found["0"]["mre_E_percent"]["after"] == pytest.approx(100.0 * 0.3, rel=1e-9)


def test_tests_of_two_amplitudes_are_not_averaged(diagnosis):
    """What softens with the strain lies as far above the law at one amplitude as below it at the other."""
    diagnosis.observed.frequency = np.full(6, 1.0)
    off = np.log(np.tile([1.1, 0.9], 3))
    found = gain.averages(diagnosis, np.log(MEASURED) + off, np.log(MEASURED))
    assert found["20"]["mre_E_percent"]["before"] == pytest.approx(10.0, rel=1e-9)


def test_the_error_of_the_phase_in_degrees_is_the_mean_of_its_sizes(diagnosis):
    turned = np.radians([1.0, -3.0, 0.0, 0.5, 2.0, 2.0])
    found = gain.errors(diagnosis, np.log(MEASURED) + 1j * turned)
    assert found[gain.OFF_PHASE] == pytest.approx({"0": 2.0, "20": 0.25, "40": 2.0})
