"""The faults: what each does to a finished study, and what the user must be told."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from faults.study import RESULTS, Study, least_memory, smallest_files

Run = subprocess.CompletedProcess
DEPOSIT, MODEL, TEST = "deposits/s1.h5", "models/free/s1.h5", "tests/s1/T20/f10.h5"
ALL = "report.html"
# A file of results, and one that is made from it.
READ = {
    DEPOSIT: "specimens/s1.h5",
    "specimens/s1.h5": MODEL,
    MODEL: TEST,
    TEST: "simulations.csv",
    "laws/published/T20.json": TEST,
    "measured.csv": "laws/fitted/T20.json",
    "simulations.csv": "samples.csv",
}


@dataclass(frozen=True)
class Fault:
    """disturb: does it, and returns the run that met it; said: what that run's last line must match, None where
    the run has to succeed in spite of it; target: the file of results that both runs are to make."""

    name: str
    disturb: Callable[[Study], Run]
    said: str | None
    target: str = ALL


def killed(rule: str, output: str) -> Fault:
    def disturb(study: Study) -> Run:
        (study.folder / output).unlink()
        return study.killed(output)

    said = "error: the job was killed, or the memory was used up; run the same"
    return Fault(f"SIGKILL in {rule}", disturb, said, str(Path(output).relative_to(RESULTS)))


def signalled(name: str, signum: int, said: str) -> Fault:
    def disturb(study: Study) -> Run:
        (study.results / DEPOSIT).unlink()
        return study.killed(f"{RESULTS}/{DEPOSIT}", signum)

    return Fault(f"{name} in deposit", disturb, said, DEPOSIT)


def workflow_signalled(name: str, signum: int, output: str) -> Fault:
    """Snakemake itself gets the signal while it makes `output`; it need not be able to say anything."""

    def disturb(study: Study) -> Run:
        (study.results / output).unlink()
        process = study.start("--cores", "2", *study.targets)
        while process.poll() is None and study.job(f"{RESULTS}/{output}") is None:
            time.sleep(0.01)
        time.sleep(0.3)
        process.send_signal(signum)
        try:
            _, said = process.communicate(timeout=30)
        except subprocess.TimeoutExpired:  # Snakemake 9.27 can wait for itself
            process.kill()
            _, said = process.communicate()
        return Run(process.args, process.returncode or 1, "", said)

    return Fault(f"{name} to Snakemake while it makes {output}", disturb, "", output)


def cut(path: Path) -> None:
    with path.open("r+b") as file:
        file.truncate(path.stat().st_size // 2)


def emptied(path: Path) -> None:
    path.write_bytes(b"")


def flipped(path: Path) -> None:
    """One bit, in the middle of what the file holds."""
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0x10
    path.write_bytes(data)


def other_kind(path: Path) -> None:
    shutil.copy(path.parents[len(path.parts) - path.parts.index("smoke") - 2] / MODEL, path)


def damaged(name: str, how: Callable[[Path], None], said: str) -> Fault:
    def disturb(study: Study) -> Run:
        path = study.results / name
        times = path.stat()
        how(path)
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))  # as damage to a disk leaves it
        (study.results / READ[name]).unlink()
        return study.finish()

    return Fault(f"{name} {how.__name__.replace('_', ' ')}", disturb, said, READ[name])


def full_disk(study: Study) -> Run:
    with mounted(study.results / "deposits", "size=4k"):
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


class Unable(Exception):
    """This machine cannot do it."""


def no_larger_files(study: Study) -> Run:
    (study.results / DEPOSIT).unlink()
    return study.under(smallest_files(20_000))


def little_memory(study: Study) -> Run:
    (study.results / DEPOSIT).unlink()
    return study.under(least_memory(900 * 2**20))


def two_at_once(study: Study) -> Run:
    (study.results / DEPOSIT).unlink()
    first = study.start("--cores", "1", *study.targets)
    while first.poll() is None and study.job(f"{RESULTS}/{DEPOSIT}") is None:
        time.sleep(0.01)
    second = study.finish()
    first.kill()
    first.communicate()
    return second


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


def half_written(study: Study) -> Run:
    """What a power cut leaves beside a result."""
    (study.results / "deposits/.s1-x3f2k1.h5").write_bytes(b"\x89HDF\r\n\x1a\n half")
    (study.results / DEPOSIT).unlink()
    done = study.finish()
    (study.results / "deposits/.s1-x3f2k1.h5").unlink()
    return done


def output_is_a_folder(study: Study) -> Run:
    path = study.results / "samples.csv"
    path.unlink()
    path.mkdir()
    done = study.finish()
    path.rmdir()
    return done


def results_is_a_file(study: Study) -> Run:
    aside = study.results.with_name("aside")
    study.results.rename(aside)
    study.results.write_text("mine\n")
    done = study.finish()
    study.results.unlink()
    aside.rename(study.results)
    return done


def table_gone(study: Study) -> Run:
    path = study.folder / "config/smoke_counts.csv"
    aside = path.rename(path.with_suffix(".aside"))
    done = study.finish()
    aside.rename(path)
    return done


def table_in_half(study: Study) -> Run:
    path = study.folder / "data/paper/table3_burgers.csv"
    whole = path.read_text()
    path.write_text(whole[: int(0.6 * len(whole))])
    done = study.finish()
    path.write_text(whole)
    return done


def configuration_in_half(study: Study) -> Run:
    path = study.folder / "study.yaml"
    whole = path.read_text()
    path.write_text(whole[: len(whole) // 2])
    done = study.finish()
    path.write_text(whole)
    return done


def with_environment(name: str, value: Callable[[Study], str]) -> Callable[[Study], Run]:
    def disturb(study: Study) -> Run:
        (study.results / TEST).unlink()
        return subprocess.run(
            study.command("--cores", "2", *study.targets), cwd=study.folder, capture_output=True, text=True,
            env=study.environment | {name: value(study)}, errors="replace",
        )  # fmt: skip

    return disturb


def _damaged_cache(study: Study) -> str:
    folder = study.folder / "numba"
    source = Path(os.environ.get("ASPHALT_NSCD_CACHE") or Path.home() / ".cache/asphalt-nscd")
    shutil.copytree(source, folder)
    for path in folder.rglob("*.nb?"):
        cut(path)
    return str(folder)


def _no_cache(study: Study) -> str:
    (study.folder / "cache").write_text("a file, where a folder should be\n")
    return str(study.folder / "cache")


REMOVED = r"error: \S+: .*; it was removed, run the workflow again to make it anew\."
NAMED = r"error: .*\S+\.(csv|json).*[.;]"
SAID_HDF5 = {cut: REMOVED, emptied: REMOVED, flipped: REMOVED}


def standing() -> list[Fault]:
    """All faults but the SIGKILL in each rule, which follow from the study's plan."""
    return [
        signalled("SIGTERM", signal.SIGTERM, "error: the job was killed"),
        signalled("SIGINT", signal.SIGINT, "error: interrupted; nothing half-written is left."),
        workflow_signalled("SIGKILL", signal.SIGKILL, DEPOSIT),
        workflow_signalled("SIGTERM", signal.SIGTERM, DEPOSIT),
        workflow_signalled("SIGINT", signal.SIGINT, DEPOSIT),
        workflow_signalled("SIGKILL", signal.SIGKILL, "report.html"),
        *(
            damaged(name, how, said)
            for name in READ if name.endswith(".h5")
            for how, said in SAID_HDF5.items()
        ),
        damaged(TEST, other_kind, r"error: \S+f10\.h5: holds 'model', not 'test'"),
        damaged("laws/published/T20.json", cut, NAMED),
        damaged("measured.csv", cut, NAMED),
        damaged("simulations.csv", cut, NAMED),
        damaged("simulations.csv", emptied, NAMED),
        Fault("disk full", full_disk, "error: .*s1.h5: no space left on device; free some space", DEPOSIT),
        Fault("results read-only", read_only, "error: .*read-only file system", DEPOSIT),
        Fault("file size limited", no_larger_files, "error: .*file too large; raise the limit", DEPOSIT),
        Fault("memory limited", little_memory, "error: .*memory", DEPOSIT),
        Fault("two Snakemakes at once", two_at_once, "cannot be locked", DEPOSIT),
        Fault("clock set back by a day", clock_set_back, None),
        Fault("input dated tomorrow", clock_ahead, None),
        Fault("records of Snakemake lost", records_lost, None, TEST),
        Fault("records of Snakemake damaged", records_damaged, None, TEST),
        Fault("stamps of the code lost", stamps_lost, None),
        Fault("half-written file left", half_written, None, DEPOSIT),
        Fault("folder in place of a table", output_is_a_folder, "error: .*samples.csv", "samples.csv"),
        Fault("file in place of the results", results_is_a_file, "error: .*results/smoke"),
        Fault("input table gone", table_gone, "error: .*smoke_counts.csv"),
        Fault("input table cut", table_in_half, "error: .*table3_burgers.csv"),
        Fault("configuration cut", configuration_in_half, "error: .*study.yaml"),
        Fault("compiled core damaged", with_environment("ASPHALT_NSCD_CACHE", _damaged_cache), None, TEST),
        Fault("compiled core has no place", with_environment("ASPHALT_NSCD_CACHE", _no_cache), None, TEST),
        Fault("locale without Unicode", with_environment("LC_ALL", lambda study: "C"), None, TEST),
    ]  # fmt: skip


def outputs_by_rule(study: Study) -> dict[str, str]:
    """An output of a job of each rule."""
    listed = study.run("--cores", "1", "--summary", *study.targets).stdout
    rows = [line.split("\t") for line in listed.splitlines() if "\t" in line][1:]
    found: dict[str, str] = {}
    for row in rows:
        found.setdefault(row[2], row[0])
    return found


def all_faults(study: Study) -> list[Fault]:
    return [killed(rule, output) for rule, output in outputs_by_rule(study).items()] + standing()


def last_line(run: Run) -> str:
    """The last line that begins with `error: `, else all that was said."""
    lines = [line for line in run.stderr.splitlines() if re.match("error: ", line)]
    return lines[-1] if lines else run.stderr.strip()
