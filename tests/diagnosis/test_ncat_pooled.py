"""What the nine NCAT campaigns of one machine share: a delay of no one size; no offset, for a mix makes such phases."""

from pathlib import Path

import pytest

import asphalt_nscd as an

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
def test_campaigns_of_ncat_share_a_delay_and_no_offset():
    made = an.compare(
        sorted((ROOT / "data/ncat").glob("*_*.csv")), measured_in="tension-compression", draws=an.Draws(1000)
    )
    table = made.same_machine(an.Draws(1000)).table
    assert set(table["cause"]) == {"channel_delay"}
    shared = table.set_index("where").loc["all campaigns"]
    assert shared["value"] == pytest.approx(0.200, abs=0.01)
    assert shared["std_error"] == pytest.approx(0.026, abs=0.01)
    page = (ROOT / "docs/machine.md").read_text(encoding="utf-8")
    assert f"A delay of {shared['value']:.2f} ms" in page and not shared["named"]
