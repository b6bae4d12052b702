"""The workflow by the conventions of Snakemake: in a folder of the clone, as a module, deployed, linted."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from forks import forked

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
SNAKEMAKE = [sys.executable, "-m", "snakemake"]
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith("SNAKEMAKE")}
OUTER = """
module asphalt:
    snakefile:
        {snakefile}
    prefix:
        "mix"
    config:
        config["asphalt"]


use rule * from asphalt as asphalt_*


rule mine:
    default_target: True
    input:
        rules.asphalt_all.input,


rule both:
    output:
        "both.txt",
    shell:
        "echo one > {{output}}; echo two >> {{output}}"
"""
# What `snakemake --lint` may find in which files and rules, and why it stays
ACCEPTED = {
    "Environment variable": {"common"},  # set there, not asked for
    "Mixed rules and functions": {"data", "report", "mapping"},  # of one rule, beside it
    "No log directive": {"publish", "first_page"},  # they say on the terminal what they copied
    "Param": {"publish", "first_page"},  # the folder that is published begins like an output
}


def snakemake(*arguments: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    if {"--dry-run", "--lint"} & {*arguments}:
        return forked("snakemake.cli:main", [*arguments], folder, ENVIRONMENT | environment)
    command = [*SNAKEMAKE, *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=ENVIRONMENT | environment)


def test_a_folder_of_the_clone_is_as_good_as_its_root():
    law = "results/paper/laws/pascal/T15.json"  # of the paper's study alone
    done = snakemake("--dry-run", "--nolock", "--snakefile", "../Snakefile", law, folder=ROOT / "docs")
    assert done.returncode == 0, done.stderr
    assert re.search("^pascal_law +1$", done.stdout + done.stderr, re.M)
    assert not (ROOT / "docs/.snakemake").exists()


def test_the_default_profile_needs_no_plugin():
    profile = yaml.safe_load((ROOT / "profiles/default/config.yaml").read_text())
    assert not {"logger", "executor", "software-deployment-method"} & set(profile)


@pytest.fixture
def outer(tmp_path):
    """Another workflow, in a folder of its own, that uses this one for a study of its own table."""
    study = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())
    for key in ("published", "audit", "tables_beside", "sensitivity", "time_step_study", "packing_study"):
        del study[key]
    counts = study["specimens"]["counts_table"]
    rows = [f"1,{temperature},{f},{9000 + 100 * f},20" for temperature in (0, 20) for f in (3, 10)]
    (tmp_path / "own").mkdir()
    (tmp_path / "own/mine.csv").write_text(
        "\n".join(["specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", *rows])
    )
    (tmp_path / "own/counts.csv").write_text((ROOT / counts).read_text())
    study |= {"study": "own", "measurements": {"table": "own/mine.csv"}, "laws": {"simulate": "fitted"}}
    study["specimens"]["counts_table"] = "own/counts.csv"
    (tmp_path / "config.yaml").write_text(yaml.safe_dump({"asphalt": study}))
    (tmp_path / "Snakefile").write_text(OUTER.format(snakefile=f'"{ROOT}/workflow/Snakefile"'))
    return tmp_path


def test_as_a_module_with_prefix_and_configuration_of_its_own(outer):
    planned = snakemake("--dry-run", "--configfile", "config.yaml", "--quiet", "rules", folder=outer)
    assert planned.returncode == 0, planned.stderr
    assert re.search(r"^asphalt_simulate +4$", planned.stdout + planned.stderr, re.M)
    targets = ["mix/results/own/table3.csv", "both.txt"]
    done = snakemake("--cores", "1", *targets, "--configfile", "config.yaml", folder=outer)
    assert done.returncode == 0, done.stderr
    assert (outer / targets[0]).read_text().count("\n") > 2
    assert (outer / "both.txt").read_text() == "one\ntwo\n"  # commands of others are as they were
    assert not (outer / "results").exists()


def test_a_module_finds_a_table_of_specimens_and_sampled_records_where_they_are(outer):
    """The prefix is for results alone: what a table of the user names stands beside it."""
    geometry = {"b_mm": 10, "B_mm": 20, "e_mm": 10, "h_mm": 60, "mass_kg": 0.021, "mobile_mass_kg": 0.008}
    (outer / "own/shapes.csv").write_text(
        f"specimen,{','.join(geometry)}\n1,{','.join(map(str, geometry.values()))}\n"
    )
    (outer / "own/record.csv").write_text("time_s,force_N,displacement_m\n")
    rows = [f"1,{temperature},{f},record.csv" for temperature in (0, 20) for f in (3, 10)]
    (outer / "own/mine.csv").write_text("\n".join(["specimen,temperature_C,frequency_Hz,record", *rows]))
    config = yaml.safe_load((outer / "config.yaml").read_text())
    config["asphalt"] |= {"geometry": "own/shapes.csv"}
    config["asphalt"]["specimens"]["geometry"] = geometry
    (outer / "config.yaml").write_text(yaml.safe_dump(config))
    targets = ["mix/results/own/measured.csv", "mix/results/own/laws/fitted/T0.json"]
    planned = snakemake("--dry-run", *targets, "--configfile", "config.yaml", folder=outer)
    assert planned.returncode == 0, planned.stderr


def test_every_step_of_a_study_names_its_software():
    for path in (ROOT / "workflow/rules").glob("*.smk"):
        if path.stem in ("mapping", "verification", "attack", "publish", "pictures", "whole"):
            continue  # programs of a clone, run beside Snakemake
        for rule in re.split(r"^ *rule[ \w]*:$", path.read_text(), flags=re.M)[1:]:
            rule = re.split(r"^ *use rule .*$", rule, flags=re.M)[0]
            assert "shell:" not in rule or "ENVIRONMENT" in rule, f"{path}: {rule[:60]}"
    assert (ROOT / "workflow/rules/../envs/asphalt-nscd.yaml").is_file()


def test_no_command_of_a_loop_is_that_of_its_last_rule():
    """Snakemake evaluates `shell` anew when a job runs: what a loop changes must reach it by params."""
    rules = "".join(path.read_text() for path in (ROOT / "workflow/rules").glob("*.smk"))
    commands = re.findall(r"^ +shell:\n((?: +.*\n)+)", rules, re.M)
    assert len(commands) == rules.count("shell:\n")
    for command in commands:
        start = re.match(r'(f?)"|[A-Z_]+\s', command.strip())
        assert start, command
        assert not start[1] or all(map(str.isupper, re.findall(r"(?<!\{)\{(?!\{)(\w+)", command))), command


def test_versions_of_conda_are_those_of_the_lock():
    listed = yaml.safe_load((ROOT / "workflow/envs/asphalt-nscd.yaml").read_text())["dependencies"]
    pins = dict(item.split("=") for item in listed)
    assert pins.pop("python") == "3.11"
    lock = (ROOT / "requirements.txt").read_text()
    for name, version in pins.items():
        name = name.removesuffix("-base")
        locked = re.search(rf"^{name}==(\S+)(?: ; python_full_version < '3.12')? \\$", lock, re.M)
        assert locked and locked[1].startswith(f"{version}."), name
    needed = set(
        re.findall(r'^    "([\w-]+)>=', (ROOT / "pyproject.toml").read_text().split("workflow = [")[0], re.M)
    )
    assert {name.removesuffix("-base") for name in pins} == {*needed, "docutils"}


def test_the_command_of_a_clone_needs_no_installation():
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    command = [ROOT / "workflow/scripts/asphalt-nscd", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT | {"PATH": path})
    assert done.stdout.startswith("asphalt-nscd "), done.stderr


def test_lint_finds_only_what_is_accepted():
    done = snakemake("--lint", "--configfile", "config/smoke.yaml", folder=ROOT)
    where, found = "", set()
    for line in done.stderr.splitlines():
        if place := re.search(r"^Lints for (?:rule (publish|\w+).*|.*/(\w+)\.smk):$", line):
            where = place[1] or place[2]
        elif finding := re.search(r"^    \* (.*)", line):
            kind = next((kind for kind in ACCEPTED if finding[1].startswith(kind)), finding[1])
            found.add((kind, where))
    assert found == {(kind, place) for kind, places in ACCEPTED.items() for place in places}


CONDA = """\
#!/bin/sh
# Answers as conda does. An environment is a Python that says that it ran, and is the one of these tests.
case "$*" in
    --version) echo "conda 26.1.0" ;;
    "info --json") echo '{{"conda_prefix": "{prefix}", "platform": "linux-64"}}' ;;
    config*) echo '{{"get": {{"channel_priority": "strict"}}}}' ;;
    *"env create"*)
        echo "$*" >>{prefix}/created
        while [ $# -gt 0 ]; do [ "$1" = --prefix ] && place=$2; shift; done
        mkdir -p "$place/bin"
        printf '#!/bin/sh\\necho "$*" >>{prefix}/ran\\nexec {python} "$@"\\n' >"$place/bin/python"
        chmod +x "$place/bin/python" ;;
esac
"""
APPTAINER = """\
#!/bin/sh
# Answers as apptainer does; the container is this machine.
[ "$1" = --version ] && echo "apptainer version 1.4.0" && exit
echo "$*" >>{prefix}/ran
while [ "${{1%.sif}}" = "$1" ]; do shift; done
shift
PATH={bin}:/usr/bin:/bin exec "$@"
"""


@pytest.fixture
def programs(tmp_path, workspace):
    """A folder of programs on the path, and what a study of the workspace says with these options."""
    (tmp_path / "programs/bin").mkdir(parents=True)

    def run(text: str, name: str, *options: str) -> tuple[subprocess.CompletedProcess[str], Path]:
        prefix, python = tmp_path / "programs", Path(sys.executable)
        program = prefix / "bin" / name
        program.write_text(text.format(prefix=prefix, python=python, bin=python.parent))
        program.chmod(0o755)
        (prefix / "bin/activate").write_text('PATH="$1/bin:$PATH"\n')
        workspace.configure()
        (workspace.folder / "asphalt-nscd.sif").touch()
        path = os.pathsep.join([str(prefix / "bin"), os.environ["PATH"]])
        command = workspace.command("results/smoke/measured.csv", "--cores", "1", *options)
        environment = workspace.environment | {"PATH": path}
        done = subprocess.run(command, cwd=workspace.folder, capture_output=True, text=True, env=environment)
        return done, prefix

    return run


def test_with_conda_the_steps_run_in_the_environment_of_the_file(programs):
    done, prefix = programs(CONDA, "conda", "--sdm", "conda")
    assert done.returncode == 0, done.stderr
    assert (prefix / "created").read_text().count("\n") == 1
    steps = [line.split()[2] for line in (prefix / "ran").read_text().splitlines()]
    assert steps == ["reconstruct", "reduce"]


def test_with_apptainer_the_steps_run_in_the_image(programs):
    done, prefix = programs(APPTAINER, "apptainer", "--sdm", "apptainer")
    assert done.returncode == 0, done.stderr
    ran = (prefix / "ran").read_text()
    assert ran.count("asphalt-nscd.sif") == 2 and "asphalt-nscd reduce" in ran
