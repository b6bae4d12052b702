"""Material cards are read back, evaluated as their programs would, and held against the law."""

from __future__ import annotations

import re

import numpy as np
import pytest
from naive.finite_elements import abaqus_modulus, ansys_modulus, comsol_modulus
from naive.prony import ROOT, SPECTRA, assert_within, stated

from asphalt_nscd.exports.card import make_card
from asphalt_nscd.exports.export import export_law
from asphalt_nscd.exports.law import read_law_file, wlf_of
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.chain_law import chain_law
from asphalt_nscd.rheology.laws_io import write_chain, write_law
from asphalt_nscd.rheology.maxwell_fitting import Miss
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.shift import Arrhenius
from asphalt_nscd.rheology.spectrum_io import write_spectrum

SETTINGS = [ExportSettings(), ExportSettings(0.3, 0.1, 0.2, "mm-N-MPa", "BASE_2")]


READERS = {
    "abaqus": ("law.inp", abaqus_modulus),
    "ansys": ("law.mac", ansys_modulus),
    "comsol": ("law.txt", comsol_modulus),
}


@pytest.mark.parametrize("settings", SETTINGS, ids=["SI", "mm-N-MPa"])
@pytest.mark.parametrize("form", READERS)
def test_a_law_of_all_temperatures_comes_back_within_the_stated_error(spectrum, tmp_path, form, settings):
    read, law, (temperature, frequency) = spectrum
    name, modulus = READERS[form]
    line = export_law(read, settings, form, tmp_path / name)
    text = (tmp_path / name).read_text()
    stress = {"Pa": 1.0, "MPa": 1e6}[re.search(r"Units: m+, N, s, (M?Pa);", text)[1]]
    found = modulus(text, temperature, frequency, stress)
    allowed = Miss(settings.error_percent, settings.error_deg)
    assert_within(found, law.complex_modulus(2 * np.pi * frequency, temperature), text, allowed)
    assert stated(line) == stated(text)
    assert text.isascii()
    assert ("assumed" if settings.poisson is None else "as stated by --poisson") in text


@pytest.mark.parametrize("form", READERS)
def test_the_laws_of_table_3_come_back(tmp_path, form):
    """At every temperature of the paper; two branches, no shift."""
    name, modulus = READERS[form]
    for temperature, law in zip(*read_published(ROOT / "data/paper/table3_burgers.csv")):
        write_law(tmp_path / "law.json", law, source="published", temperature=temperature)
        export_law(read_law_file(tmp_path / "law.json"), ExportSettings(), form, tmp_path / name)
        text = (tmp_path / name).read_text()
        assert f"Holds at {temperature:g} degC only" in text
        assert "TRS" not in text and "SHIFT" not in text and "Tref" not in text
        frequency = np.array([0.1, 3.0, 40.0])
        found = modulus(text, np.full(3, temperature), frequency, 1.0)
        assert_within(found, law.complex_modulus(2 * np.pi * frequency), text, Miss(0.1, 0.1))


def test_a_bond_law_of_the_extended_simulation_comes_back(tmp_path):
    law = SPECTRA["FD"][0]
    write_spectrum(tmp_path / "law.json", law, source="fitted", rms_log_residual=0.03)
    chain_law(tmp_path / "law.json", 21.0, 1.0, 50.0, 1e-3, 0.9, tmp_path / "f10.json")
    read = read_law_file(tmp_path / "f10.json")
    export_law(read, ExportSettings(), "abaqus", tmp_path / "law.inp")
    text = (tmp_path / "law.inp").read_text()
    frequency = np.geomspace(1.0, 50.0, 9)
    found = abaqus_modulus(text, np.full(9, 21.0), frequency, 1.0)
    wanted = 0.9 * law.complex_modulus(2 * np.pi * frequency, 21.0)
    np.testing.assert_allclose(found, wanted, rtol=2e-3 if make_card(read, ExportSettings()).exact else 1e-2)


def test_an_arrhenius_shift_is_a_wlf_shift():
    shift = Arrhenius(190e3, 15.0)
    temperature = np.linspace(-30.0, 60.0, 19)
    np.testing.assert_allclose(wlf_of(shift).factor(temperature), shift.factor(temperature), rtol=1e-10)


def test_a_spring_alone_is_refused(tmp_path):
    path, spring = tmp_path / "law.json", KelvinChain(1e10, np.inf, (), ())
    write_chain(path, spring, source="x", temperature=15.0, error=0.0, lowest_hz=1.0, highest_hz=10.0)
    with pytest.raises(InputError, match="does not relax"):
        export_law(read_law_file(path), ExportSettings(), "abaqus", tmp_path / "law.inp")
