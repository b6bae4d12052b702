from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from asphalt_nscd.diagnosis.causes._cause import EXCESS, MATERIAL, Cause, Complex, Expected, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations

# Powers of the softness with which it may fade: a film's excess goes with the square of the slope of ln|E*|, that of a
# skeleton is at the softest tests alone.
EXPONENTS = 2.0, 0.5, 1.0, 4.0


class FilmSoftening(Cause):
    """Binder films flow faster the more they are strained: the phase rises above what |E*| requires where it is soft.

    |E*| that falls with the softness is another law, which every law follows, and so is the phase that goes with its
    slope. What no law follows, and this is, are phases above that; |E*| stays as it is.
    """

    name = "film_softening"
    stage = MATERIAL
    alters_tests = False
    family = EXCESS
    parameters = (Parameter("excess_phase", "deg", 0.0, 15.0, 0.5),)
    expected = Expected(0.15, 1.5)  # deg: nine NCAT states have 2.0 at 40 degC
    plain = (
        "a softening of the binder films with strain",
        "(phase {} above what |E*| requires in the softest test)",
    )
    sentence = "the mix is not linear where it is soft: its phase lies above what |E*| requires"
    confirmed_by = "the softest tests again at half the strain, and a test on metal"

    def __init__(self, exponent: float = EXPONENTS[0]) -> None:
        self.exponent = exponent

    def variants(self) -> Sequence[Cause]:
        """It may fade in several ways towards the stiff tests."""
        return [FilmSoftening(exponent) for exponent in EXPONENTS]

    def shows(self, observed: Observations) -> bool:
        """Whether two isotherms or more were tested: on one, the law bends to it."""
        return observed.isotherms.size > 1

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """E* exp(i a s^p) (n,) [Pa], with softness s from 0 to 1; `values` (1,) is a [deg]."""
        return modulus * np.exp(1j * np.radians(values[0]) * softness(observed) ** self.exponent)


def softness(observed: Observations) -> Vector:
    """Place (n,) of ln|E*| between the stiffest tests of the table, 0, and the softest, 1."""
    # Quantiles, which one slip of a power of ten does not move far.
    soft, stiff = np.quantile(observed.table.logarithm.real, (0.02, 0.98))
    return np.clip((stiff - observed.logarithm.real) / max(stiff - soft, 1e-9), 0.0, 1.0)
