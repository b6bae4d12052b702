"""The bound of an error of temperature, against a regression of the shift alone."""

import numpy as np
import pytest
from attack import bound
from attack.mixes import LAWS, SHIFTS, Mix


def test_without_scatter_the_chamber_and_the_shift_alone_decide(monkeypatch):
    """Each isotherm gives its shift exactly: the leverage of a weighted polynomial says what an odd one leaves."""
    monkeypatch.setattr(bound, "VERY_CAREFUL", (4, (1e-5, 1e-5), (1e-4, 1e-4)))
    count, shift, chamber = 7, 3, 0.1
    found = bound._limits(0, count, shift, chamber)
    mix = Mix.draw(list(LAWS)[0], list(SHIFTS)[0], np.random.default_rng([bound.SEED, 0]))
    t = np.linspace(*bound.ENDS, count)
    along = SHIFTS[mix.shift][0]
    slope = (along(t + 1e-4, mix.constants) - along(t, mix.constants)) / 1e-4  # of ln time by a kelvin
    design = (t - t.mean())[:, None] ** np.arange(shift + 1) / slope[:, None]
    leverage = (np.linalg.qr(design)[0] ** 2).sum(axis=1)
    expected = (bound.THRESHOLD + bound.Z_95) * chamber / np.sqrt(1.0 - leverage[1:-1])
    assert found == pytest.approx(expected, rel=0.02)


def test_four_isotherms_leave_nothing_beside_three_constants():
    assert np.isinf(bound._limits(1, 4, 3, 0.0)).all()
