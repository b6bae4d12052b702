"""|E*| and its phase from the parts of E* or from the tangent, which DMA machines and French tables give."""

from __future__ import annotations

import cmath
import math

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
_SAID = {
    "E1_MPa": "E' (real part)",
    "E2_MPa": "E'' (imaginary part)",
    "tan_delta": "tan(phase)",
    "E_MPa": "|E*|",
    "phase_deg": "phase",
}


def fill_whole_modulus(values: dict[str, list[str]]) -> list[str]:
    """Put |E*| [MPa] and phase [deg] into `values` for what stands for them; returns a note if anything did."""
    parts = [name for name in ("E1_MPa", "E2_MPa", "tan_delta") if name in values]
    if not parts:
        return []
    given = [name for name in _SAID if name in values]
    rows = [
        _whole(dict(zip(given, map(float, row), strict=True)))
        for row in zip(*(values[name] for name in given), strict=True)
    ]
    for name in parts:
        del values[name]
    values["E_MPa"], values["phase_deg"] = ([f"{row[n]:.10g}" for row in rows] for n in (0, 1))
    return [f"|E*| and phase computed from {' and '.join(_SAID[name] for name in given)}"]


def _whole(test: dict[str, float]) -> tuple[float, float]:
    """|E*| and phase [deg] of one test."""
    if {"E1_MPa", "E2_MPa"} <= test.keys():
        # As a complex number: E'' / E' has no value where E' is zero.
        star = complex(test["E1_MPa"], test["E2_MPa"])
        return abs(star), math.degrees(cmath.phase(star))
    phase = math.radians(test["phase_deg"]) if "phase_deg" in test else math.atan(test["tan_delta"])
    size = next(
        value
        for value in (
            test.get("E_MPa"),
            test["E1_MPa"] / math.cos(phase) if "E1_MPa" in test else None,
            # At phase zero E'' says nothing of |E*|; the NaN is refused with its line, as no finite number.
            test["E2_MPa"] / (math.sin(phase) or math.nan) if "E2_MPa" in test else None,
        )
        if value is not None
    )
    return size, math.degrees(phase)
