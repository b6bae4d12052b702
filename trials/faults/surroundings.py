"""Clocks, records of Snakemake, inputs and environment that are not as they should be."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path

from faults.damaged import cut
from faults.fault import TEST
from faults.study import Run, Study

CACHE = "ASPHALT_NSCD_CACHE"


def clock_set_back(study: Study) -> Run:
    """Results were made while the clock went a day ahead; then an input is changed, and changed again."""
    tomorrow = time.time() + 86400
    for path in (*study.results.rglob("*"), *study.folder.glob(".snakemake/**/*")):
        if path.is_file():
            os.utime(path, (tomorrow, tomorrow))
    table = study.folder / "data/paper/table3_burgers.csv"
    right = table.read_text()
    table.write_text(right.replace("3.55e7", "3.56e7"))
    before = (study.results / "simulations.csv").read_bytes()
    done = study.finish()
    if done.returncode == 0 and (study.results / "simulations.csv").read_bytes() == before:
        return Run([], 1, "", "error: the changed table was not noticed.")
    table.write_text(right)
    return done


def clock_ahead(study: Study) -> Run:
    """One of the inputs was saved by a machine whose clock goes ahead."""
    os.utime(study.folder / "config/smoke_counts.csv", (time.time() + 86400,) * 2)
    return study.finish()


def records_lost(study: Study) -> Run:
    shutil.rmtree(study.folder / ".snakemake")
    (study.results / TEST).unlink()
    return study.finish()


def records_damaged(study: Study) -> Run:
    for path in (study.folder / ".snakemake/metadata").rglob("*"):
        if path.is_file():
            cut(path)
    (study.results / TEST).unlink()
    return study.finish()


def stamps_lost(study: Study) -> Run:
    shutil.rmtree(study.folder / ".snakemake/code")
    return study.finish()


def table_gone(study: Study) -> Run:
    """Of a name that no shipped file has, for these stand in."""
    path = study.folder / "study.yaml"
    text = path.read_text()
    path.write_text(text.replace("config/smoke_counts.csv", "config/mine.csv"))
    done = study.finish()
    path.write_text(text)
    return done


def table_in_half(study: Study) -> Run:
    return _cut(study, "data/paper/table3_burgers.csv", 0.6)


def configuration_in_half(study: Study) -> Run:
    return _cut(study, "study.yaml", 0.5)


def _cut(study: Study, name: str, share: float) -> Run:
    """A run with a `share` of an input file, which is whole again afterwards."""
    path = study.folder / name
    whole = path.read_text()
    path.write_text(whole[: int(share * len(whole))])
    done = study.finish()
    path.write_text(whole)
    return done


def with_environment(output: str, name: str, value: Callable[[Study], str]) -> Callable[[Study], Run]:
    """A run that makes `output` anew with another value of an environment variable."""

    def disturb(study: Study) -> Run:
        (study.results / output).unlink()
        return study.finish_alone(env=study.environment | {name: value(study)}, errors="replace")

    return disturb


def damaged_cache(pattern: str) -> Callable[[Study], str]:
    """A copy of what has been compiled, with the files that match a pattern cut in half."""

    def cache(study: Study) -> str:
        folder = study.folder / "numba"
        source = Path(os.environ.get(CACHE) or Path.home() / ".cache/asphalt-nscd")
        shutil.copytree(source, folder)
        found = list(folder.rglob(pattern))
        if not found:
            raise FileNotFoundError(f"{source}: holds no {pattern}")
        for path in found:
            cut(path)
        return str(folder)

    return cache


def no_cache(study: Study) -> str:
    (study.folder / "cache").write_text("a file, where a folder should be\n")
    return str(study.folder / "cache")
