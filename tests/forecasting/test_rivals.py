import numpy as np
import pytest

from asphalt_nscd.forecasting.rivals import hirsch, witczak
from asphalt_nscd.measurements.units import PSI


def test_hirsch_at_a_point_worked_by_hand(recipe):
    stone, binder = 0.946 / 2670, 0.054 / 1040
    air = 0.06
    vma = 100 * ((1 - air) * binder / (stone + binder) + air)
    vfa = 100 * (vma - 6) / vma
    g = abs(recipe.binder_modulus()[2]) / 3 / 6894.757
    x = vfa * 3 * g / vma
    pc = (20 + x) ** 0.58 / (650 + x**0.58)
    psi = pc * (4.2e6 * (1 - vma / 100) + 3 * g * vfa * vma / 10000) + (1 - pc) / (
        (1 - vma / 100) / 4.2e6 + vma / (3 * vfa * g)
    )
    found = hirsch(recipe)[2]
    assert abs(found) == pytest.approx(psi * PSI, rel=1e-6)
    assert np.degrees(np.angle(found)) == pytest.approx(-21 * np.log10(pc) ** 2 - 55 * np.log10(pc), rel=1e-6)


def test_witczak_at_a_point_worked_by_hand(recipe):
    """Bari & Witczak (2006), each coefficient beside what it multiplies."""
    p200, *passing = (100 * recipe.grading.passing_at(mm * 1e-3) for mm in (0.075, 4.75, 9.5, 19))
    r4, r38, r34 = (100 - share for share in passing)
    stone, binder = 0.946 / 2670, 0.054 / 1040
    filled = 0.94 * binder / (0.94 * binder + 0.06 * (stone + binder))
    g = abs(recipe.binder_modulus()[2]) / 3 / 6894.757
    lag = np.degrees(np.angle(recipe.binder_modulus()[2]))
    first = np.dot(
        [6.65, -0.032, 0.0027, 0.011, -0.0001, 0.006, -0.00014, -0.08, -1.06],
        [1, p200, p200**2, r4, r4**2, r38, r38**2, 6, filled],
    )
    second = np.dot([2.56, 0.03, 0.71, 0.012, -0.0001, -0.01], [1, 6, filled, r38, r38**2, r34])
    slow = np.exp(np.dot([-0.7814, -0.5785, 0.8834], [1, np.log10(g), np.log10(lag)]))
    log = -0.349 + 0.754 * g**-0.0052 * first + second / (1 + slow)
    assert witczak(recipe)[2] == pytest.approx(10**log * PSI, rel=1e-6)
