"""How near bonds come to yield and gaps to closing, bounded while the coordinates stay within an envelope.

An excerpt lists the few bonds that matter and one bound for all others. Whatever that bound cannot settle
raises `BeyondExcerpt`, so an answer is always that of all bonds. Coordinates are those of `reduced_model`, q of motion
and s of stress, (k,).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

MARGIN = 1e-9  # relative; sums of a few dozen terms round by 1e-14

# Bonds listed in an excerpt: the first by yield in the driven motion, and by the next coordinate, which is that of
# the load if there is one; by each other coordinate; by their gap, and by its closing in the driven motion
LEADING, OTHERS, NARROW = 1500, 30, 300


class BeyondExcerpt(Exception):
    """The question needs all bonds."""


@dataclass(frozen=True)
class Rest:
    """Bounds of all bonds that are not listed: the largest contribution of each coordinate, the least gap.

    `utilised` (k,) is the yield measure per unit of s, `closed` (k,) the share of the gap that closes per unit of q,
    `travel` (k,) the metres of it per unit of q; `gap` in m.
    """

    utilised: np.ndarray
    closed: np.ndarray
    travel: np.ndarray
    gap: float


@dataclass(frozen=True)
class BondBounds:
    """Contributions of each coordinate, taken alone and positive, to the state of bonds.

    `number` (n,) of the bonds listed, ascending; `utilised` (n, k) is the yield measure per unit of s, `closed` (n, k)
    the share of the gap that closes per unit of q; `gap` (n,) in m; `rest` is None where all bonds are listed.
    """

    number: np.ndarray
    utilised: np.ndarray
    closed: np.ndarray
    gap: np.ndarray
    rest: Rest | None = None

    def utilisation(self, sigma: np.ndarray) -> np.ndarray:
        """Upper bound (n,) of the yield measure of listed bonds while |s| <= sigma (k,)."""
        return _row_sums(self.utilised, sigma)

    def candidates(self, sigma: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Numbers of the bonds that could yield, and of those whose gaps could close, within envelopes.

        `sigma` (k,) bounds |s|, `motion` (k,) bounds |q|. BeyondExcerpt where a bond that is not listed could.
        """
        rest = self.rest
        if rest is not None and not self._all_below_one(rest, sigma, motion):
            raise BeyondExcerpt
        may_yield = self.number[self.utilisation(sigma) > 1.0]
        return may_yield, self.number[_row_sums(self.closed, motion) > 1.0]

    def any_candidate(self, sigma: np.ndarray, motion: np.ndarray) -> bool:
        """Whether any bond could yield or any gap close within envelopes (k,); BeyondExcerpt if an unlisted could."""
        if (self.utilisation(sigma) > 1.0).any() or (_row_sums(self.closed, motion) > 1.0).any():
            return True
        if self.rest is not None and not self._all_below_one(self.rest, sigma, motion):
            raise BeyondExcerpt
        return False

    def largest_utilisation(
        self, sigma: np.ndarray, without: np.ndarray, least: float, of_all: bool = True
    ) -> float:
        """The largest bound of the yield measure while |s| <= sigma (k,), of bonds not in `without`, at least `least`.

        BeyondExcerpt where a bond that is not listed may have it, if `of_all`.
        """
        others = ~np.isin(self.number, without)
        largest = max(least, float(self.utilisation(sigma)[others].max(initial=0.0)))
        if of_all and self.rest is not None and float(self.rest.utilised @ sigma) * (1.0 + MARGIN) > largest:
            raise BeyondExcerpt
        return largest

    def smallest_gap(self, motion: np.ndarray) -> float:
        """Lower bound [m] of all gaps while |q| <= motion (k,); BeyondExcerpt where an unlisted one may have it."""
        smallest = float((self.gap * (1.0 - _row_sums(self.closed, motion))).min())
        if self.rest is not None and self.rest.gap - float(self.rest.travel @ motion) < smallest + (
            MARGIN * self.rest.gap
        ):
            raise BeyondExcerpt
        return smallest

    def head_bounds(self, bonds: np.ndarray, sigma: np.ndarray) -> np.ndarray:
        """For listed bonds (m,), (m, 2): while |s| <= sigma (k,), the yield measure is below [:, 0] |s_0| + [:, 1]."""
        part = self.utilised[self.places(bonds)]
        return np.column_stack([part[:, 0], part[:, 1:] @ sigma[1:]])

    def places(self, bonds: np.ndarray) -> np.ndarray:
        """Places (m,) in the list of bonds given by number (m,)."""
        return np.searchsorted(self.number, bonds)

    def excerpt(self) -> tuple[BondBounds, np.ndarray]:
        """Bounds of the bonds that come first by a coordinate or their gap, and of all others; places (m,) of those."""
        chosen = np.zeros(self.number.size, bool)
        leading = [LEADING] * 2 + [OTHERS] * (self.utilised.shape[1] - 2)
        for a, count in enumerate(leading):
            chosen[_first(self.utilised[:, a], count)] = True
            chosen[_first(self.closed[:, a], count if a else NARROW)] = True
        chosen[_first(-self.gap, NARROW)] = True
        left = ~chosen
        travel = self.closed[left] * self.gap[left, None]
        rest = Rest(
            self.utilised[left].max(axis=0, initial=0.0),
            self.closed[left].max(axis=0, initial=0.0),
            travel.max(axis=0, initial=0.0),
            float(self.gap[left].min(initial=np.inf)),
        )
        listed = BondBounds(
            self.number[chosen], self.utilised[chosen], self.closed[chosen], self.gap[chosen], rest
        )
        return listed, np.flatnonzero(chosen)

    @staticmethod
    def _all_below_one(rest: Rest, sigma: np.ndarray, motion: np.ndarray) -> bool:
        return max(float(rest.utilised @ sigma), float(rest.closed @ motion)) * (1.0 + MARGIN) <= 1.0


def _row_sums(contributions: np.ndarray, envelope: np.ndarray) -> np.ndarray:
    """Sums (n,); a matrix product would round a row by its place among the others."""
    return (contributions * envelope).sum(axis=1)


def _first(values: np.ndarray, count: int) -> np.ndarray:
    """Places of the `count` largest of (n,)."""
    # stable: of equal bonds the first, so that an excerpt has the same ones everywhere
    return np.argsort(-values, kind="stable")[:count]
