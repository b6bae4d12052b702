"""Campaigns of the trial of intervals: their mixes are those of the priors, and their errors where they belong."""

from __future__ import annotations

import numpy as np
import pytest
from extrapolation import T_378, campaign, of_2s2p1d, usual_mix

from asphalt_nscd.diagnosis.criteria import LABORATORY
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.priors import USUAL
from asphalt_nscd.rheology.shift import WLF

TEMPERATURES, FREQUENCIES = np.array([-10.0, 4.0, 20.0, 40.0, 54.0]), np.array([25.0, 0.1, 1.0, 10.0, 0.01])


class Fixed:
    """Draws without chance."""

    def __init__(self, normal: float) -> None:
        self._normal = normal

    def standard_normal(self) -> float:
        return self._normal

    def normal(self, mean: float, deviation: float) -> float:
        return mean + self._normal * deviation

    def uniform(self, low: float, high: float) -> float:
        return 0.5 * (low + high)


def test_the_middle_of_usual_mixes_has_the_medians_of_the_priors():
    median = {name: one.median for name, one in USUAL.items()}
    shift = WLF(median["wlf_slope"] * median["c2"], median["c2"], 15.0)
    names = ("static_modulus", "glassy_modulus", "k", "h", "delta", "beta")
    tau = 10.0**-1.35 / shift.factor(20.0)
    law = TwoS2P1D(**{name: median[name] for name in names}, tau=tau, shift=shift)
    of_law = law.complex_modulus(2.0 * np.pi * FREQUENCIES, TEMPERATURES)
    assert usual_mix(Fixed(0.0))(TEMPERATURES, FREQUENCIES) * 1e6 == pytest.approx(of_law, rel=1e-10)


@pytest.mark.parametrize(("celsius", "slower"), [(45.0, 0.1), (-5.0, -0.1), (70.0, 0.8), (20.0, 0.0)])
def test_a_shift_leaves_wlf_by_the_cube_of_the_kelvins_from_20_degrees(celsius, slower):
    law = (70.0, 31e3, 2.2, 0.2, 0.6, 0.05, 120.0, 18.0, 140.0)
    assert of_2s2p1d(*law, 0.1)(celsius, 1.0) == pytest.approx(
        of_2s2p1d(*law)(celsius, 1.0, slower), rel=1e-12
    )


@pytest.mark.parametrize(
    ("kind", "size", "moved", "factor"),
    [
        ("isotherm temperature", 0.3, (0.3, 0.0), 1.0),
        ("specimen temperature", 0.3, (0.3, 0.0), 1.0),
        ("specimen times", 0.2, (0.0, 0.2), 1.0),
        ("mounting, modulus", 0.02, (0.0, 0.0), np.exp(0.02)),
        ("mounting, phase", 0.01, (0.0, 0.0), np.exp(0.01j)),
    ],
)
def test_each_error_of_a_laboratory_acts_on_what_it_is_of(kind, size, moved, factor):
    mix = usual_mix(Fixed(0.0))
    sizes = dict.fromkeys(LABORATORY, 0.0) | {kind: size}
    table = campaign(mix, sizes, Fixed(0.0), Fixed(1.0))
    assert len(table) == 3 * sum(len(frequencies) for _, frequencies in T_378)
    kelvin, slower = moved
    star = factor * mix(table["temperature_C"].to_numpy() + kelvin, table["frequency_Hz"].to_numpy(), slower)
    assert table["E_MPa"].to_numpy() == pytest.approx(np.abs(star), rel=1e-12)
    assert table["phase_deg"].to_numpy() == pytest.approx(np.degrees(np.angle(star)), rel=1e-12)
