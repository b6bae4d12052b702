"""Law files, alone and beside a diagnosis."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from naive.prony import SPECTRA

from asphalt_nscd.exports import card
from asphalt_nscd.exports.law import read_law_file
from asphalt_nscd.rheology.maxwell_fitting import fit_series
from asphalt_nscd.rheology.spectrum_io import write_spectrum


@pytest.fixture(autouse=True)
def series_fitted_once(monkeypatch, fitted_series):
    """One series for all formats of a law, in place of a fit for each, which `rheology/test_maxwell.py` tests."""

    def fit(modulus, lowest_omega, highest_omega, allowed):
        law = modulus(np.geomspace(lowest_omega, highest_omega, 9)).tobytes()
        key = (law, lowest_omega, highest_omega, allowed)
        if key not in fitted_series:
            fitted_series[key] = fit_series(modulus, lowest_omega, highest_omega, allowed)
        return fitted_series[key]

    monkeypatch.setattr(card, "fit_series", fit)


@pytest.fixture(scope="session")
def fitted_series():
    return {}


@pytest.fixture(params=SPECTRA)
def spectrum(request, tmp_path):
    """(law file as read, the law, its tested pairs)."""
    law, (temperatures, frequencies) = SPECTRA[request.param]
    path = tmp_path / "law.json"
    write_spectrum(path, law, source="fitted (synthetic)", rms_log_residual=0.03)
    pairs = np.array([(t, f) for t in temperatures for f in frequencies]).T
    return read_law_file(path, temperatures, frequencies), law, pairs


@pytest.fixture
def folder(tmp_path):
    """A folder as `diagnose` leaves it, of made-up tests."""
    law, (temperatures, frequencies) = SPECTRA["FD"]
    write_spectrum(tmp_path / "law.json", law, source="fitted (synthetic)", rms_log_residual=0.03)
    pairs = np.array([(t, f) for t in temperatures for f in frequencies])
    modulus = law.complex_modulus(2 * np.pi * pairs[:, 1], pairs[:, 0])
    rows = {"specimen": ["=A1"[1:]] * len(pairs), "temperature_C": pairs[:, 0], "frequency_Hz": pairs[:, 1]}
    size, phase = np.abs(modulus) / 1e6, np.degrees(np.angle(modulus))
    rows |= {"E_MPa": 1.02 * size, "phase_deg": phase + 0.3}
    for when in ("before", "after"):
        rows |= {f"E_{when}_MPa": size, f"phase_{when}_deg": phase}
        rows |= {f"residual_E_{when}_percent": 2.0, f"residual_phase_{when}_deg": 0.3}
    pd.DataFrame(rows).to_csv(tmp_path / "residuals.csv", index=False)
    return tmp_path
