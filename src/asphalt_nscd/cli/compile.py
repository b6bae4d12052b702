from __future__ import annotations

import click


@click.command()
@click.argument("step", type=click.Choice(["deposit", "simulate"]))
def command(step: str) -> None:
    """Compile what STEP needs of the core once, before its jobs start side by side."""
    from asphalt_nscd.bending.warmup import STEPS

    STEPS[step]()
