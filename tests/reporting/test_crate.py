"""The archive of a study, read again by the library of the format."""

from __future__ import annotations

import json

import pytest
from rocrate.rocrate import ROCrate

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.reporting.crate import write_crate


@pytest.fixture
def study(tmp_path):
    (tmp_path / "results/figures").mkdir(parents=True)
    made_by = {
        "git_commit": "abc123",
        "python": "3.11.7",
        "packages": {"numpy": "2.4.6"},
        "study": {"study": "mine"},
    }
    (tmp_path / "results/provenance.json").write_text(json.dumps(made_by))
    (tmp_path / "results/table.csv").write_text("T\n1\n")
    (tmp_path / "results/figures/fig.png").write_bytes(b"picture")
    (tmp_path / "Snakefile").write_text("rule all:\n")
    return tmp_path


def write(study, *names):
    root = study / "results"
    files = [root / name for name in names]
    write_crate(files, root, study / "Snakefile", root / "provenance.json", study / "mine.crate.zip")
    return ROCrate(study / "mine.crate.zip")


def test_what_made_which_files_can_be_read_again(study):
    crate = write(study, "table.csv", "figures/fig.png", "provenance.json")
    assert crate.name == "Study mine of asphalt-nscd"
    assert crate.mainEntity.id == "Snakefile" and crate.mainEntity["version"] == "abc123"
    software = {one["name"]: one["softwareVersion"] for one in crate.mainEntity["softwareRequirements"]}
    assert software == {"python": "3.11.7", "numpy": "2.4.6"}
    run = crate.dereference("#run")
    assert run["instrument"] == crate.mainEntity and run["object"].id == "provenance.json"
    assert {result.id for result in run["result"]} == {"table.csv", "figures/fig.png"}
    assert crate.get("table.csv")["encodingFormat"] == "text/csv"
    assert crate.version == "1.1" and crate.license["name"] == "MIT License"
    assert [profile.id.split("/")[-2] for profile in crate.root_dataset["conformsTo"]] == [
        "process",
        "workflow",
        "workflow-ro-crate",
    ]
    crate.write(study / "unpacked")
    assert (study / "unpacked/figures/fig.png").read_bytes() == b"picture"


def test_a_file_that_is_missing_is_named_and_nothing_is_written(study):
    with pytest.raises(InputError, match="gone.csv"):
        write(study, "gone.csv")
    assert not (study / "mine.crate.zip").exists()
