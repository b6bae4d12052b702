"""All that a diagnosis leaves in a folder; the same by `diagnose`, `compare` and `serve`."""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.diagnosis.run import Outcome
from asphalt_nscd.exports.formats.xlsx import corrected_workbook
from asphalt_nscd.reporting.pages import diagnosis_page, handout
from asphalt_nscd.reporting.settings import Heading


def write_all(outcome: Outcome, folder: Path, title: str, heading: Heading) -> list[str]:
    """Write tables, corrected.xlsx, report.pdf and, last, diagnosis.html, which links them; their names."""
    names = outcome.write(folder)
    more = corrected_workbook(folder), handout.write_handout(folder, title, heading)
    return [*names, *(path.name for path in (*more, diagnosis_page.write_page(folder, title)))]
