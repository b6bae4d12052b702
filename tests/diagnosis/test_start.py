"""First fits of a table."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.model import start
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.rheology.fitting import fit_burgers


@pytest.mark.parametrize("frequency", [[3.0, 6, 10, 25, 40], [0.1, 1, 10]], ids=["paper", "two decades"])
def test_each_burgers_law_is_the_best_of_many_random_starts(frequency):
    omega = 2.0 * np.pi * np.array(frequency)
    isotherms = [-10.0, 15.0, 30.0]
    time = [10.0, 0.05, 1e-3]
    moduli = [30e9 / (1.0 + 2.0 * (1j * omega * t) ** -0.2 + (1j * omega * t) ** -0.6) for t in time]
    n, m = omega.size, len(isotherms)
    observed = Observations(
        np.zeros(m * n, int),
        ("a",),
        np.repeat(isotherms, n),
        np.tile(frequency, m),
        np.concatenate(moduli),
        np.ones(m * n),
        np.zeros(m * n),
    )
    # Modulus and phase weighted alike and the specimen's scale held, as fit_burgers takes them.
    noise = scatter.stated(observed, 1e-2, 1e-2, 1e-9)
    _, fitted = start.fit_burgers_at_each(observed, noise)
    for rows, modulus in zip(np.split(np.arange(m * n), m), moduli, strict=True):
        law = fit_burgers(omega, modulus).law
        wanted = np.log(law.complex_modulus(omega))
        assert np.abs(fitted.modelled[rows] - wanted).max() < 1e-5


def test_a_rougher_spectrum_pays_for_each_of_its_second_differences():
    """ln of exp(-objective / 2) / sqrt(det precision) / roughness^(m - 2), of ten branches and three parameters."""
    joint = SimpleNamespace(spectrum=SimpleNamespace(times=np.zeros(10), roughness=0.5))
    fitted = SimpleNamespace(objective=3.0, precision=2.0 * np.eye(3))
    expected = -1.5 - 1.5 * np.log(2.0) - 8.0 * np.log(0.5)
    assert start.marginal_likelihood(joint, fitted) == pytest.approx(expected)


def measured(isotherms, frequencies, static=None, loss=1e9):
    grid = np.array([(t, f) for t in isotherms for f in frequencies])
    modulus = np.linspace(9e9, 1e9, len(grid)) + 1j * loss
    one = np.ones(len(grid))
    return Observations(
        np.zeros(len(grid), int), ("a",), *grid.T, modulus, one, one, static_modulus=static
    )  # fmt: skip


def test_relaxation_times_cover_what_tests_reach_and_a_margin():
    """At C1 = 12 and C2 = 60 K from the middle: 3.5 of ln time beyond the reduced band, no gap above 1.2."""
    base = start._spectrum(measured((0.0, 20.0, 30.0), (1.0, 25.0)), 12.0, 60.0)
    assert (base.reference_temperature, base.below, base.above, base.roughness) == (20.0, 20.0, 10.0, 0.2)

    def reduced(t, f):
        return np.log(2.0 * np.pi * f) - np.log(10.0) * 12.0 * (t - 20.0) / (60.0 + t - 20.0)

    ends = -reduced(0.0, 25.0) - 3.5, -reduced(30.0, 1.0) + 3.5
    assert np.log(base.times[[0, -1]]) == pytest.approx(ends)
    gaps = np.diff(np.log(base.times))
    assert np.ptp(gaps) < 1e-9 and 1.2 * (1.0 - 1.0 / gaps.size) < gaps[0] <= 1.2
    far = start._spectrum(measured((-60.0, 20.0, 30.0), (1.0, 25.0)), 12.0, 60.0)
    # A shift that is singular at the coldest test, 80 K below, is begun with 100 K.
    coldest = np.log(50.0 * np.pi) + np.log(10.0) * 12.0 * 80.0 / (100.0 - 80.0)
    assert np.log(far.times[0]) == pytest.approx(-coldest - 3.5)


@pytest.mark.parametrize(
    ("static", "loss", "near"), [(None, 1e6, False), (1e6, 2.9e6, True), (1e6, 3.1e6, False)]
)
def test_a_static_modulus_is_near_where_a_loss_modulus_is_below_three_of_it(static, loss, near):
    base = start._spectrum(measured((0.0, 20.0), (1.0, 25.0), static, loss), 12.0, 60.0)
    assert (base.static_modulus, base.ends_straight) == (static, near)


def test_a_first_law_is_a_little_stiffer_than_the_stiffest_test():
    """Weaker where slower, by e^-4 at the end; WLF's constants in slope and curvature; no bend and no departure."""
    observed = measured((0.0, 20.0, 30.0), (1.0, 25.0))
    base = start._spectrum(observed, 20.0, 200.0)
    law = start._first_law(observed, base, 20.0, 200.0)
    m, stiffest = base.times.size, np.abs(observed.modulus).max()
    assert np.exp(law[:m]).sum() == pytest.approx(1.2 * stiffest)
    assert np.diff(law[:m]) == pytest.approx(np.full(m - 1, -4.0 / (m - 1)))
    assert np.exp(law[m]) == pytest.approx(1e-3 * stiffest)
    assert law[m + 1 :] == pytest.approx([0.0, 0.0, 0.0, np.log(0.1), base.log_odds(1.0 / 200.0), 0.0])
    joint = SimpleNamespace(observed=observed, spectrum=base)
    every = list(start.first_laws(joint))
    assert [law[-3] for law in every] == pytest.approx(np.log([12.0 / 60.0, 0.12, 0.1, 30.0 / 280.0]))
