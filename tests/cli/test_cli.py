from __future__ import annotations

import errno
import os
import pickle
import re
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import click
import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner
from forks import forked
from matplotlib.figure import Figure

from asphalt_nscd import cli
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import save, write_table
from asphalt_nscd.reporting.figures.save import save_figure

WHOLE = "b_mm=25,B_mm=56,e_mm=25,h_mm=250,mass_kg=0.6,mobile_mass_kg=0.2"
INSIDE = {**os.environ, cli.WITHIN_WORKFLOW: "1"}


def run(*arguments, cwd=".", env=os.environ):
    return forked("asphalt_nscd.cli:main", [*map(str, arguments)], cwd, env)


def refused(done, *names):
    """In one line that holds the names."""
    assert done.returncode == 2
    assert done.stderr.startswith("error: ") and done.stderr.count("\n") == 1, done.stderr
    assert all(name in done.stderr for name in names), done.stderr


def status(error):
    def step():
        raise error

    return cli._status(step)


def test_every_step_is_listed_and_explains_itself():
    steps = cli.group.list_commands(None)
    assert {"reconstruct", "reduce", "fit", "published-law"} <= set(steps)
    for step in steps:
        command = cli.group.get_command(None, step)
        assert command.help, step
        assert all(option.help for option in command.params if isinstance(option, click.Option)), step
    shown = CliRunner().invoke(cli.group, ["--help"]).output
    first, others = shown.partition("For your measurements")[2].split("Steps of the workflow")
    named = re.findall(r"^  ([a-z-]+)  ", first, re.M)
    assert named == ["diagnose", "serve", "compare", "forecast", "export", "new-study"]
    assert sorted([*named, *re.findall(r"^  ([a-z-]+)  ", others, re.M)]) == steps
    said = CliRunner().invoke(cli.group, ["--version"]).output
    assert said.startswith(f"asphalt-nscd {cli.__version__}, commit ")


def make_a_table():
    """A script of the workflow with the inputs `one` and `code`; in a process of its own."""
    folder = Path(sys.argv[1])

    class Inputs(list):
        def items(self):
            return zip(("one", "code"), self)

    def make(one):
        print("made of", one)
        return pd.DataFrame({"x": [1.5, 2.0]})

    inputs = Inputs([str(folder / "given.csv"), "stamp"])
    job = SimpleNamespace(log=[str(folder / "log")], input=inputs, output=[folder / "made.csv"])
    cli.run_table(job, make)


def test_a_script_logs_what_it_says_and_writes_its_table(tmp_path):
    (tmp_path / "log").write_text("of an earlier run, which was longer\n" * 9)
    done = forked(f"{__name__}:make_a_table", [str(tmp_path)])
    assert (done.returncode, done.stdout) == (0, "")
    assert (tmp_path / "log").read_text() == f"made of {tmp_path}/given.csv\n"
    assert (tmp_path / "made.csv").read_text().split() == ["x", "1.5", "2"]


@pytest.mark.parametrize("page", ["cp437", "cp1252"])
def test_a_console_that_lacks_letters_shows_help_all_the_same(page):
    """As of Windows, before Python 3.15."""
    command = [sys.executable, "-m", "asphalt_nscd.cli", "new-study", "--help"]
    given = os.environ | {"PYTHONIOENCODING": page}
    done = subprocess.run(command, capture_output=True, encoding=page, env=given)
    assert done.returncode == 0 and "new-study" in done.stdout and not done.stderr


