"""The Snakefile as a user meets it; only the quick rules are really run here."""

from __future__ import annotations

import csv
import math
import os
import re
import shlex
import shutil
import signal
import sys
import time
from functools import cache
from pathlib import Path

import pytest
import yaml
from forks import forked
from workspace import Plan, Workspace

import asphalt_nscd as an

pytestmark = pytest.mark.slow

OPTIONAL = ("sensitivity", "time_step_study", "packing_study", "audit", "published")
FITS = ["results/smoke/laws/fitted/T0.json", "results/smoke/laws/fitted/T20.json"]


ROOT = Path(__file__).parents[2]
SNAKEMAKE = "snakemake.cli:main"
MAKE = dict(
    re.findall(
        r"^(\w+): \$\((?:READY|TOOLS)\)\n\t@\.venv/bin/snakemake (.*)", (ROOT / "Makefile").read_text(), re.M
    )
)


def contents(folder: Path) -> dict[str, bytes]:
    """Results as bytes, without logs and timings."""
    files = [*folder.glob("*.csv"), *folder.glob("laws/**/*.json")]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files if path.name != "timings.csv"}


def wait_for(path: Path, seconds: float = 60.0) -> None:
    until = time.monotonic() + seconds
    while not path.exists():
        assert time.monotonic() < until, f"{path} did not appear"
        time.sleep(0.02)


@cache
def shipped(study: str, folder: Path) -> Plan:
    """Of the whole study of a configuration, asked once."""
    workspace = Workspace(folder)
    (workspace.folder / "study.yaml").write_text((workspace.folder / f"config/{study}.yaml").read_text())
    return workspace.plan()


@pytest.fixture(scope="module")
def plan_of(tmp_path_factory):
    folders = {study: tmp_path_factory.mktemp(study) for study in ("smoke", "paper")}
    return lambda study: shipped(study, folders[study])


@pytest.fixture(scope="module")
def fits(tmp_path_factory):
    """A study whose laws were fitted, and what the terminal showed."""
    workspace = Workspace(tmp_path_factory.mktemp("fits"))
    workspace.configure()
    done = workspace.run("--logger", "steps", "--cores", "2", *FITS)
    assert done.returncode == 0, done.stderr
    return workspace, done.stderr


@pytest.fixture
def fitted(fits, tmp_path):
    """The same in a folder of one's own."""
    shutil.copytree(fits[0].folder, tmp_path, dirs_exist_ok=True)
    copy = Workspace.__new__(Workspace)
    copy.folder = tmp_path
    return copy


def test_make_hands_over_what_snakemake_understands():
    """Whole studies are planned below."""
    from snakemake.cli import parse_args

    together = []
    for recipe in MAKE.values():
        words = shlex.split(recipe.replace("$(CORES)", "all").replace("$(CONFIG)", "config/smoke.yaml"))
        _, given = parse_args(words)
        assert given.logger == ["steps"]
        files = given.configfile or [Path("config/paper.yaml")]
        assert all((ROOT / file).is_file() for file in files)
        if given.targets:
            together.append((words, given.targets))
    assert {name for _, names in together for name in names} == {
        *("attack", "publish_machines", "publish_inside", "verify", "benchmark")
    }
    # the one with most configuration, and the targets of the others
    (words, _), *others = sorted(together, key=lambda recipe: -len(recipe[0]))
    words = [*(name for _, names in others for name in names), *words]
    done = forked(SNAKEMAKE, [*words, "--dry-run", "--quiet", "all", "--nolock"], ROOT)
    assert done.returncode == 0, done.stderr


def test_misspelt_key_is_one_sentence(workspace):
    workspace.configure(temperature_C=[0, 20])
    done = workspace.run("--dry-run")
    assert done.returncode != 0
    sentence = "error: study.yaml: unknown key 'temperature_C' in the study; did you mean 'temperatures_C'?"
    assert sentence in done.stderr.splitlines()
    assert "Traceback" not in done.stderr


