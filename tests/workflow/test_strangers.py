"""What README promises, on machines where nobody here has been: no git, a zip, other users, other file systems."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
PLAIN = {
    name: value for name, value in os.environ.items() if not name.startswith(("SNAKEMAKE", "PYTHONPATH"))
}
SMOKE = ["--cores", "1", "--configfile", "config/smoke.yaml"]
RUN = [
    sys.executable,
    "-c",
    "import sys; sys.path[0] = sys.argv.pop(1); import asphalt_nscd.cli as c; c.main()",
]
NOBODY = 65534


def said(*command: object, folder: Path, fails: bool = False, **more) -> str:
    """What a program says, which works unless it `fails`; `path` is its PATH."""
    environment = PLAIN | {"PATH": more.pop("path", PLAIN["PATH"]), "ASPHALT_NSCD_CACHE": f"{folder}/cache"}
    environment |= {"HOME": str(folder.parent / "own")} if "user" in more else {}
    words = [*map(str, command)]
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, **more)
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def head():
    if not (ROOT / ".git").exists() or not shutil.which("git"):
        pytest.skip("no git repository")
    return said("git", "rev-parse", "HEAD", folder=ROOT).strip()


@pytest.fixture(scope="module")
def zipped(head, tmp_path_factory):
    """The folder that a download of the repository unpacks to."""
    folder = tmp_path_factory.mktemp("download")
    said("git", "archive", "--output", folder / "a.tar", "HEAD", folder=ROOT)
    said("tar", "xf", "a.tar", "--one-top-level=asphalt", folder=folder)
    return folder / "asphalt"


@pytest.fixture
def clone(head, tmp_path):
    said("git", "clone", "--quiet", ROOT, "clone", folder=tmp_path)
    return tmp_path / "clone"


@pytest.fixture(scope="module")
def without_git(tmp_path_factory):
    """A PATH with all tools but git."""
    folder = tmp_path_factory.mktemp("bin")
    for tool in [*Path("/bin").iterdir(), *Path("/usr/bin").iterdir()]:
        if not tool.name.startswith("git") and not (folder / tool.name).exists():
            (folder / tool.name).symlink_to(tool)
    return str(folder)


@pytest.fixture
def machine(tmp_path):
    """A function that installs into an environment of its own, not editable; packages of ours are borrowed."""
    place = tmp_path / "venv"
    said(sys.executable, "-m", "venv", "--without-pip", place, folder=tmp_path)
    python = place / "bin/python"
    home = Path(
        said(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", folder=tmp_path).strip()
    )
    (home / "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n")

    def install(source: Path, **more) -> Path:
        pip = [sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-deps"]
        said(*pip, "--no-build-isolation", source, folder=tmp_path, **more)
        return place / "bin"

    return install


def test_a_zip_installs_where_there_is_no_git_and_knows_its_commit(
    zipped, machine, without_git, head, tmp_path
):
    programs = machine(zipped, path=without_git)
    version = said(programs / "asphalt-nscd", "--version", folder=tmp_path, path=without_git)
    assert version.strip().endswith(head)


def test_a_clone_runs_where_there_is_no_git(clone, without_git):
    target = "results/smoke/laws/fitted/T0.json"
    said(sys.executable, "-m", "snakemake", target, *SMOKE, folder=clone, path=without_git)
    assert (clone / target).is_file()
    said(*RUN, clone / "src", "provenance", "--output", "p.json", folder=clone, path=without_git)
    assert '"git_commit": "unknown"' in (clone / "p.json").read_text()


def test_a_zip_in_another_repository_does_not_take_its_commit(zipped, head, tmp_path):
    said("git", "init", "--quiet", folder=tmp_path)
    who = ["-c", "user.name=a", "-c", "user.email=a@b"]
    said("git", *who, "commit", "--quiet", "--allow-empty", "-m", "other", folder=tmp_path)
    shutil.copytree(zipped / "src", tmp_path / "asphalt/src")
    version = [*RUN, "asphalt/src", "--version"]
    assert said(*version, folder=tmp_path).strip().endswith(head)
    (tmp_path / "asphalt/src/asphalt_nscd/commit.txt").unlink()
    assert said(*version, folder=tmp_path).strip().endswith("unknown")


def test_an_sdist_makes_a_wheel_that_knows_its_commit_and_gives_way_to_a_clone(
    clone, machine, head, tmp_path
):
    """After `git pull` a package that was installed before would compute by other sources than the rules."""
    build = "from setuptools.build_meta import build_sdist; build_sdist(sys.argv[1])"
    said(sys.executable, "-c", f"import sys; {build}", tmp_path / "dist", folder=clone)
    programs = machine(next((tmp_path / "dist").glob("*.tar.gz")))
    assert said(programs / "asphalt-nscd", "--version", folder=tmp_path).strip().endswith(head)
    assert said("git", "status", "--porcelain", folder=clone) == ""
    reduce = clone / "src/asphalt_nscd/cli/reduce.py"
    reduce.write_text("raise SystemExit('error: by the clone')\n")
    snakemake = [programs / "python", "-m", "snakemake", "results/smoke/measured.csv", *SMOKE]
    assert "by the clone" in said(*snakemake, folder=clone, fails=True)


@pytest.mark.skipif(os.getuid() != 0, reason="only root can be another user")
def test_another_user_uses_a_clone_that_may_not_be_written(clone, head, tmp_path):
    """git itself refuses to say anything about a clone of another user."""
    (own := tmp_path / "own").mkdir()
    os.chown(own, NOBODY, NOBODY)
    for folder in (tmp_path, *list(tmp_path.parents)[:2]):
        folder.chmod(0o755)
    nobody = {"user": NOBODY, "group": NOBODY, "umask": 0o077}
    try:
        subprocess.run([sys.executable, "-c", ""], check=True, **nobody)
    except PermissionError:
        pytest.skip(f"{sys.executable} is root's alone")
    version = said(*RUN, clone / "src", "--version", folder=own, **nobody)
    assert version.strip().endswith(head)
    export = [
        "published-law",
        clone / "data/paper/table3_burgers.csv",
        "--temperature-c",
        "15",
        "--unit",
        "kPa",
    ]
    said(*RUN, clone / "src", *export, "--output", "law.json", folder=own, **nobody)
    assert (own / "law.json").stat().st_mode & 0o777 == 0o600
    refused = said(sys.executable, "-m", "snakemake", "--dry-run", *SMOKE, folder=clone, fails=True, **nobody)
    assert "nothing can be written there" in refused and "Traceback" not in refused
