"""Truth laws of drawn tables: spectra that the diagnosis does not fit, each with its own shift.

The centres are of the order of what is printed for real mixes (Olard & Di Benedetto 2003 for 2S2P1D,
the Huet-Sayegh examples of the LCPC), rounded and recalled, not copied from a table; the other two
families are shaped to the same range of modulus and phase. Each case draws its parameters around them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtr

GAS_CONSTANT = 8.314462618  # J/(mol K)
KELVIN = 273.15
REFERENCE = 15.0  # degC
BRANCHES = 60
MOST_DRAWS = 1000  # one in two is a mix
EXPONENTS = ("k", "h", "a", "b")

Complex = NDArray[np.complex128]


def huet_sayegh(s: Complex, k: float, h: float, delta: float) -> Complex:
    return 1.0 / (1.0 + delta * s**-k + s**-h)


def two_s2p1d(s: Complex, k: float, h: float, delta: float, ln_beta: float) -> Complex:
    return 1.0 / (1.0 + delta * s**-k + s**-h + 1.0 / (s * np.exp(ln_beta)))


def havriliak_negami(s: Complex, a: float, b: float) -> Complex:
    """Skewed towards long times: s^a at low, 1 - s^-ab at high frequency."""
    return 1.0 - (1.0 + s**a) ** -b


def havriliak_negami_mirrored(s: Complex, a: float, b: float) -> Complex:
    """Skewed towards short times: s^ab at low, 1 - b s^-a at high frequency; a spectrum while ab <= 1."""
    return (1.0 + s**-a) ** -b


def maxwell_ladder(s: Complex, width: float, skew: float) -> Complex:
    """Maxwell branches with skew-normal weights over log10 of time, `width` in decades."""
    x = np.linspace(-3.5, 1.5, BRANCHES)  # the skew leaves nothing above
    weight = np.exp(-0.5 * x**2) * ndtr(skew * x)
    step = s[..., None] * 10.0 ** (width * x)
    return (step / (1.0 + step)) @ (weight / weight.sum())


SHAPES = {
    "huet_sayegh": huet_sayegh,
    "two_s2p1d": two_s2p1d,
    "havriliak_negami": havriliak_negami,
    "havriliak_negami_mirrored": havriliak_negami_mirrored,
    "maxwell_ladder": maxwell_ladder,
}

# glassy, static [Pa]; log10_tau (s, at REFERENCE); the rest as in SHAPES.
CENTRES = {
    "huet_sayegh": {
        "glassy": 36e9, "static": 40e6, "log10_tau": -1.4, "k": 0.21, "h": 0.63, "delta": 2.2,
    },
    "two_s2p1d": {
        "glassy": 39e9, "static": 80e6, "log10_tau": -1.3, "k": 0.18, "h": 0.58, "delta": 2.0, "ln_beta": 5.5,
    },
    "havriliak_negami": {"glassy": 36e9, "static": 50e6, "log10_tau": -0.6, "a": 0.55, "b": 0.20},
    "havriliak_negami_mirrored": {"glassy": 36e9, "static": 50e6, "log10_tau": -1.8, "a": 0.27, "b": 2.3},
    "maxwell_ladder": {"glassy": 37e9, "static": 60e6, "log10_tau": -0.7, "width": 4.0, "skew": -3.0},
}  # fmt: skip
SHIFTS = ("wlf", "arrhenius", "quadratic", "straight")  # of the last two, log10 a_T over T is a polynomial

# What a mix may show in the paper's design; draws outside it are drawn again.
STIFF_CORNER, SOFT_CORNER = (-10.0, 40.0), (30.0, 3.0)  # degC, Hz
STIFF_RANGE, SOFT_RANGE = (18e9, 40e9), (0.7e9, 4e9)  # Pa
STIFF_PHASE, SOFT_PHASE = (1.5, 9.0), (28.0, 48.0)  # deg


@dataclass(frozen=True)
class Law:
    """E*(omega, T) = static + (glassy - static) shape(i omega tau a_T)."""

    shape: str
    parameters: dict[str, float]
    shift: str
    shift_parameters: dict[str, float]

    def log_shift(self, temperature: ArrayLike) -> NDArray[np.float64]:
        """ln a_T at temperature [degC]; 0 at REFERENCE."""
        above = np.asarray(temperature, dtype=float) - REFERENCE
        if self.shift == "wlf":
            c1, c2 = self.shift_parameters["c1"], self.shift_parameters["c2"]
            return -np.log(10.0) * c1 * above / (c2 + above)
        if self.shift == "quadratic" or self.shift == "straight":
            slope, bend = self.shift_parameters["slope"], self.shift_parameters.get("bend", 0.0)
            return -np.log(10.0) * slope * above * (1.0 - bend * above)
        inverse = 1.0 / (KELVIN + REFERENCE + above) - 1.0 / (KELVIN + REFERENCE)
        return self.shift_parameters["energy"] / GAS_CONSTANT * inverse

    def modulus(self, omega: ArrayLike, temperature: ArrayLike) -> Complex:
        """E* [Pa] at omega [rad/s] and temperature [degC], broadcast together."""
        own = dict(self.parameters)
        glassy, static, tau = own.pop("glassy"), own.pop("static"), 10.0 ** own.pop("log10_tau")
        s = 1j * np.asarray(omega, dtype=float) * tau * np.exp(self.log_shift(temperature))
        return static + (glassy - static) * SHAPES[self.shape](s, **own)


def draw_law(rng: np.random.Generator, shape: str | None = None) -> Law:
    """A mix around the centre of `shape`, or of a shape drawn."""
    shape = shape or str(rng.choice(list(SHAPES)))
    for _ in range(MOST_DRAWS):
        law = Law(shape, _around(CENTRES[shape], rng), *_draw_shift(rng))
        if _is_a_mix(law):
            return law
    raise ArithmeticError(f"no mix among {MOST_DRAWS} draws around the centre of {shape}")


def _around(centre: dict[str, float], rng: np.random.Generator) -> dict[str, float]:
    drawn = {}
    for name, value in centre.items():
        if name == "log10_tau":
            drawn[name] = value + rng.normal(0.0, 0.3)
        else:
            spread = 0.04 if name in EXPONENTS else 0.3 if name == "static" else 0.1
            drawn[name] = value * np.exp(rng.normal(0.0, spread))
    return {name: float(value) for name, value in drawn.items()}


def _draw_shift(rng: np.random.Generator) -> tuple[str, dict[str, float]]:
    kind = str(rng.choice(SHIFTS))
    if kind == "arrhenius":
        return kind, {"energy": float(rng.uniform(160e3, 240e3))}  # J/mol
    c2 = float(rng.uniform(80.0, 180.0))  # K
    slope = float(rng.uniform(0.10, 0.15))  # decades per kelvin at REFERENCE
    if kind == "wlf":
        return kind, {"c1": slope * c2, "c2": c2}
    return kind, {"slope": slope} | ({"bend": 1.0 / c2} if kind == "quadratic" else {})


def _is_a_mix(law: Law) -> bool:
    temperature, frequency = np.transpose([STIFF_CORNER, SOFT_CORNER])
    stiff, soft = law.modulus(2.0 * np.pi * frequency, temperature)
    return (
        STIFF_RANGE[0] < abs(stiff) < STIFF_RANGE[1]
        and SOFT_RANGE[0] < abs(soft) < SOFT_RANGE[1]
        and STIFF_PHASE[0] < np.degrees(np.angle(stiff)) < STIFF_PHASE[1]
        and SOFT_PHASE[0] < np.degrees(np.angle(soft)) < SOFT_PHASE[1]
        and 20e9 < law.parameters["glassy"] < 45e9
    )