def test_a_forgotten_caption_is_one_sentence(workspace):
    """The recipe of CONTRIBUTING for a figure, its last step left out."""
    for name in ("workflow", "studies"):
        shutil.copytree(ROOT / name, workspace.folder / name)
    shutil.copy(ROOT / "Snakefile", workspace.folder)
    (workspace.folder / "workflow/report/fig07.rst").unlink()
    workspace.configure()
    done = forked(
        SNAKEMAKE, ["--dry-run", "--configfile", "study.yaml"], workspace.folder, workspace.environment
    )
    assert done.returncode != 0 and "Traceback" not in done.stderr
    sentence = (
        "error: workflow/report/fig07.rst: no caption of fig07; write it, its title in ** on the first line."
    )
    assert sentence in done.stderr.splitlines()


def test_least_study_is_the_tests_and_their_figures_and_an_own_table_replaces_the_reconstruction(
    workspace, plan_of
):
    assert "reconstruct" in plan_of("smoke").jobs
    workspace.configure(
        measurements=workspace.measure(), laws={"simulate": "fitted"}, **dict.fromkeys(OPTIONAL)
    )
    jobs = workspace.planned()
    assert jobs["simulate"] == 4 and jobs["fit"] == 2 and jobs["fig09"] == 1
    assert jobs["reduced_specimen"] == jobs["diagnose"] == jobs["fig_limits"] == 1
    others = {
        "reconstruct",
        "published_law",
        "simulate_scaled",
        "simulate_pascal",
        "audit",
        "table2",
        "fig06",
    }
    assert not others & set(jobs)


def test_the_paper_is_120_tests_on_four_samples(plan_of):
    plan = plan_of("paper")
    jobs = plan.jobs
    assert jobs["simulate"] == 120 and jobs["deposit"] == 4
    form = r"--frequency-hz (\S+) --law \S+/(T\S+).json --output results/paper/tests/(s\d/T\S+/f\S+).h5"
    written = re.findall(form, "\n".join(plan.lines))
    assert len(set(written)) == 120
    assert all(output.endswith(f"/{temperature}/f{frequency}") for frequency, temperature, output in written)
    # the rest is one job for all frequencies
    assert jobs["simulate_scaled"] == 32 and jobs["simulate_extended"] == 24 and jobs["audit"] == 1
    assert jobs["simulate_facets"] == 24 and jobs["ladder"] == jobs["fracture"] == 1
    assert {f"fig{number:02d}" for number in (1, *range(5, 15))} | {"table2", "table3", "table4"} <= set(jobs)


def test_bonds_are_made_ready_to_break_only_where_the_campaign_tests(plan_of):
    plan = plan_of("paper")
    lines = plan.commands("condense")
    without = {
        re.search(r"--output results/paper/(\S+).h5", line)[1] for line in lines if "--stand-by 0" in line
    }
    loose = [f"models/free/s1-friction{value}" for value in ("0.3", "0.5")]
    other = {"models/blocked/s1", "time_step/models/free/s1"}
    assert without == {*other, *loose, *(f"facets/{model}" for model in loose)}
    assert len(lines) == 15
    (line,) = plan.commands("timings")
    forecast = ("recipe", "mixes", "voids")
    assert all(f" results/paper/benchmarks/forecast_{part}.tsv" in line for part in forecast)


def test_the_log_of_each_step_lies_where_its_cpu_time_is_looked_for(plan_of):
    plan = plan_of("paper")
    logs = {*re.findall(r"> results/paper/logs/(\S+).log 2>&1", "\n".join(plan.lines))}
    (line,) = plan.commands("timings")
    timed = {*re.findall(r" results/paper/benchmarks/(\S+).tsv", line)}
    long = ("deposit", "condense", "simulate", "trim", "diagnose")
    assert len(timed) > 350 and not {name for name in timed - logs if name.startswith(long)}


