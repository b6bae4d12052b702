"""What a user sets of an export. No numpy, for the command line asks it."""

from __future__ import annotations

from dataclasses import dataclass

from asphalt_nscd.files.options import Ranged, option

UNITS = ("SI", "mm-N-MPa")


@dataclass(frozen=True)
class ExportSettings(Ranged):
    """How closely a Prony series follows its law, and what the file says beside it.

    Parameters
    ----------
    error_percent : float
        Largest error of |E*| over the tested band [%].
    error_deg : float
        Largest error of the phase over the tested band [degrees].
    poisson : float, optional
        Poisson's ratio; None for 0.35, said to be assumed.
    units : str
        "SI" or "mm-N-MPa".
    name : str
        Of the material.

    Examples
    --------
    >>> ExportSettings(error_percent=0.5, poisson=0.4, units="mm-N-MPa").error_deg
    0.5
    """

    error_percent: float = option("Largest error of |E*| of the Prony series.", 1.0, above=0.0)
    error_deg: float = option("Largest error of its phase, degrees.", 0.5, above=0.0)
    poisson: float | None = option(
        "Poisson's ratio; else 0.35, which the file calls assumed.", None, above=-1.0, below=0.5
    )
    units: str = option("Units of the file.", "SI", choices=UNITS)
    name: str = option("Name of the material (abaqus).", "ASPHALT")
