"""The picture of the rules, against a graph small enough to know."""

from __future__ import annotations

import sys

import pytest
from workspace import ROOT

sys.path.insert(0, str(ROOT / "tools"))
from rule_graph import edges_of, places  # noqa: E402

pytestmark = pytest.mark.slow

DOT = """
digraph snakemake_dag {
	0[label = "all", style="rounded"];
	1[label = "fig09", style="rounded"];
	2[label = "simulate", style="rounded"];
	3[label = "condense", style="rounded"];
	4[label = "fig10", style="rounded"];
	5[label = "compile", style="rounded"];
	1 -> 0
	2 -> 1
	3 -> 2
	3 -> 4
	5 -> 2
}
"""


def test_arrows_that_a_longer_way_says_are_left_out():
    assert edges_of(DOT) == {("simulate", "figures and tables"), ("condense", "simulate")}


def test_each_box_stands_below_what_it_is_made_from():
    edges = edges_of(DOT)
    where = places(edges)
    assert {box: layer for box, (_, layer) in where.items()} == {
        "condense": 0,
        "simulate": 1,
        "figures and tables": 2,
    }
    assert len(set(where.values())) == len(where)
