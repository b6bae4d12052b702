"""A delay put into a measured table, NCAT's S6-1_RH, is named however long it is."""

from pathlib import Path

import pandas as pd
import pytest

import asphalt_nscd as an

TABLE = Path(__file__).resolve().parents[2] / "data/ncat/S6-1_RH.csv"


@pytest.mark.slow
@pytest.mark.parametrize("delay_ms", [8.0, 12.0])
def test_a_long_delay_is_named(delay_ms):
    """From 5 ms on none was, since the search ended there."""
    table = pd.read_csv(TABLE, comment="#")
    table["phase_deg"] += 360.0 * table["frequency_Hz"] * 1e-3 * delay_ms
    found = an.diagnose(table, measured_in="tension-compression", draws=an.Draws(1000))
    delays = [
        rung["parameters"]["delay"] for rung in found.content["ladder"] if rung["cause"] == "channel_delay"
    ]
    assert len(delays) == 1 and delays[0]["unit"] == "s"
    assert 1e3 * delays[0]["value"] == pytest.approx(delay_ms, abs=1.5)
