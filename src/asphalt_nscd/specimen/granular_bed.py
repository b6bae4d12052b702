"""Spheres in a box and how they advance: what is searched when, and the numbers of the time stepping."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.lanes import WIDTH
from asphalt_nscd.nscd.spheres import granular, neighbours
from asphalt_nscd.nscd.spheres.blocks import deal_blocks
from asphalt_nscd.nscd.spheres.laws import FORCE, WITH_COUPLE, ContactLaw
from asphalt_nscd.nscd.spheres.slabs import Slabs, Workspace, slabs_of, workspace_for
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.trimming import layer_height

WALL = 5
"""The plane that is the top of the box; the last body of a bed."""
WALL_REACH = 3e-3  # m, further than for spheres: a moving plane alone calls for no search
SEARCH_EVERY = 25  # steps, for which the motion of each sphere is allowed for
FALLING = 0.01  # m/s, mean speed
# of a step while spheres fall: twelve seeds give the layers of thorough sweeps in three quarters of the time
FALLING_SWEEPS = 9
MOST_SWEEPS = 300
TOLERANCE = 2e-3
PENETRATION, FALLING_PENETRATION = 0.02, 0.1  # of the smallest radius
ALLOWED_OVERLAP = 0.005  # of the smallest radius
LARGEST_RATIO = 10.0  # of diameters: a heavier sphere sinks into light ones, which the sweeps do not notice


@dataclass(frozen=True)
class PouringNumerics:
    """Numerical choices of the preparation; each is written into the deposit file.

    `time_step` in s, `recovery_speed` (overlaps are undone by it at most) in m/s; all lengths in m: pairs are searched
    anew once a sphere moved half of `skin`; a resting pair takes part in a step below the gap `margin`; sweeps go on
    while the step would deepen an overlap by `penetration` (`falling_penetration` while the mean speed is above
    FALLING) or impulses change relatively by `tolerance` in the last one; `allowed_overlap` is left as it is.
    """

    time_step: float = 4e-4
    tolerance: float = 1e-3
    most_sweeps: int = 60
    falling_sweeps: int = (
        1_000_000  # after so many the tolerance is waived while the mean speed is above FALLING
    )
    penetration: float = np.inf
    falling_penetration: float = np.inf
    skin: float = 4e-4
    margin: float = (
        2e-5  # m, gap below which a resting pair takes part in a step; of moving pairs see _search
    )
    recovery_speed: float = 0.02
    allowed_overlap: float = 0.0

    @classmethod
    def of(cls, radius: np.ndarray, time_step: float) -> PouringNumerics:
        """Numerical choices for spheres of `radius` (n,) [m], in proportion to the smallest; `time_step` in s.

        Small overlaps are left everywhere in a layer. Undone at once, they would keep it in motion for ever; so those
        below ALLOWED_OVERLAP stay. An impact may need many sweeps, most steps need few: they end when the impulses
        hardly change and no step deepens an overlap by PENETRATION. A falling grain may enter another for a moment,
        which changes nothing of the layer.
        """
        smallest, largest = float(radius.min()), float(radius.max())
        # a sphere sinks into a grain of 1/1000 of its mass by 0.005 of the grain's radius, into one of
        # 1/27 000 by 0.48, while the sweeps end as converged
        if largest > LARGEST_RATIO * smallest * (1.0 + 1e-9):
            raise InputError(
                f"spheres of {2e3 * smallest:.3g} and {2e3 * largest:.3g} mm: diameters differ by more than "
                f"{LARGEST_RATIO:g} times, and masses by more than the sweeps over contacts can settle; leave out the "
                "smallest."
            )
        return cls(
            time_step=time_step,
            tolerance=TOLERANCE,
            most_sweeps=MOST_SWEEPS,
            falling_sweeps=FALLING_SWEEPS,
            penetration=PENETRATION * smallest,
            falling_penetration=FALLING_PENETRATION * smallest,
            allowed_overlap=ALLOWED_OVERLAP * smallest,
        )


@dataclass
class GranularBed:
    """Spheres in motion in a box; bodies n, n + 1, ... of `velocity` are the p planes.

    `position` (n, 3) and `radius` (n,) in m; `velocity` (n + p, 6) in m/s, linear and spin (surface velocity);
    `inverse_mass` (n + p,) in 1/kg; `plane_point` (p, 3) in m; `plane_normal` (p, 3) has unit vectors that point to the
    spheres; `gravity` (3,) in m/s2. `time` [s], `steps` and `sweeps` are those made so far. Any number of threads in
    `team` gives the same numbers.
    """

    position: np.ndarray
    radius: np.ndarray
    velocity: np.ndarray
    inverse_mass: np.ndarray
    plane_point: np.ndarray
    plane_normal: np.ndarray
    law: ContactLaw
    restitution: float = 0.0
    gravity: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, -9.81]))
    time: float = 0.0
    steps: int = 0
    sweeps: int = 0
    team: Team = field(default_factory=Team)

    def __post_init__(self) -> None:
        self._start: np.ndarray | None = None
        self._other = np.empty(0, np.int64)
        self._slabs: Slabs | None = None
        self._workspace: Workspace | None = None
        self.drive = np.zeros(2)  # of the top wall: speed [m/s], largest impulse of a step [N s]
        self.overlap = 0.0  # m, the largest of all steps since it was last set to zero
        self._lowest: np.ndarray | None = None  # m, of each sphere and all after it, when they began to fall
        self._involved = self.radius.size  # spheres that are searched, the first ones
        self._searched_at = self.position
        self._planes_at = self.plane_point
        self._reach = 0.0  # m, within which pairs were searched
        self._extra = np.empty(0)  # (m,) m, what each sphere may move until the next search
        self._plane_reach = np.empty(0)  # (p,) m

    @classmethod
    def spheres_in_box(
        cls,
        position: np.ndarray,
        radius: np.ndarray,
        box: tuple[float, float, float],
        density: float,
        law: ContactLaw,
        restitution: float = 0.0,
    ) -> GranularBed:
        """Spheres at rest in a box [0, length] x [0, width] x [0, height]; plane 5 is its top.

        `position` (n, 3), `radius` (n,) and `box` in m, `density` of the spheres in kg/m3.
        """
        size = np.asarray(box, float)
        normal = np.concatenate([np.eye(3), -np.eye(3)])
        point = np.concatenate([np.zeros((3, 3)), np.diag(size)])
        mass = density * 4.0 / 3.0 * np.pi * radius**3
        return cls(
            position=position.copy(),
            radius=radius.copy(),
            velocity=np.zeros((radius.size + 6, 6)),
            inverse_mass=np.concatenate([1.0 / mass, np.zeros(6)]),
            plane_point=point,
            plane_normal=normal,
            law=law,
            restitution=restitution,
        )

    def let_fall(self) -> None:
        """The spheres are at rest, apart from each other and ordered by height; now they rain.

        Grains that began to fall together keep their distances, so only those near the ground and near the
        landed ones are searched.
        """
        low = self.position[:, 2] - self.radius
        # over the last sphere, with which all that still fall keep their distance: computed once
        self._lowest = np.minimum.accumulate(low[::-1])[::-1] - self.position[-1, 2]
        self._involved = 0

    def advance(self, numerics: PouringNumerics) -> tuple[int, float]:
        """Advance by one step; returns its sweeps and the relative change of the last one."""
        n, dt = self.radius.size, numerics.time_step
        self._involve(dt)
        speed = neighbours.speeds(self.velocity[:n])
        enough, penetration = numerics.most_sweeps, numerics.penetration
        if speed.mean() > FALLING:
            enough, penetration = numerics.falling_sweeps, numerics.falling_penetration
        meeting = self._search(numerics, speed)
        how = granular.StepNumerics(
            dt,
            numerics.recovery_speed,
            numerics.allowed_overlap,
            meeting,
            numerics.tolerance,
            penetration,
            enough,
            numerics.most_sweeps,
        )
        bodies = self.position, self.radius, self.velocity, self.inverse_mass
        planes, room = (self.plane_point, self.plane_normal), (self._slabs, self._workspace)
        moved = bodies, planes, *room, self.gravity, self.drive, self.law, self.restitution, how
        sweeps, change, overlap = self.team.run(granular.step, *moved)[0]
        self.plane_point = self.plane_point + dt * self.velocity[n:, :3]
        self.overlap = max(self.overlap, overlap)
        self.time += dt
        self.steps += 1
        self.sweeps += sweeps
        return sweeps, change

    def _involve(self, dt: float) -> None:
        """Count the spheres that may meet the landed ones within the step, directly or through a third."""
        if self._lowest is None:
            return
        # the last sphere is the highest: it falls free for longest
        falling, landed = self.velocity[self.radius.size - 1, 2], slice(0, self._involved)
        moved = self.velocity[landed, 2] != falling
        top = (self.position[landed, 2] + self.radius[landed])[moved].max(initial=self.plane_point[2, 2])
        rising = self.velocity[landed, 2].max(initial=0.0)
        near = top + 4.0 * self.radius.max() + 2.0 * dt * (rising - falling)
        lowest = self._lowest + self.position[-1, 2]
        self._involved = max(self._involved, int(np.searchsorted(lowest, near)))
        if self._involved == self.radius.size:
            self._lowest = None

    def _search(self, numerics: PouringNumerics, speeds: np.ndarray) -> float:
        """List the pairs that may meet within the step; returns the gap [m] below which they take part in it.

        An impact hands its speed on within the step, so a grain at rest may move as far as the fastest one.
        """
        m, n, dt, margin = self._involved, self.radius.size, numerics.time_step, numerics.margin
        speed = float(speeds[:m].max(initial=0.0)) + dt * float(np.linalg.norm(self.gravity))
        plane_speed = np.abs(self.velocity[n:, :3]).max(axis=1)
        if self.inverse_mass[-1] > 0.0:  # what its drive makes of the wall's speed within the step
            faster = plane_speed[WALL] + self.drive[1] * self.inverse_mass[-1]
            plane_speed[WALL] = max(plane_speed[WALL], min(abs(self.drive[0]), faster), self.drive[0])
        furthest = margin + 2.0 * dt * speed  # apart, two spheres that meet in this step
        nearing = margin + dt * (speed + plane_speed)  # (p,), a sphere and a plane
        meeting = max(furthest, float(nearing.max()))
        if self._start is not None and self._start.size == m + 1:
            moved = neighbours.moved_beyond(self.position, self._searched_at, self._extra)
            planes_moved = np.abs(self.plane_point - self._planes_at).max(axis=1)
            planes_valid = moved + planes_moved + nearing < self._plane_reach
            if 2.0 * moved + furthest < self._reach and planes_valid.all():
                return meeting
        position, radius = self.position[:m], self.radius[:m]
        if furthest > 2.0 * numerics.skin:  # a rain of grains: a list for this step alone, but a short one
            self._reach = 0.0
            closing = neighbours.closing_speeds(self.team, position, radius, self.velocity[:m, :3], furthest)
            # deeper down, impacts come through others and are weaker
            reach, self._plane_reach = np.maximum(margin + dt * closing, 0.5 * numerics.skin), nearing
            self._extra = np.zeros(m)
        else:
            # a few fast grains shall not call for searches among all: what each moves is allowed for
            self._extra = np.minimum(SEARCH_EVERY * dt * speeds[:m], numerics.skin)
            self._reach = numerics.skin + furthest
            reach = np.full(m, self._reach)
            self._plane_reach = numerics.skin + nearing + np.where(plane_speed > 0.0, WALL_REACH, 0.0)
        within = neighbours.Reach(reach, self._extra, self._plane_reach)
        start, other = neighbours.find_pairs_within(
            self.team, position, radius, self.plane_point, self.plane_normal, within, n
        )
        impulse = np.zeros((other.size, 3))
        if self._start is not None:
            impulse = neighbours.carry_reactions(
                self.team, self._start, self._other, self.impulse, start, other
            )
        self._list(start, other)
        self.impulse = impulse
        self._searched_at, self._planes_at = position.copy(), self.plane_point.copy()
        return meeting

    def _list(self, start: np.ndarray, other: np.ndarray) -> None:
        """Take these pairs, dealt into slabs and blocks, and a workspace that fits them."""
        self._start, self._other = start, other
        if self._workspace is None:
            numbers = WITH_COUPLE if self.law.rolling else FORCE
            self._workspace = workspace_for(0, self.inverse_mass.size, len(self.plane_point), numbers)
        last_body = self.inverse_mass.size - 1
        begin, pair, bodies = slabs_of(self.team, self.position[: start.size - 1], start, other, last_body)
        self._slabs, self._workspace = deal_blocks(self.team, begin, pair, bodies, self._workspace)

    @property
    def impulse(self) -> np.ndarray:
        """Impulse of the listed pairs (pairs, 3) [N s], on the second body; a copy, which may be assigned."""
        impulse = np.zeros((self._other.size, 3))
        if self._slabs is not None and self._workspace is not None:
            self.team.run(granular.take_out, impulse, self._slabs.pair, self._workspace.contacts)
        return impulse

    @impulse.setter
    def impulse(self, impulse: np.ndarray) -> None:
        assert self._slabs is not None and self._workspace is not None
        self.team.run(granular.lay_in, impulse, self._slabs.pair, self._workspace.contacts)

    def kinetic_energy(self) -> float:
        """Energy of motion of the spheres [J]; spin counts with 2/5 of its surface velocity squared."""
        n = self.radius.size
        square = (self.velocity[:n, :3] ** 2).sum(axis=1) + 0.4 * (self.velocity[:n, 3:] ** 2).sum(axis=1)
        moving = self.inverse_mass[:n] > 0.0  # the others are fixed
        return float(0.5 * (square[moving] / self.inverse_mass[:n][moving]).sum())

    def contacts(self, below: float) -> tuple[np.ndarray, np.ndarray]:
        """Bodies (c, 2) and gaps (c,) [m] of the contacts with a gap smaller than `below` [m]."""
        # searched anew: the list in use holds what may meet in a step, which may be less than is asked
        start, other = neighbours.find_pairs(
            self.position, self.radius, self.plane_point, self.plane_normal, below
        )
        first, second, gap = granular.near_pairs(
            self.position, self.radius, self.plane_point, self.plane_normal, start, other, below
        )
        return np.stack([first, second], axis=1), gap

    def top(self) -> float:
        """Height of the highest point of any sphere [m]."""
        return float((self.position[:, 2] + self.radius).max())

    def weight(self) -> float:
        """Weight of all spheres [N]."""
        return float(np.linalg.norm(self.gravity) * (1.0 / self.inverse_mass[: self.radius.size]).sum())

    def layer_height(self) -> float:
        """Twice the height of the centre of mass [m]."""
        return layer_height(self.position, self.radius)

    def hang_wall(self, height: float, mass: float) -> None:
        """Hang the top wall of `mass` [kg] at `height` [m] between rails, where `drive` moves it."""
        self.inverse_mass[-1] = 1.0 / mass
        self._put_wall(height)

    def fix_wall(self, height: float) -> None:
        """Put the top wall at `height` [m], where it stays."""
        self.inverse_mass[-1] = 0.0
        self._put_wall(height)

    def _put_wall(self, height: float) -> None:
        self.velocity[-1] = 0.0
        self.plane_point = self.plane_point.copy()
        self.plane_point[WALL, 2] = height

    def touching_wall(self) -> np.ndarray:
        """Indices (t,) of the spheres that the top wall pushed in the last step."""
        assert self._start is not None and self._slabs is not None and self._workspace is not None
        begin, end = self._slabs.begin[-2:]  # of the slab of pairs with the last body
        pushed = self._workspace.contacts[begin:end, 3:6].any(axis=1).ravel()
        pair = self._slabs.pair[WIDTH * begin : WIDTH * end][pushed]
        return np.sort(np.searchsorted(self._start, pair, side="right") - 1)

    def imbalance(self, time_step: float) -> tuple[float, float]:
        """How far the forces of the last step, `time_step` [s] long, are from equilibrium; both near zero at rest.

        First, by what fraction the force on all planes differs from the weight; second, the mean resultant on a sphere,
        its weight included, over the mean contact force.
        """
        n = self.radius.size
        weight = self.gravity / self.inverse_mass[:n, None] * time_step  # as impulses
        first, second, impulse = self._pushed()
        if not first.size:
            return 1.0, 1.0  # all in flight
        force = np.zeros_like(self.velocity[:, :3])
        # bodies have many contacts: indexed assignment would keep one of each
        np.add.at(force, first, -impulse)
        np.add.at(force, second, impulse)
        total = weight.sum(axis=0)
        carried = force[n:].sum(axis=0) @ total / (total @ total)
        resultant = np.linalg.norm(force[:n] + weight, axis=1).mean()
        return abs(float(carried) - 1.0), float(resultant / np.linalg.norm(impulse, axis=1).mean())

    def contact_forces(self, time_step: float) -> tuple[np.ndarray, np.ndarray]:
        """Bodies (c, 2) and forces (c, 3) [N] of the contacts that bore something in the last step.

        The step is `time_step` [s] long. Forces act on the second body, their opposites on the first; bodies n and
        above are planes.
        """
        first, second, impulse = self._pushed()
        return np.stack([first, second], axis=1), impulse / time_step

    def _pushed(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """First and second body (c,) and impulse (c, 3) [N s] of contacts that had one in the last step."""
        assert self._start is not None
        first = np.repeat(np.arange(self._start.size - 1), np.diff(self._start))
        impulse = self.impulse
        pushed = np.flatnonzero(impulse.any(axis=1))
        return first[pushed], self._other[pushed], impulse[pushed]
