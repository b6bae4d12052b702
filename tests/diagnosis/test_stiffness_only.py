"""Tests of |E*| without a phase: the curve that made them is found, and nothing is said of causes."""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.cli import main
from asphalt_nscd.diagnosis.record.stiffness_only import fit_stiffness
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.laws_of_modulus import Sigmoid
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.table_import.campaign import read_campaign

TRUE = Sigmoid(63e6, 31.6e9, tau=0.1 / (2 * np.pi), gamma=0.22, shift=WLF(20.0, 170.0, 21.11))
LEVELS = {"A": 0.02, "B": -0.03, "C": 0.01}  # ln of the specimens' scales
SCATTER = 0.02


@pytest.fixture
def table(tmp_path):
    random = np.random.default_rng(3)
    rows = []
    for specimen, t, f in product("ABC", (14.0, 40.0, 70.0, 100.0, 130.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)):
        value = 1e-6 * abs(complex(TRUE.complex_modulus(2 * np.pi * f, (t - 32.0) / 1.8)))
        rows.append(
            (specimen, t, f, value * np.exp(LEVELS[specimen] + SCATTER * random.standard_normal()) / 6.894757)
        )
    path = tmp_path / "t.csv"
    names = ["Specimen", "Temperature (\N{DEGREE SIGN}F)", "Frequency (Hz)", "E* (ksi)"]
    pd.DataFrame(rows, columns=names).to_csv(path, index=False)
    return path


def test_the_curve_that_made_them_is_found(table):
    found = fit_stiffness(read_campaign([table])[0])
    temperature, frequency = np.array([-5.0, 15.0, 30.0, 50.0]), np.array([10.0, 10.0, 1.0, 0.5])
    true = 1e-6 * np.abs(TRUE.complex_modulus(2 * np.pi * frequency, temperature))
    said = found.modulus(temperature, frequency)
    assert ((said["E_low_MPa"] < true) & (true < said["E_high_MPa"])).all()
    assert said["E_MPa"].to_numpy() == pytest.approx(true, rel=0.05)
    # Three specimens that usually differ by 3 %: no better than 2 %, no worse than 8 %.
    assert (np.log(said["E_high_MPa"] / said["E_MPa"]).between(0.02, 0.08)).all()
    # Of 90 tests the scatter is known within 8 %; the mean of a specimen's 30 tests within 0.0037.
    assert found.within == pytest.approx(SCATTER, rel=0.16)
    assert found.between == pytest.approx(np.std(list(LEVELS.values()), ddof=1), abs=0.004)

    # Each level is known from 30 tests, and drawn to none as by (scatter of a test / 3 %)^2 more.
    tests = found.tests.assign(
        level=np.log(
            found.tests["curve_E_MPa"]
            / found.fit.law.complex_modulus(
                2.0 * np.pi * found.tests["frequency_Hz"], found.tests["temperature_C"]
            ).__abs__()
            * 1e6
        )
    )
    levels = tests.groupby("specimen")["level"].mean()
    off = np.log(tests["E_MPa"] / tests["curve_E_MPa"]) + tests["level"]
    assert levels.to_numpy() == pytest.approx(
        off.groupby(tests["specimen"]).sum() / (30.0 + (found.within / 0.03) ** 2), rel=1e-4
    )
    assert tests["residual_percent"].to_numpy() == pytest.approx(100.0 * np.expm1(off - tests["level"]))
    assert found.between == pytest.approx(levels.std(ddof=1))
    shift = found.fit.law.shift.factor(tests["temperature_C"].to_numpy())
    assert tests["reduced_frequency_Hz"].to_numpy() == pytest.approx(tests["frequency_Hz"].to_numpy() * shift)
    assert shift[0] > 10.0  # the coldest is as if tested far faster
    free = 90 - 3 - len(found.uncertainty.covariance)
    assert found.within == pytest.approx(np.sqrt(((off - tests["level"]) ** 2).sum() / free))


def test_the_command_says_what_was_not_judged(table, tmp_path, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["diagnose", str(table), "--output", str(tmp_path / "out")])
    assert not ended.value.code
    said = capsys.readouterr().out
    assert "90 tests of 3 specimens at -10, 4.44, 21.11, 37.78 and 54.44 degC: |E*| alone, no phase." in said
    assert "cannot be held against causality" in said
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {"stiffness.json", "stiffness_residuals.csv", "master_curve.csv", "diagnosis.html"}
    page = (tmp_path / "out" / "diagnosis.html").read_text(encoding="utf-8")
    assert "<svg" in page and "Not judged" in page


def test_one_temperature_is_refused(table, tmp_path):
    whole = pd.read_csv(table)
    whole[whole.iloc[:, 1] == 40.0].to_csv(tmp_path / "one.csv", index=False)
    with pytest.raises(InputError, match="one temperature has no master curve"):
        fit_stiffness(read_campaign([tmp_path / "one.csv"])[0])


def test_the_farthest_test_may_lie_below_the_curve(table, tmp_path):
    whole = pd.read_csv(table)
    whole.iloc[40, 3] *= 0.7
    whole.to_csv(tmp_path / "low.csv", index=False)
    said = dict(fit_stiffness(read_campaign([tmp_path / "low.csv"])[0]).rows)["Farthest"]
    specimen, frequency = whole.iloc[40, 0], whole.iloc[40, 2]
    assert said.startswith("-") and f"specimen {specimen}" in said and f"{frequency:g} Hz" in said