def test_help_imports_nothing_heavy():
    script = (
        "import sys; from asphalt_nscd.cli import group\n"
        "[group.get_command(None, name) for name in group.list_commands(None)]\n"
        "heavy = {'numpy', 'pandas', 'scipy', 'numba', 'h5py', 'matplotlib'}; print(heavy & set(sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout == "set()\n"


FULL = RuntimeError("Unable to flush cached information (errno = 28, error message = 'No space left')")


@pytest.mark.parametrize(
    ("error", "returned", "names"),
    [
        (InputError("m.csv: row 3: no."), 2, ["m.csv: row 3: no."]),
        (FileExistsError(errno.EEXIST, "File exists", "there"), 2, ["there: file exists"]),
        (OSError(errno.ENOSPC, "No space left on device", "out.h5"), 2, ["out.h5: no space left on device"]),
        (FULL, 2, ["output file: no space left on device"]),
        (KeyboardInterrupt(), 130, ["interrupted"]),
        (MemoryError(), 2, ["memory"]),
        (ImportError("x.so: failed to map segment from shared object"), 2, ["memory"]),
        (SystemError("error return without exception set"), 2, ["memory"]),
        (SystemError("<function f> returned NULL without setting an exception"), 2, ["memory"]),
        (ModuleNotFoundError("No module named 'docutils'", name="docutils"), 2, ["docutils"]),
    ],
)
def test_trouble_is_one_sentence(capsys, error, returned, names):
    assert status(error) == returned
    said = capsys.readouterr().err
    assert said.startswith("error: ") and said.count("\n") == 1
    assert all(name in said for name in names)


@pytest.mark.parametrize("error", [pickle.UnpicklingError("pickle data was truncated"), EOFError()])
def test_damaged_compiled_core_is_removed(capsys, monkeypatch, tmp_path, error):
    (core := tmp_path / "core").mkdir()
    (core / "kernel.nbi").write_bytes(b"half")
    monkeypatch.setattr("asphalt_nscd.nscd.core_cache.core_folder", lambda: str(core))
    assert status(error) == 2
    assert capsys.readouterr().err.startswith(f"error: {core}: ")
    assert not core.exists()


@pytest.mark.parametrize(
    "error", [RuntimeError("ours"), ValueError("too"), ImportError("no module"), SystemError("bad argument")]
)
def test_mistakes_in_the_program_keep_their_traceback(error):
    with pytest.raises(type(error)):
        status(error)


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (["fit", "gone.csv", "--temperature-c", 15, "--output", "law.json"], ["error: gone.csv: "]),
        (["table", "packin", "tests=a.h5", "--output", "o.csv"], ["'packin'", "packing"]),
        (["table", "table4", "--output", "x.csv"], ["simulations, measured"]),
        (["figure", "fig09", "laws=l", "--output-stem", "x"], ["simulations, measured"]),
        (["table", "table4", "simulation=s", "--output", "x.csv"], ["simulation"]),
        (["table", "table2", "gradings=g", "--output", "x.csv"], ["gradings", "grading, published, used"]),
        (["study", "{bad", "--output", "x.json"], ["STUDY"]),
    ],
)
def test_input_that_is_not_there_or_not_known_is_named(tmp_path, arguments, names):
    refused(run(*arguments, cwd=tmp_path), *names)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["simulat"], "'simulat'"),
        (["reduce", "m.csv", "--geometry", "b_mm=25", "--output", "o.csv"], "'--geometry'"),
        (["reduce", "m.csv", "--geometry", "b_mm=25,B_mm=wide", "--output", "o.csv"], "'--geometry'"),
        (["reduce", "m.csv", "--geometry", WHOLE + ",x=1", "--output", "o.csv"], "'--geometry'"),
        (["figure", "fig07", "a.h5", "--output-stem", "o"], "'a.h5'"),
    ],
)
def test_arguments_that_cannot_be_understood_are_named(arguments, name):
    done = run(*arguments)
    assert done.returncode == 2
    assert name in done.stderr
    assert "Traceback" not in done.stderr


def write_large():
    """A step that writes a megabyte where files may have ten kilobytes; in a process of its own."""
    path = Path(sys.argv[1])
    random = np.random.default_rng(1).random((2, 5000))
    (figure := Figure()).subplots().scatter(*random)
    steps = {
        ".h5": lambda: save(path, "test", {f"x{n}": np.arange(300) for n in range(9)}, {}),
        ".pdf": lambda: save_figure(figure, path.with_suffix("")),
        ".csv": lambda: write_table(path, pd.DataFrame({"x": range(100000)})),
    }
    sys.dont_write_bytecode = True  # Python would keep what it wrote of it, torn, for all later runs
    resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))  # matplotlib has kept its fonts by now
    sys.exit(cli._status(steps[path.suffix]))


@pytest.mark.parametrize("kind", ["h5", "csv", "pdf"])
def test_file_that_cannot_be_written_in_full_is_not_left(tmp_path, kind):
    done = forked(f"{__name__}:write_large", [str(tmp_path / f"out.{kind}")])
    refused(done, f"error: {tmp_path}/out.{kind}: ", "file too large")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="asks the kernel of Linux")
