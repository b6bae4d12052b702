"""Contact problems of rigid bodies: blocks stacked, an arch, a slope, spheres in a box."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse
from scipy.spatial import cKDTree

Contact = tuple[int, int, np.ndarray, Sequence[float] | np.ndarray]
GRAVITY_STEP = 9.81e-3  # m/s gained in a step of 1 ms


class Assembly:
    """Bodies with their free velocities, and contacts as (body, other or -1, point, normal on the body)."""

    def __init__(
        self,
        mass: Sequence[float],
        inertia: Sequence[np.ndarray],
        centre: Sequence[np.ndarray],
        contacts: Sequence[Contact],
        velocity: np.ndarray,
    ) -> None:
        self.mass, self.contacts, self.velocity = np.asarray(mass), contacts, np.asarray(velocity, float)
        rows, columns, values = [], [], []
        for c, (body, other, point, normal) in enumerate(contacts):
            axes = frame(normal)
            for b, sign in ((body, 1.0), (other, -1.0)):
                if b >= 0:
                    block = sign * np.hstack([axes, np.cross(point - centre[b], axes)])
                    rows += np.repeat(3 * c + np.arange(3), 6).tolist()
                    columns += np.tile(6 * b + np.arange(6), 3).tolist()
                    values += block.ravel().tolist()
        shape = (3 * len(contacts), 6 * len(mass))
        self.jacobian = sparse.csr_array((values, (rows, columns)), shape=shape)
        self.inverse_mass = np.concatenate(
            [np.r_[[1 / m] * 3, 1 / np.asarray(i)] for m, i in zip(mass, inertia, strict=True)]
        )
        self.W = (self.jacobian @ sparse.diags_array(self.inverse_mass) @ self.jacobian.T).tocsr()
        self.q = self.jacobian @ self.velocity.ravel()

    def velocity_after(self, reactions: np.ndarray) -> np.ndarray:
        """Velocities (n, 6) of the bodies under the reactions."""
        return self.velocity + (self.inverse_mass * (self.jacobian.T @ reactions)).reshape(-1, 6)


def frame(normal: ArrayLike) -> np.ndarray:
    """Rows n, t1, t2."""
    n = np.asarray(normal, float)
    t = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    t /= np.linalg.norm(t)
    return np.stack([n, t, np.cross(n, t)])


def cuboid(size: tuple[float, float, float], density: float = 1000.0) -> tuple[float, np.ndarray]:
    """Mass and principal moments of inertia."""
    a, b, c = size
    mass = density * a * b * c
    return mass, mass / 12 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])


def falling(bodies: int, kick: float = 0.0, seed: int = 0) -> np.ndarray:
    velocity = kick * np.random.default_rng(seed).normal(size=(bodies, 6))
    velocity[:, 2] -= GRAVITY_STEP
    return velocity


def box_stack(
    height: int, across: int = 3, kick: float = 0.0, size: tuple[float, float, float] = (1.0, 1.0, 1.0)
) -> Assembly:
    """Boxes one upon the other with across^2 contacts at each face: three would hold each of them."""
    mass, inertia = cuboid(size)
    spots = np.stack(np.meshgrid(*[np.linspace(-0.45, 0.45, across)] * 2), axis=-1).reshape(-1, 2)
    contacts = [
        (k, k - 1, np.array([x * size[0], y * size[1], k * size[2]]), [0.0, 0.0, 1.0])
        for k in range(height)
        for x, y in spots
    ]
    centre = [np.array([0.0, 0.0, (k + 0.5) * size[2]]) for k in range(height)]
    return Assembly([mass] * height, [inertia] * height, centre, contacts, falling(height, kick))


def arch(stones: int) -> Assembly:
    """A half circle of voussoirs, four contacts at each joint, both ends on the ground."""
    angle = np.linspace(0.0, np.pi, stones + 1)
    middle = 0.5 * (angle[1:] + angle[:-1])
    centre = [5.0 * np.array([np.cos(a), 0.0, np.sin(a)]) for a in middle]
    mass, inertia = cuboid((5.0 * (angle[1] - angle[0]), 1.0, 1.0))
    contacts = []
    for k, a in enumerate(angle):
        along = np.array([-np.sin(a), 0.0, np.cos(a)])
        for radius in (4.5, 5.5):
            for y in (-0.5, 0.5):
                point = np.array([radius * np.cos(a), y, radius * np.sin(a)])
                contacts.append((k, k - 1, point, along) if k < stones else (k - 1, -1, point, -along))
    return Assembly([mass] * stones, [inertia] * stones, centre, contacts, falling(stones))


def block_on_slope(slope: float, spin: float = 0.0) -> Assembly:
    """A flat block with four feet; gravity turned by `slope` towards x, so that x points downhill."""
    mass, inertia = cuboid((1.0, 1.0, 0.2))
    contacts = [(0, -1, np.array([x, y, 0.0]), [0.0, 0.0, 1.0]) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
    velocity = GRAVITY_STEP * np.array([[np.sin(slope), 0.0, -np.cos(slope), 0.0, 0.0, spin]])
    return Assembly([mass], [inertia], [np.array([0.0, 0.0, 0.1])], contacts, velocity)


def spheres_in_a_box(*cells: int, seed: int = 0) -> Assembly:
    """Spheres of a cubic lattice, jittered, each in contact with the neighbours and walls within reach.

    cells: of the lattice along each axis, or one number for all three.
    """
    rng = np.random.default_rng(seed)
    shape = cells * 3 if len(cells) == 1 else cells
    centre = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3) + 0.5
    centre += rng.uniform(-0.12, 0.12, centre.shape)
    radius = 0.5 * np.ones(len(centre))
    contacts = []
    # W and q know no gap: pairs that nearly touch count as contacts. Sorted, for a set has no order
    for i, j in sorted(cKDTree(centre).query_pairs(1.08)):
        normal = (centre[i] - centre[j]) / np.linalg.norm(centre[i] - centre[j])
        contacts.append((i, j, 0.5 * (centre[i] + centre[j]), normal))
    for i, position in enumerate(centre):
        for axis in range(3):
            for side in (1.0, -1.0):
                depth = position[axis] if side > 0 else shape[axis] - position[axis]
                if depth < 0.54 and not (axis == 2 and side < 0):  # no lid
                    normal = side * np.eye(3)[axis]
                    contacts.append((i, -1, position - 0.5 * normal, normal))
    mass = 2600.0 * 4 / 3 * np.pi * radius**3
    inertia = [np.full(3, 0.4 * m * r * r) for m, r in zip(mass, radius, strict=True)]
    return Assembly(mass.tolist(), inertia, list(centre), contacts, falling(len(mass)))
