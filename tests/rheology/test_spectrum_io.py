"""Files of continuous laws come back as they went, and a damaged one is named."""

import json

import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.parabolic import HuetSayegh, TwoS2P1D
from asphalt_nscd.rheology.shift import WLF, Arrhenius
from asphalt_nscd.rheology.spectrum_io import read_spectrum, write_spectrum

SPECTRUM = TwoS2P1D(80e6, 42e9, 0.2, 0.6, 1.64, 0.14, 28.0, WLF(11.7, 79.9, 15.0))
HUET = HuetSayegh(80e6, 42e9, 0.2, 0.6, 1.64, 0.14, Arrhenius(2e5, 10.0))


@pytest.mark.parametrize("law", [SPECTRUM, HUET])
def test_round_trip(tmp_path, law):
    path = tmp_path / "spectrum.json"
    write_spectrum(path, law, source="reconstructed", rms_log_residual=0.04)
    assert read_spectrum(path) == law


def test_content(tmp_path):
    path = tmp_path / "spectrum.json"
    write_spectrum(
        path, HUET, source="fitted", rms_log_residual=0.04, std_error={"k": 0.01}, unseen=["static_modulus"]
    )
    assert json.loads(path.read_text()) == {
        "law": "huet-sayegh", "shift": "arrhenius", "source": "fitted",
        "E_static_Pa": 80e6, "E_glassy_Pa": 42e9, "k": 0.2, "h": 0.6, "delta": 1.64, "tau_s": 0.14,
        "activation_energy_J_mol": 2e5, "reference_temperature_C": 10.0,
        "std_error": {"k": 0.01}, "unseen": ["E_static_Pa"], "rms_log_residual": 0.04,
    }  # fmt: skip


def test_what_a_prior_decided_is_written(tmp_path):
    content = write_spectrum(
        tmp_path / "law.json", SPECTRUM, source="", rms_log_residual=0.0, unseen=["c2"], from_prior=["c2"]
    )
    assert content["unseen"] == content["from_prior"] == ["wlf_C2_K"]
    assert read_spectrum(tmp_path / "law.json") == SPECTRUM


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"law": "burgers"}, "holds law 'burgers', not '2s2p1d' or 'huet-sayegh'"),
        ({"shift": "none"}, "key 'shift' is 'none'; give one of wlf, arrhenius"),
        ({"h": None}, "key 'h' is missing or not a number"),
        ({"wlf_C1": True}, "key 'wlf_C1' is missing or not a number"),
        ({"tau_s": 0.0}, "tau_s and beta above zero"),
        ({"tau_s": float("nan")}, "key 'tau_s' is missing or not a number"),
        ({"wlf_C1": -20.0}, "wlf_C1 = -20; give one above zero, with which a warmer mix is softer"),
        ({"h": 0.1}, "needs 0 < k <= h < 1"),
        ({"h": 1.0}, "needs 0 < k <= h < 1"),
        ({"k": 0.0}, "needs 0 < k <= h < 1"),
        ({"E_static_Pa": 50e9}, "E_static_Pa < E_glassy_Pa"),
    ],
)
def test_bad_files_are_refused_by_name(tmp_path, changes, words):
    path = tmp_path / "spectrum.json"
    content = write_spectrum(path, SPECTRUM, source="", rms_log_residual=0.0)
    path.write_text(json.dumps(content | changes))
    with pytest.raises(InputError, match=words) as caught:
        read_spectrum(path)
    assert str(path) in str(caught.value)