def test_step_of_the_workflow_ends_with_its_parent(tmp_path):
    step = (
        "import time; from asphalt_nscd import cli\n"
        "cli.group.main = lambda *a, **k: (print('runs', flush=True), time.sleep(60))\n"
        "cli.main([])"
    )
    parent = (
        "import subprocess, sys, time\n"
        f"child = subprocess.Popen([sys.executable, '-c', {step!r}])\n"
        "print(child.pid, flush=True); time.sleep(60)"
    )
    environment = {**os.environ, cli.WITHIN_WORKFLOW: "1"}
    process = subprocess.Popen(
        [sys.executable, "-c", parent], stdout=subprocess.PIPE, text=True, env=environment
    )
    child, state = int(process.stdout.readline()), process.stdout.readline()
    assert state == "runs\n"
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    for _ in range(100):
        if not _lives(child):
            return
        time.sleep(0.05)
    os.kill(child, signal.SIGKILL)
    pytest.fail("the step outlived its parent")


def _lives(process: int) -> bool:
    """Whether a process still runs; one that ended but was not yet reaped counts as dead."""
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", "m.h5", "--law", "l.json", "--temperature-c", "15", "--frequency-hz", value, "--output", "x"]
        for value in ("0", "-10", "nan", "inf", "three")
    ]
    + [
        ["deposit", "--counts", "c.csv", "--box-m", "1,1,1", "--seed", "1", "--output", "x", option, value]
        for option, value in (
            ("--friction", "nan"), ("--friction", "-1"), ("--time-step-s", "0"), ("--time-step-s", "-1e-4"),
            ("--stroke-mm", "-5"), ("--vibration-hz", "0"), ("--vibration-s", "nan"), ("--seed", "-1"),
        )
    ]
    + [
        ["reconstruct", "t.csv", "--geometry", "g.csv", "--seed", "1", "--output", "x", "--frequencies-hz", *more]
        for more in (
            ["3,x"], ["nan"], ["3,3"], ["0"], [""], ["3", "--phase-scatter-deg", "nan"],
            ["3", "--modulus-scatter", "-1"], ["3", "--amplitude-m", "0"], ["3", "--specimens", "0"],
        )
    ]
    + [["reduce", "m.csv", "--geometry", "g.csv", "--output", "x", "--cycles", "-3"]]
    + [["fit", "m.csv", "--output", "x", "--temperature-c", "nan"]]
    + [["trim", "d.h5", "--geometry", "g.csv", "--output", "x", "--volume-reduction", "1"]]
    + [["condense", "s.h5", "--output", "x", "--poisson", "2"]],
)  # fmt: skip
def test_number_out_of_its_range_is_refused_before_anything_is_read(arguments, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as stop:
        cli.main(arguments)
    assert stop.value.code == 2
    assert re.search("must be a number|range|positive numbers joined by commas", capsys.readouterr().err)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "damage", [lambda whole: whole[:-200], lambda whole: whole[:700] + b"x" + whole[701:], lambda _: b""]
)
def test_damaged_result_is_set_aside_within_the_workflow_only(tmp_path, damage):
    save(path := tmp_path / "f3.h5", "test", {"force_N": [1.0, 2.0]}, {"specimen": "s1"})
    path.write_bytes(damage(path.read_bytes()))
    refused(run("collect", path, "--output", tmp_path / "x.csv"), f"error: {path}: ")
    assert path.exists()
    refused(run("collect", path, "--output", tmp_path / "x.csv", env=INSIDE), ".f3.h5.damaged")
    assert [file.name for file in tmp_path.iterdir()] == [".f3.h5.damaged"]


def test_input_that_is_no_result_of_ours_is_never_removed_and_one_of_another_kind_is(tmp_path):
    (geometry := tmp_path / "g.json").write_text("{")
    save(model := tmp_path / "m.h5", "model", {}, {})
    save(made := tmp_path / "results/mine/f3.h5", "model", {}, {})
    refused(run("trim", "d.h5", "--geometry", geometry, "--output", "x", env=INSIDE))
    assert run("reduce", geometry, "--geometry", geometry, "--output", "x", env=INSIDE).returncode == 2
    for path in (model, made):
        done = run("collect", path.relative_to(tmp_path), "--output", "x.csv", env=INSIDE, cwd=tmp_path)
        refused(done, "a test file", "a model file")
    assert geometry.exists()
    assert model.exists()
    assert not made.exists()


