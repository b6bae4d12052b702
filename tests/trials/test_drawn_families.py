"""Measurements of other families are of a mix, about their own law, and not of the family that is fitted."""

from __future__ import annotations

import numpy as np
import pytest
from families import SHIFTS, draw, law

from asphalt_nscd.rheology.spectrum_fitting import fit_spectrum

TEMPERATURES, FREQUENCIES = (-10.0, 0.0, 10.0, 15.0, 20.0, 30.0), (3.0, 6.0, 10.0, 25.0, 40.0)


@pytest.mark.parametrize("family", SHIFTS)
def test_moduli_scatter_about_the_law(family):
    table = draw(family, TEMPERATURES, FREQUENCIES, 2020)
    assert len(table) == 120 and set(table["origin"]) == {"synthetic"}
    omega = 2.0 * np.pi * table["frequency_Hz"].to_numpy()
    true = law(family).modulus(omega, table["temperature_C"].to_numpy())
    norm = np.log(1e6 * table["E_MPa"] / np.abs(true))
    apart = table["phase_deg"] - np.degrees(np.angle(true))
    assert 0.005 < norm.groupby(table["specimen"]).std().mean() < 0.015
    assert 0.005 < norm.groupby(table["specimen"]).mean().std() < 0.07
    assert 0.2 < apart.std() < 0.4 and abs(apart.mean()) < 0.1
    assert table["E_MPa"].between(500, 45_000).all() and table["phase_deg"].between(0.5, 60).all()


def test_only_huet_sayegh_is_of_the_fitted_family():
    """2S2P1D with WLF is Huet-Sayegh with Arrhenius where beta is large and C2 is the temperature in kelvin."""
    off = {}
    for family in SHIFTS:
        temperature, frequency = (x.ravel() for x in np.meshgrid(TEMPERATURES, FREQUENCIES, indexing="ij"))
        omega = 2.0 * np.pi * frequency
        true = law(family).modulus(omega, temperature)
        fit = fit_spectrum(omega, temperature, true, 15.0)
        off[family] = np.abs(np.log(fit.law.complex_modulus(omega, temperature) / true)).max()
    assert off.pop("huet_sayegh") < 1e-6
    assert all(1e-4 < miss < 0.05 for miss in off.values()), off
