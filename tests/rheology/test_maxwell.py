"""Generalised Maxwell models: chains turned into them exactly, laws fitted by them within the stated error."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology import maxwell_fitting
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.maxwell import MaxwellSeries, series_of
from asphalt_nscd.rheology.maxwell_fitting import REACH, Miss, _size, _spaced, fit_series, miss
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

BURGERS = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
MIX = TwoS2P1D(100e6, 24e9, 0.21, 0.6, 2.3, 0.01, 300.0, WLF(24.0, 160.0, 15.0))
OMEGA = np.geomspace(1e-6, 1e6, 400)
decades = st.floats(-3.0, 3.0)


def at_15(omega):
    return MIX.complex_modulus(omega, 15.0)


def test_a_burgers_law_has_two_branches_and_is_the_same():
    series = series_of(BURGERS.kelvin_form())
    assert len(series.moduli) == 2 and series.long_term == 0.0
    assert series.instantaneous == pytest.approx(BURGERS.modulus_m, rel=1e-12)
    np.testing.assert_allclose(series.complex_modulus(OMEGA), BURGERS.complex_modulus(OMEGA), rtol=1e-11)
    time = np.geomspace(1e-5, 3.0, 50)
    np.testing.assert_allclose(series.relaxation_modulus(time), BURGERS.relaxation_modulus(time), rtol=1e-9)


@given(
    st.lists(st.tuples(decades, decades), min_size=0, max_size=6),
    decades,
    st.one_of(st.just(np.inf), decades),
)
@settings(max_examples=60, deadline=None)
def test_any_chain_with_a_spring_is_the_same(elements, spring, dashpot):
    chain = KelvinChain(
        1e10 * 10.0**spring,
        1e9 * 10.0**dashpot if np.isfinite(dashpot) else np.inf,
        tuple(1e10 * 10.0**modulus for modulus, _ in elements),
        tuple(1e9 * 10.0**viscosity for _, viscosity in elements),
    )
    series = series_of(chain)
    np.testing.assert_allclose(series.complex_modulus(OMEGA), chain.complex_modulus(OMEGA), rtol=1e-6)
    assert (series.long_term == 0.0) == np.isfinite(chain.dashpot)


def test_elements_of_one_rate_are_one_branch():
    chain = KelvinChain(1e10, np.inf, (2e10, 4e10), (1e9, 2e9))
    series = series_of(chain)
    assert len(series.moduli) == 1
    np.testing.assert_allclose(series.complex_modulus(OMEGA), chain.complex_modulus(OMEGA), rtol=1e-12)


def test_a_chain_without_spring_is_refused():
    with pytest.raises(InputError, match="no spring"):
        series_of(KelvinChain(np.inf, 1e9, (1e10,), (1e9,)))


@pytest.mark.parametrize(
    ("allowed", "terms"), [(Miss(5.0, 2.5), 8), (Miss(1.0, 0.5), 12), (Miss(1.0, 90.0), 11)]
)
def test_the_stated_error_holds_between_the_fitted_frequencies_and_takes_few_terms(allowed, terms):
    """Ten decades; evenly spaced times with least squares alone take more."""
    low, high = 1e-4, 1e6
    series, error = fit_series(at_15, low, high, allowed)
    assert error.is_within(allowed) and len(series.moduli) <= terms
    omega = np.geomspace(low, high, 1237)
    ratio = series.complex_modulus(omega) / at_15(omega)
    assert 100.0 * np.abs(np.abs(ratio) - 1.0).max() <= 1.01 * error.percent
    assert np.degrees(np.abs(np.angle(ratio)).max()) <= 1.01 * error.degrees
    assert error == miss(series, at_15, low, high)


def test_a_series_is_found_again():
    """From its own modulus, with as many terms as it has."""
    known = MaxwellSeries(2e8, (3e9, 8e9, 5e9), (1e-3, 0.05, 4.0))
    series, error = fit_series(known.complex_modulus, 1e-3, 1e5, Miss(0.1, 0.1))
    assert len(series.moduli) == 3
    np.testing.assert_allclose(series.times, known.times, rtol=1e-4)
    np.testing.assert_allclose(series.moduli, known.moduli, rtol=1e-4)


def test_a_series_is_as_far_off_as_the_worse_of_its_two_errors():
    assert _size(Miss(2.0, 0.1), Miss(1.0, 0.5)) == _size(Miss(0.1, 1.0), Miss(1.0, 0.5)) == 2.0


def test_a_solid_has_a_long_term_modulus_of_the_share_asked_for():
    solid = MaxwellSeries(0.0, (3e9, 1e9), (1.0, 2.0)).solid(1e-3)
    assert solid.long_term / solid.instantaneous == pytest.approx(1e-3)
    assert MaxwellSeries(1e8, (1e9,), (1.0,)).solid(1e-3).long_term == 1e8
    assert MaxwellSeries(1e9, (3e9, 1e9), (1.0, 2.0)).weights == (0.6, 0.2)


def test_the_largest_allowed_number_of_branches_is_tried(monkeypatch):
    """Where evenly spaced branches first stay within the errors, so many may be the most, and one less are too few."""
    band, allowed = (1e-2, 1e3), Miss(5.0, 2.0)
    omega = maxwell_fitting._grid(*band, maxwell_fitting.FITTED)

    def follows(terms):
        tries = (_spaced(omega, at_15(omega), terms, reach, allowed) for reach in REACH)
        return any(miss(series, at_15, *band).is_within(allowed) for series in tries)

    needed = next(terms for terms in range(1, 50) if follows(terms))
    monkeypatch.setattr(maxwell_fitting, "MOST_TERMS", needed)
    fit_series(at_15, *band, allowed)
    monkeypatch.setattr(maxwell_fitting, "MOST_TERMS", needed - 1)
    with pytest.raises(InputError, match=f"no Prony series of {needed - 1} terms"):
        fit_series(at_15, *band, allowed)
