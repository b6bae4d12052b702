"""A delay or an offset put into a measured table of NCAT is named however large it is."""

from pathlib import Path

import pandas as pd
import pytest

import asphalt_nscd as an

pytestmark = pytest.mark.slow

NCAT = Path(__file__).resolve().parents[2] / "data/ncat"


def test_a_long_delay_is_named(delay_ms=12.0):
    """From 5 ms on none was, since the search ended there."""
    table = pd.read_csv(NCAT / "S6-1_RH.csv", comment="#")
    table["phase_deg"] += 360.0 * table["frequency_Hz"] * 1e-3 * delay_ms
    found = an.diagnose(table, measured_in="tension-compression", draws=an.Draws(1000))
    delays = [
        rung["parameters"]["delay"] for rung in found.content["ladder"] if rung["cause"] == "channel_delay"
    ]
    assert len(delays) == 1 and delays[0]["unit"] == "s"
    assert 1e3 * delays[0]["value"] == pytest.approx(delay_ms, abs=1.5)


def test_a_large_offset_is_named(offset=-7.3):
    """The law bent to it, and a discrepancy of its isotherms took up the rest; 0.8 deg is the table's own."""
    table = pd.read_csv(NCAT / "N5-1_CA.csv", comment="#")
    table["phase_deg"] += offset
    found = an.diagnose(table, measured_in="tension-compression", draws=an.Draws(1000))
    (named,) = (rung for rung in found.content["ladder"] if rung["cause"] == "phase_offset")
    low, high = named["parameters"]["offset"]["interval_95"]
    assert low < offset + 0.77 < high
