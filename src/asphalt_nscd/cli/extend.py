from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli._options import GEOMETRY, option, step


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


@step
def command(
    diagnosis: Path,
    *,
    law: Path = option("Continuous law of the diagnosis."),
    measured: Path = option("Measurements that were diagnosed."),
    geometry: Any = GEOMETRY,
    number: int = option("Of the sample, from 0.", low=0),
    amplitude_m: float = option("Of the simulated tests.", above=0.0),
    tests: tuple[Any, ...] = option("A test and its bond law to write.", key="test", type=Test()),
    rig_output: Path = option("Rig to write."),
) -> None:
    """Extend the simulation of one sample by what a diagnosis named: bond laws of its tests, and a rig."""
    from asphalt_nscd.diagnosis.simulation.extension import Sample, extend

    extend(
        diagnosis,
        law,
        measured,
        geometry,
        Sample(number, amplitude_m, tests),
        rig_output,
    )
