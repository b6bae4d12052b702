"""Steps of the attack, each a command: `python -m attack STEP` with trials/ on the path."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    import pandas as pd

File = click.Path(path_type=Path)


@click.group()
def main() -> None:
    """An independent attack on the diagnosis."""


@main.command()
@click.argument("numbers", nargs=-1, type=int, required=True)
@click.option("--tables", type=int, help="Campaigns with faults put in.")
@click.option("--empty", type=int, help="More campaigns without a fault.")
@click.option("--output", required=True, type=File)
def part(numbers: tuple[int, ...], tables: int | None, empty: int | None, output: Path) -> None:
    """Attack the campaigns of these NUMBERS; one JSON line for each diagnosis, whole or not at all."""
    from asphalt_nscd.files.store import atomic_path

    from .trial import Size, attacked

    size = Size(**{name: n for name, n in (("tables", tables), ("empty", empty)) if n is not None})
    with atomic_path(output) as temporary, temporary.open("w", encoding="utf-8") as file:
        for number in numbers:
            for line in attacked(number, size):
                file.write(json.dumps(line) + "\n")


@main.command()
@click.argument("lines", nargs=-1, required=True, type=File)
@click.option("--before", type=File, help="Summary of an earlier commit, to stand beside; else that of now.")
@click.option("--folder", required=True, type=File)
def tables(lines: tuple[Path, ...], before: Path | None, folder: Path) -> None:
    """Tables of all LINES of `part` into a folder, and what made them."""
    import pandas as pd

    from asphalt_nscd.files.store import provenance, write_json, write_table
    from asphalt_nscd.reporting.figures.save import save_figure

    from . import figures, plan, rates

    read = [json.loads(text) for path in lines for text in path.read_text(encoding="utf-8").splitlines()]
    rows, names = rates.frames(read)
    write_table(folder / "cases.csv", rows)
    write_table(folder / "names.csv", names)
    write_table(folder / "by_fault.csv", rates.by_fault(rows))
    write_table(folder / "coverage.csv", rates.coverage(rows[~rows["measured"]]))
    write_table(folder / "reliability.csv", rates.reliability(names))
    earlier = rates.summary(rows, names) if before is None else pd.read_csv(before)
    write_table(folder / "before.csv", earlier)
    write_table(folder / "summary.csv", rates.summary(rows, names, earlier))
    save_figure(figures.reliability(rates.reliability(names)), folder / "figures/reliability")
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


@main.command()
@click.argument("models", nargs=-1, required=True, type=File)
@click.option("--folder", required=True, type=File)
def inside(models: tuple[Path, ...], folder: Path) -> None:
    """Hide faults inside NSCD runs on the paper's specimens, MODELS as `condense` makes them."""
    import pandas as pd

    from asphalt_nscd.files.store import write_table

    from . import inside, rates

    rows = pd.DataFrame([row for number in range(inside.MIXES) for row in inside.tried(number, models)])
    write_table(folder / "inside.csv", rows)
    write_table(folder / "inside_summary.csv", rates.inside(rows))


@main.command()
@click.argument("number", type=int)
@click.option("--folder", required=True, type=File)
def machines(number: int, folder: Path) -> None:
    """What pooling finds of an offset too small for one campaign on NUMBER machines, and on the NCAT campaigns."""
    import pandas as pd

    from asphalt_nscd.files.store import write_table

    from . import machines

    rows = pd.DataFrame([row for machine in range(number) for row in machines.tried(machine)])
    write_table(folder / "machines.csv", rows)
    write_table(folder / "machines_summary.csv", machines.summary(rows))
    write_table(folder / "machine_measured.csv", machines.measured())


@main.command()
@click.argument("kind", type=click.Choice(["nonlinear", "limits", "careful"]))
@click.argument("part", type=int)
@click.argument("parts", type=int)
@click.option("--output", required=True, type=File)
def some(kind: str, part: int, parts: int, output: Path) -> None:
    """Part number PART of PARTS of a trial: mixes not linear, limits of usual campaigns, or careful laboratories."""
    from asphalt_nscd.files.store import write_table

    from . import not_linear, power

    made = {"nonlinear": not_linear.cases, "limits": power.limits, "careful": power.cases}[kind]
    write_table(output, made(part, parts))


@main.command()
@click.argument("parts", nargs=-1, required=True, type=File)
@click.option("--folder", required=True, type=File)
def nonlinear(parts: tuple[Path, ...], folder: Path) -> None:
    """What is said of mixes that are not linear, and of true offsets of the phase."""
    from asphalt_nscd.files.store import write_table

    from . import not_linear

    rows = _together(parts)
    write_table(folder / "nonlinear.csv", rows)
    write_table(folder / "nonlinear_summary.csv", not_linear.summary(rows))


@main.command()
@click.argument("parts", nargs=-1, required=True, type=File)
@click.option("--folder", required=True, type=File)
def power(parts: tuple[Path, ...], folder: Path) -> None:
    """Sizes that are named in half and in 19 of 20 tables of usual campaigns; two faults of a careful laboratory.

    Beside them stands the bound of any search. PARTS are those of limits and of careful laboratories.
    """
    from asphalt_nscd.files.store import write_table

    from . import bound, power

    stated, rows = (
        _together([path for path in parts if path.name.startswith(kind)]) for kind in ("limits", "careful")
    )
    write_table(folder / "power_limits.csv", stated)
    write_table(folder / "power.csv", power.sizes(stated))
    write_table(folder / "power_cases.csv", rows)
    write_table(folder / "power_summary.csv", power.summary(rows))
    write_table(folder / "power_bound.csv", bound.table())


def _together(parts: Sequence[Path]) -> pd.DataFrame:
    import pandas as pd

    return pd.concat([pd.read_csv(path) for path in parts], ignore_index=True)


if __name__ == "__main__":
    main()
