from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options


class Test(click.ParamType):
    """`15,10,laws/T15/f10.json`: temperature, frequency, and the file of the bond law of this test."""

    name = "T,f,file"

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        """A temperature [degC], a frequency [Hz] and a path of `T,f,file`."""
        try:
            # At most twice, for a path may hold commas.
            temperature, frequency, path = value.split(",", 2)
            return float(temperature), float(frequency), Path(path)
        except ValueError:
            self.fail(f"{value!r} is not of the form T,f,file.", param, context)


@click.command()
@click.argument("diagnosis", type=_options.File)
@click.option("--law", required=True, type=_options.File, help="Continuous law of the diagnosis.")
@click.option("--measured", required=True, type=_options.File, help="Measurements that were diagnosed.")
@_options.geometry
@click.option("--number", required=True, type=click.IntRange(0), help="Of the sample, from 0.")
@click.option("--amplitude-m", required=True, type=_options.POSITIVE, help="Of the simulated tests.")
@click.option(
    "--test", "tests", required=True, multiple=True, type=Test(), help="A test and its bond law to write."
)
@click.option("--rig-output", required=True, type=_options.File, help="Rig to write.")
@_options.gather("sample", number="number", amplitude="amplitude_m", tests="tests")
def command(
    diagnosis: Path, law: Path, measured: Path, geometry: Any, sample: dict[str, Any], rig_output: Path
) -> None:
    """Extend the simulation of one sample by what a diagnosis named: bond laws of its tests, and a rig."""
    from asphalt_nscd.diagnosis.simulation.extension import Sample, extend

    extend(diagnosis, law, measured, geometry, Sample(**sample), rig_output)
