"""Pouring by gravity and vibrating with the top wall (section 3.2.1 of the paper)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from asphalt_nscd.nscd.spheres import granular, neighbours

REST_SPEED = 1e-3  # m/s, root mean square of all spheres
MANY = 20_000  # spheres, of which the sweeps of a step leave overlaps everywhere
ALLOWED_OVERLAP = 0.005  # of the smallest radius

Progress = Callable[[str, float, float], None]
"""Called with (stage, done, total), both in the unit of the stage."""


@dataclass(frozen=True)
class PouringNumerics:
    """Numerical choices of the preparation; each is written into the deposit file."""

    time_step: float = 4e-4  # s
    tolerance: float = 1e-3  # relative change of the impulses in the last sweep
    most_sweeps: int = 60
    skin: float = 4e-4  # m, pairs are searched again when a sphere has moved half of it
    margin: float = 2e-5  # m, gap below which a resting pair takes part in a step
    recovery_speed: float = 0.02  # m/s, at most, by which overlaps are undone
    allowed_overlap: float = 0.0  # m, left as it is

    @classmethod
    def of(cls, radius: np.ndarray, time_step: float) -> PouringNumerics:
        """Those for spheres of radius (n,) [m], with steps of time_step [s].

        The sweeps of a step leave small overlaps everywhere in a layer of many spheres; undone at once,
        they would keep it in motion for ever.
        """
        allowed = ALLOWED_OVERLAP * float(radius.min()) if radius.size > MANY else 0.0
        return cls(time_step=time_step, allowed_overlap=allowed)


@dataclass
class Granulate:
    """Spheres in a box, in motion. Bodies n, n + 1, ... of `velocity` are the planes."""

    position: np.ndarray  # (n, 3) m
    radius: np.ndarray  # (n,) m
    velocity: np.ndarray  # (n + p, 6) m/s, linear and spin (surface velocity)
    inverse_mass: np.ndarray  # (n + p,) 1/kg
    plane_point: np.ndarray  # (p, 3) m
    plane_normal: np.ndarray  # (p, 3), pointing to the spheres
    friction: float
    restitution: float = 0.0
    gravity: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, -9.81]))
    time: float = 0.0
    steps: int = 0
    sweeps: int = 0

    def __post_init__(self) -> None:
        self._start: np.ndarray | None = None
        self._other = np.empty(0, np.int64)
        self.impulse = np.zeros((0, 3))
        self._searched_at = self.position
        self._planes_at = self.plane_point

    @classmethod
    def in_box(
        cls, position: np.ndarray, radius: np.ndarray, box: tuple[float, float, float],
        density: float, friction: float, restitution: float = 0.0,
    ) -> Granulate:  # fmt: skip
        """Spheres at rest in a box [0, length] x [0, width] x [0, height]; plane 5 is its top."""
        size = np.asarray(box, float)
        normal = np.concatenate([np.eye(3), -np.eye(3)])
        point = np.concatenate([np.zeros((3, 3)), np.diag(size)])
        mass = density * 4.0 / 3.0 * np.pi * radius**3
        return cls(
            position=position.copy(), radius=radius.copy(),
            velocity=np.zeros((radius.size + 6, 6)),
            inverse_mass=np.concatenate([1.0 / mass, np.zeros(6)]),
            plane_point=point, plane_normal=normal, friction=friction, restitution=restitution,
        )  # fmt: skip

    def advance(
        self, numerics: PouringNumerics, plane_velocity: np.ndarray | None = None
    ) -> tuple[int, float]:
        """One step; planes move with plane_velocity (p, 3) [m/s]. Returns (sweeps, relative change)."""
        n, dt = self.radius.size, numerics.time_step
        if plane_velocity is not None:
            self.velocity[n:, :3] = plane_velocity
        # impacts redirect grains within a step, so grains in flight need a wider margin
        speed = np.sqrt((self.velocity[:n, :3] ** 2).sum(axis=1))
        margin = numerics.margin + 0.5 * dt * float(speed.mean())
        self._search(numerics, margin, float(speed.max()))
        _, sweeps, change = granular.step(
            self.position, self.radius, self.velocity, self.inverse_mass, self.plane_point,
            self.plane_normal, self.gravity, self._start, self._other, self.impulse, dt, self.friction,
            self.restitution, numerics.recovery_speed, numerics.allowed_overlap, margin,
            numerics.tolerance, numerics.most_sweeps,
        )  # fmt: skip
        self.plane_point = self.plane_point + dt * self.velocity[n:, :3]
        self.time += dt
        self.steps += 1
        self.sweeps += sweeps
        return sweeps, change

    def _search(self, numerics: PouringNumerics, margin: float, speed: float) -> None:
        n, dt = self.radius.size, numerics.time_step
        planes = float(np.abs(self.velocity[n:, :3]).max(initial=0.0))
        fastest = max(speed, planes) + dt * float(np.linalg.norm(self.gravity))
        # everything that two bodies may approach within this step must be on the list
        if self._start is not None:
            moved = np.sqrt(((self.position - self._searched_at) ** 2).sum(axis=1).max())
            moved = max(moved, np.abs(self.plane_point - self._planes_at).max())
            if 2.0 * (moved + dt * fastest) + margin < self._reach:
                return
        furthest = margin + 2.0 * dt * fastest
        if furthest > 2.0 * numerics.skin:  # a rain of grains: a list for this step alone, but a short one
            self._reach = 0.0
            closing = neighbours.closing_speeds(self.position, self.radius, self.velocity[:n, :3], furthest)
            reach, plane_reach = margin + dt * closing, furthest
        else:
            self._reach = numerics.skin + furthest
            reach, plane_reach = np.full(n, self._reach), self._reach
        start, other = neighbours.find_pairs_within(
            self.position, self.radius, self.plane_point, self.plane_normal, reach, plane_reach
        )
        if self._start is None:
            self.impulse = np.zeros((other.size, 3))
        else:
            self.impulse = neighbours.carry_reactions(self._start, self._other, self.impulse, start, other)
        self._start, self._other = start, other
        self._searched_at, self._planes_at = self.position.copy(), self.plane_point.copy()

    def kinetic_energy(self) -> float:
        """Of the spheres [J]; spin counts with 2/5 of its surface velocity squared."""
        n = self.radius.size
        square = (self.velocity[:n, :3] ** 2).sum(axis=1) + 0.4 * (self.velocity[:n, 3:] ** 2).sum(axis=1)
        return float(0.5 * (square / self.inverse_mass[:n]).sum())

    def contacts(self, below: float) -> tuple[np.ndarray, np.ndarray]:
        """Index pairs (c, 2) and gaps (c,) [m] of all contacts with a gap under `below` [m]."""
        start, other = neighbours.find_pairs(
            self.position, self.radius, self.plane_point, self.plane_normal, below
        )
        still = np.zeros_like(self.velocity)
        _, first, second, _, gap = granular.active_contacts(
            self.position, self.radius, still, self.plane_point, self.plane_normal, start, other, 1.0, below
        )
        return np.stack([first, second], axis=1), gap

    def top(self) -> float:
        """Height of the highest point of any sphere [m]."""
        return float((self.position[:, 2] + self.radius).max())


def settle(
    granulate: Granulate, numerics: PouringNumerics, rest_speed: float, longest: float,
    progress: Progress, stage: str,
) -> None:  # fmt: skip
    """Advance until the root mean square speed stays under rest_speed [m/s], at most `longest` [s]."""
    n = granulate.radius.size
    began = granulate.time
    check = max(1, round(5e-3 / numerics.time_step))
    calm = 0
    while granulate.time - began < longest and calm < 4:
        for _ in range(check):
            granulate.advance(numerics)
        rms = float(np.sqrt((granulate.velocity[:n, :3] ** 2).sum(axis=1).mean()))
        calm = calm + 1 if rms < rest_speed else 0
        progress(stage, min(granulate.time - began, longest), longest)


def vibrate(
    granulate: Granulate, numerics: PouringNumerics, stroke: float, frequency: float, duration: float,
    progress: Progress,
) -> None:  # fmt: skip
    """Drive the top wall by stroke/2 cos(2 pi f t) about the top of the layer.

    The paper says 6 mm. Read as +-6 mm the wall would have to pass through rigid grains; here the
    stroke is 6 mm from crest to crest and only its lower half reaches the layer.
    """
    level = granulate.top()
    omega = 2.0 * np.pi * frequency
    granulate.plane_point[5, 2] = level + stroke / 2.0
    steps = round(duration / numerics.time_step)
    plane_velocity = np.zeros((6, 3))
    for k in range(steps):
        height = level + stroke / 2.0 * np.cos(omega * (k + 1) * numerics.time_step)
        plane_velocity[5, 2] = (height - granulate.plane_point[5, 2]) / numerics.time_step
        granulate.advance(numerics, plane_velocity)
        if k % 50 == 49:
            progress("vibrating", k + 1, steps)
    granulate.velocity[-1, :3] = 0.0
