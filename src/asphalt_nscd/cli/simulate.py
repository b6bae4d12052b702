from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options, _progress


@click.command()
@click.argument("model", type=_options.File)
@click.option(
    "--excerpt",
    default=None,
    type=_options.File,
    help="Excerpt of the model, made beside it: the model is read only where a test needs more, as for a break.",
)
@click.option(
    "--law",
    "laws",
    required=True,
    multiple=True,
    type=_options.File,
    help="Law of the bonds, JSON; one for all tests or one for each.",
)
@click.option("--law-source", default="", help="Where the law comes from; kept with the result.")
@click.option(
    "--temperature-c",
    required=True,
    type=_options.Number(above=-273.15),
    help="Temperature of the law, degrees Celsius.",
)
@click.option(
    "--frequency-hz",
    "frequencies",
    required=True,
    multiple=True,
    type=_options.POSITIVE,
    help="Frequency of the head, Hz; given again, with an --output of its own, for each further test.",
)
@click.option("--amplitude-m", default=63e-6, type=_options.POSITIVE, help="Amplitude of the head, m.")
@click.option("--cycles", default=5.0, type=_options.Number(low=1.0), help="Number of cycles.")
@click.option("--time-step-s", default=5e-5, type=_options.POSITIVE, help="Time step, s.")
@click.option(
    "--rest-steps", default=1000, type=click.IntRange(0), help="Steps under gravity before the head moves."
)
@click.option(
    "--method",
    default="reduced",
    type=click.Choice(["reduced", "condensed", "sweeps", "harmonic"]),
    help="Reduced form, full condensed system, plain Gauss-Seidel on the bonds, or steady oscillation.",
)
@click.option(
    "--tolerance",
    default=1e-4,
    type=_options.NOT_NEGATIVE,
    help="Relative change per sweep that stops Gauss-Seidel.",
)
@click.option(
    "--most-sweeps", default=50, type=click.IntRange(1), help="Most sweeps of Gauss-Seidel in a step."
)
@click.option(
    "--rig",
    default=None,
    type=_options.File,
    help="What stands at the head and in the measuring channel, JSON.",
)
@click.option(
    "--scheme",
    default="euler",
    type=click.Choice(["euler", "fitted"]),
    help="Implicit Euler, or BDF2 fitted to the frequency: exact in steady oscillation, 100 steps a cycle do.",
)
@click.option(
    "--energy", is_flag=True, help="Keep the energy account of a reduced run too; condensed ones always do."
)
@click.option(
    "--checkpoint",
    default=None,
    type=_options.File,
    help="Go on from this file if it stands, and keep the run in it; removed once the result is written.",
)
@click.option(
    "--checkpoint-every", default=100, type=click.IntRange(1), help="Steps between two checkpoints."
)
@_options.outputs
def command(
    model: Path, excerpt: Path | None, laws: tuple[Path, ...], law_source: str, temperature_c: float,
    frequencies: tuple[float, ...], amplitude_m: float,
    cycles: float, time_step_s: float, rest_steps: int, method: str, tolerance: float, most_sweeps: int,
    rig: Path | None, scheme: str, energy: bool, checkpoint: Path | None, checkpoint_every: int,
    outputs: tuple[Path, ...],
) -> None:  # fmt: skip
    """Complex modulus tests at one temperature: for each frequency a file."""
    tests = len(frequencies)
    if len(outputs) != tests or len(laws) not in (1, tests):
        raise click.UsageError(
            f"{tests} x --frequency-hz, {len(laws)} x --law and {len(outputs)} x --output; give an --output "
            "for each frequency, and one --law or one for each."
        )
    if checkpoint is not None and tests > 1:
        raise click.UsageError("--checkpoint keeps one test; give one --frequency-hz.")
    from asphalt_nscd.bending.bending_test import read_subject, simulate

    specimen = read_subject(model, excerpt)
    for law, frequency, output in zip(laws * (tests // len(laws)), frequencies, outputs, strict=True):
        with _progress.bars("steps") as report:
            simulate(
                model, law, temperature_c, frequency, amplitude_m, cycles, time_step_s, rest_steps, output,
                law_source, method, tolerance, most_sweeps,
                lambda done, total: report(f"testing at {frequency:g} Hz", done, total),  # noqa: B023
                rig, scheme, energy, checkpoint, checkpoint_every, specimen,
            )  # fmt: skip
