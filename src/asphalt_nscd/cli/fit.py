from __future__ import annotations

from pathlib import Path
from typing import Any

from asphalt_nscd.cli._options import CYCLES, OUTPUT, Geometry, option, step


@step
def command(
    measured: Path,
    *,
    temperature_C: float = option("Temperature to fit, degrees Celsius.", above=-273.15),
    geometry: Any = option(
        "Reduce the measurements first, which are of these specimens.", None, type=Geometry()
    ),
    cycles: int | None = CYCLES,
    output: Path = OUTPUT,
) -> None:
    """Fit one Burgers law to reduced measurements at one temperature, Eqs. (27)-(29)."""
    from asphalt_nscd.rheology.fitted_laws import fit_temperature

    fit_temperature(measured, temperature_C, output, geometry, cycles)
