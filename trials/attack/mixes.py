"""Mixes as they are: five laws of E*, each with a shift of its own. None is the law that the diagnosis fits.

A law gives ln E* [Pa] as a complex number, at x = ln(omega) at the reference temperature of 20 degC. Where a model
states |E*| alone, the phase is the one that causality requires of it, Kramers and Kronig in Bode's form:
phase(x) = (1/pi) int dln|E*|/dx' ln coth(|x - x'|/2) dx'.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
REFERENCE = 20.0  # degC
KELVIN = 273.15
GAS = 8.314  # J/(mol K)
STEP = 0.05  # of ln omega, in the integral
REACH = 46.0  # ln omega: twenty decades to either side


def causal_phase(log_norm: Callable[[Vector], Vector], x: Vector) -> Vector:
    """Phase [rad] at x = ln omega of a law without zeros on the right, whose ln|E*| is known everywhere.

    Over each cell the slope is that of its ends; the kernel is integrated exactly enough by Gauss' rule, in which its
    logarithmic peak at zero does no harm.
    """
    edges = np.arange(-REACH, REACH + STEP / 2, STEP)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    middle = 0.5 * (edges[1:] + edges[:-1])
    u = middle[:, None] + 0.5 * STEP * nodes
    kernel = 0.5 * STEP * (weights * -np.log(np.tanh(np.maximum(np.abs(u), 1e-12) / 2.0))).sum(axis=1)
    # Two cells beside the peak, int_0^h ln coth(u/2) du = h (1 - ln(h/2)) + h^3/36.
    peak = STEP * (1.0 - np.log(STEP / 2.0)) + STEP**3 / 36.0
    kernel[np.abs(middle) < STEP] = peak
    rise = np.diff(log_norm(x[:, None] + edges), axis=1) / STEP
    return rise @ kernel / np.pi


def _cam_hirsch(x: Vector, p: dict[str, float]) -> Complex:
    """Binder by Christensen, Anderson and Marasteanu, |E*| of the mix by Hirsch (Christensen and others 2003)."""

    def log_norm(x: Vector) -> Vector:
        psi = 145.0377e-6  # per Pa; Hirsch's constants are in psi
        binder = 1e9 * psi * np.exp(-np.logaddexp(0.0, p["width"] * (p["crossover"] - x)) / p["width"])
        filled = p["vfa"] * 3.0 * binder / p["vma"]
        contact = (20.0 + filled) ** 0.58 / (650.0 + filled**0.58)
        stone, mortar = 4.2e6 * (1.0 - p["vma"] / 100.0), 3.0 * binder * p["vfa"] * p["vma"] / 1e4
        series = (1.0 - p["vma"] / 100.0) / 4.2e6 + p["vma"] / (3.0 * p["vfa"] * binder)
        return np.log((contact * (stone + mortar) + (1.0 - contact) / series) / psi)

    return log_norm(x) + 1j * causal_phase(log_norm, x)


def _sigmoid(x: Vector, p: dict[str, float]) -> Complex:
    """The sigmoid of MEPDG for |E*|; its phase is causal."""

    def log_norm(x: Vector) -> Vector:
        rise = 1.0 + np.exp(-(p["at"] + p["slope"] * x / np.log(10.0)))
        return np.log(10.0) * (p["lower"] + (p["upper"] - p["lower"]) / rise)

    return log_norm(x) + 1j * causal_phase(log_norm, x)


def _havriliak_negami(x: Vector, p: dict[str, float]) -> Complex:
    s = np.exp(p["alpha"] * (x + p["log_tau"] + 0.5j * np.pi))
    return np.log(p["glassy"] - (p["glassy"] - p["static"]) * (1.0 + s) ** -p["beta"])


def _huet_sayegh(x: Vector, p: dict[str, float]) -> Complex:
    s = x + p["log_tau"] + 0.5j * np.pi
    slow = 1.0 + p["delta"] * np.exp(-p["k"] * s) + np.exp(-p["h"] * s)
    return np.log(p["static"] + (p["glassy"] - p["static"]) / slow)


def _bimodal(x: Vector, p: dict[str, float]) -> Complex:
    """Two bell-shaped spectra of relaxation times, as of mastic and of binder."""
    log_tau = np.linspace(-45.0, 45.0, 721)
    bell = [
        share * np.exp(-0.5 * ((log_tau - centre) / width) ** 2) / width
        for share, centre, width in (
            (1.0 - p["share"], p["log_tau"], p["width"]),
            (p["share"], p["log_tau"] + p["apart"], p["second"]),
        )
    ]
    weight = np.sum(bell, axis=0)
    s = 1j * np.exp(x[:, None] + log_tau)
    return np.log(p["static"] + (p["glassy"] - p["static"]) * (s / (1.0 + s)) @ (weight / weight.sum()))


# Ranges from which the parameters of a mix are drawn; moduli in Pa, ln of times in s.
LAWS: dict[str, tuple[Callable[[Vector, Any], Complex], dict[str, tuple[float, float]]]] = {
    "CAM-Hirsch": (
        _cam_hirsch,
        {"crossover": (1.5, 5.0), "width": (0.10, 0.14), "vma": (13.0, 17.5), "vfa": (60.0, 78.0)},
    ),
    "Havriliak-Negami": (
        _havriliak_negami,
        {
            "glassy": (2.4e10, 3.5e10), "static": (5e7, 3e8), "log_tau": (-5.0, -2.0), "alpha": (0.36, 0.46),
            "beta": (0.32, 0.5),
        },
    ),
    "bimodal": (
        _bimodal,
        {
            "glassy": (2.4e10, 3.5e10), "static": (5e7, 3e8), "log_tau": (-6.5, -4.5), "width": (5.5, 7.0),
            "share": (0.15, 0.3), "apart": (4.0, 7.0), "second": (2.5, 3.5),
        },
    ),
    "sigmoid": (_sigmoid, {"lower": (7.6, 8.3), "upper": (10.35, 10.52), "at": (0.4, 0.9), "slope": (0.45, 0.6)}),
    "Huet-Sayegh": (
        _huet_sayegh,
        {
            "glassy": (2.4e10, 3.5e10), "static": (3e7, 2e8), "log_tau": (-3.5, -1.0), "delta": (1.8, 2.8),
            "k": (0.18, 0.24), "h": (0.52, 0.66),
        },
    ),
}  # fmt: skip


def _wlf(t: Vector, p: dict[str, float]) -> Vector:
    return -np.log(10.0) * p["c1"] * (t - REFERENCE) / (p["c2"] + t - REFERENCE)


def _arrhenius(t: Vector, p: dict[str, float]) -> Vector:
    return p["energy"] / GAS * (1.0 / (t + KELVIN) - 1.0 / (REFERENCE + KELVIN))


def _kaelble(t: Vector, p: dict[str, float]) -> Vector:
    """WLF above a temperature, its mirror image below (Kaelble)."""

    def bent(t: Vector) -> Vector:
        return -np.log(10.0) * p["c1"] * (t - p["bend"]) / (p["c2"] + np.abs(t - p["bend"]))

    return bent(t) - bent(np.array(REFERENCE))


SHIFTS: dict[str, tuple[Callable[[Vector, Any], Vector], dict[str, tuple[float, float]]]] = {
    "WLF": (_wlf, {"c1": (14.0, 20.0), "c2": (125.0, 160.0)}),
    "Arrhenius": (_arrhenius, {"energy": (180e3, 225e3)}),
    "Kaelble": (_kaelble, {"c1": (14.0, 22.0), "c2": (120.0, 170.0), "bend": (-12.0, 8.0)}),
}


@dataclass(frozen=True)
class Mix:
    """One mix: a law of LAWS and a shift of SHIFTS with their parameters."""

    law: str
    parameters: dict[str, float]
    shift: str
    constants: dict[str, float]

    @classmethod
    def draw(cls, law: str, shift: str, rng: np.random.Generator) -> Mix:
        drawn, constants = (
            {name: float(rng.uniform(*ends)) for name, ends in ranges.items()}
            for ranges in (LAWS[law][1], SHIFTS[shift][1])
        )
        return cls(law, drawn, shift, constants)

    def log_modulus(self, frequency: Vector, temperature: Vector, slower: Vector | float = 0.0) -> Complex:
        """ln E* (n,) [Pa] at frequency [Hz] and temperature [degC]; slower: ln of a factor on all times."""
        log_shift = SHIFTS[self.shift][0](np.asarray(temperature, float), self.constants)
        x = np.log(2.0 * np.pi * frequency) + log_shift + slower
        return LAWS[self.law][0](x, self.parameters)
