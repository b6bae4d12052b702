"""First fits: the flexible spectrum and the Burgers laws of a table, from several starts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from asphalt_nscd.diagnosis.model.bases import CLEAR, BurgersAtEach, FlexibleSpectrum
from asphalt_nscd.diagnosis.model.joint import CONVERGED, Fitted, Joint
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations

Vector = NDArray[np.float64]
SPACING = 1.2  # of ln(relaxation time): Maxwell elements this close ripple by less than 0.1 %
MARGIN = 3.5  # of ln(time) beyond the tested band on either side
ROUGHNESS = (0.05, 0.1, 0.2, 0.4, 0.8, 1.6)
KELVIN_TIMES = 24  # tried as first guess of a Burgers law, over the tested band and a decade on either side
UNSEEN = np.exp(-14.0)  # relative compliance that no measured phase tells from none
NEAR = 3.0  # times the static modulus: tests whose loss modulus is below that see the end of the spectrum
WLF_STARTS = ((12.0, 60.0), (12.0, 100.0), (20.0, 200.0), (30.0, 280.0))  # C1, C2 [K] at mid temperature


def fit_spectrum(observed: Observations, noise: Noise) -> tuple[Joint, Fitted]:
    """Fit the flexible spectrum, of the roughness of largest marginal likelihood (Laplace), without any cause."""
    best: tuple[float, Joint, Fitted] | None = None
    # Least squares on so many elements has poor local minima: several starts.
    for c1, c2 in WLF_STARTS:
        base = _spectrum(observed, c1, c2)
        joint = Joint(observed, base, noise)
        law = _first_law(observed, base, c1, c2)
        fitted = joint.fit(law, np.zeros(len(observed.names)))
        # starts that end in the same minimum differ by rounding: the first of them is kept, on every machine
        if best is None or fitted.objective < best[0] - 1e-3:
            best = fitted.objective, joint, fitted
    assert best is not None
    return fit_roughness(*best[1:])


def fit_roughness(joint: Joint, fitted: Fitted, converged: float = CONVERGED) -> tuple[Joint, Fitted]:
    """Find the roughness of largest marginal likelihood, each fitted from where the one before ended."""
    scored = []
    for roughness in ROUGHNESS:
        # from smooth to rough, each from the fit before, so that it starts near its end
        smooth = Joint(joint.observed, replace(joint.spectrum, roughness=roughness), joint.noise)
        fitted = smooth.fit(fitted.law, fitted.scales, fitted.active, converged)
        scored.append((marginal_likelihood(smooth, fitted), smooth, fitted))
    return max(scored, key=lambda item: item[0])[1:]


def marginal_likelihood(joint: Joint, fitted: Fitted) -> float:
    """ln of the marginal likelihood by Laplace's approximation, up to what does not depend on the roughness."""
    sign, curvature = np.linalg.slogdet(fitted.precision)
    return -0.5 * (fitted.objective + curvature + price_of_roughness(joint.spectrum))


def price_of_roughness(spectrum: FlexibleSpectrum) -> float:
    """-2 ln of what a prior's width costs its law, up to a constant: else the roughest would always win."""
    return float(2.0 * (spectrum.times.size - 2) * np.log(spectrum.roughness))


def fit_burgers_at_each(observed: Observations, noise: Noise) -> tuple[Joint, Fitted]:
    """Fit a Burgers law for each temperature, the paper's baseline."""
    base = BurgersAtEach(observed.isotherms)
    law = [
        _first_burgers(observed.omega[at], observed.modulus[at])
        for at in (observed.isotherm == temperature for temperature in observed.isotherms)
    ]
    joint = Joint(observed, base, noise)
    return joint, joint.fit(np.log(np.concatenate(law)), np.zeros(len(observed.names)))


def _first_burgers(omega: Vector, modulus: NDArray[np.complex128]) -> Vector:
    """Em, eta_m, Ek, eta_k: given its Kelvin time, the compliance of a Burgers law is linear in the rest."""
    stress, rate = np.abs(modulus).max(), np.sqrt(omega.min() * omega.max())
    target = np.concatenate([np.ones(omega.size), np.zeros(omega.size)])
    best: tuple[float, Vector] | None = None
    for time in np.geomspace(0.1 / omega.max(), 10.0 / omega.min(), KELVIN_TIMES):
        terms = np.array([np.ones(omega.size), rate / (1j * omega), 1.0 / (1.0 + 1j * omega * time)])
        relative = (terms * modulus / stress).T
        compliance, miss = nnls(np.vstack([relative.real, relative.imag]), target)
        if best is None or miss < best[0]:
            # NNLS gives zeros, of which no logarithm can start
            em, eta_m, ek = stress / np.maximum(compliance, UNSEEN) / [1.0, rate, 1.0]
            best = miss, np.array([em, eta_m, ek, ek * time])
    assert best is not None
    return best[1]


def _spectrum(observed: Observations, c1: float, c2: float) -> FlexibleSpectrum:
    isotherms = observed.isotherms
    reference = float(isotherms[isotherms.size // 2])
    below, above = reference - float(isotherms[0]), float(isotherms[-1]) - reference
    away = observed.temperature - reference
    reduced = np.log(observed.omega) - np.log(10.0) * c1 * away / (max(c2, below + 2.0 * CLEAR) + away)
    low, high = -reduced.max() - MARGIN, -reduced.min() + MARGIN
    times = np.exp(np.linspace(low, high, max(int(np.ceil((high - low) / SPACING)) + 1, 4)))
    static = observed.static_modulus
    # by the loss modulus, to which a spring in parallel adds nothing
    near = static is not None and float(observed.modulus.imag.min()) < NEAR * static
    return FlexibleSpectrum(times, reference, below, above, 0.2, static, near)


def first_laws(joint: Joint) -> Iterator[Vector]:
    """Parameters (p,) from which fits of a law may begin: at each of WLF_STARTS."""
    for c1, c2 in WLF_STARTS:
        yield _first_law(joint.observed, joint.spectrum, c1, c2)


def _first_law(observed: Observations, base: FlexibleSpectrum, c1: float, c2: float) -> Vector:
    """Equal strengths with the sum of the largest modulus; the fit does the rest."""
    largest = float(np.abs(observed.modulus).max())
    m = base.times.size
    slope = np.linspace(0.0, -4.0, m)  # weaker where slower
    # the sum of the elements is to be a little more than the stiffest test, whatever their number
    strength = np.log(1.2 * largest) + slope - np.log(np.exp(slope).sum())
    # Beyond the coldest test, where WLF would be singular.
    c2 = max(c2, base.below + 2.0 * CLEAR)
    shift = [np.log(c1 / c2), base.log_odds(1.0 / c2), 0.0]
    return np.concatenate([strength, [np.log(1e-3 * largest)], np.zeros(len(base.GLASS)), shift])
