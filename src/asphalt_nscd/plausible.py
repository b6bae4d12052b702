"""Ranges that no asphalt test leaves, so that a value outside is a slip of unit or sign."""

from __future__ import annotations

from asphalt_nscd.csvinput import Limits

# A phase may come out a little negative (a delayed channel does that), so its sign is judged over
# the whole table, by `measurements`.
LIMITS = {
    "temperature_C": Limits(-80, 120, "give degrees Celsius"),
    "frequency_Hz": Limits(1e-5, 1000, "give a positive frequency in Hz"),
    "F0_N": Limits(1e-6, 1e5, "give a positive force amplitude in N"),
    "z0_m": Limits(1e-8, 5e-3, "give a positive displacement amplitude in m (63 micrometres are 63e-6)"),
    "psi_deg": Limits(-180, 180, "give the angle by which the force leads, in degrees"),
    "E_MPa": Limits(0.1, 2e5, "give a positive norm of E* in MPa"),
    "phase_deg": Limits(-90, 90, "give the phase of E* in degrees"),
}
