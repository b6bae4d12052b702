from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli._options import MEASURED_IN, offered, option, step
from asphalt_nscd.cli._progress import bars
from asphalt_nscd.diagnosis.settings import Draws, Known

FEW = 3  # mixes, of more the page tells each pair


@step
def command(
    mixes: tuple[Path, ...],
    *,
    output: Path = option("Folder for comparison.html and the rest."),
    measured_in: str | None = MEASURED_IN,
    sheet: tuple[str, ...] = option("A sheet of the first file that is a mix; once for each.", ()),
    only_mix: tuple[str, ...] = option(
        "A mix of the first file, which has a column of mixes; once for each.", ()
    ),
    same_machine: bool = option("One machine tested all: say what it does to all of them, too.", False),
    known: Known = offered("law"),
    draws: Draws = offered("number"),
) -> None:
    """Diagnose several mixes and rank them: one workbook, one page, and a folder for each.

    MIXES: a file or a folder for each mix, two or more; or one file whose mixes --sheet or --only-mix names.
    """
    from asphalt_nscd.api.comparison import compare, name_of, named_apart
    from asphalt_nscd.api.tables import campaign_in

    taken: Any = mixes
    if sheet or only_mix:
        of_sheets = [(name, campaign_in(mixes[0], sheet=name)) for name in sheet]
        of_mixes = [(name, campaign_in(mixes[0], mix=name)) for name in only_mix]
        taken = named_apart([*of_sheets, *of_mixes, *((name_of(path), path) for path in mixes[1:])])
    with bars("mix", on_terminal=True) as progress:
        made = compare(taken, measured_in=measured_in, law=known.law, draws=draws, progress=progress)
    table, machine = made.table, made.same_machine(draws) if same_machine else None
    names = made.write(output, machine)
    for row in table.itertuples():
        place = f"{row.rank_low}" if row.rank_low == row.rank_high else f"{row.rank_low}-{row.rank_high}"
        click.echo(
            f"{place:>6}  {row.mix}: |E*|(15 degC, 10 Hz) = {row.E_MPa:.0f} MPa "
            f"({row.E_low_MPa:.0f} to {row.E_high_MPa:.0f}); {_found(row.causes, row.possible_causes)}"
        )
    for row in made.differences.itertuples():
        if row.told_apart and len(table) <= FEW:
            click.echo(
                f"At {row.temperature_C:g} degC, {row.frequency_Hz:g} Hz {row.mix} has {row.stiffer_percent:+.0f} % "
                f"({row.stiffer_low_percent:+.0f} to {row.stiffer_high_percent:+.0f}) of |E*| over {row.than}."
            )
    if machine is not None:
        click.echo(f"\n{machine}")
    click.echo(f"\nWritten to {output}: {', '.join(names)}, and a folder for each mix.")


def _found(certain: str, possible: str) -> str:
    return "; ".join(filter(None, [certain, possible and f"possible: {possible}"])) or "no cause named"
