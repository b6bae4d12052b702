"""Gauss-Seidel sweeps over the bonds of rigid bodies, laid out for the speed of the processor.

The three rows of a bond in the opening operator are its frame T (3, 3) and, for each body, the moments
of T about the arm a from the body to the bond: U = T u with u = v_j + s_j x a_j - v_i - s_i x a_i. In
global axes a bond needs 24 numbers, which is three cache lines, instead of three rows of twelve, and
the velocity of one body enters the next in a short chain of operations.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from asphalt_nscd.nscd.compiled import compiled

SYMMETRIC = np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2])  # the order of six entries


class PackedBonds:
    """Bonds of an opening operator (3 b, d) in global axes; body k has degrees of freedom 6 k, ...

    mobility (d,) [s/kg, s/(kg m2)]: dt / mass, zero where a velocity is prescribed; law (3 b,) [m/(N s)]:
    diagonal D of the affine law U = b - D R.
    """

    def __init__(self, operator: sparse.csr_matrix, mobility: np.ndarray, law: np.ndarray) -> None:
        self.size = mobility.size
        self._bodies, self._frame, arm = _rigid_bonds(operator)
        nobody = -(-self.size // 6)
        self._mobility = np.zeros((nobody + 1, 6))
        self._mobility.ravel()[: self.size] = mobility
        self._bodies[self._bodies < 0] = nobody
        compliance = np.einsum("bck,bc,bcl->bkl", self._frame, law.reshape(-1, 3), self._frame)
        response = compliance.copy()
        for side in range(2):
            own = self._mobility[self._bodies[:, side]]
            turn = np.cross(np.eye(3), arm[:, side, None])  # (b, k, 3): axis k x arm
            response += own[:, :3, None] * np.eye(3) + np.einsum("bmk,bm,bml->bkl", turn, own[:, 3:], turn)
        self._packed = np.zeros((len(arm), 24))
        self._packed[:, 6:12] = np.linalg.inv(response)[:, *SYMMETRIC]
        self._packed[:, 12:18] = compliance[:, *SYMMETRIC]
        self._packed[:, 18:] = arm.reshape(-1, 6)

    def sweep_until_still(
        self,
        explicit: np.ndarray,
        reaction: np.ndarray,
        velocity: np.ndarray,
        tolerance: float,
        most_sweeps: int,
    ) -> tuple[np.ndarray, np.ndarray, int, float]:
        """(reaction [N], velocity, sweeps, relative change of the last sweep) from those at the start.

        explicit b (3 b,) [m/s], reaction R (3 b,) [N], velocity (d,) [m/s, rad/s] that goes with it.
        """
        motion = np.zeros((len(self._mobility), 12))
        motion[:, 6:] = self._mobility
        moving = np.zeros(self._mobility.size)
        moving[: self.size] = velocity
        motion[:, :6] = moving.reshape(-1, 6)
        for columns, rows in ((slice(0, 3), explicit), (slice(3, 6), reaction)):
            self._packed[:, columns] = np.einsum("bck,bc->bk", self._frame, rows.reshape(-1, 3))
        sweeps, change = _sweep_until_still(self._bodies, self._packed, motion, tolerance, most_sweeps)
        reaction = np.einsum("bck,bk->bc", self._frame, self._packed[:, 3:6])
        return reaction.ravel(), motion[:, :6].ravel()[: self.size], sweeps, change


def _rigid_bonds(operator: sparse.csr_matrix) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(bodies (b, 2), frame (b, 3, 3), arm (b, 2, 3) [m]); the first body is -1 where it is fixed."""
    bonds = operator.shape[0] // 3
    body = operator.indices // 6
    starts = operator.indptr[:-1:3]
    first, second = np.minimum.reduceat(body, starts), np.maximum.reduceat(body, starts)
    rows = np.repeat(np.arange(3 * bonds), np.diff(operator.indptr))
    blocks = np.zeros((bonds, 2, 3, 6))  # bond, side, row, degree of freedom
    blocks[rows // 3, (body == second[rows // 3]).astype(int), rows % 3, operator.indices % 6] = operator.data
    frame = blocks[:, 1, :, :3]
    # the moments of frame c are arm x frame c, and the sum of frame c x (arm x frame c) is twice the arm
    arm = 0.5 * np.cross(frame[:, None], blocks[..., 3:] * np.array([-1.0, 1.0])[:, None, None]).sum(axis=2)
    return np.stack([np.where(first == second, -1, first), second], axis=1), frame, arm


@compiled
def _sweep_until_still(bodies, packed, motion, tolerance, most_sweeps):
    """Sweeps to and fro over the bonds until the relative change of the reactions is below tolerance.

    packed (b, 24): b and R, six entries each of (D + dt G M^-1 G^T)^-1 and of D, arms of both bodies.
    motion (n, 12): velocity and mobility. Returns (sweeps, relative change of the last sweep).
    """
    change = 0.0
    bonds = packed.shape[0]
    for sweep in range(most_sweeps):
        changed = size = 0.0
        for n in range(bonds):
            bond = n if sweep % 2 == 0 else bonds - 1 - n
            i, j = bodies[bond, 0], bodies[bond, 1]
            own = packed[bond]
            px, py, pz = own[3], own[4], own[5]
            ix, iy, iz, jx, jy, jz = own[18], own[19], own[20], own[21], own[22], own[23]
            mx = own[0] - (own[12] * px + own[13] * py + own[14] * pz)
            my = own[1] - (own[13] * px + own[15] * py + own[16] * pz)
            mz = own[2] - (own[14] * px + own[16] * py + own[17] * pz)
            sx, sy, sz = motion[j, 3], motion[j, 4], motion[j, 5]
            mx -= motion[j, 0] + (sy * jz - sz * jy)
            my -= motion[j, 1] + (sz * jx - sx * jz)
            mz -= motion[j, 2] + (sx * jy - sy * jx)
            sx, sy, sz = motion[i, 3], motion[i, 4], motion[i, 5]
            mx += motion[i, 0] + (sy * iz - sz * iy)
            my += motion[i, 1] + (sz * ix - sx * iz)
            mz += motion[i, 2] + (sx * iy - sy * ix)
            dx = own[6] * mx + own[7] * my + own[8] * mz
            dy = own[7] * mx + own[9] * my + own[10] * mz
            dz = own[8] * mx + own[10] * my + own[11] * mz
            motion[i, 0] -= motion[i, 6] * dx
            motion[i, 1] -= motion[i, 7] * dy
            motion[i, 2] -= motion[i, 8] * dz
            motion[i, 3] -= motion[i, 9] * (iy * dz - iz * dy)
            motion[i, 4] -= motion[i, 10] * (iz * dx - ix * dz)
            motion[i, 5] -= motion[i, 11] * (ix * dy - iy * dx)
            motion[j, 0] += motion[j, 6] * dx
            motion[j, 1] += motion[j, 7] * dy
            motion[j, 2] += motion[j, 8] * dz
            motion[j, 3] += motion[j, 9] * (jy * dz - jz * dy)
            motion[j, 4] += motion[j, 10] * (jz * dx - jx * dz)
            motion[j, 5] += motion[j, 11] * (jx * dy - jy * dx)
            px, py, pz = px + dx, py + dy, pz + dz
            own[3], own[4], own[5] = px, py, pz
            changed += dx * dx + dy * dy + dz * dz
            size += px * px + py * py + pz * pz
        change = np.sqrt(changed / size) if size > 0.0 else 0.0
        if change < tolerance:
            return sweep + 1, change
    return most_sweeps, change
