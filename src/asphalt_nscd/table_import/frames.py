"""Campaigns as data frames, to look at and to change before a diagnosis."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.campaign import Campaign
from asphalt_nscd.table_import.cells import Cells
from asphalt_nscd.table_import.decimals import Number
from asphalt_nscd.table_import.understand import TEXTS, understand

CALLED = "DataFrame (lines counted from 1)"  # where a refusal names the file
TEST_TYPE, NOTES, SOURCE = "test_type", "notes", "source"  # keys of `attrs`


def frame_of(campaign: Campaign) -> pd.DataFrame:
    """The tests of a campaign, one row each; `attrs` holds test type, source and notes of the import."""
    columns: dict[str, Any] = {}
    for name, cells in campaign.table.columns.items():
        if name in (*TEXTS, "record"):
            columns[name] = list(cells)
        else:
            columns[name] = campaign.table.numbers_or_nan(name)
    frame = pd.DataFrame(columns)
    frame.attrs = {
        TEST_TYPE: campaign.test_type,
        NOTES: list(campaign.notes),
        SOURCE: str(campaign.table.path),
    }
    return frame


def campaign_of(
    frame: pd.DataFrame, chosen: Mapping[str, str] | None = None, test_type: str | None = None
) -> Campaign:
    """The campaign in a data frame with columns named as in a file; `test_type` None is that of `attrs`, or bending."""
    header = [str(name) for name in frame.columns]
    texts = [[_cell(value) for value in frame[name]] for name in frame.columns]
    rows = [(line, list(cells)) for line, cells in enumerate(zip(*texts, strict=True), start=1)]
    kept = frame.attrs.get(SOURCE)
    # Records are files beside their table.
    path = Path(kept) if kept and "record" in header else Path(CALLED)
    if not rows:
        raise InputError(f"{path}: has no rows; add one for each test.")
    read = understand(Cells(path, header, rows), chosen)
    notes = frame.attrs.get(NOTES) or [
        *read.notes,
        *(f"{name} from column {column.source}" for name, column in read.read.items()),
    ]
    kind, left_out = test_type or frame.attrs.get(TEST_TYPE, "bending"), (read.without_phase,)
    return Campaign(read.table, (), kind, tuple(notes), left_out if read.without_phase else ())


def _cell(value: Any) -> str:
    """A value as a workbook has it; nothing for what is missing."""
    if value is None or value != value:
        return ""
    if isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool):
        return Number(float(value))
    return " ".join(str(value).split())
