"""What the command says, which law files it takes, and over which band."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from naive.prony import CAMPAIGN, SPECTRA

from asphalt_nscd import cli
from asphalt_nscd.exports.card import _short, comment, make_card, number
from asphalt_nscd.exports.export import export_law
from asphalt_nscd.exports.formats import ansys
from asphalt_nscd.exports.law import read_law_file
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import write_chain
from asphalt_nscd.rheology.spectrum_io import write_spectrum

BURGERS_KEYS = ("Em_Pa", "eta_m_Pa_s", "Ek_Pa", "eta_k_Pa_s")


def run(capsys, *arguments):
    with pytest.raises(SystemExit) as left:
        cli.main(["export", *map(str, arguments)])
    told = capsys.readouterr()
    return left.value.code, told.out + told.err


def test_the_tested_band_is_that_of_the_diagnosis(folder):
    for given, band in (
        ((), "-10 to 54 degC, 0.1 to 25 Hz (the tests in residuals.csv)"),
        (((0.0, 10.0), (1.0,)), "as stated"),
        (((0.0, 10.0),), "0 to 10 degC, 0.1 to 25 Hz"),
    ):
        assert band in str(read_law_file(folder / "law.json", *given).band)
    assert read_law_file(folder).path == folder / "law.json"
    with pytest.raises(InputError, match="law.json"):
        read_law_file(folder.parent)


@pytest.mark.parametrize(
    ("form", "name", "option", "names"),
    [
        ("abaqus", "law.csv", [], ".inp"),
        ("abaqus", "law.inp", ["--poisson", "0.5"], "less than 0.5"),
        ("ansys", "law.mac", ["--poisson", "-1"], "greater than -1"),
        ("abaqus", "law.inp", ["--name", "2nd"], "first a letter"),
        ("csv", "law.csv", ["--temperatures-c", "-300,0"], "-273.15"),
        ("csv", "law.csv", ["--error-percent", "1e-9"], "60 terms"),
        ("csv", "law.csv", ["--temperatures-c", "500"], "does not relax"),
    ],
)
def test_what_cannot_be_written_is_one_sentence(folder, capsys, monkeypatch, form, name, option, names):
    monkeypatch.chdir(folder)
    status, said = run(capsys, "law.json", "--format", form, "--output", name, *option)
    assert status == 2 and names in said
    assert not (folder / name).exists()


@pytest.mark.parametrize(
    ("content", "names"),
    [
        ({"law": "maxwell"}, "'maxwell'"),
        ([1], "'law'"),
        ({"ladder": [], "verdict": "explained"}, "law.json beside it"),
        ({"law": "burgers", **dict.fromkeys(BURGERS_KEYS, 1e9)}, "'temperature_C'"),
        ({"law": "2s2p1d"}, "'shift'"),
    ],
)
def test_law_files_that_cannot_be_read_are_refused(tmp_path, content, names):
    write_json(tmp_path / "law.json", content)
    with pytest.raises(InputError, match=names):
        read_law_file(tmp_path / "law.json")


def test_parameters_that_the_tests_do_not_determine_are_named(tmp_path):
    law = SPECTRA["FD"][0]
    unsure = {"glassy_modulus": 20e9}  # but determined, as the diagnosis says it too
    write_spectrum(
        tmp_path / "law.json", law, source="fitted", rms_log_residual=0.03, std_error=unsure, unseen=["beta"]
    )
    read = read_law_file(tmp_path / "law.json", *CAMPAIGN)
    assert read.loose().startswith("The tests do not determine beta:")
    for form, name in (("csv", "law.csv"), ("mepdg", "E.csv")):
        export_law(read, ExportSettings(), form, tmp_path / name)
        joined = re.sub(r"\n#\s+", " ", (tmp_path / name).read_text())
        assert read.loose() in joined


def test_what_a_law_file_holds_is_read(tmp_path):
    """The band reduced to the reference, parameters that are numbers, and the errors that the diagnosis tells."""
    law = SPECTRA["FD"][0]
    write_spectrum(tmp_path / "law.json", law, source="fitted", rms_log_residual=0.2)
    content = read_json(tmp_path / "law.json")
    write_json(tmp_path / "law.json", content | {"flag": True, "std_error": {"tau_s": 0.5, "word": "x"}})
    read = read_law_file(tmp_path / "law.json", (-10.0, 50.0), (0.5, 20.0))
    ends = 2 * np.pi * 20.0 * law.shift.factor(-10.0), 2 * np.pi * 0.5 * law.shift.factor(50.0)
    assert read.reduced_band() == pytest.approx(sorted(ends))
    assert read.parameters["E_glassy_Pa"] == law.glassy_modulus and read.std_error == {"tau_s": 0.5}
    assert not {"flag", "temperature_C", "rms_log_residual", "source"} & set(read.parameters)
    assert read.rms_log_residual == 0.2 and read.misses is None and read.loose() == ""
    assert (read.name, read.temperature) == ("2S2P1D, WLF shift", law.shift.reference_temperature)
    singular = law.shift.reference_temperature - law.shift.c2
    assert read.defined(np.array([singular - 0.1, singular + 0.1])).tolist() == [False, True]
    errors = {"mre_E_percent": 2.0, "off_phase_deg": 0.5}
    for told, misses in ((errors, errors), ({"mre_E_percent": 2.0}, None), (None, None)):
        write_json(tmp_path / "diagnosis.json", {"law_misses": told})
        assert read_law_file(tmp_path / "law.json").misses == misses
    assert str(read_law_file(tmp_path / "law.json").band).startswith("-10 to 40 degC, 0.1 to 40 Hz (assumed")
    write_chain(
        tmp_path / "chain.json", KelvinChain(3e10, np.inf, (5e10,), (2e9,)), source="x", temperature=15.0,
        error=0.0, lowest_hz=3.0, highest_hz=40.0,
    )  # fmt: skip
    chain = read_law_file(tmp_path / "chain.json")
    assert str(chain.band) == "15 degC, 3 to 40 Hz (band of the chain)" and chain.shift is chain.wlf() is None
    assert chain.defined(np.array([-300.0])).all() and chain.factor(np.array([0.0, 30.0])).tolist() == [
        1.0,
        1.0,
    ]
    far, near = (make_card(replace(read, rms_log_residual=off), ExportSettings()) for off in (0.16, 0.14))
    assert far.told().endswith("The law itself misses its tests by 16 %: do not rely on it.")
    assert near.told().endswith("Poisson's ratio 0.35 (assumed, not measured).")


def test_an_error_is_never_understated_and_a_number_has_ten_digits():
    assert [_short(x) for x in (0.9801, 1.0, 0.01201, 1e-7)] == ["0.99", "1", "0.013", "less than 1e-06"]
    assert number(1.0 / 3.0) == "3.333333333E-01"
    assert comment("#", ["word " * 30, "é"]).splitlines()[1:] == ["#   " + "word " * 9 + "word", "# ?"]


def test_programs_have_their_limits(folder):
    read = read_law_file(folder / "law.json")
    export_law(read, ExportSettings(name="A" * 80), "abaqus", folder / "law.inp")
    with pytest.raises(InputError, match="at most 80 characters"):
        export_law(read, ExportSettings(name="A" * 81), "abaqus", folder / "law.inp")
    for terms, refused in ((100, False), (101, True)):
        series = SimpleNamespace(series=SimpleNamespace(moduli=[1.0] * terms))
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(
                ansys, "make_card", lambda law, settings, s=series: SimpleNamespace(solid=lambda: s)
            )
            patched.setattr(ansys, "write_card", lambda *given, **more: "written")
            if refused:
                with pytest.raises(InputError, match="101 Prony terms, ANSYS takes 100"):
                    ansys.write(read, ExportSettings(), folder / "law.mac")
            else:
                assert ansys.write(read, ExportSettings(), folder / "law.mac") == "written"
