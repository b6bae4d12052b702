"""The page of several mixes beside each other."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.files.words import joined
from asphalt_nscd.reporting.pages.charts import Chart, curves
from asphalt_nscd.reporting.pages.style import filled

PAGE = "comparison.html"
HEAD = (
    *("mix", "rank", "|E*| [MPa]", "95 %", "phase [°]", "95 %", "tests"),
    *("check first", "left out"),
    *("certain causes", "possible causes"),
)
NOTES = (
    "All values are of the mix: certain causes are taken off, possible ones by their probability.",
    "A rank of several places says that the tests do not tell these mixes apart.",
)


def write_page(path: Path, table: pd.DataFrame, of_mixes: pd.DataFrame, machine: str = "") -> None:
    """Write the page: curves, ranking, and a link to the diagnosis of each mix in a folder beside it.

    `table` has a row for each mix, the stiffest first, with its ranks; `of_mixes` has mix, frequency_Hz, temperature_C,
    E_MPa and phase_deg with their bounds _low and _high; `machine` says what one machine does to all mixes, a sentence
    a line, if that was asked.
    """
    at = f"{of_mixes['temperature_C'].iloc[0]:g} °C"
    each = {str(name): rows for name, rows in of_mixes.groupby("mix", sort=False)}
    chart = Chart(
        "mixes", f"Mixes at {at}", "Bands: 95 %.", curves(each, f"frequency (Hz), at {at}"), hint=""
    )
    content = filled(
        "plain.html",
        title=f"{len(table)} mixes",
        value=_stiffest(table),
        charts=[chart],
        notes=NOTES,
        caption="Mixes, the stiffest first",
        head=HEAD,
        rows=[_row(row) for row in table.itertuples()],
        machine=machine.splitlines(),
    )
    with atomic_path(path) as temporary:
        temporary.write_text(content, encoding="utf-8")


def _stiffest(table: pd.DataFrame) -> str:
    """Which mix is the stiffest, or which are not told apart from it."""
    first, rivals = table.iloc[0], list(table["mix"][table["rank_low"] == 1])
    at = f"at {first.temperature_C:g} °C and {first.frequency_Hz:g} Hz"
    if len(rivals) > 1:
        return f"Stiffest {at}: one of {joined(rivals)}, which these tests do not tell apart."
    interval = f"95 % interval {first.E_low_MPa:.0f} to {first.E_high_MPa:.0f}"
    return f"Stiffest {at}: {first.mix}, {first.E_MPa:.0f} MPa ({interval})."


def _row(row: Any) -> list[str]:
    name = escape(row.mix)
    return [
        Markup(f'<a href="{name}/diagnosis.html">{name}</a>'),
        f"{row.rank_low}" + f" to {row.rank_high}" * bool(row.rank_high > row.rank_low),
        f"{row.E_MPa:.0f}",
        f"{row.E_low_MPa:.0f} to {row.E_high_MPa:.0f}",
        f"{row.phase_deg:.1f}",
        f"{row.phase_low_deg:.1f} to {row.phase_high_deg:.1f}",
        str(row.tests),
        str(row.check_first),
        str(row.left_out),
        row.causes or "none",
        row.possible_causes or "none",
    ]
