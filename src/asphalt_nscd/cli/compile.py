from __future__ import annotations

import click


@click.command()
def command() -> None:
    """Compile the core once, so that jobs which start together find it compiled."""
    from asphalt_nscd.bending.warmup import warm_up

    warm_up()
