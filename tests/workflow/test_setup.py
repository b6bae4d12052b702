"""tools/venv.sh on machines with and without a usable Python; nothing is downloaded."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]

FAKE = """\
#!/bin/sh
# A Python that answers like version 3.{minor} and notes what it is asked to do.
case "$*" in
    --version) echo "Python 3.{minor}.0" ;;
    *version_info*) [ {minor} -ge 11 ] ;;
    *"import ensurepip"*) {ensurepip} ;;
    "-m pip --version") {pip} ;;
    *) echo "3.{minor}: $*" >>"$NOTES"
       if [ "$2" = venv ]; then for last; do :; done; mkdir -p "$last/bin"; cp "$0" "$last/bin/python"; fi ;;
esac
"""


@pytest.fixture
def machine(tmp_path):
    """A copy of the script, a PATH with the usual tools and whatever Pythons a test puts there."""
    (tmp_path / "bin").mkdir()
    for tool in ("sh", "ls", "sed", "sort", "rm", "mkdir", "cp", "dirname"):
        (tmp_path / "bin" / tool).symlink_to(shutil.which(tool))
    (tmp_path / "clone/tools").mkdir(parents=True)
    shutil.copy(ROOT / "tools/venv.sh", tmp_path / "clone/tools")
    return tmp_path


def install(machine: Path, name: str, minor: int, ensurepip: bool = True, pip: bool = True) -> None:
    answers = {"ensurepip": str(ensurepip).lower(), "pip": str(pip).lower()}
    path = machine / "bin" / name
    path.write_text(FAKE.format(minor=minor, **answers))
    path.chmod(0o755)


def set_up(
    machine: Path, *what: str, **environment: str
) -> tuple[subprocess.CompletedProcess[str], list[str]]:
    notes = machine / "notes"
    done = subprocess.run(
        ["sh", "tools/venv.sh", *what],
        cwd=machine / "clone",
        capture_output=True,
        text=True,
        env={"PATH": str(machine / "bin"), "NOTES": str(notes), **environment},
    )
    return done, notes.read_text().splitlines() if notes.exists() else []


def test_newest_python_is_taken_and_hashes_are_required(machine):
    for name, minor in {"python3": 11, "python3.9": 9, "python3.11": 11, "python3.13": 13}.items():
        install(machine, name, minor)
    done, notes = set_up(machine)
    assert done.returncode == 0, done.stderr
    assert notes[0] == "3.13: -m venv .venv"
    assert "--require-hashes --requirement requirements-study.txt" in notes[1]
    assert "--no-deps --no-build-isolation --editable ." in notes[2]
    assert (machine / "clone/.venv/.ready").read_text() == f"{machine / 'clone'}\n"


def test_a_study_does_not_wait_for_tools_which_are_added_when_asked_for(machine):
    install(machine, "python3", 12)
    _, notes = set_up(machine, "study")
    assert not any("--requirement requirements.txt" in note for note in notes)
    assert (machine / "clone/.venv/.ready").exists() and not (machine / "clone/.venv/.tools").exists()
    _, both = set_up(machine, "tools")
    assert len(both) == len(notes) + 1 and "--require-hashes --requirement requirements.txt" in both[-1]
    assert (machine / "clone/.venv/.tools").exists()


def test_without_ensurepip_the_pip_outside_installs(machine):
    install(machine, "python3", 11, ensurepip=False)
    done, notes = set_up(machine)
    assert done.returncode == 0, done.stderr
    assert notes[0] == "3.11: -m venv --without-pip .venv"
    assert notes[1].startswith("3.11: -m pip --python .venv/bin/python install ")


def test_without_ensurepip_and_pip_one_sentence_says_what_to_install(machine):
    install(machine, "python3", 11, ensurepip=False, pip=False)
    done, notes = set_up(machine)
    assert (done.returncode, notes) == (2, [])
    assert done.stderr.count("\n") == 1 and "apt install python3-venv" in done.stderr


def test_python_too_old_is_one_sentence(machine):
    install(machine, "python3", 9)
    done, notes = set_up(machine)
    assert (done.returncode, notes) == (2, [])
    assert done.stderr.startswith("error: no Python 3.11 or newer on PATH") and done.stderr.count("\n") == 1


def test_failed_installation_leaves_no_stamp(machine):
    install(machine, "python3", 11)
    fake = machine / "bin/python3"
    failing = "    *require-hashes*) exit 1 ;;\n    *) echo"
    fake.write_text(fake.read_text().replace("    *) echo", failing))
    assert set_up(machine)[0].returncode != 0
    assert not (machine / "clone/.venv/.ready").exists()


def test_missing_study_is_one_sentence(tmp_path):
    command = ["make", "-f", str(ROOT / "Makefile"), "study", "CONFIG=gone.yaml"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "gone.yaml: no such file; give a study with CONFIG=my.yaml." in done.stderr
    assert not list(tmp_path.iterdir())


def test_lock_holds_hashes_and_no_addresses():
    lock = (ROOT / "requirements.txt").read_text()
    pins = [line for line in lock.splitlines() if line and line[0] not in "# "]
    assert all("==" in pin and pin.endswith("\\") for pin in pins)
    names = {pin.split("==")[0] for pin in pins}
    assert {"snakemake", "numba", "h5py", "click", "tqdm", "pytest", "setuptools"} <= names
    assert "://" not in lock


def test_lock_of_a_study_is_part_of_the_lock_of_all():
    study, whole = (
        set(re.findall(r"^([\w-]+==[\w.]+).*\\\n((?:    --hash=.*\n)+)", (ROOT / name).read_text(), re.M))
        for name in ("requirements-study.txt", "requirements.txt")
    )
    assert study < whole
    names = {pin.split("==")[0] for pin, _ in study}
    assert {"snakemake", "rich", "flask", "setuptools"} <= names and not {"pytest", "vtk", "mypy"} & names
