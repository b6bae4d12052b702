"""Bodies joined by bonds, as matrices.

The opening velocities of all bonds are U = G v, three rows each (normal and two tangents at the
middle of the gap); the reactions act on the bodies as G^T R. With R = w sigma, w = g for the
normal and g / (2 (1 + nu)) for the tangents (Eqs. 8-11), the stiffness per unit modulus is the
purely geometric matrix K = G^T w G [m].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from asphalt_nscd.nscd.bonds.strength import utilisations
from asphalt_nscd.nscd.compiled import compiled


@dataclass(frozen=True)
class BondedSystem:
    """Bonded bodies with one driven degree of freedom; only free ones and the driven one are kept.

    Degrees of freedom (d,): three translations [m] and three rotations [rad] of each moving body. `operator` is G (3 b,
    d), `weight` w (3 b,) in m, `mass` (d,) in kg or kg m2, constant `load` (d,) in N or N m, `gap` (b,) in m,
    `strength` (b,) the yield force in tension and in shear [N]; `friction` acts where a gap closes.
    `position` (n, 3) [m] of the bodies serves multigrid; `place` (d,) is that among the six of all (None: the first).
    """

    operator: sparse.csr_matrix
    weight: np.ndarray
    mass: np.ndarray
    load: np.ndarray
    driven: int
    gap: np.ndarray
    strength: np.ndarray
    friction: float
    position: np.ndarray | None = None
    place: np.ndarray | None = (
        None  # (d,) of each degree of freedom among the six of all bodies; None: the first
    )

    def __post_init__(self) -> None:
        # asked so that NaN is refused
        if not (self.strength > 0.0).all():
            raise ValueError("strength: each bond's must be greater than zero; leave weaker bonds out.")
        if not (self.gap >= 0.0).all():
            raise ValueError("gap: none may be negative; bonded bodies must not overlap.")
        if not self.friction >= 0.0:
            raise ValueError(f"friction = {self.friction:g} must not be negative.")

    @cached_property
    def free(self) -> np.ndarray:
        """Indices of the degrees of freedom that are not driven."""
        return np.delete(np.arange(self.mass.size), self.driven)

    @cached_property
    def stiffness_diagonal(self) -> np.ndarray:
        """Diagonal (d,) of K [m] of the unbroken system."""
        return self.operator.power(2).T @ self.weight

    def rigid_motions(self) -> np.ndarray:
        """The six motions (d, 6) of all bodies as one: three translations, three rotations."""
        assert self.position is not None, "a system without places has no rotation as one"
        motion = np.zeros((len(self.position), 6, 6))
        motion[:, :3, :3] = motion[:, 3:, 3:] = np.eye(3)
        motion[:, :3, 3:] = np.cross(np.eye(3), self.position[:, None]).transpose(0, 2, 1)
        return motion.reshape(-1, 6)[np.arange(self.mass.size) if self.place is None else self.place]

    def stiffness(self, weight: np.ndarray | None = None) -> sparse.csc_matrix:
        """Stiffness per unit modulus K = G^T w G (d, d) [m]; `weight` w (3 b,) [m] has zeros for broken bonds."""
        weight = self.weight if weight is None else weight
        return (self.operator.T @ (sparse.diags_array(weight) @ self.operator)).tocsc()

    def utilisation(self, reaction: np.ndarray) -> np.ndarray:
        """Yield measure (b,) of a `reaction` (3 b,) [N]; above one a bond breaks."""
        return utilisations(reaction, self.strength)


def clusters(first: np.ndarray, second: np.ndarray, n: int) -> np.ndarray:
    """Number (n,) of each body's cluster, held together by bonds that join `first` to `second` (b,)."""
    graph = sparse.coo_array((np.ones(first.size), (first, second)), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1])


def opening_operator(
    first: np.ndarray, second: np.ndarray, frame: np.ndarray, point: np.ndarray, position: np.ndarray
) -> sparse.csr_matrix:
    """G (3 b, 6 n), which makes opening velocities of those of bodies; bodies numbered n or above are fixed.

    Rows of `frame` (b, 3, 3) are the normal from `first` to `second` (b,) and two tangents; `point` (b, 3) and
    `position` (n, 3) in m.
    """
    n, bonds = position.shape[0], first.size
    first, second = first.astype(np.int64), second.astype(np.int64)  # else a second kernel would be compiled
    columns, values = _opening_rows(first, second, frame, point, position)
    keep = columns >= 0
    rows = np.repeat(np.arange(3 * bonds), 12)[keep.ravel()]
    entries = (values.ravel()[keep.ravel()], (rows, columns.ravel()[keep.ravel()]))
    return sparse.csr_matrix(entries, shape=(3 * bonds, 6 * n))


@compiled
def _opening_rows(first, second, frame, point, position):
    """Columns and values (3 b, 12) of the rows of G, six of each body; column -1 for a body that is fixed."""
    bonds = first.shape[0]
    columns = np.full((3 * bonds, 12), -1)
    values = np.zeros((3 * bonds, 12))
    arm = np.empty(3)
    for b in range(bonds):
        for side in range(2):
            body = first[b] if side == 0 else second[b]
            sign = -1.0 if side == 0 else 1.0
            if body >= position.shape[0]:
                continue
            for k in range(3):
                arm[k] = point[b, k] - position[body, k]
            for c in range(3):
                row = 3 * b + c
                for k in range(3):
                    k1, k2 = (k + 1) % 3, (k + 2) % 3
                    columns[row, 6 * side + k] = 6 * body + k
                    columns[row, 6 * side + 3 + k] = 6 * body + 3 + k
                    values[row, 6 * side + k] = sign * frame[b, c, k]
                    values[row, 6 * side + 3 + k] = sign * (
                        arm[k1] * frame[b, c, k2] - arm[k2] * frame[b, c, k1]
                    )
    return columns, values
