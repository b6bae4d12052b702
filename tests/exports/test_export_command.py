"""What the command says, which law files it takes, and over which band."""

from __future__ import annotations

import re

import pytest
from naive.prony import CAMPAIGN, SPECTRA

from asphalt_nscd import cli
from asphalt_nscd.exports.export import export_law
from asphalt_nscd.exports.law import read_law_file
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json
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


def test_the_command_says_what_it_wrote(folder, capsys):
    status, said = run(capsys, folder / "law.json", "--format", "abaqus", "--output", folder / "law.inp")
    assert status == 0 and said.count("\n") == 1
    assert "Prony terms at 21 degC" in said and "assumed, not measured" in said


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
