"""Faults put into a copy of the sources, one at a time, and the tests that must then fail: do the tests notice?

    PYTHONPATH=trials python -m mutants [WORDS] [--output results/mutants]

`mutants.csv` lists them: what is wrong, `right` made `wrong` in a file of the package, and the tests that must notice.
Those of equations of the core name a theme of `tests/theory`: `python -m mutants theory/` tries these.
"""

from __future__ import annotations

import hashlib
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

import click
import pandas as pd
import pytest

from asphalt_nscd.files.store import provenance, write_json, write_table

ROOT = Path(__file__).parents[1]
PACKAGE = "src/asphalt_nscd"
LONGEST = 1800  # s of CPU for the tests of a file: many times what they need, so that more means without end
MUTANTS = list(pd.read_csv(Path(__file__).with_suffix(".csv"), keep_default_na=False).itertuples(index=False))


class Copy:
    """The package and its tests in a folder of their own; kernels that a test compiles stay for the next."""

    def __init__(self, folder: Path) -> None:
        for part in (PACKAGE, "studies", "tests", "trials"):
            shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "pyproject.toml", folder)
        (folder / "data").symlink_to(ROOT / "data")
        self.folder = folder
        self.passes = cache(lambda *part: not self.failed(*part))

    def failed(self, tests: str, mark: str) -> str:
        """What pytest says of the tests in a file that are marked so; empty if they pass, or if there are none."""
        command = [sys.executable, *"-m pytest -x -p no:cacheprovider -m".split(), mark, f"tests/{tests}"]
        where = {"cwd": self.folder, "env": os.environ | {"PYTHONPATH": str(self.folder / "src")}}
        done = subprocess.run(command, **where, capture_output=True, text=True, preexec_fn=_limit)
        if done.returncode == -signal.SIGXCPU:
            return f"tests/{tests} does not end"
        if done.returncode in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            return ""
        found = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR tests"))]
        if not found:  # no verdict on the mutant: nothing was tested
            raise click.ClickException(f"tests/{tests} cannot run:\n{(done.stdout + done.stderr)[-600:]}")
        return found[0]

    def noticed(self, mutant) -> str:
        """By which test, the quick ones first; empty if the mutant lives."""
        file = self.folder / PACKAGE / mutant.file
        text = file.read_text(encoding="utf-8")
        for mark in ("not slow", "slow"):
            if not self.passes(mutant.tests, mark):
                raise click.ClickException(f"tests/{mutant.tests} fails without a mutant; mend it first.")
            file.write_text(text.replace(mutant.right, mutant.wrong), encoding="utf-8")
            try:
                found = self.failed(mutant.tests, mark)
            finally:
                file.write_text(text, encoding="utf-8")
            if found:
                return found
        return ""


def _limit() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST + 9))


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """How many mutants of each room were noticed, and those that live."""
    alive = table.what.where(table.noticed_by == "")
    rooms = table.assign(alive=alive).groupby(table.file.str.partition("/")[0].rename("room"))
    return rooms.agg(
        mutants=("what", "size"),
        noticed=("alive", lambda names: names.isna().sum()),
        alive=("alive", lambda names: "; ".join(names.dropna())),
    ).reset_index()


def sources(mutant) -> str:
    """Digest of the mutant, of the file that it changes and of its tests: while these stay, so does its verdict."""
    files = (ROOT / PACKAGE / mutant.file, ROOT / "tests" / mutant.tests)
    parts = [*mutant, *(file.read_text(encoding="utf-8") for file in files)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:12]


def earlier(path: Path) -> dict[str, str]:
    """What an earlier run found, by `sources`."""
    if not path.is_file():
        return {}
    table = pd.read_csv(path, keep_default_na=False)
    return dict(zip(table.sources, table.noticed_by, strict=True))


@click.command()
@click.argument("words", nargs=-1)
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    help="Folder for the table of mutants, and their number in each room. A mutant tried there before, with the same "
    "sources and tests, is not tried again; one that is not tried now keeps its row.",
)
def main(words: tuple[str, ...], output: Path | None) -> None:
    """Try the mutants, or those whose line in the list holds one of WORDS."""
    chosen = [one for one in MUTANTS if not words or any(word in " ".join(one) for word in words)]
    judged = {} if output is None else earlier(output / "mutants.csv")
    digests = [sources(mutant) for mutant in chosen]
    with tempfile.TemporaryDirectory() as name:
        copy = Copy(Path(name))
        for mutant, digest in zip(chosen, digests):
            if digest not in judged:
                judged[digest] = copy.noticed(mutant)
                if output is not None:  # each time, for whoever interrupts
                    write_tables(output, chosen, digests, judged)
            click.echo(f"{mutant.what} ({mutant.file}): {judged[digest] or 'ALIVE'}")
    if output is not None:
        write_tables(output, chosen, digests, judged)
    alive = sum(not judged[digest] for digest in digests)
    click.echo(f"{'error: ' if alive else ''}{len(chosen) - alive} of {len(chosen)} mutants were noticed.")
    sys.exit(alive > 0)


def write_tables(output: Path, mutants: list, digests: list[str], judged: dict[str, str]) -> None:
    """The mutants judged so far, those of earlier runs too, their number in each room, and from which commit."""
    path = output / "mutants.csv"
    before = pd.read_csv(path, keep_default_na=False).to_dict("records") if path.is_file() else []
    rows = {row["what"]: row for row in before} | {
        one.what: one._asdict() | {"noticed_by": judged[digest], "sources": digest}
        for one, digest in zip(mutants, digests)
        if digest in judged
    }
    table = pd.DataFrame([rows[one.what] for one in MUTANTS if one.what in rows])
    write_table(path, table)
    write_table(output / "summary.csv", summary(table))
    write_json(output / "provenance.json", provenance())


if __name__ == "__main__":
    main()
