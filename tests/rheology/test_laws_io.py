"""Law files come back as they went, and a damaged one is named."""

import json

import pytest

from asphalt_nscd.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import read_law, read_spectrum, write_law, write_spectrum
from asphalt_nscd.rheology.spectrum import TwoS2P1D

LAW = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
SPECTRUM = TwoS2P1D(80e6, 42e9, 0.2, 0.6, 1.64, 0.14, 28.0, 11.7, 79.9, 15.0)


def test_burgers_round_trip(tmp_path):
    path = tmp_path / "laws" / "T15.json"
    errors = {"modulus_m": 1e8, "viscosity_m": 2e7, "modulus_k": 3e8, "viscosity_k": 4e6}
    write_law(path, LAW, source="fitted", temperature=15, std_error=errors, rms_log_residual=0.01)
    assert read_law(path) == LAW
    assert json.loads(path.read_text()) == {
        "law": "burgers", "source": "fitted", "temperature_C": 15.0,
        "Em_Pa": 24.3e9, "eta_m_Pa_s": 3.71e9, "Ek_Pa": 48.4e9, "eta_k_Pa_s": 0.773e9,
        "std_error": {"Em_Pa": 1e8, "eta_m_Pa_s": 2e7, "Ek_Pa": 3e8, "eta_k_Pa_s": 4e6},
        "rms_log_residual": 0.01,
    }  # fmt: skip


def test_spectrum_round_trip(tmp_path):
    path = tmp_path / "spectrum.json"
    write_spectrum(path, SPECTRUM, source="reconstructed", rms_log_residual=0.04)
    assert read_spectrum(path) == SPECTRUM


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ('{"law": "2s2p1d"}', "holds law '2s2p1d', not 'burgers'"),
        ("[1, 2]", "holds law None"),
        ("{", "not valid JSON"),
        ('{"law": "burgers", "Em_Pa": 1.0}', "'eta_m_Pa_s' is missing"),
        ('{"law": "burgers", "Em_Pa": "stiff"}', "'Em_Pa' is missing or not a number"),
        ('{"law": "burgers", "Em_Pa": -1, "eta_m_Pa_s": 1, "Ek_Pa": 1, "eta_k_Pa_s": 1}', "modulus_m = -1"),
    ],
)
def test_bad_law_files_are_refused_by_name(tmp_path, content, words):
    path = tmp_path / "law.json"
    path.write_text(content)
    with pytest.raises(InputError, match=words) as caught:
        read_law(path)
    assert str(path) in str(caught.value)
