from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    law: Path,
    *,
    parameter: str = option("Parameter to change: Em, eta_m, Ek or eta_k."),
    factor: float = option("Factor on the parameter.", above=0.0),
    output: Path = OUTPUT,
) -> None:
    """Change one parameter of a Burgers law, for the sensitivity study."""
    from asphalt_nscd.rheology.scaled_laws import scale_law

    scale_law(law, parameter, factor, output)
