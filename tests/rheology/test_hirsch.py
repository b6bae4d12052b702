from __future__ import annotations

import pytest

from asphalt_nscd.rheology.hirsch import contact_share, hirsch_modulus, limiting_modulus

PSI = 4.4482216152605 / 0.0254**2  # Pa


def printed(shear, vma, vfa):
    """Christensen, Pellinen & Bonaquist (2003) in psi: contact volume Pc, then |E*|."""
    binder = 3.0 * shear / PSI
    pc = (20.0 + vfa * binder / vma) ** 0.58 / (650.0 + (vfa * binder / vma) ** 0.58)
    beside = 4.2e6 * (1.0 - vma / 100.0) + binder * vfa * vma / 10_000.0
    behind = 1.0 / ((1.0 - vma / 100.0) / 4.2e6 + vma / (vfa * binder))
    return pc, PSI * (pc * beside + (1.0 - pc) * behind)


@pytest.mark.parametrize("shear", [1e3, 1e6, 3e7, 1e9])
@pytest.mark.parametrize(("vma", "vfa"), [(14.0, 70.0), (18.0, 55.0)])
def test_the_equations_as_printed(shear, vma, vfa):
    pc, modulus = printed(shear, vma, vfa)
    assert contact_share(shear, vma, vfa) == pytest.approx(pc, rel=1e-9)
    assert hirsch_modulus(shear, vma, vfa) == pytest.approx(modulus, rel=1e-9)


def test_a_binder_as_stiff_as_stone_that_fills_all_voids_makes_stone():
    assert hirsch_modulus(4.2e6 * PSI / 3.0, 18.0, 100.0) == pytest.approx(4.2e6 * PSI, rel=1e-9)


def test_the_limit_has_a_binder_of_145_ksi():
    """R 84: |E*|max of VMA 17.9 and VFA 61.5, with 3 |G*| = 435 000 psi."""
    assert limiting_modulus(17.9, 61.5) == pytest.approx(printed(145e3 * PSI, 17.9, 61.5)[1], rel=1e-3)
