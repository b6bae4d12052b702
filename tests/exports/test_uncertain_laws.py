"""The covariance of a law reaches Prony terms and AASHTOWare's rows."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import asphalt_nscd as an
from asphalt_nscd.exports.card import make_card
from asphalt_nscd.exports.law import read_law_file
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.measurements.units import PSI
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.priors import prior_of
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum import parameters
from asphalt_nscd.rheology.spectrum_fitting import fit_spectrum
from asphalt_nscd.rheology.spectrum_io import Uncertainty, fit_content

TRUTH = TwoS2P1D(100e6, 30e9, 0.2, 0.58, 2.2, 0.06, 100.0, WLF(20.0, 140.0, 15.0))
TESTED = {"temperatures_C": (-10.0, 5.0, 20.0, 35.0), "frequencies_Hz": (0.1, 1.0, 5.0, 25.0)}


@pytest.fixture(scope="module")
def fitted(tmp_path_factory):
    """law.json of a fit to tests that scatter by 2 %; (path, fit)."""
    omega, temperature = (
        grid.ravel()
        for grid in np.meshgrid(2 * np.pi * np.array(TESTED["frequencies_Hz"]), TESTED["temperatures_C"])
    )
    noise = 0.02 * np.random.default_rng(4).standard_normal((2, omega.size))
    modulus = TRUTH.complex_modulus(omega, temperature) * np.exp(noise[0] + 1j * noise[1])
    fit = fit_spectrum(omega, temperature, modulus, 15.0, prior=prior_of("2s2p1d"))
    path = tmp_path_factory.mktemp("law") / "law.json"
    write_json(path, fit_content(fit, "fitted", Uncertainty(fit.covariance, (np.inf, np.inf))))
    return path, fit


def drawn(fit, count=400):
    """Laws whose parameters scatter by the covariance of the fit."""
    random, names = np.random.default_rng(1), list(parameters(fit.law))
    log = np.log(list(parameters(fit.law).values()))
    for x in random.multivariate_normal(log, fit.covariance, count):
        values = dict(zip(names, np.exp(x), strict=True))
        shift = WLF(values.pop("c1"), values.pop("c2"), 15.0)
        yield TwoS2P1D(**values, shift=shift)


def test_moduli_of_the_series_scatter_as_told(fitted):
    path, fit = fitted
    card = make_card(
        read_law_file(path, TESTED["temperatures_C"], TESTED["frequencies_Hz"]), ExportSettings()
    )
    omega = np.geomspace(*card.law.reduced_band(), 200)
    turned = 1j * omega[:, None] * np.array(card.series.times)
    branches = np.hstack([np.ones((omega.size, 1)), turned / (1 + turned)])
    # The series stands for the law: where that moves, the series is to move as much, but for its own small error.
    own = card.series.complex_modulus(omega) / fit.law.complex_modulus(omega, 15.0)
    moduli = []
    for law in drawn(replace(fit, covariance=1e-4 * fit.covariance)):  # so little that the first order holds
        star = own * law.complex_modulus(omega, 15.0)
        system = branches / star[:, None]
        both, ones = np.vstack([system.real, system.imag]), np.repeat([1.0, 0.0], omega.size)
        moduli.append(np.linalg.lstsq(both, ones, rcond=None)[0])
    size = 100.0 * np.std(moduli, axis=0)
    assert card.half_widths == pytest.approx(1.96 * size, rel=0.15)
    assert (card.half_widths[1:] > 0.002 * np.array(card.series.moduli)).all()


def test_few_freedoms_widen_by_students_factor(fitted, tmp_path):
    """3.182 of three, tabulated, for the 1.960 of many."""
    path, fit = fitted
    write_json(tmp_path / "law.json", fit_content(fit, "fitted", Uncertainty(fit.covariance, (40.0, 3.0))))
    few, many = (
        make_card(
            read_law_file(one, TESTED["temperatures_C"], TESTED["frequencies_Hz"]), ExportSettings()
        ).half_widths
        for one in (tmp_path / "law.json", path)
    )
    assert few / many == pytest.approx(3.18245 / 1.95996, rel=1e-5)


def test_rows_for_aashtoware_have_the_interval_of_the_law(fitted, tmp_path):
    path, fit = fitted
    an.export(path, tmp_path / "m.csv", "mepdg", **TESTED)
    text = (tmp_path / "m.csv").read_text()
    rows = dict(re.findall(r"^# (\d+), (.*)$", text, re.MULTILINE))
    assert list(rows) == ["14", "40", "70", "100", "130"]
    low, high = map(float, rows["70"].split(", ")[4].split(" to "))  # 10 Hz
    kelvin = (70.0 - 32.0) / 1.8
    moduli = [np.abs(law.complex_modulus(2 * np.pi * 10.0, kelvin)) / PSI for law in drawn(fit)]
    assert np.log(high / low) / 2 == pytest.approx(1.96 * np.std(np.log(moduli)), rel=0.15)
    table = pd.read_csv(tmp_path / "m.csv", comment="#")
    assert low < table["E_psi_at_10_Hz"][2] < high


def test_intervals_stand_in_each_format(fitted, tmp_path):
    path, _ = fitted
    for form, ending in (("abaqus", "inp"), ("ansys", "inp"), ("comsol", "txt"), ("csv", "csv")):
        an.export(path, tmp_path / f"{form}.{ending}", form, **TESTED)
        text = re.sub(r"\s*\n\S* *", " ", (tmp_path / f"{form}.{ending}").read_text())
        assert "95 % interval of the law in the band" in text and "95 % intervals of the moduli" in text, form
    table = pd.read_csv(tmp_path / "csv.csv", comment="#")
    assert (table["half_95_Pa"][1:] < table["modulus_Pa"][1:]).all()


def test_a_damaged_covariance_is_refused_and_none_is_needed(fitted, tmp_path):
    path, _ = fitted
    content = read_json(path)
    write_json(tmp_path / "law.json", content | {"covariance_of_logarithms": {"values": [[1.0]]}})
    with pytest.raises(InputError, match="covariance_of_logarithms"):
        read_law_file(tmp_path / "law.json")
    content.pop("covariance_of_logarithms")
    write_json(tmp_path / "law.json", content)
    an.export(tmp_path / "law.json", tmp_path / "law.csv", "csv", **TESTED)
    assert "half_95" not in (tmp_path / "law.csv").read_text()
