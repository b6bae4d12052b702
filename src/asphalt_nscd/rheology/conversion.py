"""A continuous law at one temperature as a Kelvin chain, with a stated error."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.rheology.chain import KelvinChain

Modulus = Callable[[NDArray[np.float64]], NDArray[np.complex128]]

# a mix takes 11 over four decades to 0.1 %, 14 over six: more is a law that bends too sharply
MOST_ELEMENTS = 60
REACH = np.geomspace(0.3, 10.0, 12)  # factors by which times reach beyond the band, tried in turn
OMEGA = Range(low=1e-100, high=1e100)  # rad/s: their products are finite
FITTED, TESTED = 30, 300  # frequencies in a decade for the fit, and between them for the error


def kelvin_chain(
    modulus: Modulus, lowest_omega: float, highest_omega: float, tolerance: float = 1e-3
) -> tuple[KelvinChain, float]:
    """A continuous law at one temperature as a Kelvin chain, and its error over a band [rad/s].

    `modulus` gives E* [Pa] at angular frequencies (n,) [rad/s]. Elements are added, their retardation times evenly
    spaced on a logarithmic scale, until the error, max |ln(E_chain / E)|, is within `tolerance`; compliances are a
    non-negative least-squares fit, so that the chain is passive. Outside the band it is whatever follows from within.
    """
    if not 0.0 < lowest_omega <= highest_omega < np.inf:
        raise InputError(
            f"band from {lowest_omega:g} to {highest_omega:g} rad/s: give a lowest frequency that is "
            "positive and not above the highest."
        )
    with np.errstate(invalid="ignore"):
        ends = modulus(np.array([lowest_omega, highest_omega]))
    if not (np.isfinite(ends).all() and OMEGA.low <= lowest_omega and highest_omega <= OMEGA.high):
        raise InputError("the law says nothing finite there; give another temperature or frequency.")
    best = np.inf
    for elements in range(1, MOST_ELEMENTS + 1):
        # times beyond the band shape the law within it; how far beyond is best differs from law to law
        tries = [_fit(modulus, lowest_omega, highest_omega, elements, reach) for reach in REACH]
        # of equal errors the chain with fewer elements: each costs a variable of every bond in every step
        error, _, chain = min(tries, key=lambda found: found[:2])
        if chain is not None and error <= tolerance:
            return chain, error
        best = min(best, error)
    raise InputError(
        f"no Kelvin chain of {MOST_ELEMENTS} elements or fewer follows the law to {tolerance:g} from "
        f"{lowest_omega:g} to {highest_omega:g} rad/s, the best to {best:.2g}; "
        "allow a larger error or check the law."
    )


def _fit(
    modulus: Modulus, low: float, high: float, elements: int, reach: float
) -> tuple[float, int, KelvinChain | None]:
    """(error, number of elements left, chain) of one set of retardation times; None where nothing fits."""
    middle, half = np.sqrt(low * high), np.sqrt(high / low) * reach
    omega = _grid(low, high, FITTED)
    time = np.geomspace(1.0 / half, half, elements) / middle if elements > 1 else np.array([1.0 / middle])
    # compliances of all parts times the modulus: their sum is to be one, whatever the law's size
    i_omega = 1j * omega[:, None]
    parts = np.hstack([np.ones_like(i_omega), middle / i_omega, 1.0 / (1.0 + i_omega * time)])
    relative = parts * modulus(omega)[:, None]
    size = np.linalg.norm(relative, axis=0)
    system = np.vstack([relative.real, relative.imag]) / size
    # columns of equal length: NNLS holds the gradients of all against one tolerance
    share = nnls(system, np.concatenate([np.ones(omega.size), np.zeros(omega.size)]))[0] / size
    if not share.any():
        return np.inf, 0, None
    kept = share[2:] > 0.0
    with np.errstate(divide="ignore"):
        spring, dashpot = 1.0 / share[:2] / np.array([1.0, middle])
    springs = 1.0 / share[2:][kept]
    chain = KelvinChain(
        float(spring), float(dashpot), tuple(springs.tolist()), tuple((springs * time[kept]).tolist())
    )
    # the error is measured between the frequencies of the fit, where it is largest
    dense = _grid(low, high, TESTED)
    error = float(np.abs(np.log(chain.complex_modulus(dense) / modulus(dense))).max())
    return error, int(kept.sum()), chain


def _grid(low: float, high: float, in_a_decade: int) -> NDArray[np.float64]:
    return np.geomspace(low, high, max(3, round(in_a_decade * np.log10(high / low)) + 1))
