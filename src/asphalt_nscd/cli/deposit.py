from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options, _progress


@click.command()
@click.option("--counts", required=True, type=_options.File, help="Table diameter_mm,count.")
@click.option("--box-m", required=True, type=_options.Numbers(3), help="Length,width,height of the box, m.")
@click.option("--seed", required=True, type=click.IntRange(0), help="Seed of the random lattice.")
@click.option(
    "--friction",
    default=0.2,
    type=_options.NOT_NEGATIVE,
    help="Coefficient of friction between spheres and with walls.",
)
@click.option(
    "--stroke-mm",
    default=6.0,
    type=_options.NOT_NEGATIVE,
    help="Stroke of the top wall from crest to crest, mm.",
)
@click.option("--vibration-hz", default=30.0, type=_options.POSITIVE, help="Frequency of the top wall, Hz.")
@click.option(
    "--vibration-s", default=1.0, type=_options.NOT_NEGATIVE, help="Duration of the vibration, s; 0 for none."
)
@click.option("--time-step-s", default=4e-4, type=_options.Number(above=0.0, high=1e-3), help="Time step, s.")
@_options.output
def command(
    counts: Path, box_m: tuple[float, float, float], seed: int, friction: float, stroke_mm: float,
    vibration_hz: float, vibration_s: float, time_step_s: float, output: Path,
) -> None:  # fmt: skip
    """Pour spheres from a random lattice by gravity, then vibrate the layer with the top wall."""
    from asphalt_nscd.specimen.preparation import deposit

    with _progress.bars("s") as progress:
        deposit(
            counts, box_m, seed, friction, stroke_mm * 1e-3, vibration_hz, vibration_s, time_step_s,
            output, progress,
        )  # fmt: skip
