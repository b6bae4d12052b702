from __future__ import annotations

import os

import pandas as pd
import pytest

from asphalt_nscd.reporting.timings import elapsed, rule_times, timing_summary

HEADER = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n"


def benchmark(path, seconds, memory, cpu):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER + f"{seconds}\t0:00:01\t{memory}\t9\t9\t9\t0\t0\t90\t{cpu}\n")


def files(folder):
    return sorted(folder.rglob("*.tsv"))


def test_only_the_jobs_named_count(tmp_path):
    benchmark(tmp_path / "simulate/s1/T15/f3.tsv", 5.0, 100.0, 4.0)
    benchmark(tmp_path / "simulate/s9/T15/f3.tsv", 3.0, 120.0, 2.5)
    named = [tmp_path / "simulate/s1/T15/f3.tsv", tmp_path / "never_timed.tsv"]
    assert rule_times(named, tmp_path)[["rule", "jobs", "wall_s"]].values.tolist() == [["simulate", 1, 5.0]]


def test_jobs_are_summed_by_rule_most_time_first(tmp_path):
    benchmark(tmp_path / "reduce.tsv", 2.0, 80.0, 1.5)
    benchmark(tmp_path / "simulate/s1/T15/f3.tsv", 5.0, 100.0, 4.0)
    benchmark(tmp_path / "simulate/s2/T15/f3.tsv", 3.0, 120.0, 2.5)
    expected = pd.DataFrame({
        "rule": ["simulate", "reduce"], "jobs": [2, 1], "wall_s": [8.0, 2.0], "cpu_s": [6.5, 1.5],
        "longest_s": [5.0, 2.0], "memory_MB": [120.0, 80.0], "share_percent": [80.0, 20.0],
    })  # fmt: skip
    pd.testing.assert_frame_equal(rule_times(files(tmp_path), tmp_path), expected)


def test_job_too_short_to_be_measured_counts_as_none(tmp_path):
    benchmark(tmp_path / "fit/T15.tsv", 0.1, "-", "-")
    benchmark(tmp_path / "fit/T10.tsv", 0.1, "NA", "NA")
    benchmark(tmp_path / "fit/T20.tsv", 0.3, 50.0, 0.2)
    assert rule_times(files(tmp_path), tmp_path).loc[0, ["cpu_s", "memory_MB"]].tolist() == [0.2, 50.0]


def test_the_log_of_a_job_knows_its_cpu_time_and_memory_best(tmp_path):
    folder = tmp_path / "benchmarks"
    for name, seen in (("T10", 0.1), ("T15", 0.2), ("T20", "NA")):
        benchmark(folder / f"fit/{name}.tsv", 1.0, 50.0, seen)
        log = tmp_path / f"logs/fit/{name}.log"
        log.parent.mkdir(parents=True, exist_ok=True)
        log.write_text("fitted\nCPU time: 0.75 s, memory: 120.5 MB\n" if name != "T15" else "fitted\n")
    table = rule_times(files(folder), folder)
    assert table.loc[0, ["cpu_s", "memory_MB"]].tolist() == [pytest.approx(1.7), 120.5]


def test_time_elapsed_counts_jobs_side_by_side_once_and_no_pause(tmp_path):
    for name, seconds, end in (
        ("a", 10.0, 1010.0),
        ("b", 4.0, 1008.0),
        ("c", 6.0, 1014.0),
        ("d", 5.0, 2000.0),
    ):
        benchmark(tmp_path / f"{name}.tsv", seconds, 100.0, 1.0)
        os.utime(tmp_path / f"{name}.tsv", (end, end))
    # 1000 to 1014 and 1995 to 2000
    assert elapsed([*files(tmp_path), tmp_path / "never_timed.tsv"]) == pytest.approx(19.0)


def test_markdown_sums_what_is_short(tmp_path):
    for name, seconds in {"deposit": 900.0, "a": 5.0, "b": 3.0}.items():
        benchmark(tmp_path / f"{name}.tsv", seconds, 100.0, seconds / 2)
    lines = timing_summary(rule_times(files(tmp_path), tmp_path), 750.0).splitlines()
    assert [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines[2:5]] == [
        ["deposit", "1", "900", "100", "99"],
        ["all others", "2", "8", "100", "1"],
        ["sum", "3", "908", "100", "100"],
    ]
    assert lines[-1] == "Jobs ran side by side, so that all this took 12.5 minutes."
