"""Which kind of test a file names: schemes of EN 12697-26 and AASHTO, and words in the lines above a table."""

from __future__ import annotations

import re
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import read_sheets

MOST_LINES = 15  # from the top, in which a title stands
# 2PB-TR, 2PB-PR, DTC-CY and DT-CY are the names of EN 12697-26; T, TP and R with a number are AASHTO's.
_SCHEMES = {
    "bending": r"2\s?PB\b|2PB-?(?:TR|PR)|two[- ]point bending|flexion (?:deux|2)[- ]points|zwei-?punkt-?biege|"
    r"trap[eéè]z",
    "tension-compression": r"AASHTO\s*(?:T\s*(?:342|378)|TP\s*(?:62|79|132)|R\s*84)|\bAMPT\b|DTC-?CY|DT-?CY|"
    r"tension[-/ ]compression|traction[-/ ]compression|zug[-/ ]druck|uniaxial|axial compression",
}


def schemes_in(path: Path) -> set[str]:
    """Kinds of test, of `kinds.TEST_TYPES`, that the first lines of a file name."""
    try:
        sheets = read_sheets(path)
    # Why it cannot be read is said where it is read.
    except InputError:
        return set()
    text = " ".join(cell for sheet in sheets for _, cells in sheet.rows[:MOST_LINES] for cell in cells)
    return {kind for kind, pattern in _SCHEMES.items() if re.search(pattern, text, re.IGNORECASE)}
