"""Which kind of test a file names: schemes of EN 12697-26 and AASHTO, and words in the lines above a table."""

from __future__ import annotations

import re
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import read_sheets
from asphalt_nscd.table_import.words import WORDS

MOST_LINES = 15  # from the top, in which a title stands


def schemes_in(path: Path) -> set[str]:
    """Kinds of test, of `kinds.TEST_TYPES`, that the first lines of a file name."""
    try:
        sheets = read_sheets(path)
    # Why it cannot be read is said where it is read.
    except InputError:
        return set()
    text = " ".join(cell for sheet in sheets for _, cells in sheet.rows[:MOST_LINES] for cell in cells)
    return {kind for kind, pattern in WORDS["scheme"].items() if re.search(pattern, text, re.IGNORECASE)}
