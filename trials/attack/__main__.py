"""Steps of the attack, each a command: `python -m attack STEP` with trials/ on the path."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import click
import pandas as pd

from asphalt_nscd.files.store import atomic_path, provenance, write_json, write_table

from . import bound, machines, not_linear, plan, power, rates
from .trial import Size, attacked

File = click.Path(path_type=Path)
FOLDER = click.option("--folder", required=True, type=File)
PARTS = click.argument("parts", nargs=-1, required=True, type=File)
TRIALS = {"nonlinear": not_linear.cases, "limits": power.limits, "careful": power.cases}


@click.group()
def main() -> None:
    """An independent attack on the diagnosis."""


@main.command("part")
@click.argument("numbers", nargs=-1, type=int, required=True)
@click.option("--tables", default=plan.TABLES, help="Campaigns with faults put in.")
@click.option("--empty", default=plan.EMPTY, help="More campaigns without a fault.")
@click.option("--output", required=True, type=File)
def attack_part(numbers: tuple[int, ...], tables: int, empty: int, output: Path) -> None:
    """Attack the campaigns of these NUMBERS; one JSON line for each diagnosis, whole or not at all."""
    with atomic_path(output) as temporary, temporary.open("w", encoding="utf-8") as file:
        for number in numbers:
            for line in attacked(number, Size(tables, empty)):
                file.write(json.dumps(line) + "\n")


@main.command("tables")
@PARTS
@click.option("--before", type=File, help="Summary of an earlier commit, to stand beside; else that of now.")
@FOLDER
def write_tables(parts: tuple[Path, ...], before: Path | None, folder: Path) -> None:
    """Tables of all lines of PARTS into a folder, and what made them."""
    from asphalt_nscd.reporting.figures.save import save_figure  # Matplotlib: no part needs it

    from . import figures

    read = [json.loads(text) for path in parts for text in path.read_text(encoding="utf-8").splitlines()]
    rows, names = rates.frames(read)
    earlier = rates.summary(rows, names) if before is None else pd.read_csv(before)
    reliability = rates.reliability(names)
    made = {"cases": rows, "names": names, "by_fault": rates.by_fault(rows), "reliability": reliability}
    made |= {"coverage": rates.coverage(rows[~rows["measured"]]), "before": earlier}
    _write(folder, made | {"summary": rates.summary(rows, names, earlier)})
    save_figure(figures.reliability(reliability), folder / "figures/reliability")
    tried = rows.drop_duplicates("table")
    write_json(
        folder / "campaign.json",
        {
            **provenance(),
            "seed": plan.SEED,
            "invented": int((~tried["measured"]).sum()),
            "measured": int(tried["measured"].sum()),
            "diagnoses": len(read),
            "cpu_s_median": float(rows["cpu_s"].median()),
            "cpu_s_largest": float(rows["cpu_s"].max()),
            "failures": sorted({line["failure"] for line in read if line["failure"]}),
        },
    )


@main.command("inside")
@click.argument("models", nargs=-1, required=True, type=File)
@FOLDER
def try_inside(models: tuple[Path, ...], folder: Path) -> None:
    """Hide faults inside NSCD runs on the paper's specimens, MODELS as `condense` makes them."""
    from . import inside  # with the core

    rows = pd.DataFrame([row for number in range(inside.MIXES) for row in inside.tried(number, models)])
    _write(folder, {"inside": rows, "inside_summary": rates.inside(rows)})


@main.command("machines")
@click.argument("number", type=int)
@FOLDER
def try_machines(number: int, folder: Path) -> None:
    """What pooling finds of an offset too small for one campaign on NUMBER machines, and on the NCAT campaigns."""
    rows = pd.DataFrame([row for machine in range(number) for row in machines.tried(machine)])
    told = {"machines": rows, "machines_summary": machines.summary(rows)}
    _write(folder, told | {"machine_measured": machines.measured()})


@main.command("some")
@click.argument("kind", type=click.Choice(list(TRIALS)))
@click.argument("part", type=int)
@click.argument("parts", type=int)
@click.option("--output", required=True, type=File)
def try_some(kind: str, part: int, parts: int, output: Path) -> None:
    """Part number PART of PARTS of a trial: mixes not linear, limits of usual campaigns, or careful laboratories."""
    write_table(output, TRIALS[kind](part, parts))


@main.command("nonlinear")
@PARTS
@FOLDER
def judge_nonlinear(parts: tuple[Path, ...], folder: Path) -> None:
    """What is said of mixes that are not linear, and of true offsets of the phase."""
    rows = _together(parts)
    _write(folder, {"nonlinear": rows, "nonlinear_summary": not_linear.summary(rows)})


@main.command("power")
@PARTS
@FOLDER
def judge_power(parts: tuple[Path, ...], folder: Path) -> None:
    """Sizes that are named in half and in 19 of 20 tables of usual campaigns; two faults of a careful laboratory.

    Beside them stands the bound of any search. PARTS are those of limits and of careful laboratories.
    """
    of = {kind: [path for path in parts if path.name.startswith(kind)] for kind in ("limits", "careful")}
    limits, rows = _together(of["limits"]), _together(of["careful"])
    told = {"power_limits": limits, "power": power.sizes(limits), "power_bound": bound.table()}
    _write(folder, told | {"power_cases": rows, "power_summary": power.summary(rows)})


def _together(parts: Sequence[Path]) -> pd.DataFrame:
    return pd.concat([pd.read_csv(path) for path in parts], ignore_index=True)


def _write(folder: Path, tables: dict[str, pd.DataFrame]) -> None:
    for name, table in tables.items():
        write_table(folder / f"{name}.csv", table)


if __name__ == "__main__":
    main()
