"""An export whose name and header say two temperatures is refused only if its moduli belong to the other one."""

from __future__ import annotations

import pytest
from table_import.slips import refused, said
from test_targets import EXPORT, READINGS

from asphalt_nscd.table_import.campaign import read_campaign

AT_21 = 0.5  # |E*| at 21 degC over that at 4 degC


@pytest.fixture
def read(tmp_path):
    """Read specimens A and B at both temperatures, and C, whose name says 21 degC and whose header and readings 4."""

    def save(file, header, specimen, factor):
        text = EXPORT.format(header=header, specimen=specimen, readings=READINGS.format(header))
        for modulus in (9100, 8000, 5000):
            text = text.replace(f",{modulus}", f",{factor * modulus:g}")
        (tmp_path / file).write_text(text, encoding="utf-8")

    def read(factor):
        for specimen, level in (("A", 0.97), ("B", 1.03)):
            save(f"{specimen}4.csv", 4, f"Mix-{specimen}", level)
            save(f"{specimen}21.csv", 21, f"Mix-{specimen}", AT_21 * level)
        save("Mix-C_21C.csv", 4, "Mix-C", factor)
        return read_campaign([tmp_path])[0]

    return read


@pytest.mark.parametrize("factor", [0.5, 0.45, 0.53, 0.58])
def test_moduli_that_belong_to_the_other_temperature_are_refused(read, factor):
    said_of = (f"{ratio:.2f} times" for ratio in (factor, factor / AT_21))
    refused(read, factor, names=["Mix-C_21C.csv", *said_of])


@pytest.mark.parametrize("factor", [0.72, 0.70, 1.4, 0.2, 0.8, 1.0])
def test_a_specimen_that_is_soft_or_stiff_but_fits_neither_is_read(read, factor):
    """0.70: a third off at 4 degC, and 1.4 times too stiff for 21 degC."""
    assert said(read(factor), "the header is taken")


def test_moduli_of_zero_judge_nothing(read):
    read(0.0)  # refused further on
