"""Laws to export, and what a Prony series makes of them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from asphalt_nscd.rheology.parabolic import HuetSayegh, TwoS2P1D
from asphalt_nscd.rheology.shift import WLF, Arrhenius

CAMPAIGN = (-10.0, 4.0, 21.0, 37.0, 54.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)


PAPER = (-10.0, 15.0, 30.0), (3.0, 40.0)


AMPT = (4.0, 20.0, 40.0), (0.01, 10.0)


# Made up: a mix as in the paper's Table 3, one like FHWA's, one like an AMPT's, and other kinds.
SPECTRA = {
    "paper": (TwoS2P1D(100e6, 24e9, 0.21, 0.6, 2.3, 0.01, 300.0, WLF(24.0, 160.0, 15.0)), PAPER),
    "FD": (TwoS2P1D(130e6, 35e9, 0.18, 0.49, 2.5, 0.04, 2000.0, WLF(22.0, 185.0, 21.0)), CAMPAIGN),
    "AMPT": (TwoS2P1D(60e6, 31e9, 0.2, 0.55, 2.1, 0.02, 500.0, WLF(18.0, 150.0, 20.0)), AMPT),
    "Arrhenius": (
        HuetSayegh(50e6, 30e9, 0.2, 0.6, 2.0, 0.05, Arrhenius(190e3, 15.0)),
        ((0.0, 30.0), (1.0, 10.0)),
    ),
    "flowing": (
        TwoS2P1D(0.0, 30e9, 0.2, 0.55, 2.1, 0.02, 50.0, WLF(18.0, 150.0, 20.0)),
        ((10.0, 50.0), (0.01, 10.0)),
    ),
}


ROOT = Path(__file__).parents[2]


def stated(text):
    """Errors that a file states: % of |E*|, degrees."""
    joined = re.sub(r"\n\W+", " ", text)
    found = re.search(r"largest errors (less than )?(\S+) % of \|E\*\| and (less than )?(\S+) deg", joined)
    return float(found[2]), float(found[4])


def assert_within(found, law, text, allowed):
    """E* found within the errors stated, which are within those allowed; nearly reached by one."""
    percent, degrees = stated(text)
    assert percent <= allowed.percent and degrees <= allowed.degrees
    ratio = found / law
    assert 100.0 * np.abs(np.abs(ratio) - 1.0).max() <= percent
    assert np.degrees(np.abs(np.angle(ratio)).max()) <= degrees


def from_shear_and_bulk(shear, bulk):
    return 9.0 * bulk * shear / (3.0 * bulk + shear)


def relaxing(share, times, omega):
    """Modulus over its instantaneous value, of shares and relaxation times, at omega (n,)."""
    turned = 1j * omega[:, None] * np.asarray(times)
    return 1.0 - np.sum(share) + (np.asarray(share) * turned / (1.0 + turned)).sum(axis=1)
