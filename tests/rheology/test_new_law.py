"""The recipe of CONTRIBUTING for a law, followed: what it says is enough to read, write, fit, export and bend by it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

import asphalt_nscd as an
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology import spectrum
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_coordinates import RANGES
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import read_spectrum, write_spectrum


@dataclass(frozen=True)
class Power:
    """Christensen, Anderson & Marasteanu (1999): E* = Eg (1 + (i w tau)^-width)^(-slope / width)."""

    title: ClassVar[str] = "Power"

    glassy_modulus: float
    width: float
    slope: float
    tau: float
    shift: WLF

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        return "" if values["width"] > 0.0 else "needs width > 0"

    def complex_modulus(self, omega, temperature):
        reduced = 1j * np.asarray(omega, float) * self.tau * self.shift.factor(temperature)
        return self.glassy_modulus * (1.0 + reduced**-self.width) ** (-self.slope / self.width)

    def log_slopes(self, omega, temperature):
        log_reduced = np.log(1j * omega * self.tau * self.shift.factor(temperature))
        part = np.exp(-self.width * log_reduced)
        fall = self.slope / self.width * np.log1p(part)
        by_time = self.slope * part / (1.0 + part)
        columns = [np.ones(omega.size), fall + by_time * log_reduced, -fall, by_time]
        return np.column_stack([*columns, *(by_time * self.shift.log_slopes(temperature).T)])


LAW = Power(30e9, 0.2, 0.9, 0.01, WLF(20.0, 140.0, 15.0))
OMEGA, TEMPERATURE = (
    grid.ravel() for grid in np.meshgrid(2 * np.pi * np.array([1.0, 5, 25]), [-10.0, 5.0, 20.0, 35.0])
)


@pytest.fixture
def known(monkeypatch):
    monkeypatch.setitem(spectrum.LAWS, "power", Power)
    monkeypatch.setitem(RANGES, "width", (-4.0, 2.0, -2.0, -1.0))
    monkeypatch.setitem(RANGES, "slope", (-3.0, 2.0, -0.5, 0.5))


def test_slopes_are_those_of_the_modulus():
    for column, name in enumerate(("glassy_modulus", "width", "slope", "tau")):
        value, step = getattr(LAW, name), 1e-6
        up, down = (Power(**(vars(LAW) | {name: value * np.exp(sign * step)})) for sign in (1, -1))
        moduli = up.complex_modulus(OMEGA, TEMPERATURE), down.complex_modulus(OMEGA, TEMPERATURE)
        slope = np.log(moduli[0] / moduli[1]) / (2 * step)
        assert np.abs(LAW.log_slopes(OMEGA, TEMPERATURE)[:, column] - slope).max() < 1e-8


def test_a_new_law_is_written_read_exported_and_followed_by_bonds(known, tmp_path):
    write_spectrum(tmp_path / "law.json", LAW, source="stated", rms_log_residual=0.0)
    assert read_spectrum(tmp_path / "law.json") == LAW
    law = an.read(tmp_path / "law.json")
    assert repr(law).startswith("Law(Power") and law.parameters.loc["width", "value"] == 0.2
    exact = LAW.complex_modulus(2 * np.pi * 10.0, 15.0)
    assert law.of_bonds(10.0, 15.0).complex_modulus(10.0) == pytest.approx(exact, rel=2e-3)
    assert "Prony" in an.export(law, tmp_path / "law.csv", "csv", frequencies_Hz=(1.0, 10.0))


def test_what_a_new_law_refuses_names_the_file(known, tmp_path):
    write_spectrum(
        tmp_path / "law.json", Power(30e9, -0.2, 0.9, 0.01, LAW.shift), source="", rms_log_residual=0.0
    )
    with pytest.raises(InputError, match=r"law.json: needs width > 0; correct it"):
        read_spectrum(tmp_path / "law.json")


def test_a_new_law_is_fitted_within_its_ranges(known, monkeypatch):
    fit = fit_spectrum(OMEGA, TEMPERATURE, LAW.complex_modulus(OMEGA, TEMPERATURE), 15.0, Form("power"))
    assert fit.law.glassy_modulus == pytest.approx(30e9, rel=1e-3) and fit.law.slope == pytest.approx(
        0.9, rel=1e-3
    )
    monkeypatch.delitem(RANGES, "width")
    with pytest.raises(InputError, match="'power' cannot be fitted without a range for width"):
        fit_spectrum(OMEGA, TEMPERATURE, LAW.complex_modulus(OMEGA, TEMPERATURE), 15.0, Form("power"))


def test_the_zener_solid_of_contributing_is_a_file(tmp_path):
    text = (Path(__file__).parents[2] / "CONTRIBUTING.md").read_text(encoding="utf-8")
    (tmp_path / "zener.json").write_text(re.search(r"```json\n(.*?)```", text, re.DOTALL)[1])
    element = 10e9 + 2j * np.pi * 10.0 * 0.5e9
    assert an.read(tmp_path / "zener.json").complex_modulus(10.0) == pytest.approx(
        1 / (1 / 25e9 + 1 / element)
    )
