"""The table of a Prony series, held against the law."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from naive.prony import ROOT, assert_within

from asphalt_nscd.exports.export import export_law
from asphalt_nscd.exports.law import read_law_file
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import write_chain, write_law
from asphalt_nscd.rheology.maxwell_fitting import Miss
from asphalt_nscd.rheology.published_laws import read_published


def test_the_csv_comes_back(spectrum, tmp_path):
    read, law, (temperature, frequency) = spectrum
    export_law(read, ExportSettings(), "csv", tmp_path / "law.csv")
    table = pd.read_csv(tmp_path / "law.csv", comment="#")
    assert np.isinf(table["relaxation_time_s"][0]) and table["share_of_instantaneous"].sum() == pytest.approx(
        1
    )
    omega = 2 * np.pi * frequency * law.shift.factor(temperature)
    turned = 1j * omega[:, None] * table["relaxation_time_s"].to_numpy()[1:]
    moduli = table["modulus_Pa"].to_numpy()
    found = moduli[0] + (moduli[1:] * turned / (1 + turned)).sum(axis=1)
    wanted = law.complex_modulus(2 * np.pi * frequency, temperature)
    assert_within(found, wanted, (tmp_path / "law.csv").read_text(), Miss(1.0, 0.5))


def test_a_burgers_law_as_csv_flows(tmp_path):
    temperatures, laws = read_published(ROOT / "data/paper/table3_burgers.csv")
    write_law(tmp_path / "law.json", laws[0], source="published", temperature=temperatures[0])
    export_law(read_law_file(tmp_path / "law.json"), ExportSettings(), "csv", tmp_path / "law.csv")
    assert pd.read_csv(tmp_path / "law.csv", comment="#")["modulus_Pa"][0] == 0.0


def test_a_kelvin_chain_is_not_asked_beyond_its_band(tmp_path):
    chain = KelvinChain(30e9, np.inf, (50e9,), (2e9,))
    band = {"lowest_hz": 3.0, "highest_hz": 40.0}
    write_chain(tmp_path / "law.json", chain, source="spectrum.json", temperature=15, error=4e-4, **band)
    read_law_file(tmp_path / "law.json", None, (3.0, 40.0))
    with pytest.raises(InputError, match="says nothing at 400 Hz"):
        read_law_file(tmp_path / "law.json", None, (3.0, 400.0))
