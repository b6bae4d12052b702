"""Valid calls of the public Python functions with arguments drawn from their ranges: a result or one sentence each.

PYTHONPATH=trials:tests python -m fuzz.calls [NUMBER] [--first SEED] [--output FOLDER]

writes `calls.csv`, a row for each function, and `call_failures.csv`, a row for each call that ended otherwise. Calls
run in a process of their own, one after another; one that takes more than LONGEST s of CPU ends that process and
counts as without end. The call of a seed is `draw(seed)`. `outcomes.csv` there keeps what was called; the same command
goes on from it as long as the commit is the same.
"""

from __future__ import annotations

import csv
import json
import resource
import sys
import tempfile
import time
import warnings
from dataclasses import asdict, dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import click
import numpy as np
import pandas as pd

import asphalt_nscd as an
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import provenance, write_json, write_table
from fuzz.diagnoses import _own_line
from fuzz.draws import called, draw, packings

PUBLISHED = 10_000  # calls of `make fuzz`; a published table may hold fewer, and says so
LONGEST = 60  # s of CPU, of one call
ENDS = ("result", "sentence", "traceback", "no end")


@dataclass(frozen=True)
class Outcome:
    """How the call of a seed ended, one of ENDS; said: the sentence or the error, where: file and line of ours."""

    seed: int
    function: str
    ended: str
    said: str = ""
    where: str = ""
    cpu_s: float = 0.0


def tried(seed: int) -> Outcome:
    """The call of a seed in this process."""
    name, call = called(seed), draw(seed)
    began, ended, said, where = time.process_time(), "result", "", ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            require_sound(call())
        except InputError as error:
            ended, said = "sentence", str(error)
            if not said.endswith("."):
                ended, said = "traceback", f"no sentence: {said}"
        except Exception as error:
            ended, said = "traceback", f"{type(error).__name__}: {' '.join(str(error).split())}"
            where = _own_line(error)
    said = said.replace(tempfile.gettempdir(), "")
    return Outcome(seed, name, ended, said[:300], where, time.process_time() - began)


def require_sound(result: Any) -> None:
    """What every result of its kind must be."""
    if isinstance(result, an.Test):
        sound = np.isfinite(result.E_MPa) and result.E_MPa > 0.0 and np.isfinite(result.phase_deg)
        if "ended" not in result.attributes and not sound:
            raise ValueError(f"a modulus of {result.E_MPa} MPa and {result.phase_deg} deg")
    elif isinstance(result, an.Packing | an.Specimen):
        if not (np.isfinite(result.position_m).all() and (result.radius_m > 0.0).all()):
            raise ValueError("spheres that are nowhere")
    elif isinstance(result, pd.DataFrame):
        if not len(result):
            raise ValueError("a table without a row")


def _serve(pipe: Connection) -> None:
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    packings()  # what is compiled for the first time is no call's
    while (seed := pipe.recv()) is not None:
        resource.setrlimit(resource.RLIMIT_CPU, (int(time.process_time()) + LONGEST, hard))
        pipe.send(tried(seed))


class Trial:
    """A process that makes calls, and another one where a call had no end."""

    def __init__(self) -> None:
        self._start()

    def _start(self) -> None:
        context = get_context("spawn")
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_serve, args=(other,), daemon=True)
        self._process.start()
        other.close()

    def of(self, seed: int) -> Outcome:
        """How the call of a seed ends."""
        self._pipe.send(seed)
        try:
            found: Outcome = self._pipe.recv()
        except EOFError:
            self._process.join()
            self._start()
            return Outcome(seed, called(seed), "no end", f"ended by signal {-(self._process.exitcode or 0)}")
        return found

    def end(self) -> None:
        """Let the process go."""
        self._pipe.send(None)
        self._process.join()


def counted(outcomes: pd.DataFrame) -> pd.DataFrame:
    """A row for each function and one for all: calls, how many ended how, CPU seconds."""
    rows = []
    for name, part in [*outcomes.groupby("function"), ("all", outcomes)]:
        row = {"function": name, "calls": len(part)}
        row |= {end.replace(" ", "_"): int((part["ended"] == end).sum()) for end in ENDS}
        rows.append(row | {"cpu_s_median": part["cpu_s"].median(), "cpu_s_largest": part["cpu_s"].max()})
    return pd.DataFrame(rows)


@click.command()
@click.argument("number", default=PUBLISHED)
@click.option("--first", default=0, help="Seed of the first call.")
@click.option("--output", type=click.Path(path_type=Path), help="Folder for the tables.")
def main(number: int, first: int, output: Path | None) -> None:
    """Try NUMBER calls, of seeds that follow one another."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) if output is None else output
        outcomes = all_tried(range(first, first + number), output)
        table = counted(outcomes)
        failed = outcomes[~outcomes["ended"].isin(ENDS[:2])].drop(columns="cpu_s")
        write_table(output / "calls.csv", table)
        write_table(output / "call_failures.csv", failed)
    click.echo(table.to_string(index=False))
    sys.exit(int(len(failed) > 0))


def all_tried(seeds: range, folder: Path) -> pd.DataFrame:
    """An `Outcome` in each row; those that `folder` holds of this commit are not tried again."""
    made, origin = folder / "outcomes.csv", folder / "calls_provenance.json"
    told = provenance() | {"calls": len(seeds), "first_seed": seeds.start}
    before = json.loads(origin.read_text(encoding="utf-8")) if origin.exists() else {}
    if before | {"calls": len(seeds)} != told:
        folder.mkdir(parents=True, exist_ok=True)
        made.write_text(",".join(Outcome.__annotations__) + "\n", encoding="utf-8")
    write_json(origin, told)
    known = len(pd.read_csv(made))
    with made.open("a", encoding="utf-8", newline="") as rows:
        trial = Trial()
        for seed in seeds[known:]:
            found = trial.of(seed)
            csv.writer(rows).writerow(asdict(found).values())
            rows.flush()
            if found.ended not in ENDS[:2]:
                click.echo(f"seed {seed}, {found.function}: {found.ended}: {found.said} [{found.where}]")
        trial.end()
    return pd.read_csv(made, keep_default_na=False)[: len(seeds)]


if __name__ == "__main__":
    main()
