"""E* from real and imaginary part, or from tan(phase), as DMA machines and French tables give."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Columns that give E* whole, the first that a table has.
WAYS = (
    ("E_MPa", "phase_deg"),
    ("E1_MPa", "E2_MPa"),
    ("E_MPa", "tan_delta"),
    ("E1_MPa", "tan_delta"),
    ("E1_MPa", "phase_deg"),
    ("E2_MPa", "phase_deg"),
    ("E2_MPa", "tan_delta"),
)
PARTS = {"E1_MPa": "E' (real part)", "E2_MPa": "E'' (imaginary part)", "tan_delta": "tan(phase)"}
SAID = PARTS | {"E_MPa": "|E*|", "phase_deg": "phase"}


def whole_modulus(given: dict[str, NDArray[np.float64]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """|E*| [MPa] and phase [deg] (n,) of the columns of one of WAYS."""
    if {"E1_MPa", "E2_MPa"} <= given.keys():
        # As a complex number: E'' / E' has no value where E' is zero.
        star = given["E1_MPa"] + 1j * given["E2_MPa"]
        return np.abs(star), np.degrees(np.angle(star))
    phase = np.radians(given["phase_deg"]) if "phase_deg" in given else np.arctan(given["tan_delta"])
    # At phase zero E'' says nothing of |E*|; the NaN is refused with its line.
    sine = np.where(np.sin(phase) == 0.0, np.nan, np.sin(phase))
    size = given.get("E_MPa")
    if size is None:
        size = given["E1_MPa"] / np.cos(phase) if "E1_MPa" in given else given["E2_MPa"] / sine
    return size, np.degrees(phase)
