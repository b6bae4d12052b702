"""The page on campaigns of one machine has the sizes that the nine NCAT campaigns give."""

from pathlib import Path

import pytest

import asphalt_nscd as an

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
def test_the_page_has_the_sizes_of_ncat():
    made = an.compare(
        sorted((ROOT / "data/ncat").glob("*_*.csv")), measured_in="tension-compression", draws=an.Draws(1000)
    )
    table = made.same_machine(an.Draws(1000)).table
    assert set(table["cause"]) == {"phase_offset"} and not table["named"].any()
    found = table.set_index("where")
    text = (ROOT / "docs/machine.md").read_text(encoding="utf-8")
    block = text.split("<!-- machine_measured -->\n")[1].split("<!-- end")[0]
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in block.splitlines()[2:]]
    assert len(rows) == 17
    for where, value, error in rows:
        assert float(value) == pytest.approx(found.loc[where, "value"], abs=0.03)
        assert float(error) == pytest.approx(found.loc[where, "std_error"], abs=0.03)
