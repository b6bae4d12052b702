"""The published tables are as the paper prints them."""

from pathlib import Path

import numpy as np
import pytest

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.rheology.published_laws import read_published

PAPER = Path(__file__).parents[2] / "data" / "paper"


def column(file, name):
    return read_csv(PAPER / file).numbers(name)


def test_counts_sum_to_the_number_of_spheres_generated():
    assert column("table2_counts.csv", "count").sum() == 14160


def test_counts_follow_the_grading():
    """The spheres of a size stand for what lies between its sieve and the next larger one of Table 1."""
    sieve, passing = (
        column("table1_grading.csv", "diameter_mm"),
        column("table1_grading.csv", "passing_percent"),
    )
    diameter, count = column("table2_counts.csv", "diameter_mm"), column("table2_counts.csv", "count")
    assert list(sieve[5::-1]) == [*diameter, 12.5]
    retained = np.diff(passing[5::-1])
    volume = count * diameter**3
    np.testing.assert_allclose(volume / volume.sum(), retained / retained.sum(), rtol=0.02)


def test_kpa_reading_gives_asphalt_its_stiffness():
    temperatures, laws = read_published(PAPER / "table3_burgers.csv")
    assert list(temperatures) == [-10, 0, 10, 15, 20, 30]
    assert laws[0].modulus_m == pytest.approx(39.8e9)
    norms = [abs(law.complex_modulus(2 * np.pi * 10)) for law in laws]
    assert norms == sorted(norms, reverse=True)


def test_table_4_has_a_row_for_each_law():
    assert list(column("table4_errors.csv", "temperature_C")) == list(
        read_published(PAPER / "table3_burgers.csv")[0]
    )