def test_rungs_above_the_paper_s_are_simulated_with_facets_and_nothing_is_divided_out(plan_of):
    plan = plan_of("smoke")
    found = [
        re.search(r"asphalt-nscd simulate (\S+) .*--output (\S+)", line) for line in plan.commands("simulate")
    ]
    by_output = {one[2]: one[1] for one in found}
    facets, paper = "results/smoke/facets/models/free/s1.h5", "results/smoke/models/free/s1.h5"
    for folder, model in (("tests", paper), ("facets/tests", facets), ("extended/tests", facets)):
        assert by_output[f"results/smoke/{folder}/s1/T20/f10.h5"] == model
    (line,) = (
        line for line in plan.commands("trim") if "--output results/smoke/facets/specimens/s1.h5" in line
    )
    assert "--area facets" in line and "results/smoke/deposits/s1.h5" in line
    (line,) = plan.commands("extend")
    assert "--specimen" not in line
    line, again = plan.commands(
        "diagnose results/smoke/measured.csv"
    )  # for its words, and for what is simulated
    assert line.rpartition(" --output ")[0] == again.rpartition(" --output ")[0]
    assert "--facets results/smoke/facets.csv" in line


def test_packings_stand_in_for_pouring(workspace):
    """A pile of another program goes through to its |E*|; nothing is poured."""
    pile = an.pour({4.0: 900}, (0.06, 0.012, 0.15), vibration=an.Vibration(duration=0.0))
    an.export(pile, workspace.folder / "pile one.csv", "csv")
    length, width = (1e3 * pile.box_m[:2]).tolist()
    shape = {"b_mm": 10, "B_mm": 20, "e_mm": width, "h_mm": length, "mass_kg": 0.021, "mobile_mass_kg": 0.008}
    workspace.configure(
        specimens={"packings": ["pile one.csv"], "geometry": shape}, **dict.fromkeys(OPTIONAL)
    )
    jobs = workspace.planned()
    assert jobs["import_packing"] == 1 and not {"deposit", "fig05", "fig_compaction", "preparation"} & set(
        jobs
    )
    done = workspace.run("results/smoke/samples.csv", "--cores", "1")
    assert done.returncode == 0, done.stderr
    (row,) = csv.DictReader((workspace.folder / "results/smoke/samples.csv").open())
    assert row["packing"] == "pile one.csv" and row["sample"] == "s1" and row["tests"] == "4"
    assert 0.5 < float(row["E_over_law"]) < 2.0 and float(row["largest_phase_difference_deg"]) < 0.2


def test_timings_are_those_of_the_study_s_own_jobs_and_what_it_says_of_the_diagnosis_reaches_it(workspace):
    """Timings not of a temperature that was left out since."""
    scatter = {"modulus_scatter_percent": 2, "phase_scatter_deg": 0.5}
    workspace.configure(
        temperatures_C=[20], diagnosis={"seed": 7, "static_modulus_MPa": 30, "scatter": scatter}
    )
    left = workspace.folder / "results/smoke/benchmarks/simulate/s1/T0/f3.tsv"
    left.parent.mkdir(parents=True)
    left.touch()
    plan = workspace.plan("results/smoke/timings.csv")
    (command,) = (line.split() for line in plan.commands("timings"))
    timed = [word.removeprefix("results/smoke/benchmarks/") for word in command if word.endswith(".tsv")]
    assert {"simulate/s1/T20/f3.tsv", "deposit/s1.tsv", "reconstruct.tsv", "fig09.tsv"} <= set(timed)
    assert "simulate/s1/T0/f3.tsv" not in timed and "timings.tsv" not in timed
    (command,) = plan.commands("diagnose results/smoke/measured.csv")
    for words in (
        "--seed 7",
        "--draws 4000",
        "--static-modulus-mpa 30",
        "--modulus-scatter-percent 2",
        "--phase-scatter-deg 0.5",
        "--geometry B_mm=20,b_mm=10",
        "--specimen results/smoke/diagnosis/specimens/s1.h5",
    ):
        assert words in command
    workspace.configure(diagnosis={"scatter": {"phase_scatter_deg": 0.5}})
    done = workspace.run("--dry-run")
    assert "key 'modulus_scatter_percent' is missing from diagnosis.scatter; add it." in done.stderr


