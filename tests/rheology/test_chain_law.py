"""From a law file of all temperatures to that of the bonds at one."""

import json

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.chain_law import chain_law
from asphalt_nscd.rheology.laws_io import read_bond_law
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_io import write_spectrum

SPECTRUM = TwoS2P1D(80e6, 42.6e9, 0.2, 0.6, 1.64, 0.14, 28.0, WLF(11.7, 79.9, 15.0))


def test_chain_of_a_spectrum_file(tmp_path):
    """At the temperature asked for, not that of reference; times the factor; error and band in the file."""
    write_spectrum(tmp_path / "mix.json", SPECTRUM, source="fitted", rms_log_residual=0.04)
    chain_law(tmp_path / "mix.json", 30.0, 3.0, 40.0, 1e-3, 1.02, tmp_path / "T30.json")
    frequency = np.geomspace(3.0, 40.0, 50)
    modulus = read_bond_law(tmp_path / "T30.json").complex_modulus(2 * np.pi * frequency)
    error = np.abs(np.log(modulus / (1.02 * SPECTRUM.complex_modulus(2 * np.pi * frequency, 30.0)))).max()
    content = json.loads((tmp_path / "T30.json").read_text())
    assert content["largest_log_error"] == pytest.approx(error, rel=0.1) and error < 1e-3
    assert (content["temperature_C"], content["lowest_Hz"], content["highest_Hz"]) == (30.0, 3.0, 40.0)
    assert content["source"] == str(tmp_path / "mix.json")


def test_refusals_name_file_and_temperature(tmp_path):
    write_spectrum(tmp_path / "mix.json", SPECTRUM, source="fitted", rms_log_residual=0.04)
    with pytest.raises(InputError, match="mix.json at -70 degC: WLF shift"):
        chain_law(tmp_path / "mix.json", -70.0, 3.0, 40.0, 1e-3, 1.0, tmp_path / "T.json")
    with pytest.raises(InputError, match="mix.json at 15 degC: no Kelvin chain"):
        chain_law(tmp_path / "mix.json", 15.0, 1e-3, 1e3, 1e-14, 1.0, tmp_path / "T.json")
    assert not (tmp_path / "T.json").exists()
