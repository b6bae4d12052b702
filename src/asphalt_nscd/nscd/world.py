"""Bonded and loose spheres in one world: bonds turn with their spheres, and whatever meets is a contact with friction.

The bonds of `stepping` are those of small displacements. Here a bond's opening is measured in axes that turn with its
two spheres (the mean of their rotations), so a rigid motion, however large, opens none:

    U = T(q) (p_j - p_i),   p = x + R a,   a: from a sphere's centre to the bond, in the axes of the sphere

A step is that of `stepping/condensed`, with the operator G of the configuration at its start, q+ = q + dt v+: a pair of
forces acts on one place, so linear and angular momentum stay as they are. Contacts are solved on the Delassus operator
of the bonded system, so a fragment stops as a whole. Stresses follow the openings U of the new configuration: G v plus
a part of second order, which a few solutions with the same factors find.

Times (v+ + v)/2 =: v', the balance of momentum is one of energy, of which each part is counted by itself:

    H+ - H = dt f v' + dt <sigma+, G v'> + p (u+ + u)/2

with H kinetic and p the impulses of contacts at openings u. Springs and dashpots take -<sigma+, U+ - U>, gravity gives
f dt v+. What the scheme takes is what these differ by, and the numerical dissipation of implicit Euler in the law.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU
from scipy.spatial.transform import Rotation

from asphalt_nscd.nscd.bonds.implicit_operator import factors
from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.bonds.strength import utilisations
from asphalt_nscd.nscd.bonds.system import clusters, opening_operator
from asphalt_nscd.nscd.contacts.couples import solve_with_couples
from asphalt_nscd.nscd.contacts.friction import solve_contacts
from asphalt_nscd.nscd.spheres.granular import near_pairs
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.spheres.neighbours import find_pairs
from asphalt_nscd.nscd.stepping.energy import Energies, diagonal_form

CLOSED = 1e-12  # m, by which a gap in contact may differ from zero
SETTLED = 1e-14  # m, by which openings may still change: the account of energy then closes to 1e-8 and better
TOLERANCE = 1e-10  # of the contacts
MOST_TURNS = 30  # of a step, in which it learns how far bonds turn


@dataclass(frozen=True)
class WorldBonds:
    """Bonds between spheres, as they are where no sphere has turned and none is stressed.

    `first` and `second` (b,) are spheres; the rows of `frame` (b, 3, 3) are the normal from first to second and two
    tangents; `point` (b, 3) [m] is where the bond acts, `weight` (3 b,) [m] as of a BondedSystem, `strength` (b,) in N.
    """

    first: np.ndarray
    second: np.ndarray
    frame: np.ndarray
    point: np.ndarray
    weight: np.ndarray
    strength: np.ndarray


@dataclass(frozen=True)
class Surroundings:
    """Planes, contact law and gravity that the spheres of a world meet.

    `plane_point` (p, 3) in m, `plane_normal` (p, 3) unit vectors that point to the spheres; `gravity` in m/s2.
    """

    plane_point: np.ndarray
    plane_normal: np.ndarray
    law: ContactLaw
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)


class World:
    """Spheres (n,), some of them bonded, which advance by steps of `dt` [s].

    `position` (n, 3) and `radius` (n,) in m; `mass` (n, 6) of translations [kg] and rotations [kg m2]. Rotations are
    those since the beginning.
    """

    def __init__(
        self,
        position: np.ndarray,
        radius: np.ndarray,
        mass: np.ndarray,
        bonds: WorldBonds,
        law: AnyLaw,
        around: Surroundings,
        dt: float,
    ) -> None:
        # asked so that NaN is refused; a bond of no strength would break for ever
        if not (bonds.strength > 0.0).all():
            raise ValueError("strength: each bond's must be greater than zero; leave weaker bonds out.")
        self.position, self.radius, self.mass = position.copy(), radius, mass.ravel()
        self.bonds, self.law, self.around, self.dt = bonds, law, around, dt
        self.rotation = Rotation.from_quat(np.tile([0.0, 0.0, 0.0, 1.0], (radius.size, 1)))
        self.velocity = np.zeros(self.mass.size)
        self.sigma = np.zeros(bonds.weight.size)
        self.memory = np.zeros((law.memory, bonds.weight.size))
        self.broken = np.zeros(bonds.first.size, bool)
        self.energies = Energies()
        self.time = 0.0
        self._arms = tuple(bonds.point - position[body] for body in (bonds.first, bonds.second))
        self._step_law = law.step(dt)
        self._load = (mass * [*around.gravity, 0.0, 0.0, 0.0]).ravel()

    @property
    def weight(self) -> np.ndarray:
        """w (3 b,) [m] of the bonds, zero for the broken ones."""
        return np.where(np.repeat(self.broken, 3), 0.0, self.bonds.weight)

    def opening(self) -> np.ndarray:
        """U (3 b,) [m] of the bonds since the beginning, in axes that turn with them."""
        return self._openings(self.position, self.rotation)[0]

    def throw(self, velocity: np.ndarray) -> None:
        """Set all at rest in motion at a `velocity` (n, 6) [m/s, rad/s]; the account takes it as work done."""
        self.velocity = velocity.ravel().copy()
        self.energies.actuator = self.energies.kinetic = 0.5 * float(self.mass @ self.velocity**2)

    def cut(self, bonds: np.ndarray) -> None:
        """Break the bonds marked in `bonds` (b,) as with a saw: what they store is lost."""
        now = self._stored()
        self.broken |= bonds
        self._lose(now)

    def advance(self) -> int:
        """Advance by one step and return how many contacts held.

        Bonds break one after another, the most overstressed first. Raises ArithmeticError if the motion is not finite.
        """
        dt, law, before = self.dt, self._step_law, self.velocity
        # where spheres stand now, though half a step ahead openings would err less: forces would then act beside the
        # places that momentum counts, and a spinning bar would lose 5 % of its spin in a turn of 300 steps
        opening, frame, point = self._openings(self.position, self.rotation)
        operator = opening_operator(self.bonds.first, self.bonds.second, frame, point, self.position)
        explicit = law.explicit_part(self.sigma, self.memory)
        contacts = _Contacts.near(self)
        stored = self._stored()
        while True:
            weight = self.weight
            scaled = dt * weight / law.compliance
            matrix = sparse.diags_array(self.mass) + operator.T @ (sparse.diags_array(scaled) @ operator)
            factor = factors(matrix.tocsc())
            push = self.mass * before + dt * self._load
            beyond = np.zeros_like(explicit)  # of the openings, what is not linear in the motion [m/s]
            # openings are not linear in the motion: what G v lacks of them enters the law, until it does not
            # change any more
            for _ in range(MOST_TURNS):
                start = factor.solve(push + operator.T @ (scaled * (explicit - beyond)))
                velocity = contacts.solve(start, factor, dt)
                if not np.isfinite(velocity).all():
                    raise ArithmeticError("the motion of a step is not finite")
                position, rotation = self._moved(dt * velocity)
                rate = (self._openings(position, rotation)[0] - opening) / dt
                last, beyond = beyond, rate - operator @ velocity
                if dt * np.abs(beyond - last).max(initial=0.0) <= SETTLED:
                    break
            sigma, memory = law.update(explicit, rate, self.memory)
            used = utilisations(weight * sigma, self.bonds.strength)
            worst = int(np.argmax(used)) if used.size else -1
            if worst < 0 or used[worst] <= 1.0:
                break
            # one at a time: a break unloads some of the bonds that were overstressed beside it
            self.broken[worst] = True
        self._lose(stored)
        self._count(velocity, sigma, memory, rate, operator, contacts)
        self.position, self.rotation, self.velocity = position, rotation, velocity
        self.sigma, self.memory = sigma, memory
        self.time += dt
        return contacts.met

    def fragments(self) -> np.ndarray:
        """Number of the fragment that each sphere belongs to (n,), the largest fragment being 0."""
        left = ~self.broken
        number = clusters(self.bonds.first[left], self.bonds.second[left], self.radius.size)
        # the largest first; stable, so that equal ones keep their order from run to run
        order = np.argsort(-np.bincount(number), kind="stable")
        return np.asarray(np.argsort(order)[number])

    def _moved(self, motion: np.ndarray) -> tuple[np.ndarray, Rotation]:
        """Positions and rotations after motions (6 n,) [m, rad]."""
        by_body = motion.reshape(-1, 6)
        return self.position + by_body[:, :3], Rotation.from_rotvec(by_body[:, 3:]) * self.rotation

    def _openings(
        self, position: np.ndarray, rotation: Rotation
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(U (3 b,) [m], axes (b, 3, 3), place (b, 3) [m]) of the bonds at these places and rotations of spheres."""
        first, second = self.bonds.first, self.bonds.second
        if not first.size:
            return np.empty(0), np.empty((0, 3, 3)), np.empty((0, 3))
        # axes that stay would strain a body that turns: by 5e-5 at 0.01 rad, by 0.12 at 0.5 rad
        half = (rotation[second] * rotation[first].inv()).as_rotvec() / 2.0
        mean = (Rotation.from_rotvec(half) * rotation[first]).as_matrix()
        frame = self.bonds.frame @ mean.transpose(0, 2, 1)
        here = position[first] + rotation[first].apply(self._arms[0])
        there = position[second] + rotation[second].apply(self._arms[1])
        return (frame @ (there - here)[:, :, None]).ravel(), frame, 0.5 * (here + there)

    def _stored(self) -> float:
        return self._product(self.sigma, self.memory)

    def _product(self, sigma: np.ndarray, memory: np.ndarray) -> float:
        """Energy [J] of springs under these stresses and memory."""
        state = sigma, memory
        return 0.5 * self.law.stored(diagonal_form(self.weight), state, state)

    def _lose(self, stored: float) -> None:
        """Account for bonds that broke since springs stored `stored` [J]."""
        self.energies.fracture += stored - self._stored()
        self.energies.springs = self._stored()

    def _count(
        self,
        velocity: np.ndarray,
        sigma: np.ndarray,
        memory: np.ndarray,
        rate: np.ndarray,
        operator: sparse.csr_matrix,
        contacts: _Contacts,
    ) -> None:
        """Add a step to the account, in which bonds open at the `rate` (3 b,) [m/s]; see the balance above."""
        sums, dt, weight = self.energies, self.dt, self.weight
        mean, change = 0.5 * (velocity + self.velocity), 0.5 * (velocity - self.velocity)
        sums.kinetic = 0.5 * float(self.mass @ velocity**2)
        sums.load -= dt * float(self._load @ velocity)
        sums.springs = self._product(sigma, memory)
        drift = (memory - self.memory) / dt
        sums.dashpots += dt * self.law.dissipated(diagonal_form(weight), sigma, memory, drift)
        work = (contacts.impulse * (contacts.rows_met @ mean)).reshape(-1, 3)
        sums.impact -= float(work[: contacts.met, 0].sum())
        sums.friction -= float(work[: contacts.met, 1:].sum() + work[contacts.met :].sum())
        sums.numerical += self._product(sigma - self.sigma, memory - self.memory)
        sums.numerical += dt * float(self._load @ change + (weight * sigma) @ (rate - operator @ mean))


