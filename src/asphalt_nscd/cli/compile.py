from __future__ import annotations

import click


@click.command()
def command() -> None:
    """Compile the core once, before jobs start side by side."""
    from asphalt_nscd.bending.warmup import warm_up

    warm_up()