def test_failed_job_ends_with_its_sentence_and_its_log(workspace):
    """Traceable without reading what Snakemake says about itself."""
    table = workspace.measure()
    path = workspace.folder / "mine.csv"
    path.write_text(path.read_text().replace("9000", "9"))
    workspace.configure(measurements=table)
    done = workspace.run("results/smoke/measured.csv", "--cores", "1")
    assert done.returncode != 0
    lines = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert lines[-1].startswith(
        "error: mine.csv, line 2: 9 MPa is softer than any asphalt at 0 degC and 3 Hz"
    )
    assert lines[-1].endswith("multiply by 1000. (results/smoke/logs/reduce.log)")


def test_edited_record_is_reduced_again(workspace):
    folder = workspace.folder
    table = ["specimen,temperature_C,frequency_Hz,record"]
    for frequency in (5, 10):
        rows = ["time_s,force_N,displacement_m"]
        for step in range(800):
            angle = 2 * math.pi * frequency * step * 1e-3
            rows.append(f"{step * 1e-3},{20 * math.sin(angle + 0.3)},{6.3e-5 * math.sin(angle)}")
        (record := folder / f"record{frequency}.csv").write_text("\n".join(rows) + "\n")
        table += [f"{specimen},20,{frequency},{record.name}" for specimen in (1, 2)]
    (folder / "mine.csv").write_text("\n".join(table) + "\n")
    one = {"temperatures_C": [20], "frequencies_Hz": [5, 10], "measurements": {"table": "mine.csv"}}
    one |= dict.fromkeys(OPTIONAL)
    workspace.configure(**one, reduction={"cycles": 3})
    target = "results/smoke/measured.csv"
    done = workspace.run(target, "--cores", "1")
    assert done.returncode == 0, done.stderr
    assert workspace.planned(target) == {}
    record.write_text("\n".join(rows[:-50]) + "\n")
    assert workspace.planned(target) == {"reduce": 1}
    workspace.configure(**one, reduction={"cycles": 2})
    record.write_text("\n".join(rows) + "\n")
    assert workspace.planned(target) == {"reduce": 1}


def test_what_was_reconstructed_with_a_table_of_specimens_is_made_again_with_it(workspace):
    """Forces drawn for one height and reduced with another would give another |E*|."""
    shape = {"b_mm": 10, "B_mm": 20, "e_mm": 10, "h_mm": 60, "mass_kg": 0.021, "mobile_mass_kg": 0.008}
    values = ",".join(map(str, shape.values()))
    shapes = workspace.folder / "shapes.csv"
    shapes.write_text(f"specimen,{','.join(shape)}\n1,{values}\n2,{values}\n")
    specimens = yaml.safe_load((workspace.folder / "config/smoke.yaml").read_text())["specimens"]
    workspace.configure(geometry="shapes.csv", specimens=specimens | {"geometry": shape})
    target = "results/smoke/measured.csv"
    done = workspace.run(target, "--cores", "1")
    assert done.returncode == 0, done.stderr
    shapes.write_text(shapes.read_text().replace(",60,", ",66,"))
    assert workspace.planned(target) == {"reconstruct": 1, "reduce": 1}


