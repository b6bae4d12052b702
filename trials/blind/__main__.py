"""Steps of the blind campaign, each a command: `python -m blind STEP` with trials/ on the path."""

from __future__ import annotations

import json
from pathlib import Path

import click

File = click.Path(path_type=Path)
output = click.option("--output", required=True, type=File)


@click.group()
def main() -> None:
    """Blind tests of the diagnosis."""


@main.command()
@click.argument("number", type=int)
@click.option("--seed", required=True, type=int, help="Of the campaign.")
@output
def chunk(number: int, seed: int, output: Path) -> None:
    """Draw, seal and diagnose the cases of chunk NUMBER; one JSON line each."""
    from . import plan, sealed

    _write_lines(output, sealed.run(plan.chunks(seed)[number]))


@main.command()
@click.argument("effect")
@click.argument("models", nargs=-1, required=True, type=File)
@click.option("--limits", type=File, help="Line of the empty case, by which the effect is scaled.")
@click.option("--seed", required=True, type=int, help="Of the campaign.")
@output
def inside(effect: str, models: tuple[Path, ...], limits: Path | None, seed: int, output: Path) -> None:
    """Hide EFFECT (or `nothing`) inside NSCD runs of the MODELS and diagnose their records."""
    from . import inside

    known = None if limits is None else json.loads(limits.read_text(encoding="utf-8"))
    _write_lines(output, [inside.run(effect, models, known, seed)])


@main.command()
@click.argument("number", type=int)
@click.option("--seed", required=True, type=int, help="Of the campaign.")
@output
def real(number: int, seed: int, output: Path) -> None:
    """Put causes into the real and real-like tables of group NUMBER; one JSON line for each diagnosis."""
    from . import real, real_plan

    _write_lines(output, real.run(real_plan.tasks(seed)[number]))


@main.command()
@click.argument("lines", nargs=-1, required=True, type=File)
@click.option("--folder", required=True, type=File)
def real_tables(lines: tuple[Path, ...], folder: Path) -> None:
    """Tables of all LINES of `real` into a folder, and what made them."""
    from asphalt_nscd.files.store import provenance, write_json, write_table

    from . import plan, real_plan, real_tables

    rows = [json.loads(text) for path in lines for text in path.read_text(encoding="utf-8").splitlines()]
    cases = real_tables.cases(rows)
    write_table(folder / "real_cases.csv", cases)
    for make in (
        real_tables.efficiency,
        real_tables.false_names,
        real_tables.coverage,
        real_tables.limits,
        real_tables.summary,
    ):
        write_table(folder / f"real_{make.__name__}.csv", make(cases))
    count = cases.loc[cases["kind"] == "real", "table"].nunique()
    said = f"{count} real tables" if count else f"no real table: set {real_plan.FOLDER} to a folder of them"
    print(said)
    write_json(
        folder / "real_campaign.json",
        {**provenance(), "seed": plan.SEED, "real_tables": count, "said": said, "rows": len(rows)},
    )


@main.command()
@click.argument("number", type=int)
@click.option("--seed", required=True, type=int, help="Of the campaign.")
@click.option("--folder", required=True, type=File)
def reported(number: int, seed: int, folder: Path) -> None:
    """What is reported of NUMBER tables, against the mix that was drawn: each table, and the rates."""
    import pandas as pd

    from asphalt_nscd.files.store import write_table

    from . import reported

    rows = pd.DataFrame(reported.run(number, seed))
    write_table(folder / "reported.csv", rows)
    write_table(folder / "reported_summary.csv", reported.summary(rows))


@main.command()
@click.argument("lines", nargs=-1, required=True, type=File)
@click.option("--folder", required=True, type=File)
def tables(lines: tuple[Path, ...], folder: Path) -> None:
    """Tables of all LINES into a folder, and what made them."""
    from asphalt_nscd.files.store import provenance, write_json, write_table

    from . import plan, tables

    texts = (path.read_text(encoding="utf-8").splitlines() for path in lines)
    drawn = [json.loads(text) for part in texts for text in part]
    cases = tables.cases(drawn)
    write_table(folder / "cases.csv", cases)
    for make in (
        tables.efficiency, tables.isolation, tables.false_alarms, tables.coverage, tables.gains,
        tables.outside, tables.removal, tables.inside_runs, tables.summary,
    ):  # fmt: skip
        write_table(folder / f"{make.__name__}.csv", make(cases))
    write_json(
        folder / "campaign.json",
        {
            **provenance(),
            "seed": plan.SEED,
            "mixes_of_runs": list(plan.MIXES),
            "cases": len(drawn),
            "cases_that_cannot_be_drawn": sum("seal" not in line for line in drawn),
        },
    )


@main.command()
@click.argument("name", type=click.Choice(["efficiency", "isolation"]))
@click.argument("table", type=File)
@click.option("--output-stem", required=True, type=File, help="Path without .pdf, .png, .svg.")
def figure(name: str, table: Path, output_stem: Path) -> None:
    """Draw figure NAME from its TABLE."""
    import pandas as pd

    from asphalt_nscd.reporting.figures.save import save_figure

    from . import figures

    save_figure(getattr(figures, name)(pd.read_csv(table)), output_stem)


def _write_lines(path: Path, lines) -> None:
    """Whole or not at all, so that a chunk that was stopped is run again."""
    from asphalt_nscd.files.store import atomic_path

    with atomic_path(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        for line in lines:
            file.write(json.dumps(line) + "\n")


if __name__ == "__main__":
    main()
