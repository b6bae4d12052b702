"""No room, no right, no memory, and other things where results should go."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from faults.fault import DEPOSIT, Unable
from faults.study import Run, Study, least_memory, smallest_files


def full_disk(study: Study) -> Run:
    with mounted(study.results / "deposits", "size=8k"):
        # Snakemake removes empty folders, and cannot remove what is mounted.
        (study.results / "deposits/held").write_text("x")
        return study.finish()


def read_only(study: Study) -> Run:
    with mounted(study.results / "deposits", "ro"):
        return study.finish()


@contextmanager
def mounted(folder: Path, options: str) -> Iterator[None]:
    """A file system of its own in place of a folder, which is put back afterwards."""
    aside = folder.with_suffix(".aside")
    folder.rename(aside)
    folder.mkdir()
    try:
        done = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", options, "none", folder], capture_output=True, text=True
        )
        if done.returncode:
            raise Unable(f"cannot mount: {done.stderr.strip()}")
        try:
            yield
        finally:
            subprocess.run(["umount", folder], check=True)
    finally:
        shutil.rmtree(folder)
        aside.rename(folder)


def no_larger_files(study: Study) -> Run:
    (study.results / DEPOSIT).unlink()
    return study.finish_alone(preexec_fn=smallest_files(20_000))


def little_memory(study: Study) -> Run:
    (study.results / DEPOSIT).unlink()
    return study.finish_alone(preexec_fn=least_memory(400 * 2**20))  # Snakemake itself takes 320


def output_is_a_folder(study: Study) -> Run:
    path = study.results / "samples.csv"
    path.unlink()
    (path / "mine").mkdir(parents=True)
    (study.results / "pages/samples.html").unlink()
    done = study.finish()
    shutil.rmtree(path)
    return done


def results_is_a_file(study: Study) -> Run:
    aside = study.results.with_name("aside")
    study.results.rename(aside)
    study.results.write_text("mine\n")
    done = study.finish()
    study.results.unlink()
    aside.rename(study.results)
    return done
