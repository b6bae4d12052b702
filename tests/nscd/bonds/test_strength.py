"""The three forms of the measure of yield are one."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.bonds.strength import bound, utilisation, utilisations


def test_tension_and_shear_count_and_compression_does_not():
    assert utilisation(-2.0, 0.0, 0.0) == 2.0
    assert utilisation(2.0, 0.0, 0.0) == 0.0
    assert utilisation(0.5, 3.0, -4.0) == 5.0


def test_the_solvers_use_one_measure_and_its_bound_holds():
    random = np.random.default_rng(5)
    reaction, strength = random.normal(size=(500, 3)), random.uniform(0.5, 2.0, 500)
    together = utilisations(reaction.ravel(), strength)
    each = [utilisation(*share) for share in reaction / strength[:, None]]
    np.testing.assert_allclose(together, each, rtol=1e-14)
    assert (np.array([bound(*share) for share in reaction / strength[:, None]]) >= each).all()
    # The bound of a sum is no more than the sum of the bounds.
    first, second = reaction[:250], reaction[250:]
    for a, b in zip(first, second, strict=True):
        assert bound(*(a + b)) <= (bound(*a) + bound(*b)) * (1 + 1e-15)
