"""The published table of campaigns of one machine has the sizes that the nine NCAT campaigns give."""

from pathlib import Path

import pandas as pd
import pytest

import asphalt_nscd as an

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
def test_the_published_table_has_the_sizes_of_ncat():
    made = an.compare(
        sorted((ROOT / "data/ncat").glob("*_*.csv")), measured_in="tension-compression", draws=an.Draws(1000)
    )
    table = made.same_machine(an.Draws(1000)).table
    assert set(table["cause"]) == {"phase_offset"} and not table["named"].any()
    found = table.set_index("where")
    rows = pd.read_csv(ROOT / "results/published/attack/machine_measured.csv").to_numpy().tolist()
    assert len(rows) == 17
    for where, value, error in rows:
        assert value == pytest.approx(found.loc[where, "value"], abs=0.03)
        assert error == pytest.approx(found.loc[where, "std_error"], abs=0.03)
