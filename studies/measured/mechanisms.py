"""What grains that slip, and films that soften, change in a test of a mix, from tables made without one."""

from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.screening.kramers_kronig import required_phase

Vector = np.ndarray
NAMES = "contacts", "binder", "clock"


class Mechanisms:
    """Changes of ln E*, as a haversine is read with a term for its drift, by modulus and phase of the mix.

    Beyond the moduli and phases that were simulated, the nearest hold: a mix softer than its own skeleton under the
    stated pressure has no network that stands for it.
    """

    def __init__(self, tables: Any) -> None:
        """tables: the files NAMES, as attributes."""
        self.contact, self.binder, self.clock = (pd.read_csv(getattr(tables, name)) for name in NAMES)

    def usual(self, amplitude: float, shear: float = 1.0) -> pd.DataFrame:
        """Haversines of this amplitude of strain, by films of this stiffness in shear, as pressed as is stated."""
        of = self.contact
        stated = (of["haversine"] == 1) & (of["pressure_kPa"] == 10.0) & (of["friction"] == 0.5)
        stated &= np.isclose(of["shear"], shear)
        return of[stated & np.isclose(of["amplitude_1e6"], 1e6 * amplitude)]

    def contacts(self, modulus: Vector, amplitude: float, shear: float = 1.0) -> Vector:
        """ln of what is read over E* (n,) [Pa], by grains that slip and open, at an amplitude of strain."""
        usual = self.usual(amplitude, shear)
        phase = np.degrees(np.angle(modulus))
        levels, changes = [], []
        for _, row in usual.groupby((np.log(usual["E_MPa"]) / 0.1).round()):
            row = row.sort_values("phase_deg")
            levels.append(np.log(row["E_MPa"]).mean())
            parts = [np.interp(phase, row["phase_deg"], row[name]) for name in ("lnE", "change_deg")]
            changes.append(parts[0] + 1j * np.radians(parts[1]))
        at = zip(np.log(np.abs(modulus) / 1e6), np.transpose(changes), strict=True)
        return np.array([np.interp(place, levels, own) for place, own in at])

    def softening(self, modulus: Vector, amplitude: float, kind: str = "haversine") -> Vector:
        """The same by films that soften; kind: "haversine" or "pulled"."""
        place = np.log(np.abs(modulus) / 1e6)
        fall = amplitude * np.exp(np.interp(place, np.log(self.binder["E_MPa"]), np.log(self.binder["fall"])))
        slope = np.angle(modulus) / (0.5 * np.pi)
        of = {name: np.interp(slope, self.clock["slope"], self.clock[name]) for name in self.clock}
        return fall / -of["pulled_lnE"] * (of[f"{kind}_lnE"] + 1j * np.radians(of[f"{kind}_deg"]))


def excess_of(frequency: Vector, modulus: Vector, change: Vector) -> Vector:
    """Phase [deg] by which a change of ln E* (n,) of an isotherm lies above what its own |E*| requires then."""
    before = np.log(np.abs(modulus))
    required = [required_phase(frequency, log).phase for log in (before, before + change.real)]
    return np.degrees(change.imag - (required[1] - required[0]))
