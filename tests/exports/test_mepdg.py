"""The table of AASHTOWare, held against the law."""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from naive.prony import ROOT, SPECTRA

from asphalt_nscd.exports.export import export_law
from asphalt_nscd.exports.formats.mepdg import FREQUENCIES, TEMPERATURES_F, make_table, sigmoid
from asphalt_nscd.exports.law import read_law_file
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.laws_io import write_law
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_io import write_spectrum


def exported(folder, law, temperatures, frequencies):
    """What the command says; the table, of which the comments are joined to one line, is E.csv."""
    write_spectrum(folder / "law.json", law, source="fitted", rms_log_residual=0.03)
    read = read_law_file(folder / "law.json", temperatures, frequencies)
    line = export_law(read, ExportSettings(), "mepdg", folder / "E.csv")
    return line, re.sub(r"\n#\s+", " ", (folder / "E.csv").read_text())


def test_the_table_of_aashtoware(spectrum, tmp_path):
    read, law, _ = spectrum
    line = export_law(read, ExportSettings(), "mepdg", tmp_path / "E.csv")
    text = (tmp_path / "E.csv").read_text()
    table = pd.read_csv(tmp_path / "E.csv", comment="#", index_col="temperature_F")
    assert table.index.tolist() == [14, 40, 70, 100, 130]
    assert [float(re.search(r"at_(.*)_Hz", name)[1]) for name in table] == [0.1, 0.5, 1, 5, 10, 25]
    celsius = (np.array(TEMPERATURES_F) - 32.0) / 1.8
    wanted = np.abs(law.complex_modulus(2 * np.pi * np.array(FREQUENCIES), celsius[:, None])) / 6894.757
    np.testing.assert_allclose(table.to_numpy(), wanted, rtol=1e-3)
    joined = re.sub(r"\n#\s+", " ", text)
    delta, alpha, beta, gamma = (
        float(re.search(rf"{name} = ([-\d.e]+?)[,;]", joined)[1])
        for name in ("delta", "alpha", "beta", "gamma")
    )
    shifts = dict(re.findall(r"(\d+) degF (-?\d+\.\d{5})", joined))
    error = float(re.search(r"largest error (\S+) %", joined)[1])
    for temperature, row in zip(TEMPERATURES_F, wanted):
        log_time = -np.log10(FREQUENCIES) - float(shifts[f"{temperature:g}"])
        fit = 10.0 ** (delta + alpha / (1.0 + np.exp(beta + gamma * log_time)))
        assert 100.0 * np.abs(fit / row - 1.0).max() <= 1.05 * error + 0.02
    assert float(shifts["14"]) > 0 > float(shifts["130"])
    assert f"sigmoid within {error:.2g} %" in line


def test_what_aashtoware_would_take_beyond_the_tests_is_named(tmp_path):
    line, joined = exported(tmp_path, SPECTRA["FD"][0], (4.0, 21.0, 37.0), (1.0, 10.0))
    beyond = dict(re.findall(r"([\d.]+ degF [\d.]+ Hz) \((f?T?)\)", joined))
    assert beyond["130 degF 0.1 Hz"] == "fT" and beyond["14 degF 25 Hz"] == "fT"
    assert "70 degF 10 Hz" not in beyond and "70 degF 1 Hz" not in beyond
    assert f"{len(beyond)} of them extrapolated" in line


def test_where_the_shift_is_not_defined_the_table_is_empty(tmp_path):
    law = TwoS2P1D(130e6, 35e9, 0.18, 0.49, 2.5, 0.04, 2000.0, WLF(12.0, 30.0, 21.0))
    exported(tmp_path, law, (10.0, 21.0, 37.0), (1.0, 10.0))
    table = pd.read_csv(tmp_path / "E.csv", comment="#", index_col="temperature_F")
    assert table.loc[14].isna().all() and table.loc[[40, 70, 100, 130]].notna().all(axis=None)


