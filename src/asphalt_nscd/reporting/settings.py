"""What a user states of a report. No numpy, for the command line asks it."""

from __future__ import annotations

from dataclasses import dataclass

from asphalt_nscd.files.options import option


@dataclass(frozen=True)
class Heading:
    """What stands at the head of report.pdf; what is empty is left out."""

    project: str = option("Project, for report.pdf, as the next six.", "")
    mix: str = option("Mix.", "")
    operator: str = option("Who tested.", "")
    date: str = option("Date of the tests.", "")
    standard: str = option("Standard of the tests, as EN 12697-26 or AASHTO T 378.", "")
    dimensions: str = option("Dimensions of the specimens.", "")
    strain: str = option("Strain of the tests.", "")
