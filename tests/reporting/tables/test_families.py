"""Burgers laws and one law for all, fitted to the same averages."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.reporting.tables.families import _fitted
from asphalt_nscd.rheology.burgers import Burgers

pytestmark = pytest.mark.slow


def test_each_law_is_fitted_to_the_averages_of_all_specimens():
    """Data that are Burgers' at each temperature: these laws meet the averages, the one law does not."""
    frequency = np.array([0.1, 1.0, 10.0])
    frames = []
    for temperature, softer in ((4.0, 1.0), (20.0, 0.3), (40.0, 0.05)):
        law = Burgers(20e9 * softer, 20e9 * softer, 10e9 * softer, 1e9 * softer)
        modulus = law.complex_modulus(2.0 * np.pi * frequency)
        for specimen, factor in (("a", 0.9), ("b", 1.1)):
            columns = {"specimen": specimen, "temperature_C": temperature, "frequency_Hz": frequency}
            columns |= {"E_MPa": factor * np.abs(modulus) / 1e6, "phase_deg": np.degrees(np.angle(modulus))}
            frames.append(pd.DataFrame(columns))
    data = pd.concat(frames, ignore_index=True)
    means = data.groupby(["temperature_C", "frequency_Hz"])[["E_MPa", "phase_deg"]].mean().reset_index()
    fitted = _fitted(data)
    np.testing.assert_allclose(fitted["burgers"]["E_MPa"], means["E_MPa"], rtol=1e-6)
    np.testing.assert_allclose(fitted["burgers"]["phase_deg"], means["phase_deg"], rtol=1e-6)
    missed = fitted["law"]["E_MPa"] / means["E_MPa"] - 1.0
    assert 0.01 < missed.abs().mean() < 0.3
