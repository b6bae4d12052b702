"""Table 1, and the rivals of the law of all temperatures."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.store import write_table
from asphalt_nscd.reporting.tables import rivals, table1
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.rivals import left_out
from asphalt_nscd.rheology.rivals import rivals as laws_of
from asphalt_nscd.rheology.shift import WLF

PAPER = Path(__file__).parents[3] / "data/paper"
LAW = TwoS2P1D(30e6, 36e9, k=0.2, h=0.58, delta=2.2, tau=0.06, beta=250.0, shift=WLF(12.0, 90.0, 15.0))


def test_spheres_stand_for_what_the_sieves_retain():
    table = table1.make(grading=[PAPER / "table1_grading.csv"], used=[PAPER / "table2_counts.csv"])
    assert list(table["passing_percent"]) == sorted(table["passing_percent"], reverse=True)
    assert table["retained_percent"].iloc[:3].tolist() == [0.0, 10.0, 15.0]
    shown = table[table["spheres"].notna()]
    assert shown["spheres"].sum() == 14160 and shown["diameter_mm"].min() == 2.0
    np.testing.assert_allclose(shown["volume_percent"], shown["retained_shown_percent"], rtol=0.02)


@pytest.fixture
def exact(tmp_path):
    """Tests of one specimen that lie on a 2S2P1D law."""
    temperature, frequency = (a.ravel() for a in np.meshgrid([-10.0, 5.0, 15.0, 30.0], [1.0, 5.0, 20.0]))
    modulus = LAW.complex_modulus(2 * np.pi * frequency, temperature)
    columns = {
        "specimen": "1",
        "temperature_C": temperature,
        "frequency_Hz": frequency,
        "E_MPa": np.abs(modulus) / 1e6,
        "phase_deg": np.degrees(np.angle(modulus)),
        "origin": "synthetic",
    }
    path = tmp_path / "measured.csv"
    write_table(path, pd.DataFrame(columns))
    return path


@pytest.mark.slow
def test_a_law_predicts_what_it_has_not_seen_only_where_it_is_the_true_one(exact):
    table = rivals.make(measured=[exact]).set_index("law")
    assert list(table["parameters"]) == [9, 8, 9]
    own, prony = table.loc["2S2P1D"], table.loc["Prony"]
    assert own["fitted_E_percent"] < 0.01 and own["inner_temperatures_phase_percent"] < 1.0
    for name in ("inner_temperatures", "end_temperatures", "end_frequencies"):
        assert prony[f"{name}_phase_percent"] > 5.0 * own[f"{name}_phase_percent"]


def test_a_prony_series_is_a_sum_of_maxwell_branches():
    omega, temperature = np.array([1.0, 10.0]), np.array([15.0, 15.0])
    *_, prony = laws_of(omega, temperature, np.array([1e9, 2e9], complex), 15.0)
    x = np.array([np.log(0.1), np.log(0.5), -30.0, -30.0, -30.0, 0.0, 3.0, np.log(0.1), 0.5])
    rate = np.sqrt(10.0)
    reduced = 1j * omega / rate
    expected = 2e9 * (0.1 + 0.5 * reduced / (1.0 + reduced))
    np.testing.assert_allclose(prony.modulus(x, omega, temperature), expected, rtol=1e-9)


def test_the_shift_of_a_prony_series_is_regular_at_its_coldest_test():
    omega, temperature = np.array([1.0, 1.0, 1.0]), np.array([-10.0, 15.0, 40.0])
    *_, prony = laws_of(omega, temperature, np.full(3, 1e9, complex), 15.0)
    x = np.array([np.log(0.1), 0.0, -30.0, -30.0, -30.0, 0.0, 3.0, np.log(0.1), 0.6])
    c2 = 30.0 / 0.6  # the coldest test is 25 K below the reference, and 5 K are kept clear
    shift = 10.0 ** (-0.1 * c2 * (temperature - 15.0) / (c2 + temperature - 15.0))
    expected = 1e9 * (0.1 + 1j * shift / (1.0 + 1j * shift))
    np.testing.assert_allclose(prony.modulus(x, omega, temperature), expected, rtol=1e-9)


def test_what_was_left_out_does_not_come_back_through_the_start():
    """A temperature left out of three leaves the shift undetermined: the fit must not keep it from its start."""
    temperature, frequency = (a.ravel() for a in np.meshgrid([0.0, 15.0, 30.0], [1.0, 5.0, 20.0]))
    omega = 2 * np.pi * frequency
    modulus = LAW.complex_modulus(omega, temperature)
    law = next(iter(laws_of(omega, temperature, modulus, 15.0)))
    whole = law.fit(omega, temperature, modulus)
    elsewhere = law.starts[-1]
    predicted = [
        dict(left_out(law, omega, temperature, modulus, temperature, start))[0.0]
        for start in (whole, elsewhere)
    ]
    cold = temperature == 0.0
    one, other = (law.modulus(x, omega[cold], temperature[cold]) for x in predicted)
    np.testing.assert_allclose(np.abs(one), np.abs(other), rtol=0.02)


def test_errors_of_what_a_law_was_fitted_to_and_has_not_seen(monkeypatch):
    """A stand-in whose coordinates are factors on |E*| and phase; of the tests left out at a value v they say v."""
    temperature, frequency = (a.ravel() for a in np.meshgrid([0.0, 1.0, 2.0, 5.0], [1.0, 2.0, 4.0]))
    omega = 2.0 * np.pi * frequency
    modulus = 1e9 * np.exp(0.5j * np.where(temperature == 2.0, -1.0, 1.0))
    law = SimpleNamespace(
        fit=lambda *tests: (1.01, 0.9),
        modulus=lambda x, w, t: x[0] * 1e9 * np.exp(0.5j * x[1] * np.where(t == 2.0, -1.0, 1.0)),
    )
    monkeypatch.setattr(
        rivals,
        "left_out",
        lambda rival, w, t, e, groups, start: [
            (v, (1.0 + 0.01 * v / (1.0 if groups is t else 2.0 * np.pi), 1.0 - 0.1 * (v == 1.0)))
            for v in np.unique(groups)
        ],
    )
    found = dict(rivals.errors_of(law, omega, temperature, modulus))
    assert found == pytest.approx(
        {
            ("fitted", "E"): 1.0, ("fitted", "phase"): 10.0,
            ("inner_temperatures", "E"): 1.5, ("inner_temperatures", "phase"): 5.0,
            ("end_temperatures", "E"): 2.5, ("end_temperatures", "phase"): 0.0,
            ("inner_frequencies", "E"): 2.0, ("inner_frequencies", "phase"): 0.0,
            ("end_frequencies", "E"): 2.5, ("end_frequencies", "phase"): 0.0,
        }
    )  # fmt: skip
    few = temperature < 5.0  # of three temperatures none can be left out
    found = dict(rivals.errors_of(law, omega[few], temperature[few], modulus[few]))
    assert not any("temperatures" in kind for kind, _ in found) and ("end_frequencies", "E") in found
