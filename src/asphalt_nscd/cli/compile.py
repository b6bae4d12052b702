from __future__ import annotations

from asphalt_nscd.cli._options import option, step


@step
def command(step: str = option("", choices=("deposit", "simulate"))) -> None:
    """Compile what STEP needs of the core once, before its jobs start side by side."""
    from asphalt_nscd.bending.warmup import STEPS

    STEPS[step]()
