"""Phases with the wrong sign are found; negative phases that a machine or a stiff mix makes are left alone."""

from __future__ import annotations

import numpy as np
import pytest
from test_slips import FREQUENCIES, campaign

from asphalt_nscd.measurements.signs import negative_phases, wrong_sign

SWEEP = "specimen == 'B' and temperature_C == 21.0"


def with_phases(phases, rows=SWEEP):
    table = campaign()
    table.loc[table.eval(rows), "phase_deg"] = phases
    return table


def test_a_right_table_has_none():
    assert wrong_sign(campaign()) is None


@pytest.mark.parametrize("place", range(6))
def test_one_phase_with_the_wrong_sign(place):
    phases = np.array([30.0, 29.0, 28.0, 26.0, 25.0, 24.0])
    phases[place] *= -1.0
    row, said = wrong_sign(with_phases(phases))
    table = campaign()
    assert table.eval(SWEEP)[row] and table["frequency_Hz"][row] == FREQUENCIES[place]
    assert said.startswith(
        f"the phase at {FREQUENCIES[place]:g} Hz is {phases[place]:.3g} deg, and the other "
    )
    assert said.endswith("deg: the sign is wrong; remove the minus sign.") and "specimen B at 21 degC" in said


def test_the_phase_below_the_lowest_lies_on_a_line_over_ln_f():
    phases = 30.0 - 3.0 * np.log(FREQUENCIES / FREQUENCIES[0])
    _, said = wrong_sign(with_phases(np.where(FREQUENCIES == FREQUENCIES[0], -phases, phases)))
    assert "is -30 deg, " in said and "say about +30 deg" in said


def test_all_phases_of_one_sweep_with_the_wrong_sign():
    row, said = wrong_sign(with_phases([-20.0, -19.0, -18.0, -18.0, -17.0, -7.0]))
    assert campaign().eval(SWEEP)[row]
    assert said.startswith("all phases of specimen B at 21 degC are negative (median -18 deg)")
    assert said.endswith(": the signs are wrong; remove the minus signs.")


def test_two_of_one_sweep_name_the_first():
    row, said = wrong_sign(with_phases([30.0, -29.0, 28.0, -26.0, 25.0, 24.0]))
    assert campaign()["frequency_Hz"][row] == 0.5 and "-29" in said


@pytest.mark.parametrize(
    ("phases", "told"),
    [
        ([8.0, 7.5, 7.0, 6.5, 6.0, -5.5], ""),  # less than 6 deg may be scatter
        ([16.0, 15.0, 14.0, 13.0, 12.0, -10.5], "+9 deg"),  # 12 less 0.2 for each of 15 Hz
        ([44.0, 43.0, 42.0, 41.0, 40.9, -33.0], "+40.6 deg"),  # within a fifth
        ([44.0, 43.0, 42.0, 41.0, 40.9, -31.0], ""),
        ([44.0, 43.0, 42.0, 20.0, 30.0, -29.0], "+30 deg"),  # a delay does not let phases rise
    ],
)
def test_a_sign_is_wrong_where_the_phase_turned_is_near_what_the_others_ask(phases, told):
    found = wrong_sign(with_phases(phases))
    assert found is None if not told else told in found[1]


def test_a_frequency_that_is_negative_in_most_sweeps_is_the_machine_s():
    table = with_phases(-15.0, "frequency_Hz == 25.0 and (specimen != 'A' or temperature_C > 0.0)")
    assert wrong_sign(table) is None
    assert wrong_sign(with_phases(-15.0, "frequency_Hz == 25.0 and specimen == 'B'")) is not None


@pytest.mark.parametrize("delay", [1e-3, 2e-3, 3e-3, 4e-3, 6e-3])
def test_a_delay_of_the_force_is_no_wrong_sign(delay):
    phases = np.array([18.0, 18.0, 17.5, 17.0, 16.5, 16.0]) - 360.0 * delay * FREQUENCIES
    assert wrong_sign(with_phases(phases)) is None


@pytest.mark.parametrize(
    "phases",
    [
        [3.0, 2.0, 1.5, 0.8, -0.4, -1.2],  # noise about zero
        [18.0, 17.0, 17.0, 16.0, 15.0, -4.0],  # a bad test, and no sign makes it right
        [18.0, 17.0, 17.0, 16.0, 15.0, -40.0],
    ],
)
def test_other_negative_phases_are_left_to_the_diagnosis(phases):
    assert wrong_sign(with_phases(phases)) is None


def test_phases_below_zero_are_told_where_nothing_says_that_their_sign_is_wrong():
    assert negative_phases(campaign()) == ""
    table = campaign()
    table.loc[[3, 7], "phase_deg"] = [-3.0, -1.0]
    told = negative_phases(table)
    assert told.startswith(f"2 of {len(table)} phases are below zero, at worst -3 deg")
    assert f"{table['frequency_Hz'][3]:g} Hz" in told
