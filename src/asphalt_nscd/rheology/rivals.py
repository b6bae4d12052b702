"""Laws of all temperatures that compete for one table: fitted alike, and asked for what they have not seen."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares

from asphalt_nscd.rheology.fitting import log_residual
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_coordinates import Coordinates

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
STARTS = 4
FIRST_STEPS = 20  # from each start; the best of them goes on to the end
PULL = 1e-3  # towards the middle of the starts; a residual of ln E* is of the order of 1e-2
BRANCHES = 4


@dataclass(frozen=True)
class Rival:
    """A law in coordinates x (p,) of order one, and where its fits start.

    `modulus` gives E* [Pa] of x, omega [rad/s] and temperature [degC]; `starts` (s, p) are coordinates from which fits
    start; `low` and `high` (p,) bound the coordinates.
    """

    name: str
    modulus: Callable[[Vector, Vector, Vector], Complex]
    starts: NDArray[np.float64]
    low: Vector
    high: Vector

    def fit(
        self, omega: Vector, temperature: Vector, modulus: Complex, start: Vector | None = None
    ) -> Vector:
        """Coordinates (p,) fitted by least squares of ln E* at `omega` [rad/s] and `temperature` [degC].

        `modulus` is E* (n,) in Pa. What the tests do not determine stays near the middle of the starts, wherever the
        fit starts; without `start` (p,) the best of all is taken.
        """
        middle = self.starts.mean(axis=0)

        def fitted(one: Vector, most: int) -> OptimizeResult:
            return least_squares(
                # the pull settles what the tests leave open, so that a law left without an isotherm is not
                # fitted at random
                lambda x: np.append(
                    log_residual(modulus, self.modulus(x, omega, temperature)), PULL * (x - middle)
                ),
                np.clip(one, self.low + 1e-6, self.high - 1e-6),
                bounds=(self.low, self.high),
                max_nfev=most,
            )

        if start is None:
            # twenty steps tell a good start from a bad one; to the end from each would take as many times as
            # long as there are starts
            start = min((fitted(one, FIRST_STEPS) for one in self.starts), key=lambda fit: fit.cost).x
        return fitted(start, 200).x


def rivals(omega: Vector, temperature: Vector, modulus: Complex, reference: float) -> Iterator[Rival]:
    """Yield 2S2P1D and a Prony series of as many parameters, nine, and Huet-Sayegh, eight, all with a WLF shift.

    Tests (n,): `omega` in rad/s, `temperature` in degC, `modulus` E* in Pa; `reference` of the shift in degC.
    """
    largest = float(np.abs(modulus).max())
    for name, law in (("2S2P1D", "2s2p1d"), ("Huet-Sayegh", "huet-sayegh")):
        at = Coordinates(law, "wlf", omega, temperature, largest, reference)
        # of each group of usual laws those at ln(tau) = -2, 0 and 2, over the middle frequency
        usual = [group[len(group) // 2 - 2 : len(group) // 2 + 3 : 2] for group in at.usual_starts()]
        starts = np.concatenate([*usual, at.random_starts(STARTS)])
        yield Rival(name, _spectrum(at), starts, at.low, at.high)
    yield _prony(omega, temperature, largest, reference)


def _spectrum(at: Coordinates) -> Callable[[Vector, Vector, Vector], Complex]:
    """E* [Pa] of a continuous law by its coordinates, as `Rival` takes it."""

    def modulus(x: Vector, omega: Vector, temperature: Vector) -> Complex:
        with np.errstate(over="ignore", invalid="ignore"):
            return at.build(x).complex_modulus(omega, temperature)

    return modulus


def _prony(omega: Vector, temperature: Vector, largest: float, reference: float) -> Rival:
    """Static modulus, BRANCHES Maxwell branches with times evenly spaced in logarithm, and a WLF shift."""
    rate = float(np.sqrt(omega.min() * omega.max()))

    def modulus(x: Vector, omega: Vector, temperature: Vector) -> Complex:
        static, *weights, place, spacing, slope, curvature = x
        # the curvature as in `Coordinates`: the least c2 that the coldest test allows, over c2
        c2 = least / curvature
        shift = WLF(float(np.exp(slope)) * c2, c2, reference).factor(temperature)
        times = np.exp(place + spacing * np.arange(BRANCHES)) / rate
        reduced = 1j * (omega * shift)[:, None] * times
        return largest * (np.exp(static) + (np.exp(weights) * reduced / (1.0 + reduced)).sum(axis=1))

    least = max(0.0, reference - float(temperature.min())) + 5.0
    low = np.array([-14.0, *[-10.0] * BRANCHES, -15.0, 0.5, -6.0, 1e-3])
    high = np.array([0.0, *[1.0] * BRANCHES, 10.0, 6.0, 1.0, 0.999])
    middle = np.array([-5.0, *[-1.5] * BRANCHES, 0.0, 3.0, np.log(0.12), 0.3])
    starts = [
        middle + np.array([0.0] * (1 + BRANCHES) + [place, spacing - 3.0, 0.0, 0.0])
        for place in (-8.0, -5.0, -2.0)
        for spacing in (2.5, 3.5)
    ]
    return Rival("Prony", modulus, np.array(starts), low, high)


def left_out(
    rival: Rival, omega: Vector, temperature: Vector, modulus: Complex, groups: Vector, start: Vector
) -> Iterator[tuple[float, Vector]]:
    """Fit a law without each temperature, or each frequency: yields the value left out and the coordinates (p,).

    `omega` in rad/s, `temperature` in degC, `modulus` E* in Pa. `groups` (n,) is the temperature or frequency of each
    test; `start` (p,) are the coordinates of a fit to all tests.
    """
    for value in np.unique(groups):
        rest = groups != value
        yield float(value), rival.fit(omega[rest], temperature[rest], modulus[rest], start)
