"""A diagnosis from Python: the same from path, folder and DataFrame, on disk and as the command line has it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pandas.testing import assert_frame_equal

import asphalt_nscd as an
from asphalt_nscd import cli

pytestmark = pytest.mark.slow

EXPORTS = Path(__file__).parents[2] / "data/tutorial/exports"


@pytest.fixture(scope="module")
def diagnosis() -> an.Diagnosis:
    return an.diagnose(EXPORTS, draws=an.Draws(500))


@pytest.fixture(scope="module")
def folder(diagnosis, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("diagnosis")
    diagnosis.write(folder)
    return folder


def test_the_fault_of_the_tutorial_is_on_the_ladder(diagnosis):
    ladder = diagnosis.ladder.set_index("cause")
    delay = ladder.loc["channel_delay"]
    assert diagnosis.verdict == "explained" and delay["established"] and delay["unit"] == "s"
    assert delay["value"] == pytest.approx(
        0.8e-3, abs=4 * delay["std_error"]
    )  # as tools/tutorial_exports.py made it
    assert delay["error_phase_after_percent"] < 0.3 * delay["error_phase_before_percent"]


def test_suspects_and_limits_are_frames(diagnosis):
    (suspect,) = diagnosis.suspects.itertuples()
    at = suspect.specimen, suspect.temperature_C, suspect.frequency_Hz
    assert at == ("Mix-B", 4.0, 25.0) and suspect.status == "left out"
    limits = diagnosis.limits.set_index("cause")
    assert limits.loc["channel_delay", "unit"] == "s" and 0.0 < limits.loc["channel_delay", "value"] < 0.8e-3
    assert set(limits.loc["specimen_geometry", "where"]) == {"Mix-A", "Mix-B", "Mix-C"}


@pytest.fixture(scope="module")
def warm_files() -> list[Path]:
    """Exports of one temperature, whose diagnosis takes a tenth of the time."""
    return sorted(EXPORTS.glob("*-50C*"))


@pytest.fixture(scope="module")
def warm(warm_files) -> pd.DataFrame:
    return an.read(warm_files)


@pytest.fixture(scope="module")
def of_files(warm_files) -> an.Diagnosis:
    return an.diagnose(warm_files, draws=an.Draws(500))


def test_a_frame_is_diagnosed_as_the_files_it_was_read_from(warm, of_files):
    from_frame = an.diagnose(warm, draws=an.Draws(500))
    assert_frame_equal(from_frame.residuals, of_files.residuals)
    assert from_frame.ladder.equals(of_files.ladder)
    assert from_frame.content["reading"] == of_files.content["reading"]
    assert from_frame.content["provenance"]["measurements"].startswith("DataFrame")


def test_rows_taken_out_of_a_frame_are_not_diagnosed(warm):
    table = warm
    without = an.diagnose(table[table["specimen"] != "Mix-B"], draws=an.Draws(500))
    assert set(without.residuals["specimen"]) == {"Mix-A", "Mix-C"}
    assert without.content["reading"]["test_type"] == "tension-compression"


def test_a_frame_of_ones_own_is_understood_as_a_file_is():
    own = pd.DataFrame(
        {"Sample": ["A"], "Temp °C": [20], "f (Hz)": [10.0], "|E*| [GPa]": [9.5], "delta_rad": [0.4]}
    )
    (row,) = an.read(own, measured_in="tension-compression").itertuples()
    assert (row.specimen, row.temperature_C, row.E_MPa) == ("A", 20.0, 9500.0)
    assert row.phase_deg == pytest.approx(np.degrees(0.4))


KEYS = {"temperature_C": [20.0, 20.0], "frequency_Hz": [1.0, 10.0]}


@pytest.mark.parametrize(
    ("frame", "sentence"),
    [
        (pd.DataFrame({"temperature_C": [20.0]}), "no columns for frequency"),
        (pd.DataFrame(columns=["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]), "has no rows"),
        (
            pd.DataFrame(KEYS | {"E_MPa": [5e3, np.nan], "phase_deg": 30.0}),
            "line 2: E_MPa: the cell is empty",
        ),
    ],
)
def test_bad_frames_are_refused_in_a_sentence(frame, sentence):
    with pytest.raises(an.InputError, match=sentence):
        an.diagnose(frame)


def test_what_was_written_reads_back(diagnosis, folder):
    again = an.read(folder)
    assert isinstance(again, an.Diagnosis) and again.content == json.loads(diagnosis.to_json())
    assert_frame_equal(again.residuals, diagnosis.residuals)
    assert_frame_equal(again.causality, diagnosis.causality, check_dtype=False)
    assert again.law.parameters.equals(diagnosis.law.parameters)
    assert an.read(folder / "law.json").kind == "2s2p1d"


def test_the_command_line_gives_the_same(warm_files, of_files, tmp_path, capsys):
    (theirs := tmp_path / "theirs").mkdir()
    of_files.write(theirs)
    with pytest.raises(SystemExit) as done:
        cli.main(["diagnose", *map(str, warm_files), "--output", str(tmp_path / "ours"), "--draws", "500"])
    assert done.value.code == 0 and "Written to" in capsys.readouterr().out
    for name in ("residuals.csv", "causality.csv"):
        assert (tmp_path / "ours" / name).read_bytes() == (theirs / name).read_bytes()
    ours, python = (
        json.loads((tmp_path / side / "diagnosis.json").read_text()) for side in ("ours", "theirs")
    )
    assert ours == python


@pytest.mark.parametrize("plot", ["plot_black", "plot_master_curve", "plot_residuals"])
def test_figures_are_pictures_in_a_notebook(diagnosis, plot):
    figure = getattr(diagnosis, plot)()
    assert figure._repr_png_().startswith(b"\x89PNG") and len(figure.axes) >= 2


def test_export_of_a_diagnosis_is_that_of_its_folder(diagnosis, folder, tmp_path):
    said = [
        an.export(what, tmp_path / f"{name}.inp", "abaqus")
        for name, what in (("object", diagnosis), ("file", folder / "law.json"))
    ]
    ours, theirs = ((tmp_path / f"{name}.inp").read_text() for name in ("object", "file"))
    assert ours == theirs and "*VISCOELASTIC" in ours and "tests in residuals.csv" in ours
    assert said[0].partition(": ")[2] == said[1].partition(": ")[2]


def test_the_kind_of_test_is_said_or_refused_as_by_the_command(warm, tmp_path, capsys):
    table = warm
    bent = an.diagnose(table, measured_in="bending", draws=an.Draws(500))
    assert bent.content["reading"]["test_type"] == "bending"
    with pytest.raises(
        an.InputError, match="'torsion' is not known; give one of bending, tension-compression"
    ):
        an.diagnose(table, measured_in="torsion")
    with pytest.raises(SystemExit) as done:
        cli.main(["diagnose", str(EXPORTS), "--measured-in", "torsion", "--output", str(tmp_path)])
    assert done.value.code == 2 and "'bending', 'tension-compression'" in capsys.readouterr().err


def test_what_is_known_beside_the_table(warm):
    stated = an.diagnose(
        warm, known=an.Known(static_modulus_MPa=50.0, scatter=(2.0, 0.5)), draws=an.Draws(500)
    )
    said = stated.content["provenance"]
    assert said["static_modulus_Pa"] == 50e6 and said["scatter_stated"] == pytest.approx(
        [0.02, np.radians(0.5)]
    )
