"""A test from rest as a machine reads it, against convolution with the creep compliance and steady oscillation."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.conversion import kelvin_chain

CHAIN = KelvinChain(20e9, 400e9, (30e9, 8e9, 3e9), (0.5e9, 6e9, 40e9))


def power_law(exponent):
    return kelvin_chain(lambda omega: 1e9 * (1j * omega) ** exponent, 2e-3 * np.pi, 2e2 * np.pi, 1e-4)[0]


def excess_deg(exponent, programme):
    read = modulus_as_read(power_law(exponent), [1.0], programme)
    return float(np.degrees(np.angle(read))[0]) - 90.0 * exponent


def convolved(chain, programme):
    """The phase [deg] at 1 Hz of the same record by Boltzmann's superposition of small steps."""
    steps = programme.samples
    time = np.arange(programme.cycles * steps + 1) / steps
    stress = 0.5 * (1.0 - np.cos(2.0 * np.pi * time))
    kernel = chain.creep_compliance((np.arange(time.size - 1) + 0.5) / steps)
    strain = np.concatenate([[0.0], np.convolve(np.diff(stress), kernel)[: time.size - 1]])
    last = slice(-programme.read * steps, None)
    angle = 2.0 * np.pi * time[last]
    terms = np.column_stack([np.ones_like(angle), np.cos(angle), np.sin(angle)])
    phasors = [
        np.linalg.lstsq(terms, signal[last], rcond=None)[0] @ [0.0, 1.0, -1j] for signal in (stress, strain)
    ]
    return float(np.degrees(np.angle(phasors[0] / phasors[1])))


@pytest.mark.parametrize(("cycles", "read"), [(10, 5), (1, 1)])
@pytest.mark.parametrize("dashpot", [CHAIN.dashpot, np.inf])
def test_the_closed_form_is_boltzmann_s_superposition(cycles, read, dashpot):
    chain = KelvinChain(CHAIN.spring, dashpot, CHAIN.kelvin_springs, CHAIN.kelvin_dashpots)
    programme = Programme(cycles=cycles, read=read, samples=2000)
    found = modulus_as_read(chain, [1.0], programme)
    assert np.degrees(np.angle(found))[0] == pytest.approx(convolved(chain, programme), abs=1e-3)


def test_a_fit_without_drift_reads_the_phase_of_a_creeping_mix_too_large():
    # measured with a discrete sum of D(t) = t^n: 0.27, 1.09, 2.27 and 3.94 degrees
    for exponent, excess in ((0.08, 0.27), (0.2, 1.09), (0.3, 2.27), (0.4, 3.94)):
        assert excess_deg(exponent, Programme()) == pytest.approx(excess, rel=0.06)
        assert abs(excess_deg(exponent, Programme(drift=True))) < 0.06
        assert abs(excess_deg(exponent, Programme(haversine=False))) < 0.05
        assert excess_deg(exponent, Programme(cycles=20, read=10)) < 0.75 * excess


def test_steady_oscillation_is_read_exactly():
    read = modulus_as_read(CHAIN, [10.0, 1.0], Programme(haversine=False, cycles=400, read=5, drift=True))
    law = CHAIN.complex_modulus(2.0 * np.pi * np.array([10.0, 1.0]))
    assert np.abs(np.log(read / law)).max() < 1e-6


def test_what_came_before_is_remembered():
    alone, after = (modulus_as_read(power_law(0.3), sweep, Programme())[-1] for sweep in ([1.0], [10.0, 1.0]))
    assert 0.05 < np.degrees(np.angle(alone) - np.angle(after)) < 0.5
