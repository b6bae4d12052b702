from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import MEASURED_IN, offered, option, step
from asphalt_nscd.cli._progress import bars
from asphalt_nscd.diagnosis.settings import Draws, Known


@step
def command(
    mixes: tuple[Path, ...],
    *,
    output: Path = option("Folder for comparison.html and the rest."),
    measured_in: str | None = MEASURED_IN,
    same_machine: bool = option("One machine tested all: say what it does to all of them, too.", False),
    known: Known = offered("law"),
    draws: Draws = offered("number"),
) -> None:
    """Diagnose several mixes and rank them: one workbook, one page, and a folder for each.

    MIXES: a file or a folder for each mix, two or more.
    """
    from asphalt_nscd.api.comparison import compare

    with bars("mix", on_terminal=True) as progress:
        made = compare(mixes, measured_in=measured_in, law=known.law, draws=draws, progress=progress)
    table, machine = made.table, made.same_machine(draws) if same_machine else None
    names = made.write(output, machine)
    for row in table.itertuples():
        place = f"{row.rank_low}" if row.rank_low == row.rank_high else f"{row.rank_low}-{row.rank_high}"
        click.echo(
            f"{place:>6}  {row.mix}: |E*|(15 degC, 10 Hz) = {row.E_MPa:.0f} MPa "
            f"({row.E_low_MPa:.0f} to {row.E_high_MPa:.0f}); {_found(row.causes, row.possible_causes)}"
        )
    if machine is not None:
        click.echo(f"\n{machine}")
    click.echo(f"\nWritten to {output}: {', '.join(names)}, and a folder for each mix.")


def _found(certain: str, possible: str) -> str:
    return "; ".join(filter(None, [certain, possible and f"possible: {possible}"])) or "no cause named"
