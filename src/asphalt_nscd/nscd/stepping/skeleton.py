"""Grains that touch beside their films: Hertz contacts that open, with Mindlin's friction, and their preload.

A contact under the overlap d of spheres with the effective radius R and the plane modulus E' presses with

    N = 4/3 E' sqrt(R) d^(3/2),   a = sqrt(R d),   k_n = 2 E' a,   k_t = 2 (1 - nu)/(2 - nu) k_n (Mindlin, stuck)

and slides by sliders in parallel, each with an equal share of k_t and a share of the limit mu N. At constant N they
follow Cattaneo and Mindlin, T = mu N (1 - (1 - k_t x/(1.5 mu N))^(3/2)), and Masing's rule on the way back. As N falls,
k_t falls, and what a slider holds falls with it: no energy comes out of an unloaded contact. As N grows, k_t does so
for further sliding alone.

Films between the same grains hold the preload, as they are left by compaction: at rest all bodies are in balance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.nscd.compiled import compiled

Vector = NDArray[np.float64]
SLIDERS = 8  # sheared to 0.8 of the limit mu N, they move within 1 % as Cattaneo and Mindlin say


@dataclass(frozen=True)
class Skeleton:
    """Contacts of a system: `bonds` (c,) beside which they act, and what they are.

    `radius` (c,) is the effective one, R1 R2/(R1 + R2) [m]; `overlap` (c,) that of the preload [m]; `plane_modulus` E'
    in Pa, E/(2 (1 - nu^2)) for two grains alike; `sliding` is k_t/k_n; `friction` the limit mu.
    """

    bonds: NDArray[np.int64]
    radius: Vector
    overlap: Vector
    plane_modulus: float
    sliding: float
    friction: float

    @classmethod
    def preloaded(
        cls,
        touching: NDArray[np.int64],
        radius: Vector,
        length: Vector,
        volume: float,
        pressure: float,
        grain: tuple[float, float] = (60e9, 0.2),
        friction: float = 0.5,
        seed: int = 0,
    ) -> Skeleton:
        """A skeleton with normal forces drawn exponentially about a mean that carries `pressure` [Pa] (Love and Weber).

        p = sum F l/(3 V): `length` l (c,) is between the centres [m], `volume` V that of the specimen [m3].
        `touching` (c,) lists bonds; `grain`: E [Pa] and Poisson's ratio.
        """
        modulus, poisson = grain
        plane = modulus / (2.0 * (1.0 - poisson**2))
        share = np.random.default_rng(seed).exponential(size=touching.size)
        force = share * 3.0 * pressure * volume / (share @ length)
        overlap = (force / (4.0 / 3.0 * plane * np.sqrt(radius))) ** (2.0 / 3.0)
        return cls(touching, radius, overlap, plane, 2.0 * (1.0 - poisson) / (2.0 - poisson), friction)

    @property
    def rows(self) -> NDArray[np.int64]:
        """The components (3 c,) of the contacts among those of all bonds."""
        return (3 * self.bonds[:, None] + np.arange(3)).ravel()

    def stiffness(self, overlap: Vector) -> Vector:
        """Stiffness (3 c,) [N/m] of the components of stuck contacts at these overlaps (c,) [m]."""
        normal = 2.0 * self.plane_modulus * np.sqrt(self.radius * np.maximum(overlap, 0.0))
        return (normal[:, None] * [1.0, self.sliding, self.sliding]).ravel()

    def normal_force(self, overlap: Vector) -> Vector:
        """N (c,) at these overlaps (c,) [m]."""
        return 4.0 / 3.0 * self.plane_modulus * np.sqrt(self.radius) * np.maximum(overlap, 0.0) ** 1.5


@dataclass
class Grip:
    """What contacts hold at one instant: `opening` (c, 3) since rest [m], `slider` (c, s, 2) [N], `stiffness` k_t (c,).

    `slipped` is what friction has taken since rest [J].
    """

    opening: Vector
    slider: NDArray[np.float64]
    stiffness: Vector
    slipped: float = 0.0

    @classmethod
    def rest(cls, skeleton: Skeleton) -> Grip:
        """Preloaded, and not yet sheared."""
        contacts = skeleton.bonds.size
        stiffness = skeleton.stiffness(skeleton.overlap)[1::3]
        return cls(np.zeros((contacts, 3)), np.zeros((contacts, SLIDERS, 2)), stiffness)

    def held(self, skeleton: Skeleton) -> float:
        """What the reactions, less the preload, have taken since rest [J]: 2/5 N d, in sliders, and by friction."""
        overlap, rest = skeleton.overlap - self.opening[:, 0], skeleton.overlap
        force, preload = skeleton.normal_force(overlap), skeleton.normal_force(rest)
        pressed = 0.4 * (force @ np.maximum(overlap, 0.0) - preload @ rest) + preload @ self.opening[:, 0]
        sheared = 0.5 * SLIDERS * (self.slider**2).sum(axis=(1, 2))
        stuck = self.stiffness > 0.0
        return float(pressed + (sheared[stuck] / self.stiffness[stuck]).sum()) + self.slipped

    def moved(self, skeleton: Skeleton, opening: Vector) -> tuple[Vector, Grip]:
        """Reactions (3 c,) [N] that push the bodies apart, less the preload, and the grip at openings (3 c,) [m]."""
        opening = opening.reshape(-1, 3)
        overlap = skeleton.overlap - opening[:, 0]
        normal = skeleton.normal_force(overlap)
        stiffness = skeleton.stiffness(overlap)[1::3]
        slider = np.empty_like(self.slider)
        tangential = np.empty((normal.size, 2))
        lost = _slide(
            self.slider,
            self.stiffness,
            stiffness,
            opening[:, 1:] - self.opening[:, 1:],
            skeleton.friction * normal,
            *_sliders(),
            slider,
            tangential,
        )
        reaction = np.column_stack([normal - skeleton.normal_force(skeleton.overlap), -tangential])
        return reaction.ravel(), Grip(opening.copy(), slider, stiffness, self.slipped + lost)


def _sliders() -> tuple[Vector, Vector]:
    """Shares (s,) of stiffness and of the limit mu N that make sliders a contact of Cattaneo and Mindlin."""
    # the stiffness left at x = k_t u / (1.5 mu N) is sqrt(1 - x): a slider that slips at the share q has x = 1 - q^2
    left = 1.0 - (np.arange(SLIDERS) + 0.5) / SLIDERS
    limit = 1.5 * (1.0 - left**2) / SLIDERS
    return np.full(SLIDERS, 1.0 / SLIDERS), limit / limit.sum()


@compiled
def _slide(before, stiff_before, stiff, moved, limit, share, capacity, after, force):
    """Write sliders at the end of a step to `after`, their sum (c, 2) to `force`; gives what friction takes [J]."""
    lost = 0.0
    for c in range(limit.size):
        force[c, 0] = force[c, 1] = 0.0
        softer = min(stiff_before[c], stiff[c])
        # unloaded, a slider gives back no more than it held; pressed further, it is stiffer for the rest of its way
        kept = softer / stiff_before[c] if stiff_before[c] > 0.0 else 0.0
        mean = 0.5 * (softer + stiff[c])
        for s in range(share.size):
            x, y = kept * before[c, s, 0], kept * before[c, s, 1]
            own = mean * share[s]
            x1, y1 = x + own * moved[c, 0], y + own * moved[c, 1]
            size, most = np.hypot(x1, y1), capacity[s] * limit[c]
            if size > most:
                x1, y1 = x1 * most / size, y1 * most / size
            after[c, s, 0], after[c, s, 1] = x1, y1
            force[c, 0] += x1
            force[c, 1] += y1
            work = 0.5 * ((before[c, s, 0] + x1) * moved[c, 0] + (before[c, s, 1] + y1) * moved[c, 1])
            held = held_before = 0.0
            if stiff[c] > 0.0:
                held = 0.5 * (x1 * x1 + y1 * y1) / (share[s] * stiff[c])
            if stiff_before[c] > 0.0:
                held_before = (
                    0.5 * (before[c, s, 0] ** 2 + before[c, s, 1] ** 2) / (share[s] * stiff_before[c])
                )
            lost += work - held + held_before
    return lost
