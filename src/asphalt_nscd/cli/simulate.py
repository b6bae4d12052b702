from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click
from click.core import ParameterSource

from asphalt_nscd.bending.settings import Fitted, Load, Numerics
from asphalt_nscd.cli import _progress
from asphalt_nscd.cli._options import OUTPUTS, option, step
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.kinds import usual_steps_per_cycle


@step
def command(
    model: Path,
    *,
    excerpt: Path | None = option(
        "Excerpt of the model, made beside it: the model is read only where a test needs more, as for a break.",
        None,
    ),
    laws: tuple[Path, ...] = option("Law of the bonds, JSON; one for all tests or one for each.", key="law"),
    law_source: str = option("Source of the law, stored with the result.", ""),
    temperature_C: float = option("Temperature of the law, degrees Celsius.", above=-273.15),
    frequencies: tuple[float, ...] = option(
        "Frequency of the head, Hz; repeatable, each with an --output of its own.",
        key="frequency_Hz",
        above=0.0,
    ),
    load: Load,
    fitted: Fitted,
    numerics: Numerics,
    rig: Path | None = option("Devices at the head and errors of the measuring channel, JSON.", None),
    energy: bool = option("Keep the energy balance of a reduced run; condensed runs always keep it.", False),
    outputs: tuple[Path, ...] = OUTPUTS,
) -> None:
    """Simulate complex modulus tests at one temperature and write a file for each frequency."""
    count = len(frequencies)
    if len(outputs) != count or len(laws) not in (1, count):
        raise click.UsageError(
            f"{count} x --frequency-hz, {len(laws)} x --law and {len(outputs)} x --output; give an --output "
            "for each frequency, and one --law or one for each."
        )
    from asphalt_nscd.bending.bending_test import TestFiles, damage, read_subject, simulate, told, unsettled
    from asphalt_nscd.bending.case import RunOptions, load_case

    # Read once for all frequencies: 400 jobs of a study became 80.
    specimen, steps = read_subject(model, excerpt), fitted.steps_per_cycle
    source = click.get_current_context().get_parameter_source
    stepping = any(source(name) is not ParameterSource.DEFAULT for name in ("time_step_s", "scheme"))
    if not steps and not stepping and numerics.method in ("reduced", "condensed"):
        steps = usual_steps_per_cycle(specimen.geometry.test)
    for law, frequency, output in zip(laws * (count // len(laws)), frequencies, outputs, strict=True):
        if steps:
            numerics = replace(numerics, time_step=1.0 / (frequency * steps), scheme="fitted")
        files = TestFiles(model, law, output, rig, law_source)
        with _progress.bars("steps") as report:
            options = RunOptions(
                lambda done, total: report(f"testing at {frequency:g} Hz", done, total),  # noqa: B023
                energy=energy,
                frames=load.frames,
            )
            case = load_case(load, frequency, specimen.geometry)
            columns = simulate(files, temperature_C, case, numerics, options, specimen)
        if "ended" in columns:
            # the record is written; E*, which the test is for, there is none
            raise InputError(f"{output}: {told(columns)}")
        click.echo(told(columns))
        if columns["broken_bonds"]:
            click.echo(f"warning: {damage(columns)}", err=True)
        if doubt := unsettled(columns):
            click.echo(f"warning: {doubt}", err=True)
