"""How published tables are shown in README.md and docs/: which columns, under which headings (published_tables.yaml).

A page shows at most 120 characters in a line. A table with more columns is shown in parts, and its CSV holds the rest.
"""

from __future__ import annotations

from importlib.resources import files
from typing import Any

import msgspec
import pandas as pd
from msgspec import yaml


class Layout(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One table of a block: `columns` with their headings, below a `sentence`. A column the table lacks is left out.

    `figures`: significant figures. `where`: by column, the values of the rows that a page shows. `shorter`: cells that
    are too long for a page, and what stands there instead. `notes`: the column whose texts are listed behind those of
    `columns`. `rungs`: the quantity of ladder.csv, a row for each temperature, a column for each rung. `crossed`: row,
    column and quantity of a long table, shown below `heading`.
    """

    columns: dict[str, str] = {}
    sentence: str = ""
    figures: int = 4
    where: dict[str, list[str | float]] = {}
    shorter: dict[str, str] = {}
    notes: str = ""
    rungs: str = ""
    crossed: list[str] = []
    heading: str = ""

    @property
    def required(self) -> set[str]:
        """Columns that the table must have."""
        return set(self.crossed) or {*self.columns, *filter(None, [self.notes])}

    def markdown(self, table: pd.DataFrame) -> str:
        """The table for a page of the documents, its sentence above it."""
        if self.notes:
            told = table[table[self.notes].notna()][[*self.columns, self.notes]].astype(str)
            return "".join(f"* {', '.join(names)}: {text}\n" for *names, text in told.to_numpy().tolist())
        if self.rungs:
            table = _by_rung(table, f"mre_{self.rungs}")
        elif self.crossed:
            table = self._crossed(table)
        else:
            for column, values in self.where.items():
                table = table[table[column].isin(values)]
            table = table[[name for name in self.columns if name in table]].replace(self.shorter)
        shown = table.rename(
            columns=self.columns
        ).convert_dtypes()  # whole numbers stay so beside empty fields
        filled = shown.astype(object).where(shown.notna(), None)
        grid = filled.to_markdown(index=False, floatfmt=f".{self.figures}g", missingval="") + "\n"
        return f"{self.sentence}\n\n{grid}" if self.sentence else grid

    def _crossed(self, table: pd.DataFrame) -> pd.DataFrame:
        """Rows in the order of the long table."""
        row, column, quantity = self.crossed
        wide = table.pivot(index=row, columns=column, values=quantity).loc[table[row].unique()]
        return wide.rename(columns=str)[[*self.columns]].rename_axis(self.heading).reset_index()


def _by_rung(ladder: pd.DataFrame, error: str) -> pd.DataFrame:
    """Errors of ladder.csv, a column for each rung."""
    by = {rung: rows.set_index("temperature_C") for rung, rows in ladder.groupby("rung", sort=False)}
    printed = next(iter(by.values())).get(f"{error}_published_percent")
    columns = {} if printed is None else {"printed": printed}
    columns |= {rung: rows[f"{error}_percent"] for rung, rows in by.items()}
    return pd.DataFrame(columns).rename_axis("T, °C").reset_index()


_FILE = files("asphalt_nscd.reporting") / "published_tables.yaml"
BLOCKS: dict[str, list[Layout]] = yaml.decode(_FILE.read_bytes(), type=dict[str, list[Layout]])


def shown(block: str, table: pd.DataFrame) -> str:
    """The published table of a block in Markdown, all columns where no layout is named."""
    every: Any = {name: name for name in table.columns}
    return "\n".join(part.markdown(table) for part in BLOCKS.get(block, [Layout(every)]))