def test_an_older_table_put_in_the_place_of_one_of_one_s_own_is_reduced_and_fitted(workspace):
    """Copies and archives keep dates."""
    workspace.configure(
        measurements=workspace.measure(), laws={"simulate": "fitted"}, **dict.fromkeys(OPTIONAL)
    )
    table, targets = workspace.folder / "mine.csv", ("results/smoke/measured.csv", FITS[0])
    done = workspace.run(*targets, "--cores", "1")
    assert done.returncode == 0, done.stderr
    times = table.stat()
    table.write_text(table.read_text().replace("1,0,3,9000", "1,0,3,9100"))
    os.utime(table, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert workspace.planned(*targets) == {"reduce": 1, "fit": 1}


def test_all_asks_for_each_file_by_name(workspace, plan_of):
    """Else one that a failed run left missing between newer ones would not be made."""
    (workspace.folder / "study.yaml").write_text((workspace.folder / "config/paper.yaml").read_text())
    lines = plan_of("paper").lines
    at = next(n for n, line in enumerate(lines) if re.fullmatch("(local)?rule all:", line))
    asked = lines[at + 1].removeprefix("    input: ").split(", ")
    made = re.findall(r"^(results/\S+)\t", workspace.run("--summary").stdout, re.MULTILINE)
    assert len(made) > 100
    assert {path for path in made if "/compiled/" not in path} <= set(asked)


def test_a_run_is_a_line_for_each_step_and_its_commands_are_kept(fits):
    workspace, said = fits
    lines = said.strip().splitlines()
    steps = [line for line in lines if " s)" in line]
    assert [line.split()[0] for line in steps] == ["1/4", "2/4", "3/4", "4/4"]
    assert len(steps) == 4 and len(lines) <= len(steps) + 2 and max(map(len, lines)) < 120, lines
    (log,) = workspace.folder.glob(".snakemake/log/*.log")
    assert "asphalt-nscd reduce" in log.read_text()


def test_no_timer_renews_the_look_at_jobs_on_this_machine(fitted):
    """Snakemake starts them where it limits jobs a second, as it does by default."""
    done = fitted.run("--cores", "1", "--verbose", "--force", FITS[0])
    counts = re.findall(r"Resources after job selection: .*'_job_count': (\d+)", done.stderr)
    assert counts and set(counts) == {str(sys.maxsize)}, done.stderr


def test_killed_run_is_finished_by_the_same_command(fitted):
    workspace = fitted
    results = workspace.folder / "results/smoke"
    expected = contents(results)
    assert len(expected) == 5

    for path in FITS:
        (workspace.folder / path).unlink()
    (results / "measured.csv").unlink()
    running = workspace.start("--cores", "1", *FITS)
    wait_for(results / "measured.csv")
    os.kill(running.pid, signal.SIGKILL)
    running.communicate()
    assert list((workspace.folder / ".snakemake/locks").iterdir()), "the kill came too late to test anything"

    again = workspace.run("--cores", "2", *FITS)
    assert again.returncode == 0, again.stderr
    assert contents(results) == expected


def test_a_finished_table_that_decayed_is_set_aside_by_the_next_run_and_made_anew_by_the_one_after(fitted):
    workspace = fitted
    law = workspace.folder / FITS[0]
    whole, times = law.read_text(), law.stat()
    law.write_text(whole.replace("1", "2", 1))
    os.utime(law, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert workspace.planned(*FITS) == {} and law.exists()
    met = workspace.run("--cores", "2", *FITS)
    assert met.returncode != 0
    assert f"\nerror: {FITS[0]}: damaged, or edited after the workflow wrote it" in met.stderr
    assert not law.exists()
    assert workspace.run("--cores", "2", *FITS).returncode == 0
    assert law.read_text() == whole


def test_second_run_at_the_same_time_is_refused(workspace):
    workspace.configure()
    first = workspace.start("--cores", "1", *FITS)
    try:
        wait_for(workspace.folder / "results/smoke/logs/reconstruct.log")
        first.send_signal(signal.SIGSTOP)  # however slow the second is, the first has not ended
        assert first.poll() is None, "the first run ended too early to test anything"
        second = workspace.run("--cores", "1", *FITS)
    finally:
        # not SIGTERM, on which Snakemake 9.27 can wait for itself forever
        first.kill()
        first.communicate()
    assert second.returncode != 0
    assert "cannot be locked" in second.stderr


def test_changed_law_reruns_only_what_depends_on_it(fitted):
    workspace = fitted
    table = workspace.folder / "data/paper/table3_burgers.csv"
    os.utime(table)
    assert workspace.planned(*FITS) == {}, "the content is the same"
    (workspace.folder / FITS[0]).unlink()
    assert workspace.planned(*FITS) == {"fit": 1}
    table.write_text(table.read_text().replace("3.55e7", "3.56e7"))
    assert workspace.planned(*FITS) == {"reconstruct": 1, "reduce": 1, "fit": 2}
    workspace.configure(measurements={"reconstruct": {"seed": 7, "specimens": 2}})
    table.write_text(table.read_text().replace("3.56e7", "3.55e7"))
    assert workspace.planned(*FITS) == {"reconstruct": 1, "reduce": 1, "fit": 2}
