"""What is drawn where measurements are reconstructed. No numpy, for command line and schema ask it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.options import Ranged, option
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.measurements.kinds import PAPER_AMPLITUDE

FREQUENCIES = (3.0, 6.0, 10.0, 25.0, 40.0)  # Hz, section 2.1 of the paper


@dataclass(frozen=True)
class Sampling(Ranged):
    """What is drawn; each scatter is a standard deviation, and the same seed gives the same table.

    `frequencies` in Hz, `amplitude` z0 of the head in m; `specimen_scatter` of ln|E*| of a whole specimen,
    `modulus_scatter` of ln|E*| of a point, `phase_scatter_deg` of the phase of a point in degrees.
    """

    seed: int = option("Seed of the random scatter.", low=0)
    specimens: int = option("Number of specimens to draw.", 4, low=1)
    specimen_scatter: float = option(
        "Relative standard deviation of the modulus from specimen to specimen.", 0.03, low=0.0
    )
    modulus_scatter: float = option(
        "Relative standard deviation of the modulus from test to test.", 0.01, low=0.0
    )
    phase_scatter_deg: float = option(
        "Standard deviation of the phase from test to test, degrees.", 0.3, low=0.0
    )
    amplitude: float = option(
        "Amplitude of the head's displacement, m.", PAPER_AMPLITUDE, key="amplitude_m", above=0.0
    )
    frequencies: Sequence[float] = option(
        "Test frequencies, comma-separated, Hz.", FREQUENCIES, key="frequencies_Hz", above=0.0
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        frequencies = list(self.frequencies)
        if not frequencies or not all(map(Range(above=0.0).holds, frequencies)):
            raise InputError(f"frequencies {frequencies} must be positive; give them in Hz.")
        if len(set(frequencies)) < len(frequencies):
            raise InputError(f"frequencies {frequencies}: one is given twice; give each once.")
