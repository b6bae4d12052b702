"""Laws of measured mixes and their excess phase, on a mix whose law, reading and offset are known."""

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF
from studies.measured.excess import budget, excess
from studies.measured.ladder import RUNGS, averages, errors

LAW = TwoS2P1D(150e6, 28e9, k=0.2, h=0.6, delta=2.3, tau=0.02, beta=300.0, shift=WLF(17.0, 150.0, 20.0))
FREQUENCIES = (0.1, 1.0, 10.0)
TEMPERATURES = (4.0, 20.0, 40.0)


def table(of_one_test):
    """Two equal specimens; `of_one_test` gives E* [Pa] at a temperature [degC] and a frequency [Hz]."""
    rows = []
    for specimen in ("a", "b"):
        for temperature in TEMPERATURES:
            for frequency in FREQUENCIES:
                modulus = of_one_test(temperature, frequency)
                rows.append(
                    (specimen, temperature, frequency, abs(modulus) / 1e6, np.degrees(np.angle(modulus)))
                )
    return pd.DataFrame(rows, columns=["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"])


def true(temperature, frequency):
    return LAW.complex_modulus(np.array([2.0 * np.pi * frequency]), np.array([temperature]))[0]


def as_the_machine_reads(temperature, frequency):
    chain, _ = kelvin_chain(lambda w: LAW.complex_modulus(w, np.full_like(w, temperature)), 1e-5, 1e3)
    return modulus_as_read(chain, [frequency], Programme())[0]


@pytest.fixture(scope="module")
def read_table():
    return table(as_the_machine_reads)


def test_the_reading_without_a_parameter_finds_the_law_that_was_read(read_table):
    laws = (RUNGS[name](*averages(read_table))[0] for name in ("one_law", "as_run"))
    plain, read = (errors(law, read_table).mean(axis=0) for law in laws)
    assert (read < 0.6 * plain).all() and read[1] < 0.6


def test_an_offset_is_found_and_a_law_alone_needs_none():
    turned = table(lambda t, f: true(t, f) * np.exp(1j * np.radians(1.5)))
    law, fitted = RUNGS["phase_offset"](*averages(turned))
    assert errors(law, turned).max() < 0.2 and fitted == RUNGS["one_law"](*averages(turned))[1] + 1
    assert errors(RUNGS["one_law"](*averages(table(true)))[0], table(true)).max() < 0.05


def test_burgers_laws_between_their_temperatures_follow_straight_lines():
    tests = table(true)
    law, fitted = RUNGS["burgers"](*averages(tests[tests["temperature_C"] != 20.0]))
    omega = np.array([2.0 * np.pi])
    cold, warm = (law(omega, np.array([t]))[0] for t in (4.0, 40.0))
    between, exact = law(omega, np.array([20.0]))[0], law(omega, np.array([4.0 + 1e-9]))[0]
    assert fitted == 8 and abs(warm) < abs(between) < abs(cold) and exact == pytest.approx(cold, rel=1e-6)


def test_the_excess_of_a_mix_that_is_only_read_is_what_the_reading_predicts(read_table):
    found = excess("drawn", "mix", read_table)
    at = found.groupby("temperature_C")[["isotherm_deg", "reading_deg", "isotherm_standard_error_deg"]].mean()
    off = (at["isotherm_deg"] - at["reading_deg"]) / at["isotherm_standard_error_deg"]
    assert np.abs(off).max() < 2.0 and at["reading_deg"].max() > 1.0
    summed = budget(found)
    assert (
        summed["mixes"].tolist() == [1, 1, 1] and (summed["rms_less_reading_deg"] < summed["rms_deg"]).all()
    )
