"""Files of continuous laws come back as they went, and a damaged one is named."""

import json
from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.parabolic import HuetSayegh, TwoS2P1D
from asphalt_nscd.rheology.shift import WLF, Arrhenius
from asphalt_nscd.rheology.spectrum_io import Uncertainty, read_spectrum, student, write_spectrum

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


def test_the_band_of_a_law_adds_parameters_form_and_a_shift_beyond_the_tests():
    """10 % of tau; 0.02 and 0.003 of the form; beyond 0 to 20 degC ln a_T is off by 0.1 (|T - 10| / 25)^3 more."""
    omega, temperature = np.full(3, 50.0), np.array([10.0, 30.0, -15.0])
    covariance = np.zeros((7, 7))
    covariance[5, 5] = 0.1**2
    known = Uncertainty(covariance, (np.inf, 2.0), (0.02, 0.003), (0.0, 20.0))
    half = known.half(HUET, omega, temperature)
    ends = [
        np.log(replace(HUET, tau=by * HUET.tau).complex_modulus(omega, temperature))
        for by in np.exp([1e-4, -1e-4])
    ]
    steep = (ends[0] - ends[1]) / 2e-4
    beyond = 0.1 * np.array([0.0, 0.8**3 - 0.4**3, 1.0**3 - 0.4**3])
    for part, slope, form, t in (
        (half.real, steep.real, 0.02, 1.959964),
        (half.imag, steep.imag, 0.003, 4.302653),
    ):
        assert part == pytest.approx(t * np.sqrt((0.1**2 + beyond**2) * slope**2 + form**2), rel=1e-5)
    assert student(np.inf) == pytest.approx(1.959964) and student(10.0) == pytest.approx(2.228139)


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
