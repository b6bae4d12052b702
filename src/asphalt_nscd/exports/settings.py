"""What a user sets of an export. No numpy, for the command line asks it."""

from __future__ import annotations

from dataclasses import dataclass

from asphalt_nscd.files.options import Ranged, option


@dataclass(frozen=True)
class Units:
    """A consistent system of units, whose unit `stress` is `pascals` Pa."""

    name: str
    stress: str
    pascals: float

    def express(self, modulus: float) -> float:
        """A modulus [Pa] in the unit `stress`."""
        return modulus / self.pascals


UNITS = {"SI": Units("m, N, s, Pa", "Pa", 1.0), "mm-N-MPa": Units("mm, N, s, MPa", "MPa", 1e6)}


@dataclass(frozen=True)
class ExportSettings(Ranged):
    """How closely a Prony series follows its law, and what the file says beside it.

    Parameters
    ----------
    error_percent : float
        Largest error of |E*| of the Prony series.
    error_deg : float
        Largest error of its phase, degrees.
    poisson : float, optional
        Poisson's ratio; else 0.35, which the file calls assumed.
    units : str
        Units of the file.
    name : str
        Name of the material (abaqus).

    Examples
    --------
    >>> ExportSettings(error_percent=0.5, poisson=0.4, units="mm-N-MPa").error_deg
    0.5
    """

    error_percent: float = option(default=1.0, above=0.0)
    error_deg: float = option(default=0.5, above=0.0)
    # between these limits shear and bulk moduli are positive
    poisson: float | None = option(default=None, above=-1.0, below=0.5)
    units: str = option(default="SI", choices=tuple(UNITS))
    name: str = option(default="ASPHALT")