@dataclass
class _Contacts:
    """Pairs that may meet within a step, and what they did in it."""

    rows: sparse.csr_matrix  # (3 c, 6 n) opening of each: normal, two tangents
    turning: sparse.csr_matrix  # (3 c, 6 n) angular velocity between its bodies
    gap: np.ndarray  # (c,) m, at the start of the step
    friction: np.ndarray  # (c,)
    arm: np.ndarray  # (c,) m, of the largest couple
    rows_met: sparse.csr_matrix  # (3 c', 6 n) of those that closed; of a law with couples, then their turning
    impulse: np.ndarray  # (3 c',) of these rows: N s, then N m s
    met: int = 0  # how many closed
    _kept: tuple[SuperLU, bytes, np.ndarray] | None = None

    @classmethod
    def near(cls, world: World) -> _Contacts:
        """Pairs of spheres that no bond joins, or of a sphere and a plane, as they stand at the start of the step."""
        around, radius, n = world.around, world.radius, world.radius.size
        speed = np.linalg.norm(world.velocity.reshape(-1, 6)[:, :3], axis=1).max()
        # twice as far as the two fastest could approach each other, and a margin
        reach = 4.0 * world.dt * (speed + world.dt * np.linalg.norm(around.gravity)) + 0.05 * radius.min()
        planes = around.plane_point, around.plane_normal
        found = find_pairs(world.position, radius, *planes, reach)
        first, second, gap = near_pairs(world.position, radius, *planes, *found, reach)  # type: ignore[call-arg]  # compiled
        left = ~world.broken
        joined = np.sort(np.stack([world.bonds.first[left], world.bonds.second[left]]), axis=0)
        # a pair as one number, since isin knows no pairs
        lower, higher = np.minimum(first, second), np.maximum(first, second)
        free = ~np.isin(lower * (n + len(planes[0])) + higher, joined[0] * (n + len(planes[0])) + joined[1])
        first, second, gap = first[free], second[free], gap[free]
        normal = np.empty((first.size, 3))
        spheres = second < n
        normal[~spheres] = -around.plane_normal[second[~spheres] - n]
        apart = world.position[second[spheres]] - world.position[first[spheres]]
        normal[spheres] = apart / np.linalg.norm(apart, axis=1, keepdims=True)
        point = world.position[first] + radius[first, None] * normal
        rows = opening_operator(first, second, _frames(normal), point, world.position)
        friction = np.where(spheres, around.law.friction, around.law.wall_friction)
        curvature = 1.0 / radius[first]
        curvature[spheres] += 1.0 / radius[second[spheres]]
        turning = _turning(first, np.where(spheres, second, -1), n)
        return cls(rows, turning, gap, friction, around.law.rolling / curvature, rows[:0], np.empty(0))

    def solve(self, velocity: np.ndarray, factor: SuperLU, dt: float) -> np.ndarray:
        """The velocity (6 n,) after the impulses of all that would close within the step."""
        # an overlap is not pushed open, which would add energy
        gap, touching = np.maximum(self.gap, 0.0), np.zeros(self.gap.size, bool)
        corrected = velocity
        self.rows_met, self.impulse, self.met = self.rows[:0], np.empty(0), 0
        while True:
            closing = gap + dt * (self.rows[::3] @ corrected) < -CLOSED
            if not (closing & ~touching).any():
                return corrected
            touching |= closing
            chosen, self.met = np.repeat(touching, 3), int(touching.sum())
            rows = self.rows_met = self.rows[chosen]
            if self.arm.any():
                rows = self.rows_met = sparse.vstack([rows, self.turning[chosen]], format="csr")
            response = self._response(touching, rows, factor)
            free = rows @ velocity
            free[: 3 * self.met : 3] += gap[touching] / dt
            delassus = rows @ response
            # symmetric but for rounding of the factors
            delassus, friction = 0.5 * (delassus + delassus.T), self.friction[touching]
            if self.arm.any():
                self.impulse = solve_with_couples(delassus, free, friction, self.arm[touching], TOLERANCE)
            else:
                solved = solve_contacts(delassus, free, friction, tolerance=TOLERANCE)
                self.impulse = solved.require_converged().reactions
            corrected = velocity + response @ self.impulse

    def _response(self, touching: np.ndarray, rows: sparse.csr_matrix, factor: SuperLU) -> np.ndarray:
        """Velocities (6 n, 3 c') for unit impulses at these contacts; the last ones are kept."""
        asked = factor, touching.tobytes()
        if self._kept is None or self._kept[0] is not factor or self._kept[1] != asked[1]:
            self._kept = *asked, factor.solve(rows.T.toarray())
        return self._kept[2]


def _turning(first: np.ndarray, second: np.ndarray, n: int) -> sparse.csr_matrix:
    """Rows (3 c, 6 n) of the angular velocity of spheres `second` against `first`; -1: a plane, which does not turn."""
    row, signs = (
        3 * np.arange(first.size)[:, None] + np.arange(3),
        np.repeat([[-1.0, 1.0]], first.size, axis=0),
    )
    signs[second < 0, 1] = 0.0
    places = [6 * body[:, None] + 3 + np.arange(3) for body in (first, np.maximum(second, 0))]
    entries = np.repeat(signs.T.ravel(), 3), (np.tile(row.ravel(), 2), np.concatenate(places).ravel())
    return sparse.csr_matrix(entries, shape=(3 * first.size, 6 * n))


def _frames(normal: np.ndarray) -> np.ndarray:
    """Axes (c, 3, 3), rows: normals (c, 3) and two tangents."""
    # the axis farthest from the normal: the cross product keeps its digits
    least = np.eye(3)[np.argmin(np.abs(normal), axis=1)] if len(normal) else normal
    tangent = np.cross(normal, least)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    return np.stack([normal, tangent, np.cross(normal, tangent)], axis=1)
