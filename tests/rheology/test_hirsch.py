from __future__ import annotations

import pytest

from asphalt_nscd.measurements.units import PSI
from asphalt_nscd.rheology.hirsch import STONE, contact_share, hirsch_modulus


@pytest.mark.parametrize("vma", [10.0, 18.0, 40.0])
def test_a_binder_as_stiff_as_stone_that_fills_all_voids_makes_stone(vma):
    """Both bounds are stone then, whatever their shares; half as stiff, the mix lies between its two parts."""
    assert hirsch_modulus(STONE * PSI / 3.0, vma, 100.0) == pytest.approx(STONE * PSI, rel=1e-12)
    assert 0.5 < hirsch_modulus(0.5 * STONE * PSI / 3.0, vma, 100.0) / (STONE * PSI) < 1.0


def test_a_binder_that_flows_leaves_the_contacts_of_dry_stones():
    dry = contact_share(0.0, 18.0, 60.0)
    assert dry == pytest.approx(20.0**0.58 / 650.0, rel=1e-12)
    assert hirsch_modulus(1e-3, 18.0, 60.0) == pytest.approx(dry * 0.82 * STONE * PSI, rel=1e-3)
