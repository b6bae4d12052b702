"""What a user states of a report. No numpy, for the command line asks it."""

from __future__ import annotations

from dataclasses import dataclass

from asphalt_nscd.files.options import option


@dataclass(frozen=True)
class Heading:
    """What stands at the head of report.pdf; what is empty is left out.

    Parameters
    ----------
    project : str
        Project that report.pdf names.
    mix : str
        Mix that it names.
    operator : str
        Who tested.
    date : str
        Date of the tests or of the report.
    standard : str
        Standard of the tests, as EN 12697-26 or AASHTO T 378.

    Examples
    --------
    >>> Heading(mix="N1-1", standard="AASHTO T 378").project
    ''
    """

    project: str = option(default="")
    mix: str = option(default="")
    operator: str = option(default="")
    date: str = option(default="")
    standard: str = option(default="")
