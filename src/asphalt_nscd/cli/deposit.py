from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options, _progress

_POURING, _SURFACES = "specimen.preparation.Pouring", "specimen.preparation.Surfaces"
_VIBRATION = "specimen.deposit.Vibration"


@click.command()
@click.option(
    "--counts",
    required=True,
    type=_options.File,
    help="Table diameter_mm,count; or a deposit, .h5, to go on from where its spheres stand.",
)
@click.option("--box-m", required=True, type=_options.Numbers(3), help="Length,width,height of the box, m.")
@click.option("--seed", required=True, type=click.IntRange(0), help="Seed of the random lattice.")
@click.option(
    "--friction",
    default=0.2,
    type=_options.Of(f"{_SURFACES}.friction"),
    help="Coefficient of friction between spheres.",
)
@click.option(
    "--wall-friction",
    default=None,
    type=_options.Of(f"{_SURFACES}.wall_friction"),
    help="The same with walls; if not given, that between spheres.",
)
@click.option(
    "--stroke-mm",
    default=6.0,
    type=_options.Of(f"{_VIBRATION}.stroke", unit=1e-3),
    help="Stroke of the top wall from crest to crest, mm.",
)
@click.option(
    "--vibration-hz",
    default=30.0,
    type=_options.Of(f"{_VIBRATION}.frequency"),
    help="Frequency of the top wall, Hz.",
)
@click.option(
    "--vibration-s",
    default=1.0,
    type=_options.Of(f"{_VIBRATION}.duration"),
    help="Duration of the vibration, s; 0 for none.",
)
@click.option(
    "--restitution",
    default=0.0,
    type=_options.Of(f"{_SURFACES}.restitution"),
    help="Speed after an impact over that before it.",
)
@click.option("--time-step-s", default=4e-4, type=_options.Of(f"{_POURING}.time_step"), help="Time step, s.")
@click.option(
    "--threads",
    default=1,
    type=int,
    help="Threads to compute on, at most as many as the cores granted; they change no number.",
)
@_options.output
@_options.gather("vibration", stroke="stroke_mm", frequency="vibration_hz", duration="vibration_s")
@_options.gather(
    "pouring",
    box="box_m",
    seed="seed",
    time_step="time_step_s",
    threads="threads",
)
@_options.gather("surfaces", friction="friction", wall_friction="wall_friction", restitution="restitution")
def command(
    counts: Path,
    pouring: dict[str, Any],
    surfaces: dict[str, float],
    vibration: dict[str, float],
    output: Path,
) -> None:
    """Pour spheres from a random lattice by gravity, then vibrate the layer with the top wall."""
    from asphalt_nscd.nscd.core_cache import is_compiled
    from asphalt_nscd.specimen.deposit import Vibration
    from asphalt_nscd.specimen.preparation import Pouring, Surfaces, deposit, unrest

    vibration["stroke"] *= 1e-3
    fallen = Pouring(surfaces=Surfaces(**surfaces), vibration=Vibration(**vibration), **pouring)
    # Half a minute without a word looks like a hang.
    if not is_compiled("granular.step"):
        click.echo("compiling the core, once for this version: half a minute", err=True)
    with _progress.bars("s") as progress:
        attributes = deposit(counts, fallen, output, progress)
    if doubt := unrest(attributes):
        click.echo(f"warning: {doubt}", err=True)
