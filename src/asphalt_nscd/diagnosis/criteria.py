"""Thresholds of a name, chances of causes, usual errors of a laboratory: each with its unit, and what chose it.

What tunes one computation alone stands beside it in its own module: most in `screening`, as what makes a test suspect.

Each cause carries its own chance and usual size (`causes/`). "Drawn tables" are those of `trials/attack` and of a
program like it that is gone; docs/trust.md has what the attack gives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# Probability by the model from which a cause is established, and from which it, or one that fits as well, is told as
# possible.
NAMED, POSSIBLE = 0.95, 0.5
# Stated probability (`probability.stated`): the most of a name, by whether it is established; the most of one in doubt,
# and the ln odds at which half of these are right. Of 199 names in the invented tables 1001 to 1040 of `trials/attack`
# and in new faults of the nine NCAT states, right are: established 73 of 73, without a doubt 69 of 72. Of those in
# doubt in 96 tables of seed 20270101, 15 of 31 are right where the model gives less than 0.8, 32 of 40 up to 0.96, 22
# of 27 up to 0.995, and 42 of 62 above, before an error of the highest frequency displaced names.
SUREST = {True: 0.98, False: 0.96}
DOUBTED, HALF_FROM = 0.82, 0.5
ALPHA_PER_STEP = 0.005  # of naming anything at one rung of an empty table, over the whole catalogue
USUAL_THRESHOLD = 3.7  # standard errors that the largest of a usual catalogue reaches with that chance
# Normal quantile of 95 %: an effect at its detection limit is found so often. Texts, trials and tests repeat it, as 5.3
# (with the usual threshold), 0.95, 19 of 20, and 21 (`instructions.TOLD_APART`).
Z_95 = 1.645
TWENTY_TIMES = (
    6.0  # of -2 ln likelihood, 2 ln 20: what gains less than that is not told from what it gains on
)
CONFIDENCE = 1.96  # standard errors to either side of an estimate: 95 %
MOST_CAUSES = 4  # of a table: 813 tables of the first review had three at most
# Standard errors that an estimate keeps whatever isotherm, frequency or specimen is left out: with 2, drawn tables gave
# names that one isotherm carried alone.
SURVIVES = 3.0
# Standard errors that a size keeps beside each rival without a name. In drawn tables look-alikes of a cause that the
# catalogue lacks keep up to 5.1, right names at three times the limit 8.7 or more.
ENOUGH = 6.0
# On fewer, what the catalogue lacks passes for a cause: a gain over ln f for an offset of the phase.
LEAST_ISOTHERMS = 4
MANY_ISOTHERMS = 3  # at which errors of temperature speak for a shift of another form: drawn Kaelble shifts
MOST_SPECIMENS = 0.5  # share of the specimens at which a fault of one specimen may be named
# Phase [rad] by which a mix that is not linear may differ from a linear one nearly everywhere: of a tenth less |E*| at
# the softest tests, the slope of ln|E*| alone asks for half a degree at all others.
MIXES_TURN = float(np.radians(1.0))
ABSORBED = 3e-3  # share of a direction's square that the law must leave for it to be seen at all
# The same of a fault of one specimen and of a spring, which a fit decides: a law leaves 2e-4 of a spring.
FOLLOWED = 1e-6
WIDE_SPREAD = 1.2  # of the estimates of causes without a name, from which limits are multiplied by it
NOTICED = 0.5  # size of a process over the scatter of one test, below which it is none: half of empty tables have 0.3
HIDES = 1.0  # the same, from which it may be the shape of a cause that has one
NOTABLE = 3.0  # standard deviations from which the mean residual of a condition stands out


# Standard errors without a discrepancy of its place, from which a fault of one place is estimated beside it: those told
# have 4.9; and from which any other cause is.
NEARLY_SURE, WORTH_SIZING = 4.0, 2.5
# Of -2 ln likelihood, that a discrepancy of its own gains at an isotherm that is torn from the others. In drawn tables:
# 50 or more where gauges slip, at most 4 elsewhere.
TORN = 25.0


@dataclass(frozen=True)
class Usual:
    """What a laboratory adds: usual standard deviation `size`, and `spread` of its logarithm between laboratories."""

    size: float
    spread: float


# AASHTO T 378 allows a specimen 0.5 K: two standard deviations of both temperatures together, 0.25 K. NCAT has 0.2 K of
# specimens on an isotherm, the likeliest over its nine states. Careful laboratories stay far below.
LABORATORY = {
    "isotherm temperature": Usual(0.15, 1.0),  # K
    "specimen temperature": Usual(0.2, 0.7),  # K
    # What the isotherms of one specimen differ by in NCAT (data/ncat) and in two campaigns that are not shipped,
    # FD_Mix1 and one of an AMPT: 1 to 2 % and 0.1 to 0.3 deg.
    "mounting, modulus": Usual(0.01, 0.6),
    "mounting, phase": Usual(float(np.radians(0.15)), 0.6),  # rad
    # Of ln(relaxation time). NCAT's nine states give 0.03 to 0.5, most of them little beside this. Without it, loose
    # clamps of empty drawn tables of three or four specimens are 1.6 of their standard errors off (rms), with it 0.9.
    "specimen times": Usual(0.1, 1.0),
}
# Correlation between laboratories of the logarithms of both temperatures: one thermostat and one time of conditioning
# hold the isotherm and the specimens on it. A judgement; the spreads of LABORATORY stay what they are.
SAME_CONTROL = 0.7
# Size of a discrepancy over the scatter of one test: scale of its half-Cauchy prior. What is common to all isotherms is
# rarer than what breaks one: it must come from the machine.
DISCREPANCY = {"isotherm": 0.5, "all": 0.1, "specimen": 0.3, "spectrum": 1.0}

# Campaigns of one machine.
MOST_OF_MACHINE = 3
ALPHA_OF_MACHINE = 0.01  # of naming anything common to campaigns of a machine without a fault
# Share of campaigns in error by more than they say, and by how much: of 100 drawn ones without fault z is 1.05 rms, at
# most 3.8.
ASTRAY, LARGER = 0.1, 2.5
DIFFERENT = 0.003  # chance below which sizes are said to differ between campaigns; three times looked at
