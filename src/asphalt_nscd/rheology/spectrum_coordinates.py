"""Coordinates of order one in which a continuous law is fitted, with their bounds and starts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, logit

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.priors import REFERENCE_TEMPERATURE, USUAL
from asphalt_nscd.rheology.shift import SHIFTS
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum, parameter_names

Vector = NDArray[np.float64]

# Each parameter in the coordinate of the fit: its bounds, and the range of the random starts.
# Moduli over the largest norm, tau times the middle frequency, c1/c2 in decades/K and the activation energy over
# 1e5 J/mol are logarithms, as are delta, beta, gamma, v and w; h and k/h are log-odds. c2 is the curvature of the
# shift, its least value over it: a straight shift, c2 infinite, is then a short way off and not an endless valley.
RANGES = {
    "static_modulus": (-14.0, -0.1, -8.0, -4.0),
    "glassy_modulus": (-0.5, 3.0, 0.0, 1.0),
    "k": (-5.0, 5.0, -1.5, 0.0),
    "h": (-5.0, 5.0, -0.5, 2.0),
    "delta": (-5.0, 6.0, 0.0, 1.5),
    "tau": (-15.0, 15.0, -3.0, 8.0),
    "beta": (-3.0, 15.0, 2.0, 8.0),
    "gamma": (-3.5, 0.5, -2.0, -1.0),
    "v": (-4.0, 0.5, -2.5, -1.0),
    "w": (-3.0, 0.0, -1.0, -0.1),
    "c1": (-6.0, 1.0, -2.6, -1.4),
    "c2": (1e-3, 0.999, 0.1, 0.6),
    "activation_energy": (-5.0, 3.0, 0.0, 1.5),
}
MARGIN = 1e-2  # from a bound within which a fitted coordinate lies at it
SEED = 20200117  # of the random starts; any value, fixed so that a fit can be repeated
GUESSES = (1.2, 2.0)  # glassy modulus over the largest norm, of the starts from usual values
SLOPES = (0.08, 0.14, 0.2)  # decades/K of their shifts
TAUS = np.arange(-12.0, 13.0)  # ln of tau times the middle frequency, of the starts from usual values


class Coordinates:
    """Coordinates x (p,) of a law (of LAWS) with a shift (of SHIFTS), for given tests.

    Tests: `omega` (n,) in rad/s, `temperature` (n,) in degC, `largest` norm of E* in Pa. `reference` [degC] is of the
    shift; a glassy modulus is sought at least up to `largest_glassy` [Pa]. A law that lacks a parameter from which fits
    start is refused.
    """

    def __init__(
        self,
        law: str,
        shift: str,
        omega: Vector,
        temperature: Vector,
        largest: float,
        reference: float,
        largest_glassy: float = 0.0,
    ) -> None:
        self.law, self.shift, self.reference = LAWS[law], SHIFTS[shift], float(reference)
        self.own, self.of_shift = parameter_names(self.law), parameter_names(self.shift)
        self.names = self.own + self.of_shift
        missing = [name for name in ("glassy_modulus", "tau") if name not in self.own]
        missing += [f"a range for {name}" for name in self.names if name not in RANGES]
        if missing:
            raise InputError(f"law {law!r} cannot be fitted without {', '.join(missing)}; fit another law.")
        rate = float(np.sqrt(omega.min() * omega.max()))
        self.scales = {
            "static_modulus": largest,
            "glassy_modulus": largest,
            "tau": 1.0 / rate,
            "activation_energy": 1e5,
        }
        # The shift is singular at c2 below the coldest test; 5 K keeps the steps of the fit off it.
        coldest = min(float(temperature.min()), REFERENCE_TEMPERATURE)
        self.least_c2 = max(0.0, self.reference - coldest) + 5.0
        self.low, self.high, self.first, self.last = np.array([RANGES[name] for name in self.names]).T.copy()
        # Hot tests alone lie further below the glassy modulus; where no prior says so it is unseen anyway.
        glassy = self.names.index("glassy_modulus")
        self.high[glassy] = max(self.high[glassy], np.log(max(largest_glassy, largest) / largest))

    def build(self, x: Vector) -> Spectrum:
        """The law, with its shift, at the coordinates `x` (p,)."""
        given = dict(zip(self.names, x.tolist(), strict=True))
        values = {name: self.scales.get(name, 1.0) * float(np.exp(value)) for name, value in given.items()}
        if "h" in values:
            values["h"] = float(expit(given["h"]))
            # As a share of h, k is below it whatever the fit tries.
            values["k"] = values["h"] * float(expit(given["k"]))
        if "c2" in values:
            values["c2"] = self.least_c2 / given["c2"]
            values["c1"] *= values["c2"]
        shift = self.shift(
            **{name: values[name] for name in self.of_shift}, reference_temperature=self.reference
        )
        return self.law(**{name: values[name] for name in self.own}, shift=shift)

    def log_slopes(self, x: Vector) -> NDArray[np.float64]:
        """Derivatives (p, p) of the logarithms of the parameters (rows) by the coordinates (columns) at `x` (p,)."""
        slope = np.eye(x.size)
        if "h" in self.names:
            k, h = self.names.index("k"), self.names.index("h")
            slope[h, h] = slope[k, h] = expit(-x[h])
            slope[k, k] = expit(-x[k])
        if "c2" in self.names:
            c1, c2 = self.names.index("c1"), self.names.index("c2")
            slope[c1, c2] = slope[c2, c2] = -1.0 / x[c2]
        return slope

    def inside(self, x: Vector) -> NDArray[np.bool_]:
        """Whether each of the coordinates `x` (p,) is off its bounds."""
        return (x > self.low + MARGIN) & (x < self.high - MARGIN)

    def random_starts(self, count: int) -> NDArray[np.float64]:
        """Starts (count, p) drawn uniformly over the ranges of the coordinates, the same ones in every call."""
        return np.random.default_rng(SEED).uniform(self.first, self.last, (count, self.first.size))

    def usual_starts(self) -> Iterator[NDArray[np.float64]]:
        """Groups (t, p) of usual laws that differ by tau; the best of each group is a start."""
        for guess in (*GUESSES, USUAL["glassy_modulus"].median / self.scales["glassy_modulus"]):
            for slope in SLOPES:
                x = 0.5 * (self.first + self.last)
                for name, value in self._usual(guess, slope).items():
                    if name in self.names:
                        x[self.names.index(name)] = value
                # Off the bounds, at which a parameter would count as unseen.
                group = np.tile(np.clip(x, self.low + 2.0 * MARGIN, self.high - 2.0 * MARGIN), (TAUS.size, 1))
                group[:, self.names.index("tau")] = TAUS
                yield group

    def _usual(self, guess: float, slope: float) -> dict[str, float]:
        """Coordinates by name of a usual law: `guess` as in GUESSES, `slope` of its shift in decades/K."""
        k, h = USUAL["k"].median, USUAL["h"].median
        out = {
            "static_modulus": -6.0,
            "glassy_modulus": np.log(guess),
            "k": logit(k / h),
            "h": logit(h),
            "delta": np.log(USUAL["delta"].median),
            "beta": np.log(USUAL["beta"].median),
        }
        if "c2" in self.names:
            c2 = max(USUAL["c2"].median + self.reference - REFERENCE_TEMPERATURE, 1.5 * self.least_c2)
            out |= {"c1": np.log(slope), "c2": self.least_c2 / c2}
        else:
            usual = USUAL["activation_energy"].median * slope / USUAL["wlf_slope"].median
            out["activation_energy"] = np.log(usual / self.scales["activation_energy"])
        return out
