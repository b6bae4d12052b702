"""Commands made of functions and of the options of dataclasses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.cli import group
from asphalt_nscd.cli._options import offered, step
from asphalt_nscd.files.options import Ranged, option, options_of
from asphalt_nscd.specimen.settings import Vibration


@dataclass(frozen=True)
class Inner(Ranged):
    stroke: float = option("Stroke, mm.", 6e-3, key="stroke_mm", unit=1e-3, low=0.0, high=1.0)


@dataclass(frozen=True, kw_only=True)
class Outer:
    count: int = option("How many.", low=1)
    inner: Inner = Inner()
    kept: str = "not offered"


@step
def sample(
    files: tuple[Path, ...],
    *,
    outer: Outer,
    bonds: Bonds = offered("friction"),
    titles: tuple[str, ...] = option("Titles.", (), key="title"),
    numbers: Sequence[float] | None = option("Numbers.", None, above=0.0),
    page: bool = option("A page.", True),
) -> None:
    """Show what came."""
    click.echo(repr((files, outer, bonds.friction, titles, numbers, page)))


def answer(*arguments: str) -> str:
    return CliRunner().invoke(sample, arguments).output.strip()


def test_values_arrive_in_the_unit_of_the_field():
    given = "a b --count 2 --stroke-mm 7 --friction 0.3 --title x --title y".split()
    inner = Inner(0.007)
    expected = (Path("a"), Path("b")), Outer(count=2, inner=inner), 0.3, ("x", "y"), None, True
    assert answer(*given) == repr(expected)
    expected = (Path("a"),), Outer(count=1), Bonds.friction, (), (1.0, 2.5), False
    assert answer("a", "--count", "1", "--numbers", "1,2.5", "--no-page") == repr(expected)


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (("--count", "1"), ["'FILES...'"]),
        (("a",), ["'--count'"]),
        (("a", "--count", "0"), ["'--count'", "0 is not in the range x>=1"]),
        (("a", "--count", "1", "--stroke-mm", "1000.1"), ["'--stroke-mm'", "at least 0 and at most 1000."]),
        (("a", "--count", "1", "--stroke-mm", "nan"), ["'--stroke-mm'", "'nan'"]),
        (("a", "--count", "1", "--numbers", "0"), ["'--numbers'", "'0'"]),
        (("a", "--count", "1", "--poisson", "0.2"), ["--poisson"]),
    ],
)
def test_what_is_wrong_is_answer(arguments, names):
    assert all(name in answer(*arguments) for name in names)


COLD, ZERO = ("-273.1", "-273.15"), ("1e-9", "0")
RANGES = [
    *((step, "temperature_c", *COLD) for step in "chain-law cycle fit hold published-law ramp simulate".split()),
    *((step, "frequency_hz", *ZERO) for step in ("cycle", "fatigue", "simulate")),
    *(("chain-law", name, *ZERO) for name in ("lowest_hz", "highest_hz", "tolerance", "factor")),
    ("condense", "stand_by", "0", "-1"), ("diagnose", "jobs", "1", "0"), ("extend", "number", "0", "-1"),
    ("extend", "amplitude_m", *ZERO), ("export", "temperatures_c", *COLD), ("export", "frequencies_hz", *ZERO),
    ("fatigue", "finer", "0.1", "0.09"), ("fatigue", "finer", "1e4", "1.1e4"), ("fatigue", "strain", "0.1", "0.11"),
    ("fclib", "tolerance", *ZERO), ("reduce", "cycles", "1", "0"), ("serve", "port", "0", "-1"),
    ("serve", "port", "65535", "65536"),
]  # fmt: skip


@pytest.mark.parametrize(("step", "name", "inside", "outside"), RANGES)
def test_the_last_value_of_a_range_is_taken_and_the_next_is_not(step, name, inside, outside):
    (asked,) = (one for one in group.get_command(None, step).params if one.name == name)
    asked.type.convert(inside, asked, None)
    with pytest.raises(click.BadParameter):
        asked.type.convert(outside, asked, None)


def test_help_has_the_default_in_the_unit_of_the_option():
    context = click.Context(sample, show_default=True)
    words = " ".join(sample.get_help(context).split())
    assert "--stroke-mm NUMBER Stroke, mm. [default: 6.0]" in words
    assert "--count INTEGER RANGE How many. [x>=1; required]" in words and "kept" not in words


def test_a_default_comes_back_as_the_field_has_it():
    for name, declared in options_of(Vibration).items():
        assert declared.stored(declared.given(declared.default)) == getattr(Vibration(), name)
