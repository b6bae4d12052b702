from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_diagnose import SCATTER, table

from asphalt_nscd.diagnosis.next_tests.further_tests import possible
from asphalt_nscd.diagnosis.next_tests.sweeps import Costs, metal_tests
from asphalt_nscd.diagnosis.search.diagnose import diagnose

pytestmark = pytest.mark.slow


def test_tests_to_come_measure_what_the_law_says_in_whatever_order_the_table_is():
    """At conditions tested that is what was measured there."""
    whole = table(4)
    few = replace(whole.subset(np.isin(whole.isotherm, [-10.0, 10.0, 30.0])), whole=None)
    mixed = replace(few.subset(np.random.default_rng(1).permutation(few.size)), whole=None)
    one, other = (possible(diagnose(each, draws=1000), Costs()) for each in (few, mixed))
    come = one.table
    for temperature, frequency in {*zip(few.isotherm.tolist(), few.frequency.tolist(), strict=True)}:
        done, new = (
            each.logarithm[(each.isotherm == temperature) & (each.frequency == frequency)]
            for each in (few, come.subset(np.arange(few.size, come.size)))
        )
        assert new.size > done.size
        assert np.abs(new - done.mean()).max() < 3.0 * SCATTER[2]
    n = few.size
    assert (metal_tests(mixed).temperature == metal_tests(few).temperature).all()
    assert other.table.modulus[n:] == pytest.approx(come.modulus[n:], rel=1e-6)
    assert other.linear.effects[n:] == pytest.approx(one.linear.effects[n:], rel=1e-4, abs=1e-6)
