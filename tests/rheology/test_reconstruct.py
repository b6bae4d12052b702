"""Reconstructed measurements: the law behind them, and scatter that is nothing but scatter."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.reduction import reduce_table
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.reconstruct import fit_published, reconstruct_table
from asphalt_nscd.rheology.sampling import Sampling
from asphalt_nscd.rheology.spectrum_io import read_spectrum

PAPER = Path(__file__).parents[2] / "data" / "paper"
TABLE3, GEOMETRY = PAPER / "table3_burgers.csv", PAPER / "geometry.csv"
MAPPING = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
OMEGA = 2 * np.pi * np.array([3.0, 6, 10, 25, 40])


@pytest.fixture(scope="module")
def smooth():
    return fit_published(TABLE3)[1].law


def draw(tmp_path, geometry=GEOMETRY, law_output=None, **options):
    frame = reconstruct_table(
        TABLE3, geometry, tmp_path / "measurements.csv", Sampling(**options), law_output
    )
    return frame, reduce_table(tmp_path / "measurements.csv", geometry, tmp_path / "measured.csv")


def points(law_of):
    temperatures, _ = read_published(TABLE3)
    rows = []
    for temperature in temperatures:
        modulus = law_of(temperature)
        rows.append(
            pd.DataFrame(
                {
                    "temperature_C": temperature,
                    "frequency_Hz": OMEGA / (2 * np.pi),
                    "E_MPa": np.abs(modulus) * 1e-6,
                    "phase_deg": np.degrees(np.angle(modulus)),
                }
            )
        )
    return pd.concat(rows)


def test_smooth_law_behind_table_3(smooth):
    """Parameters found independently by a prototype."""
    assert smooth.glassy_modulus == pytest.approx(42.6e9, rel=2e-3)
    assert smooth.k == pytest.approx(0.20, abs=5e-3)
    assert smooth.h == pytest.approx(0.60, abs=5e-3)
    assert smooth.delta == pytest.approx(1.64, abs=0.01)
    assert np.log(smooth.tau) == pytest.approx(-1.97, abs=0.01)
    assert np.log(smooth.beta) == pytest.approx(3.35, abs=0.01)
    assert (smooth.shift.c1, smooth.shift.c2) == pytest.approx((11.7, 79.9), abs=0.1)


def test_prediction_of_table_4(smooth):
    """Distance of the Table 3 laws from the smooth law; Table 4 has had no part in it."""
    temperatures, laws = read_published(TABLE3)
    by_temperature = dict(zip(temperatures, laws, strict=True))
    errors = mean_relative_error(
        points(lambda t: smooth.complex_modulus(OMEGA, t)),
        points(lambda t: by_temperature[t].complex_modulus(OMEGA)),
    )
    assert list(errors["mre_phase_percent"]) == pytest.approx([23.7, 10.3, 7.2, 8.4, 7.7, 4.7], abs=0.06)
    assert list(errors["mre_E_percent"]) == pytest.approx([0.32, 1.39, 2.57, 2.56, 3.42, 4.24], abs=0.006)


def test_without_scatter_the_table_reduces_to_the_smooth_law(smooth, tmp_path):
    scatter = {"specimen_scatter": 0, "modulus_scatter": 0, "phase_scatter_deg": 0}
    frame, reduced = draw(tmp_path, law_output=tmp_path / "law.json", seed=1, specimens=2, **scatter)
    assert len(frame) == 2 * 30 and set(reduced["origin"]) == {"reconstructed"}
    assert set(frame["z0_m"]) == {63e-6}
    modulus = smooth.complex_modulus(2 * np.pi * reduced["frequency_Hz"].to_numpy(), reduced["temperature_C"])
    np.testing.assert_allclose(reduced["E_MPa"] * 1e6, np.abs(modulus), rtol=1e-8)
    np.testing.assert_allclose(reduced["phase_deg"], np.degrees(np.angle(modulus)), rtol=1e-7)
    assert read_spectrum(tmp_path / "law.json") == smooth
    content, burgers = json.loads((tmp_path / "law.json").read_text()), read_published(TABLE3)
    missed = [
        np.log(law.complex_modulus(OMEGA) / smooth.complex_modulus(OMEGA, t)) for t, law in zip(*burgers)
    ]
    assert content["rms_log_residual"] == pytest.approx(np.sqrt(np.mean(np.abs(missed) ** 2)), rel=1e-9)
    assert content["source"] == "reconstructed" and set(content["std_error"]) >= {"E_glassy_Pa", "wlf_C1"}


def test_scatter_is_centred_and_as_large_as_stated(smooth, tmp_path):
    _, reduced = draw(tmp_path, MAPPING, seed=7, specimens=400)
    modulus = smooth.complex_modulus(2 * np.pi * reduced["frequency_Hz"].to_numpy(), reduced["temperature_C"])
    log_norm = np.log(reduced["E_MPa"] * 1e6 / np.abs(modulus)).to_numpy().reshape(400, 30)
    phase = (reduced["phase_deg"] - np.degrees(np.angle(modulus))).to_numpy()
    scale = log_norm.mean(axis=1)
    assert scale.mean() == pytest.approx(0, abs=3 * 0.03 / 20)
    assert scale.std() == pytest.approx(np.hypot(0.03, 0.01 / np.sqrt(30)), rel=0.1)
    assert (log_norm - scale[:, None]).std() == pytest.approx(0.01 * np.sqrt(29 / 30), rel=0.03)
    assert phase.mean() == pytest.approx(0, abs=3 * 0.3 / np.sqrt(phase.size))
    assert phase.std() == pytest.approx(0.3, rel=0.03)


def test_a_seed_repeats_and_specimens_do_not_depend_on_their_number(tmp_path):
    two, _ = draw(tmp_path, seed=5, specimens=2)
    four, _ = draw(tmp_path, seed=5, specimens=4)
    pd.testing.assert_frame_equal(two, four[:60])
    other, _ = draw(tmp_path, seed=6, specimens=2)
    assert not np.any(other["F0_N"] == two["F0_N"])
    first, second = (two[two["specimen"] == name]["F0_N"].to_numpy() for name in ("1", "2"))
    assert not np.any(first == second)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"specimens": 0}, "specimens = 0; give a number at least 1"),
        ({"specimens": 5}, "specimen '5' has no geometry"),
        ({"frequencies": (3.0, -1.0)}, "must be positive"),
        ({"frequencies": ()}, "must be positive"),
        ({"frequencies": (3.0, float("nan"))}, "must be positive"),
        ({"frequencies": (3.0, 3.0)}, "give each once"),
        ({"amplitude": 0.0}, "amplitude_m = 0; give a number greater than 0"),
        ({"modulus_scatter": -0.1}, "modulus_scatter = -0.1; give a number at least 0"),
        ({"phase_scatter_deg": float("nan")}, "phase_scatter_deg = nan;"),
        ({"seed": -1}, "seed = -1"),
    ],
)
def test_impossible_options_are_refused(tmp_path, options, words):
    with pytest.raises(InputError, match=words):
        reconstruct_table(TABLE3, GEOMETRY, tmp_path / "out.csv", Sampling(**({"seed": 1} | options)))
    assert not (tmp_path / "out.csv").exists()
