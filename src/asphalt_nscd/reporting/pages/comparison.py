"""The page of several mixes beside each other."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from urllib.parse import quote

import pandas as pd
from markupsafe import Markup

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.files.words import joined
from asphalt_nscd.reporting.pages.charts import Chart, curves
from asphalt_nscd.reporting.pages.diagnosis_page import PAGE as DIAGNOSIS
from asphalt_nscd.reporting.pages.style import filled

PAGE = "comparison.html"
HEAD = (
    *("mix", "test", "rank", "|E*| [MPa]", "95 %", "phase [°]", "95 %", "tests"),
    *("check first", "left out"),
    *("certain causes", "possible causes"),
)
NOTES = (
    "All values are of the mix: certain causes are taken off, possible ones by their probability.",
    "A rank of several places says that the tests do not tell these mixes apart.",
    "The folder of each mix has all that diagnose writes: report.pdf, corrected.xlsx, law.json and the rest.",
)
CONDITIONS = "|E*| in MPa where clients ask for it, with 95 % intervals; empty where no test was made near"
DIFFERENCES = "By how much the first mix is stiffer, with 95 % intervals; bold where the two are told apart"


def folder_of(mix: str) -> str:
    """The folder of a mix, whose name may hold what divides folders."""
    return mix.replace("/", "-").replace("\\", "-")


def write_page(
    path: Path,
    table: pd.DataFrame,
    of_mixes: pd.DataFrame,
    elsewhere: tuple[pd.DataFrame, pd.DataFrame],
    machine: str = "",
) -> None:
    """Write the page: curves, ranking, and a link to the diagnosis of each mix in a folder beside it.

    `table` has a row for each mix, the stiffest first, with its ranks; `of_mixes` has mix, frequency_Hz, temperature_C,
    E_MPa and phase_deg with their bounds _low and _high; `elsewhere` holds the conditions and differences of a
    `Comparison`; `machine` says what one machine does to all mixes, a sentence a line, if that was asked.
    """
    at = f"{of_mixes['temperature_C'].iloc[0]:g} °C"
    each = {str(name): rows for name, rows in of_mixes.groupby("mix", sort=False)}
    chart = Chart(
        "mixes", f"Mixes at {at}", "Bands: 95 %.", curves(each, f"frequency (Hz), at {at}"), hint=""
    )
    conditions, differences = elsewhere
    values = conditions.assign(cell=[_interval(row) for row in conditions.itertuples()])
    off = differences.assign(
        mix=[f"{row.mix} over {row.than}" for row in differences.itertuples()],
        cell=[_difference(row) for row in differences.itertuples()],
    )
    content = filled(
        "plain.html",
        title=f"{len(table)} mixes",
        value=_stiffest(table),
        charts=[chart],
        notes=NOTES,
        tables=[
            ("Mixes, the stiffest first", HEAD, [_row(row) for row in table.itertuples()]),
            (CONDITIONS, *_conditions(values)),
            (DIFFERENCES, *_conditions(off)),
        ],
        machine=machine.splitlines(),
    )
    with atomic_path(path) as temporary:
        temporary.write_text(content, encoding="utf-8")


def _conditions(table: pd.DataFrame) -> tuple[list[str], list[list[str]]]:
    """Head and rows: a column for each condition, with what is asked for there."""
    asked = {}
    if "asked_for" in table:
        asked = dict(zip(table["temperature_C"], table["asked_for"], strict=True))
    keys = ["temperature_C", "frequency_Hz"]
    cells = table.pivot(index="mix", columns=keys, values="cell").reindex(table["mix"].unique()).fillna("")
    head = [f"{t:g} °C, {f:g} Hz{': ' + asked[t] if t in asked else ''}" for t, f in cells.columns]
    return ["mix", *head], [[name, *row] for name, row in zip(cells.index, cells.to_numpy(), strict=True)]


def _interval(row: Any) -> str:
    return f"{row.E_MPa:.0f} ({row.E_low_MPa:.0f} to {row.E_high_MPa:.0f})"


def _difference(row: Any) -> Markup:
    """By how much one mix is stiffer, with its interval; bold where the two are told apart."""
    # + 0.0: what is rounded to -0 is 0.
    middle, low, high = (
        f"{round(getattr(row, f'stiffer{end}_percent')) + 0.0:+.0f}" for end in ("", "_low", "_high")
    )
    said = f"{middle} % ({low} to {high})".replace("-", "\N{MINUS SIGN}")
    return Markup("<b>{}</b>").format(said) if row.told_apart else Markup(said)  # noqa: S704  numbers


def _stiffest(table: pd.DataFrame) -> str:
    """Which mix is the stiffest, or which are not told apart from it."""
    first, rivals = table.iloc[0], list(table["mix"][table["rank_low"] == 1])
    at = f"at {first.temperature_C:g} °C and {first.frequency_Hz:g} Hz"
    if len(rivals) > 1:
        return f"Stiffest {at}: one of {joined(rivals)}, which these tests do not tell apart."
    interval = f"95 % interval {first.E_low_MPa:.0f} to {first.E_high_MPa:.0f}"
    return f"Stiffest {at}: {first.mix}, {first.E_MPa:.0f} MPa ({interval})."


def _row(row: Any) -> list[str]:
    """Cells of a mix in the order of HEAD."""
    return [
        Markup('<a href="{}/{}">{}</a>').format(quote(folder_of(row.mix)), DIAGNOSIS, row.mix),
        "not said" if row.test == "unknown" else row.test,
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