def test_one_temperature_is_not_enough_for_aashtoware_nor_takes_others(tmp_path):
    temperatures, laws = read_published(ROOT / "data/paper/table3_burgers.csv")
    write_law(tmp_path / "law.json", laws[0], source="published", temperature=temperatures[0])
    with pytest.raises(InputError, match="this table has five"):
        export_law(read_law_file(tmp_path / "law.json"), ExportSettings(), "mepdg", tmp_path / "E.csv")
    with pytest.raises(InputError, match="leave out --temperatures-c"):
        read_law_file(tmp_path / "law.json", (0.0, 10.0))


@pytest.mark.parametrize(
    ("tested", "extrapolated"),
    [
        ((4.0, 21.0, 38.0), {14, 130}),
        ((-10.0, 21.0, 38.0), {130}),
        ((4.0, 21.0, 54.4), {14}),
        ((-10.0, 54.4), set()),
        ((-10.0, 53.0), {130}),
        ((-9.0, 54.4), {14}),
    ],
)
def test_temperatures_of_the_shift_are_told_at_either_end(tmp_path, tested, extrapolated):
    """14 and 130 degF are -10 and 54.4 degC; the frequencies, so wide, are none of them beyond the tests."""
    _, joined = exported(tmp_path, SPECTRA["FD"][0], tested, (1e-9, 1e9))
    beyond = re.findall(r"([\d.]+) degF [\d.]+ Hz \((f?T?)\)", joined)
    assert {float(t) for t, flag in beyond if "T" in flag} == extrapolated
    assert not any("f" in flag for _, flag in beyond)


def test_a_law_that_is_a_sigmoid_comes_back():
    """Tested at 40 and 70 degF, 1 to 10 Hz: the frequency is reduced to 70 degF, where the law has its reference."""
    parameters, shift = (3.9, 2.6, -0.8, 0.45), WLF(10.0, 100.0, (70.0 - 32.0) / 1.8)

    def modulus(omega):
        time = np.log10(2.0 * np.pi / omega)
        return 6894.757 * 10 ** (3.9 + 2.6 / (1.0 + np.exp(-0.8 + 0.45 * time)))

    tested = np.array([(t, f) for t in (40.0, 70.0) for f in (1.0, 10.0)]).T
    celsius = (tested[0] - 32.0) / 1.8
    reduced = 2.0 * np.pi * tested[1] * shift.factor(celsius)
    half = SimpleNamespace(
        half=lambda law, omega, at: np.log(1.0 + 0.01 * omega / (2 * np.pi)) * (at > 20) + 0j
    )
    law = SimpleNamespace(
        shift=shift, factor=shift.factor, reference_modulus=modulus, law=None, uncertainty=half,
        defined=lambda at: np.full(at.shape, True), reduced_band=lambda: (reduced.min(), reduced.max()),
        band=SimpleNamespace(temperature=celsius),
    )  # fmt: skip
    made = make_table(law)
    assert made.sigmoid == pytest.approx(parameters, rel=1e-5) and made.error_percent < 1e-3
    at = (np.array(TEMPERATURES_F) - 32.0) / 1.8
    assert made.log_shift == pytest.approx(np.log10(shift.factor(at)), abs=1e-12)
    all_reduced = 2.0 * np.pi * np.array(FREQUENCIES) * shift.factor(at)[:, None]
    np.testing.assert_allclose(made.modulus, modulus(all_reduced) / 6894.757)
    inside = (all_reduced > reduced.min() * 0.999) & (all_reduced < reduced.max() * 1.001)
    warm = np.array([True, False, False, True, True])  # or cold
    assert made.outside == [
        ["" if ok else "f" for ok in row] if not off else [("" if ok else "f") + "T" for ok in row]
        for row, off in zip(inside, warm)
    ]
    np.testing.assert_allclose(made.spread[:2], 1.0)
    np.testing.assert_allclose(made.spread[2:], 1.0 + 0.01 * np.tile(FREQUENCIES, (3, 1)))
    assert sigmoid((1.0, 2.0, 0.0, 1.0), np.array([-99.0, 0.0, 99.0])) == pytest.approx([3.0, 2.0, 1.0])
