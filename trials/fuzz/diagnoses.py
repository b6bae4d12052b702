"""Wild tables through everything behind `asphalt-nscd diagnose`: a diagnosis or one sentence, never a traceback.

PYTHONPATH=trials:tests python -m fuzz.diagnoses [NUMBER] [--first SEED] [--jobs N] [--output FOLDER]

writes `wild.csv`, the rates, and `wild_failures.csv`, a line for each table that ended otherwise. The table of
a seed is `fuzz.wild.draw(seed)`.
"""

from __future__ import annotations

import json
import math
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

import click
import pandas as pd
from attack.rates import rate

from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY
from asphalt_nscd.diagnosis.run import conclude
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import provenance, write_json, write_table
from fuzz import wild

PUBLISHED = 1000  # tables of `make fuzz`; published rates may rest on fewer, and say so
SHORT = 60  # tables with so few tests, and more, are timed apart


@dataclass(frozen=True)
class Outcome:
    """How the table of a seed ended: diagnosed, refused, or traceback. where: file, line and what it said."""

    seed: int
    faults: str
    tests: int
    ended: str
    said: str = ""
    where: str = ""
    warned: str = ""
    cpu_s: float = 0.0


def tried(seed: int) -> Outcome:
    """The table of a seed read, diagnosed, written and read again."""
    table, faults = wild.draw(seed)
    began, ended, said, where = time.process_time(), "diagnosed", "", ""
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RuntimeWarning)
        folder = Path(name)
        table.to_csv(folder / "measured.csv", index=False)
        try:
            summary = conclude(folder / "measured.csv", PAPER_GEOMETRY).written(folder)
            assert summary.strip(), "no summary"
            _require_finite(json.loads((folder / "diagnosis.json").read_text(encoding="utf-8")))
            read_diagnosis([folder / "diagnosis.json"])
        except InputError as error:
            ended, said = "refused", str(error).replace(str(folder), "")
        except Exception as error:
            ended, said = "traceback", f"{type(error).__name__}: {' '.join(str(error).split())}"
            where = _own_line(error)
    warned = {f"{Path(w.filename).name}:{w.lineno}" for w in caught if issubclass(w.category, RuntimeWarning)}
    spent = time.process_time() - began
    return Outcome(seed, faults, len(table), ended, said[:200], where, " ".join(sorted(warned)), spent)


def _require_finite(value: object, key: str = "diagnosis") -> None:
    """JSON has no infinity; Python writes one all the same."""
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, part in parts:
        _require_finite(part, f"{key}.{name}")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"{value} is no JSON: {key}")


def _own_line(error: Exception) -> str:
    """The last line of the package that the error passed."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if "asphalt_nscd" in f.filename]
    return f"{Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else ""


def rates(outcomes: Iterable[Outcome]) -> pd.DataFrame:
    """Rates of the ends with 95 % intervals, and CPU seconds: median, 95th percentile, largest."""
    table = pd.DataFrame([asdict(outcome) for outcome in outcomes])
    ends = {end: table["ended"] == end for end in ("diagnosed", "refused", "traceback")}
    ends["numerical warning"] = table["warned"] != ""
    rows = [{"what": what, **rate(hits)} for what, hits in ends.items()]
    done = table[table["ended"] == "diagnosed"]
    few = done["tests"] <= SHORT
    kinds = {f"tables of up to {SHORT} tests": few, f"of {SHORT + 1} to {wild.MOST_TESTS}": ~few}
    for what, part in kinds.items():
        seconds = done.loc[part, "cpu_s"]
        row = {"what": f"CPU seconds, {what}", "n": len(seconds), "median": seconds.median()}
        rows.append(row | {"most_95_percent": seconds.quantile(0.95), "largest": seconds.max()})
    return pd.DataFrame(rows)


@click.command()
@click.argument("number", default=PUBLISHED)
@click.option("--first", default=0, help="Seed of the first table.")
@click.option("--jobs", type=int, help="Processes; as many as cores by default.")
@click.option("--output", type=click.Path(path_type=Path), help="Folder for the tables.")
def main(number: int, first: int, jobs: int | None, output: Path | None) -> None:
    """Try NUMBER wild tables, of seeds that follow one another."""
    outcomes = []
    with ProcessPoolExecutor(jobs) as pool:
        for outcome in pool.map(tried, range(first, first + number), chunksize=4):
            outcomes.append(outcome)
            if outcome.ended == "traceback":
                click.echo(f"seed {outcome.seed} ({outcome.faults}): {outcome.said} [{outcome.where}]")
    table = rates(outcomes)
    failed = [asdict(one) for one in outcomes if one.ended == "traceback"]
    failures = pd.DataFrame(failed, columns=[*Outcome.__annotations__])
    if output is not None:
        write_table(output / "wild.csv", table)
        write_table(output / "wild_failures.csv", failures.drop(columns="cpu_s"))
        write_json(output / "provenance.json", provenance() | {"tables": number, "first_seed": first})
    click.echo(table.to_string(index=False))
    sys.exit(int(len(failures) > 0))


if __name__ == "__main__":
    main()
