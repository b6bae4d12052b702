from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    benchmarks: tuple[Path, ...],
    *,
    folder: Path = option("Folder whose names are those of rules."),
    markdown: Path = option("File for the same table in Markdown."),
    output: Path = OUTPUT,
) -> None:
    """Sum Snakemake's BENCHMARKS files by rule, which shows where the time goes."""
    from asphalt_nscd.files.store import atomic_path, write_table
    from asphalt_nscd.reporting.timings import elapsed, rule_times, timing_summary

    table = rule_times(benchmarks, folder)
    write_table(output, table)
    with atomic_path(markdown) as path:
        path.write_text(timing_summary(table, elapsed(benchmarks)), encoding="utf-8")
