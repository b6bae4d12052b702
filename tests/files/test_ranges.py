"""Ranges of numbers: the same in Python and at the command line."""

from __future__ import annotations

import re

import numpy as np
import pytest

from asphalt_nscd.bending.further_settings import FatigueLaw, Hold
from asphalt_nscd.bending.settings import Bonds, Load, Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.specimen.settings import Cutting, Pouring, Surfaces, Vibration

NAN, INF, BOX = float("nan"), float("inf"), (0.1, 0.1, 0.1)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Bonds(yield_Pa=0.0), "bonds: yield_Pa = 0; give a number at least 1."),
        (lambda: Bonds(yield_Pa=NAN), "bonds: yield_Pa = nan; give a number at least 1."),
        (lambda: Bonds(yield_Pa=1e-320), "bonds: yield_Pa ="),  # times an area: zero
        (lambda: Bonds(yield_Pa=-1.0), "bonds: yield_Pa = -1;"),
        (lambda: Bonds(friction=-1.0), "bonds: friction = -1; give a number at least 0 and at most 100."),
        (lambda: Bonds(friction=INF), "bonds: friction = inf;"),
        (lambda: Bonds(poisson=0.51), "bonds: poisson = 0.51; give a number greater than -1 and at most 0.5"),
        (lambda: Bonds(kt_over_kn=0.0), "bonds: kt_over_kn = 0;"),
        (lambda: Bonds(kt_over_kn=1e-7), "bonds: kt_over_kn = 1e-07;"),  # statics are not solved
        (lambda: Bonds(head="loose"), "bonds: head = 'loose' is not known; give one of free, blocked."),
        (lambda: Pouring(BOX, time_step=-1e-4), "pouring: time_step_s = -0.0001; give a number at least"),
        (lambda: Pouring(BOX, time_step=0.1), "pouring: time_step_s = 0.1;"),
        (lambda: Surfaces(friction=-0.5), "surfaces: friction = -0.5;"),
        (lambda: Pouring(BOX, seed=-1), "pouring: seed = -1; give a number at least 0."),
        (lambda: Pouring((0.1, NAN, 0.1)), "box_m = (0.1, nan, 0.1): give length, width and height"),
        (lambda: Vibration(stroke=np.float64(-1e-3)), "vibration: stroke_m = -0.001;"),
        (lambda: Vibration(duration=1e9), "vibration: duration_s = 1e+09;"),
        (lambda: Cutting(volume_reduction=1.0), "cutting: volume_reduction = 1;"),
        (lambda: Cutting(gap_max_mm=-2.0), "cutting: gap_max_mm = -2;"),
        (lambda: Cutting(gap_max_mm=1e300), "cutting: gap_max_mm = 1e+300;"),
        (lambda: Numerics(time_step=0.0), "numerics: time_step_s = 0;"),
        (lambda: Numerics(method="guess"), "numerics: method = 'guess' is not known; give one of reduced,"),
        (lambda: Numerics(rest_steps=-1), "numerics: rest_steps = -1;"),
        (lambda: Load(amplitude_m=NAN), "load: amplitude_m = nan;"),
        (lambda: Load(amplitude_m=1e-320), "load: amplitude_m ="),  # a modulus that is not finite
        (lambda: Load(amplitude_m=1e300), "load: amplitude_m = 1e+300;"),
        (lambda: Load(amplitude_N=1e300), "load: amplitude_N = 1e+300;"),
        (lambda: Load(frames=10**9), "load: frames = 1e+09;"),
        (lambda: Hold(duration_s=1e300), "hold: duration_s = 1e+300;"),
        (lambda: Hold(duration_s=1e-300), "hold: duration_s = 1e-300;"),
        (lambda: Hold(force_N=-1e300), "hold: force_N = -1e+300;"),
        (lambda: FatigueLaw(endured=1e-320), "fatiguelaw: endured ="),
        (lambda: Load(cycles=0.5), "load: cycles = 0.5;"),
        (lambda: Load(frames=-1), "load: frames = -1;"),
    ],
)
def test_values_out_of_range_are_one_sentence(make, sentence):
    with pytest.raises(InputError, match="^" + re.escape(sentence)):
        make()
