"""Isotherms: readings of one temperature belong together, temperatures that were set apart do not."""

from pathlib import Path

import numpy as np
import pytest

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.measurements.campaign import (
    isotherm_notes,
    isotherms,
    nominal_temperatures,
    separate_sweeps,
)


def grouped(*temperature, tests=None):
    tests = range(len(temperature)) if tests is None else tests
    return isotherms(np.array(temperature, float), list(tests)).tolist()


@pytest.mark.parametrize(
    ("measured", "nominal"),
    [
        ((4.0, 4.1, 4.1, 20.9, 21.0), (4.1, 4.1, 4.1, 20.9, 20.9)),
        ((20.0, 22.0), (20.0, 22.0)),
        ((20.0, 21.0), (20.0, 21.0)),
        ((20.0, 20.6), (20.0, 20.6)),
        ((20.0, 20.5), (20.2, 20.2)),
        ((20.0, 20.0, 20.0, 20.4), (20.1, 20.1, 20.1, 20.1)),
        ((19.5, 20.0, 20.5), (20.0, 20.0, 20.0)),  # the whole range that T 378 allows
        ((19.4, 19.9, 20.4, 20.6), (19.4, 19.9, 20.4, 20.6)),  # a chain wider than that is left alone
        ((-10.1, -9.9, 9.9, 10.1), (-10.0, -10.0, 10.0, 10.0)),
        ((15.0, 15.0), (15.0, 15.0)),
        ((12.345,), (12.345,)),
    ],
)
def test_neighbours_within_half_a_degree_are_one_isotherm(measured, nominal):
    assert grouped(*measured) == pytest.approx(list(nominal))


def test_order_of_the_rows_does_not_matter():
    assert grouped(21.0, 4.1, 20.9, 4.0, 4.1) == pytest.approx([20.9, 4.1, 20.9, 4.1, 4.1])


def test_a_specimen_tested_at_both_temperatures_meant_two():
    at_10_hz = [("A", "10"), ("A", "10"), ("B", "10")]
    assert grouped(20.0, 20.4, 20.0, tests=at_10_hz) == [20.0, 20.4, 20.0]
    assert grouped(20.0, 20.4, 20.4, tests=[("A", "10"), ("A", "1"), ("B", "10")]) == [20.3] * 3


def table(**columns):
    rows = len(next(iter(columns.values())))
    return Table(
        Path("t.csv"),
        {name: list(map(str, values)) for name, values in columns.items()},
        [*range(2, rows + 2)],
    )


def test_targets_of_the_machine_decide():
    measured = [20.2, 20.4, 19.6, 21.9, 20.4]
    given = table(
        specimen="AABBB",
        frequency_Hz=[10, 1, 10, 1, 2],
        temperature_C=measured,
        nominal_temperature_C=[20, 20.6, "", "", ""],
    )
    assert nominal_temperatures(given, np.array(measured)).tolist() == [20.0, 20.6, 20.0, 21.9, 20.6]


@pytest.mark.parametrize(
    ("specimens", "readings", "targets", "isotherm"),
    [
        ("AABB", (21.0, 21.1, 20.9, 21.0), (20, 21), [21.0] * 4),  # two operators, one bath
        ("AABB", (20.0, 20.1, 20.2, 20.3), (20, 21), [20.0] * 4),
        ("AABB", (20.0, 20.2, 20.5, 20.7), (20, 21), [20.0] * 4),  # half a degree apart
        ("AAAB", (21.0, 21.1, 20.9, 21.0), (20, 21), [20.0, 20.0, 21.0, 21.0]),  # A was tested at both
        ("AABB", (20.1, 20.0, 20.9, 21.0), (20, 21), [20.0, 20.0, 21.0, 21.0]),  # and so was the bath
        ("AABB", (21.0, 21.1, 20.9, 21.0), (20, 22), [20.0, 20.0, 22.0, 22.0]),  # too far apart
    ],
)
def test_two_targets_held_at_one_temperature_are_one(specimens, readings, targets, isotherm):
    given = table(
        specimen=specimens,
        frequency_Hz=[10, 1, 10, 1],
        temperature_C=readings,
        nominal_temperature_C=np.repeat(targets, 2),
    )
    assert nominal_temperatures(given, np.array(readings)).tolist() == isotherm


def test_notes_say_what_was_put_together_and_what_is_off_its_target():
    measured, nominal = np.array([4.0, 4.1, 20.0, 36.2]), np.array([4.0, 4.0, 20.0, 37.0])
    together, off = isotherm_notes(measured, nominal)
    assert together == "Isotherms in degC: 4 (measured 4 to 4.1), 20, 37 (measured 36.2)."
    assert "1 of 4 tests, at worst 36.2 instead of 37 degC" in off
    assert isotherm_notes(nominal, nominal) == []


@pytest.mark.parametrize(
    ("sweeps", "belongs_to"),
    [
        ({"A": (0, 10, 20), "B": (0, 10, 20), "C": (0, 11.7, 20)}, {11.7: 10.0}),
        ({"A": (0, 10, 20), "B": (0, 10, 21.7), "C": (1.5, 10, 20)}, {1.5: 0.0, 21.7: 20.0}),
        ({"A": (0, 10, 20), "B": (0, 11.7, 20)}, {11.7: 10.0}),  # the rounder of two
        ({"A": (-8.3, 0, 20), "B": (-10, 0, 20)}, {-8.3: -10.0}),
        ({"A": (0, 10, 20), "B": (0, 13, 20)}, {}),  # targets are so far apart
        ({"A": (0, 10, 20), "B": (0, 10, 11.7, 20)}, {}),  # B was tested at both
        ({"A": (0, 10, 20), "B": (0, 10, 20), "C": (0, 12, 20), "D": (0, 12, 20)}, {}),  # so were two
        ({"A": (10, 20), "B": (12, 20)}, {}),  # the grids have one temperature in common
    ],
)
def test_a_sweep_of_one_specimen_belongs_to_the_isotherm_that_it_lacks(sweeps, belongs_to):
    specimen = np.array([name for name, at in sweeps.items() for _ in at])
    given = np.array([t for at in sweeps.values() for t in at], float)
    expected = [belongs_to.get(t, t) for t in given]
    assert separate_sweeps(given, specimen).tolist() == expected
