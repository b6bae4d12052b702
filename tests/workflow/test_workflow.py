"""The Snakefile as a user meets it; only the quick rules are really run here."""

from __future__ import annotations

import csv
import math
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import asphalt_nscd as an

pytestmark = pytest.mark.slow

OPTIONAL = ("sensitivity", "time_step_study", "packing_study", "audit", "published")
FITS = ["results/smoke/laws/fitted/T0.json", "results/smoke/laws/fitted/T20.json"]


ROOT = Path(__file__).parents[2]
MAKE = dict(
    re.findall(r"^(\w+): \$\(READY\)\n\t@\.venv/bin/snakemake (.*)", (ROOT / "Makefile").read_text(), re.M)
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


@pytest.mark.parametrize("target", MAKE)
def test_make_hands_over_what_snakemake_understands(target):
    recipe = MAKE[target].replace("$(CORES)", "all").replace("$(CONFIG)", "config/smoke.yaml")
    recipe += " --dry-run --quiet all --nolock"
    command = [sys.executable, "-m", "snakemake", *shlex.split(recipe)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_misspelt_key_is_one_sentence(workspace):
    workspace.configure(temperature_C=[0, 20])
    done = workspace.run("--dry-run")
    assert done.returncode != 0
    sentence = "error: study.yaml: unknown key 'temperature_C' in the study; did you mean 'temperatures_C'?"
    assert sentence in done.stderr.splitlines()
    assert "Traceback" not in done.stderr


def test_key_that_stands_twice_is_one_sentence(workspace):
    study = workspace.configure()
    study.write_text(study.read_text() + "study: other\n")
    done = workspace.run("--dry-run")
    assert done.returncode != 0
    assert "key 'study' appears twice; keep one of the two." in done.stderr


def test_a_forgotten_caption_is_one_sentence(workspace):
    """The recipe of CONTRIBUTING for a figure, its last step left out."""
    shutil.copytree(ROOT / "workflow", workspace.folder / "workflow")
    shutil.copy(ROOT / "Snakefile", workspace.folder)
    (workspace.folder / "workflow/report/fig07.rst").unlink()
    workspace.configure()
    command = [sys.executable, "-m", "snakemake", "--dry-run", "--configfile", "study.yaml"]
    done = subprocess.run(
        command, cwd=workspace.folder, capture_output=True, text=True, env=workspace.environment
    )
    assert done.returncode != 0 and "Traceback" not in done.stderr
    sentence = (
        "error: workflow/report/fig07.rst: no caption of fig07; write it, its title in ** on the first line."
    )
    assert sentence in done.stderr.splitlines()


def test_study_that_cannot_work_is_one_sentence(workspace):
    left_out = dict.fromkeys(OPTIONAL)
    workspace.configure(
        measurements=workspace.measure(), temperatures_C=[0, 5, 20], laws={"simulate": "fitted"}, **left_out
    )
    done = workspace.run("--dry-run")
    assert done.returncode != 0 and "Traceback" not in done.stderr
    sentence = "error: study.yaml: temperatures_C: 5 is not in mine.csv, which has 0, 20; use these."
    assert sentence in done.stderr.splitlines()


def test_own_table_replaces_the_reconstruction(workspace):
    workspace.configure()
    assert "reconstruct" in workspace.planned()
    workspace.configure(measurements=workspace.measure())
    assert "reconstruct" not in workspace.planned()


def test_least_study_is_the_tests_and_their_figures(workspace):
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


def test_the_paper_is_120_tests_on_four_samples(workspace):
    (workspace.folder / "study.yaml").write_text((workspace.folder / "config/paper.yaml").read_text())
    jobs = workspace.planned("results/paper/simulations.csv")
    assert jobs["simulate"] == 120 and jobs["deposit"] == 4
    said = workspace.run("results/paper/simulations.csv", "--dry-run", "--printshellcmds").stdout
    written = re.findall(r"--frequency-hz (\S+) --law \S+/(T\S+).json --output \S+/(s\d/T\S+/f\S+).h5", said)
    assert len(set(written)) == 120
    assert all(output.endswith(f"/{temperature}/f{frequency}") for frequency, temperature, output in written)
    jobs = workspace.planned()
    # the rest is one job for all frequencies
    assert jobs["simulate_scaled"] == 32 and jobs["simulate_extended"] == 24 and jobs["audit"] == 1
    assert jobs["simulate_facets"] == 24 and jobs["ladder"] == jobs["fracture"] == 1
    assert {f"fig{number:02d}" for number in (1, *range(5, 15))} | {"table2", "table3", "table4"} <= set(jobs)


def test_bonds_are_made_ready_to_break_only_where_the_campaign_tests(workspace):
    (workspace.folder / "study.yaml").write_text((workspace.folder / "config/paper.yaml").read_text())
    said = workspace.run("--dry-run", "--printshellcmds").stdout
    lines = [line for line in said.splitlines() if "asphalt-nscd condense" in line]
    without = {
        re.search(r"--output results/paper/(\S+).h5", line)[1] for line in lines if "--stand-by 0" in line
    }
    loose = [f"models/free/s1-friction{value}" for value in ("0.3", "0.5")]
    other = {"models/blocked/s1", "time_step/models/free/s1"}
    assert without == {*other, *loose, *(f"facets/{model}" for model in loose)}
    assert len(lines) == 15
    (line,) = (line for line in said.splitlines() if "asphalt-nscd timings" in line)
    forecast = ("packings", "recipe", "mixes", "voids")
    assert all(f" results/paper/benchmarks/forecast_{part}.tsv" in line for part in forecast)


def test_rungs_above_the_paper_s_are_simulated_with_facets_and_nothing_is_divided_out(workspace):
    workspace.configure()
    said = workspace.run("results/smoke/ladder.csv", "--dry-run", "--printshellcmds").stdout
    by_output = {
        found[2]: found[1] for found in re.finditer(r"asphalt-nscd simulate (\S+) .*--output (\S+)", said)
    }
    facets, paper = "results/smoke/facets/models/free/s1.h5", "results/smoke/models/free/s1.h5"
    for folder, model in (("tests", paper), ("facets/tests", facets), ("extended/tests", facets)):
        assert by_output[f"results/smoke/{folder}/s1/T20/f10.h5"] == model
    (line,) = (line for line in said.splitlines() if "asphalt-nscd trim" in line and "/facets/" in line)
    assert "--area facets" in line and "results/smoke/deposits/s1.h5" in line
    (line,) = (line for line in said.splitlines() if "asphalt-nscd extend" in line)
    assert "--specimen" not in line
    (line,) = (line for line in said.splitlines() if "asphalt-nscd diagnose" in line)
    assert "--facets results/smoke/facets.csv" in line


def test_a_study_with_facets_has_no_first_rung(workspace):
    settings = {"seeds": [1], "counts_table": "config/smoke_counts.csv", "box_m": [0.06, 0.01, 0.2]}
    workspace.configure(specimens=settings | {"bonds": {"area": "facets"}})
    jobs = workspace.planned()
    assert not {"trim_facets", "simulate_facets", "fracture"} & set(jobs) and jobs["ladder"] == 1
    said = workspace.run("--dry-run", "--printshellcmds").stdout
    assert "--facets" not in said and "results/smoke/facets" not in said


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


def test_timings_are_those_of_the_study_s_own_jobs(workspace):
    """Not of a temperature that was left out since."""
    workspace.configure(temperatures_C=[20])
    left = workspace.folder / "results/smoke/benchmarks/simulate/s1/T0/f3.tsv"
    left.parent.mkdir(parents=True)
    left.touch()
    said = workspace.run("results/smoke/timings.csv", "--dry-run").stdout
    (command,) = (line.split() for line in said.splitlines() if "asphalt-nscd timings" in line)
    timed = [word.removeprefix("results/smoke/benchmarks/") for word in command if word.endswith(".tsv")]
    assert {"simulate/s1/T20/f3.tsv", "deposit/s1.tsv", "reconstruct.tsv", "fig09.tsv"} <= set(timed)
    assert "simulate/s1/T0/f3.tsv" not in timed and "timings.tsv" not in timed


def test_what_the_study_says_of_the_diagnosis_reaches_it(workspace):
    scatter = {"modulus_scatter_percent": 2, "phase_scatter_deg": 0.5}
    workspace.configure(diagnosis={"seed": 7, "static_modulus_MPa": 30, "scatter": scatter})
    done = workspace.run("results/smoke/diagnosis/diagnosis.json", "--dry-run", "--printshellcmds")
    command = next(line for line in done.stdout.splitlines() if "asphalt-nscd diagnose" in line)
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


@pytest.mark.parametrize("study", ["smoke", "paper"])
def test_all_asks_for_each_file_by_name(workspace, study):
    """Else one that a failed run left missing between newer ones would not be made."""
    (workspace.folder / "study.yaml").write_text((workspace.folder / f"config/{study}.yaml").read_text())
    said = workspace.run("--dry-run").stdout
    asked = re.search(r"^(?:local)?rule all:\n    input: (.+)", said, re.MULTILINE)[1].split(", ")
    made = re.findall(r"^(results/\S+)\t", workspace.run("--summary").stdout, re.MULTILINE)
    assert len(made) > 100
    assert {path for path in made if "/compiled/" not in path} <= set(asked)


def test_killed_run_is_finished_by_the_same_command(workspace):
    workspace.configure()
    undisturbed = workspace.run("--cores", "2", *FITS)
    assert undisturbed.returncode == 0, undisturbed.stderr
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


def test_a_finished_table_that_decayed_is_set_aside_by_the_next_run_and_made_anew_by_the_one_after(workspace):
    workspace.configure()
    assert workspace.run("--cores", "2", *FITS).returncode == 0
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


def test_changed_law_reruns_only_what_depends_on_it(workspace):
    workspace.configure()
    assert workspace.run("--cores", "2", *FITS).returncode == 0
    assert workspace.planned(*FITS) == {}
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
