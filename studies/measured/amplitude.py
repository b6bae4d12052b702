"""What a larger strain does to modulus and phase at 20 degC and 10 Hz: measured by two laboratories, and predicted.

Of the measurements only least-squares slopes are here, with their standard errors: uniaxial cylinders of Zeiada et al.
(2013), 75 to 200e-6, and beams in four-point bending of NCHRP 9-44A (Witczak et al. 2013). Both are of about the 50th
cycle, so that heating and damage are in them. In bending strain grows from the axis outwards: what falls with strain
falls by 3/4 of what it does uniaxially. A reading of drift changes with no strain.
"""

from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import write_table
from studies.measured.mechanisms import Mechanisms
from studies.measured.stated import SEVERAL, SEVERAL_WEAK, WEAK

MIX = 6e9 * np.exp(1j * np.radians(28.0))  # Pa, at 20 degC and 10 Hz: that of the uniaxial tests
PER = 100e-6  # of strain
MEASURED = {  # ln|E*| and phase [deg] by PER, and standard errors; no phase was published of the beams
    "uniaxial": (-0.197, 0.055, 4.35, 1.4),
    "bending": (0.008, 0.051, np.nan, np.nan),
}
IN_BENDING = 0.75
UNLIKELY = 2.0  # standard errors


def predictions(mechanisms: Mechanisms) -> dict[str, complex]:
    """Change of ln E* by PER in tension-compression."""
    contacts, weak = (
        _of_contacts(mechanisms.contact, *pair) for pair in ((1.0, SEVERAL), (WEAK, SEVERAL_WEAK))
    )
    softening = mechanisms.softening(np.array([MIX]), PER, "pulled")[0]
    parts = {"reading": 0j, "contacts": contacts, "softening": softening, "all": contacts + softening}
    return parts | {"weak films": weak}


def _of_contacts(table: pd.DataFrame, shear: float, amplitudes: tuple[float, float]) -> complex:
    """The same among films of this stiffness in shear, between two amplitudes of strain."""
    pulled = table[(table["haversine"] == 0) & np.isclose(table["shear"], shear)].sort_values("amplitude_1e6")
    change = (pulled["lnE"] + 1j * np.radians(pulled["change_deg"])).diff().iloc[-1]
    return complex(change / (amplitudes[1] - amplitudes[0]) * PER)


def table(mechanisms: Mechanisms) -> pd.DataFrame:
    """A row for each test and mechanism: measured, predicted, and whether one contradicts the other."""
    rows = []
    for test, (modulus, modulus_error, phase, phase_error) in MEASURED.items():
        for name, change in predictions(mechanisms).items():
            own = change * (IN_BENDING if test == "bending" else 1.0)
            off = [(own.real - modulus) / modulus_error, (np.degrees(own.imag) - phase) / phase_error]
            rows.append(
                {
                    "test": test,
                    "mechanism": name,
                    "measured_E_percent": 100.0 * modulus,
                    "standard_error_E_percent": 100.0 * modulus_error,
                    "predicted_E_percent": 100.0 * own.real,
                    "measured_phase_deg": phase,
                    "standard_error_phase_deg": phase_error,
                    "predicted_phase_deg": np.degrees(own.imag),
                    "contradicted": "yes" if np.nanmax(np.abs(off)) > UNLIKELY else "no",
                }
            )
    return pd.DataFrame(rows)


def run(job: Any) -> None:
    """amplitude.csv."""
    write_table(job.output[0], table(Mechanisms(job.input)))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