GEOMETRY = "b_mm,B_mm,e_mm,h_mm,mass_kg,mobile_mass_kg\n25,56,25,250,0.6,0.1\n"
MODULI = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\na,10,3,5000,20\nb,10,3,5100,21\n"


@pytest.mark.parametrize(
    "damage", [lambda text: text.replace("5000", "5001"), lambda text: text[: text[:-1].rfind("\n") + 1]]
)
def test_a_digit_changed_or_a_line_lost_is_noticed_within_the_workflow(tmp_path, damage):
    (tmp_path / "geometry.csv").write_text(GEOMETRY)
    (tmp_path / "m.csv").write_text(MODULI)
    table = tmp_path / "results/mine/measured.csv"
    reduce = ("reduce", "m.csv", "--geometry", "geometry.csv", "--output", "results/mine/measured.csv")
    page = ("page", "results/mine/measured.csv", "--title", "t", "--output", "page.html")
    for step in (reduce, page):
        assert run(*step, env=INSIDE, cwd=tmp_path).returncode == 0
    changed = damage(table.read_text())
    assert changed != table.read_text()
    table.write_text(changed)
    refused(run(*page, env=INSIDE, cwd=tmp_path), "results/mine/measured.csv")
    assert not table.exists()
    assert table.with_name(".measured.csv.damaged").read_text() == changed
    for step in (reduce, page):
        assert run(*step, env=INSIDE, cwd=tmp_path).returncode == 0


def test_a_step_repeated_by_hand_is_no_damage_and_a_digest_cut_short_no_verdict(tmp_path):
    table, digest = tmp_path / "results/mine/m.csv", tmp_path / "results/mine/.m.csv.sha256"
    table.parent.mkdir(parents=True)
    page = ("page", "results/mine/m.csv", "--title", "t", "--output", "results/mine/page.html")
    table.write_text("a\n1\n")
    digest.write_text("0" * 63)
    assert run(*page, env=INSIDE, cwd=tmp_path).returncode == 0
    digest.write_text("0" * 64)
    assert run(*page, env=INSIDE, cwd=tmp_path).returncode == 2
    made = tmp_path / "results/mine/.page.html.sha256"
    before = made.read_text()
    assert cli.CPU_TIME not in run(*page, env=INSIDE, cwd=tmp_path).stderr  # it is refused again
    table.write_text("a\n2\n")
    assert run(*page, cwd=tmp_path).stderr == ""
    assert made.read_text() != before
    made.unlink()
    assert run(*page, cwd=tmp_path).returncode == 0
    assert not made.exists()
    digest.unlink(missing_ok=True)
    said = run(*page, env=INSIDE, cwd=tmp_path).stderr
    assert re.search(rf"^{cli.CPU_TIME}\d+\.\d+ s, memory: ", said, re.M)


@pytest.mark.parametrize("threads", ["0", "-2", "1000000"])
def test_threads_that_the_machine_has_not_are_refused_before_anything_is_compiled(
    threads, capsys, tmp_path, monkeypatch
):
    monkeypatch.setattr("asphalt_nscd.nscd.core_cache.is_compiled", lambda _: False)
    monkeypatch.chdir(tmp_path)
    Path("counts.csv").write_text("diameter_mm,count\n5,20\n")
    box = [
        "deposit",
        "--counts",
        "counts.csv",
        "--box-m",
        "0.05,0.02,0.12",
        "--seed",
        "1",
        "--output",
        "s1.h5",
    ]
    with pytest.raises(SystemExit) as stop:
        cli.main([*box, "--threads", threads])
    assert stop.value.code == 2
    assert f"threads = {threads}" in capsys.readouterr().err
    assert not Path("s1.h5").exists()


def test_memory_is_told_in_megabytes():
    """Of a process with numpy and pandas."""
    assert 50.0 < cli._most_memory() < 5000.0


def test_a_thread_without_memory_ends_the_step_in_a_sentence():
    """The others may wait for it for ever: here the step does."""
    step = """
import threading
from asphalt_nscd import cli

def fail():
    raise MemoryError

def step():
    threading.Thread(target=fail).start()
    threading.Event().wait()

cli._end(step)
"""
    done = subprocess.run([sys.executable, "-c", step], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and done.stderr.startswith("error: the memory is used up")
    assert done.stderr.count("\n") == 1
