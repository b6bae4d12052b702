"""A few real-like tables through the diagnosis itself: bare ones get no confident name, and nothing fails."""

import pytest
from blind import real, reallike
from blind.real_plan import Task

pytestmark = pytest.mark.slow

SEED = 11


def rows(kind, *causes):
    return list(real.run([Task("drawn table", kind, causes, seed=SEED, shape="huet_sayegh")]))


@pytest.mark.parametrize("kind", reallike.KINDS)
def test_a_table_without_a_cause_gets_no_confident_name(kind):
    (row,) = rows(kind)
    assert not row["failed"] and row["wrong"] == 0, row


def test_an_offset_in_a_table_with_a_broken_isotherm_is_named_and_sized(monkeypatch):
    monkeypatch.setattr(real, "RATIOS_OF", {"phase_offset": (5.0,)})
    _, row = rows("broken_hot", "phase_offset")
    assert row["named"] and row["covered"] and row["added"] == 0, row
