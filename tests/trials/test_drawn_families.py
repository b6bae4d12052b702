"""Measurements of other families are of a mix, about their own law, and not of the family that is fitted."""

from __future__ import annotations

import numpy as np
import pytest
from families import SHIFTS, draw, law

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
