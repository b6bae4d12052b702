from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from asphalt_nscd.cli import _options, _progress

_NUMERICS = "bending.case.Numerics"


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
@click.option("--law-source", default="", help="Source of the law, stored with the result.")
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
    help="Frequency of the head, Hz; repeatable, each with an --output of its own.",
)
@click.option(
    "--amplitude-m",
    default=None,
    type=_options.Of("bending.case.Load.amplitude_m"),
    help="Amplitude of the head, m; else the strain of the paper, whose specimen is moved by 63 um.",
)
@click.option(
    "--amplitude-n",
    default=None,
    type=_options.Of("bending.case.Load.amplitude_N"),
    help="Amplitude of the force, N: it is commanded, the displacement measured, and the weight tared.",
)
@click.option("--cycles", default=5.0, type=_options.Of("bending.case.Load.cycles"), help="Number of cycles.")
@click.option(
    "--time-step-s",
    default=5e-5,
    type=_options.Of(f"{_NUMERICS}.time_step"),
    help="Time step, s. Other tests than two-point bending take 200 --steps-per-cycle unless it is given.",
)
@click.option(
    "--steps-per-cycle",
    default=None,
    type=click.IntRange(20),
    help="Steps in a cycle of each frequency, by the scheme fitted to it; in place of --time-step-s and --scheme.",
)
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
    type=_options.Of(f"{_NUMERICS}.tolerance"),
    help="Relative change per sweep that stops Gauss-Seidel.",
)
@click.option(
    "--most-sweeps",
    default=50,
    type=click.IntRange(1),
    help="Largest number of Gauss-Seidel sweeps in a step.",
)
@click.option(
    "--rig",
    default=None,
    type=_options.File,
    help="Devices at the head and errors of the measuring channel, JSON.",
)
@click.option(
    "--scheme",
    default="euler",
    type=click.Choice(["euler", "fitted"]),
    help="Implicit Euler, or BDF2 fitted to the frequency: exact in steady oscillation, 100 steps a cycle do.",
)
@click.option(
    "--energy", is_flag=True, help="Keep the energy balance of a reduced run; condensed runs always keep it."
)
@click.option(
    "--frames",
    default=0,
    type=click.IntRange(0),
    help="Instants of the last cycle of which to keep the motion of all spheres and the forces of all bonds; 24 bytes "
    "a sphere and 12 a bond each, before they are packed.",
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
@_options.gather(
    "case", amplitude_m="amplitude_m", amplitude_N="amplitude_n", cycles="cycles", frames="frames"
)
@_options.gather(
    "numerics",
    time_step="time_step_s",
    rest_steps="rest_steps",
    method="method",
    scheme="scheme",
    tolerance="tolerance",
    most_sweeps="most_sweeps",
)
@_options.gather(
    "files",
    model="model",
    rig="rig",
    checkpoint="checkpoint",
    checkpoint_every="checkpoint_every",
    law_source="law_source",
)
@_options.gather(
    "tests", laws="laws", frequencies="frequencies", outputs="outputs", steps_per_cycle="steps_per_cycle"
)
def command(
    tests: dict[str, Any],
    case: dict[str, Any],
    numerics: dict[str, Any],
    files: dict[str, Any],
    temperature_c: float,
    excerpt: Path | None,
    energy: bool,
) -> None:
    """Simulate complex modulus tests at one temperature and write a file for each frequency."""
    laws, frequencies, outputs = tests["laws"], tests["frequencies"], tests["outputs"]
    count = len(frequencies)
    if len(outputs) != count or len(laws) not in (1, count):
        raise click.UsageError(
            f"{count} x --frequency-hz, {len(laws)} x --law and {len(outputs)} x --output; give an --output "
            "for each frequency, and one --law or one for each."
        )
    if files["checkpoint"] is not None and count > 1:
        raise click.UsageError("--checkpoint keeps one test; give one --frequency-hz.")
    from asphalt_nscd.bending.bending_test import TestFiles, damage, read_subject, simulate, told, unsettled
    from asphalt_nscd.bending.case import Load, Numerics, RunOptions
    from asphalt_nscd.measurements.kinds import usual_steps_per_cycle

    # Read once for all frequencies: 400 jobs of a study became 80.
    specimen, load = read_subject(files["model"], excerpt), Load(**case)
    steps = tests["steps_per_cycle"]
    source = click.get_current_context().get_parameter_source
    stepping = any(source(name) is not ParameterSource.DEFAULT for name in ("time_step_s", "scheme"))
    if not steps and not stepping and numerics["method"] in ("reduced", "condensed"):
        steps = usual_steps_per_cycle(specimen.geometry.test)
    for law, frequency, output in zip(laws * (count // len(laws)), frequencies, outputs, strict=True):
        if steps:
            numerics |= {"time_step": 1.0 / (frequency * steps), "scheme": "fitted"}
        with _progress.bars("steps") as report:
            options = RunOptions(
                lambda done, total: report(f"testing at {frequency:g} Hz", done, total),  # noqa: B023
                energy=energy,
                frames=load.frames,
            )
            columns = simulate(
                TestFiles(law=law, output=output, **files),
                temperature_c,
                load.at(frequency, specimen.geometry),
                Numerics(**numerics),
                options,
                specimen,
            )
        click.echo(told(columns))
        if columns["broken_bonds"]:
            click.echo(f"warning: {damage(columns)}", err=True)
        if doubt := unsettled(columns):
            click.echo(f"warning: {doubt}", err=True)
