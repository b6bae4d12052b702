"""Gauss-Seidel sweeps over the bonds of rigid bodies, laid out for the speed of the processor.

The three rows of a bond in the opening operator are its frame T (3, 3) and, for each body, the moments
of T about the arm a from the body to the bond: U = T u with u = v_j + s_j x a_j - v_i - s_i x a_i.
Bonds are taken in blocks that share no body: bond by bond within a block or all at once is the same. The last blocks
hold the bonds of bodies whose mobility differs between axes, as of the head, of which one motion is prescribed.
In place of b stands b - D R, by which the law still lets a bond open; after a visit the bond opens by just that.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.lanes import WIDTH, aligned, gather, load, scatter, store, total, zeros

SYMMETRIC = np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2])  # rows, columns of six entries
# Bonds among which those of a block are looked for: many enough to fill blocks, few enough to keep their order
WINDOW = 256


class PackedBonds:
    """Bonds of an opening operator in global axes; body k has degrees of freedom 6 k, ...

    `operator` is G (3 b, d); `mobility` (d,) is dt / mass [s/kg, s/(kg m2)], zero where a velocity is prescribed; `law`
    (3 b,) is the diagonal D [m/(N s)] of the affine law U = b - D R.
    """

    def __init__(self, operator: sparse.csr_matrix, mobility: np.ndarray, law: np.ndarray) -> None:
        self.size, self._law = mobility.size, law
        bodies, self._frame, arm = _rigid_bonds(operator)
        nobody = -(-self.size // 6)
        # what stands still is a body of no mobility, whose row stays zero: sweeps need no branch for it
        bodies[bodies < 0] = nobody
        self._mobility = self._rows_by_body(mobility, nobody)
        self._mobility[:, 6:] = self._mobility[:, [0, 3]]
        # even: both bodies move as easily along any axis, and turn as easily about any
        even = (
            (self._mobility[:, :6] == self._mobility[:, [6, 6, 6, 7, 7, 7]]).all(axis=1)[bodies].all(axis=1)
        )
        # in global axes: a sweep reads 18 numbers a bond, and neither frame nor law
        response = np.einsum("bck,bc,bcl->bkl", self._frame, law.reshape(-1, 3), self._frame)
        for side in range(2):
            own = self._mobility[bodies[:, side]]
            turn = np.cross(np.eye(3), arm[:, side, None])  # (b, k, 3): axis k x arm
            response += own[:, :3, None] * np.eye(3) + np.einsum("bmk,bm,bml->bkl", turn, own[:, 3:6], turn)
        parts = []
        # even ones first: one comparison a block tells whether mobilities come with the motion
        for bonds in (np.flatnonzero(even), np.flatnonzero(~even)):
            blocks = _blocks(bodies[bonds], nobody, WIDTH, WINDOW)
            parts.append(np.where(blocks >= 0, bonds[blocks], -1))
        self._even, self._blocks = len(parts[0]), np.concatenate(parts)
        block, lane = np.nonzero(self._blocks >= 0)
        self.visits = self._blocks[block, lane]
        self._bodies = np.full((len(self._blocks), 2, WIDTH), nobody, np.int32)
        self._bodies[block, :, lane] = bodies[self.visits]
        self._packed = aligned((len(self._blocks), 18, WIDTH))
        self._packed[block, 6:12, lane] = np.linalg.inv(response)[self.visits][:, *SYMMETRIC]
        self._packed[block, 12:, lane] = arm.reshape(-1, 6)[self.visits]

    def sweep_until_still(
        self,
        explicit: np.ndarray,
        reaction: np.ndarray,
        velocity: np.ndarray,
        tolerance: float,
        most_sweeps: int,
    ) -> tuple[np.ndarray, np.ndarray, int, float]:
        """Gauss-Seidel sweeps, forth and back, until their relative change is below `tolerance`.

        `explicit` (3 b,) is b of the law [m/s], `reaction` (3 b,) the start R [N], `velocity` (d,) that before R acts.
        Returns reaction (3 b,) [N], velocity (d,) [m/s, rad/s], number of sweeps, relative change of the last one.
        """
        motion = self._rows_by_body(velocity, len(self._mobility) - 1)
        # a row has room for eight numbers: the mobility comes with the motion, a fifth less time
        motion[:, 6:] = self._mobility[:, 6:]
        _lay_out(self._blocks, self._frame, self._law, explicit, reaction, self._packed)
        _apply(self._bodies, self._packed, motion, self._mobility, self._even)
        sweeps, change = _sweep_until_still(
            self._bodies, self._packed, motion, self._mobility, self._even, tolerance, most_sweeps
        )
        reaction = _reactions(self._blocks, self._frame, self._packed)
        return reaction, motion[:, :6].ravel()[: self.size], sweeps, change

    def _rows_by_body(self, values: np.ndarray, nobody: int) -> np.ndarray:
        """Values (d,) in a row of eight for each body, the last two zero; a last row of zeros for what stands still."""
        rows = aligned((nobody + 1, WIDTH))
        six = np.zeros(6 * (nobody + 1))
        six[: self.size] = values
        rows[:, :6] = six.reshape(-1, 6)
        return rows


def _rigid_bonds(operator: sparse.csr_matrix) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Read from G: (bodies (b, 2), frame (b, 3, 3), arm (b, 2, 3) [m]); the first body is -1 where it is fixed."""
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
def _blocks(bodies, nobody, width, window):
    """(blocks, width) bonds that share no body but `nobody`, nearly in their order; -1 where a lane is empty."""
    bonds = bodies.shape[0]
    blocks = np.full((bonds, width), -1)
    taken = np.full(nobody + 1, -1)  # the last block of each body
    waiting = np.empty(window, np.int64)
    count = following = 0
    block = -1
    while count > 0 or following < bonds:
        block += 1
        while count < window and following < bonds:
            waiting[count] = following
            count, following = count + 1, following + 1
        lane = left = 0
        for n in range(count):
            bond = waiting[n]
            i, j = bodies[bond, 0], bodies[bond, 1]
            # what stands still may be shared by lanes: its row is written back as it was
            if lane < width and (i == nobody or taken[i] != block) and taken[j] != block:
                blocks[block, lane] = bond
                taken[i] = taken[j] = block
                lane += 1
            else:
                waiting[left] = bond
                left += 1
        count = left
    return blocks[: block + 1]


@compiled
def _lay_out(blocks, frame, law, explicit, reaction, packed):
    """Put b - D R and R (3 b,), given in the frames of the bonds, into their lanes in global axes."""
    for block in range(blocks.shape[0]):
        for lane in range(blocks.shape[1]):
            bond = blocks[block, lane]
            if bond < 0:
                continue
            for k in range(3):
                free = held = 0.0
                for c in range(3):
                    row = 3 * bond + c
                    free += frame[bond, c, k] * (explicit[row] - law[row] * reaction[row])
                    held += frame[bond, c, k] * reaction[row]
                packed[block, k, lane], packed[block, 3 + k, lane] = free, held


@compiled
def _reactions(blocks, frame, packed):
    """R (3 b,) in the frames of the bonds, from their lanes in global axes."""
    reaction = np.empty(3 * frame.shape[0])
    for block in range(blocks.shape[0]):
        for lane in range(blocks.shape[1]):
            bond = blocks[block, lane]
            if bond < 0:
                continue
            for c in range(3):
                reaction[3 * bond + c] = (
                    frame[bond, c, 0] * packed[block, 3, lane]
                    + frame[bond, c, 1] * packed[block, 4, lane]
                    + frame[bond, c, 2] * packed[block, 5, lane]
                )
    return reaction


@compiled
def _apply(bodies, packed, motion, mobility, even):
    """Let the reactions that sweeps start from change the velocities."""
    for block in range(packed.shape[0]):
        i, j = gather(motion, bodies, block, 0), gather(motion, bodies, block, 1)
        arm_i, arm_j = _arms(packed, block)
        reaction = load(packed, block, 3), load(packed, block, 4), load(packed, block, 5)
        _pushed(motion, mobility, bodies, block, block < even, (i, arm_i, j, arm_j), reaction)


@compiled
def _sweep_until_still(bodies, packed, motion, mobility, even, tolerance, most_sweeps):
    """Sweeps to and fro over blocks of bonds until the relative change of the reactions is below tolerance.

    bodies (blocks, 2, lanes). packed (blocks, 18, lanes): b - D R and R, six entries of (D + dt G M^-1 G^T)^-1,
    arms of both bodies. motion and mobility (n, 8): of six degrees of freedom, then the mobilities along any axis and
    about any axis, which suffice in the first `even` blocks. Returns (sweeps, relative change of the last one).
    """
    change = 0.0
    blocks = packed.shape[0]
    for sweep in range(most_sweeps):
        changed, size = zeros(), zeros()
        for n in range(blocks):
            block = n if sweep % 2 == 0 else blocks - 1 - n
            i, j = gather(motion, bodies, block, 0), gather(motion, bodies, block, 1)
            arm_i, arm_j = _arms(packed, block)
            ux, uy, uz = _opening(i, arm_i, j, arm_j)
            mx = load(packed, block, 0) - ux
            my = load(packed, block, 1) - uy
            mz = load(packed, block, 2) - uz
            xy, xz, yz = load(packed, block, 7), load(packed, block, 8), load(packed, block, 10)
            dx = load(packed, block, 6) * mx + xy * my + xz * mz
            dy = xy * mx + load(packed, block, 9) * my + yz * mz
            dz = xz * mx + yz * my + load(packed, block, 11) * mz
            i, j = _pushed(motion, mobility, bodies, block, block < even, (i, arm_i, j, arm_j), (dx, dy, dz))
            ux, uy, uz = _opening(i, arm_i, j, arm_j)
            store(packed, block, 0, ux)
            store(packed, block, 1, uy)
            store(packed, block, 2, uz)
            px = load(packed, block, 3) + dx
            py = load(packed, block, 4) + dy
            pz = load(packed, block, 5) + dz
            store(packed, block, 3, px)
            store(packed, block, 4, py)
            store(packed, block, 5, pz)
            changed = changed + (dx * dx + dy * dy + dz * dz)
            size = size + (px * px + py * py + pz * pz)
        change = 0.0 if total(size) == 0.0 else np.sqrt(total(changed) / total(size))
        if change < tolerance:
            return sweep + 1, change
    return most_sweeps, change


@compiled
def _arms(packed, block):
    return (
        (load(packed, block, 12), load(packed, block, 13), load(packed, block, 14)),
        (load(packed, block, 15), load(packed, block, 16), load(packed, block, 17)),
    )


@compiled
def _pushed(motion, mobility, bodies, block, even, pair, reaction):
    """Motions of both bodies of each bond once `reaction` pushed them apart, also written; pair: (i, arm, j, arm)."""
    i, arm_i, j, arm_j = pair
    dx, dy, dz = reaction
    lx, ly, lz, kx, ky, kz = _mobility_of(i, mobility, bodies, block, even, 0)
    tx, ty, tz = _cross(arm_i, reaction)
    i = (
        i[0] - lx * dx, i[1] - ly * dy, i[2] - lz * dz,
        i[3] - kx * tx, i[4] - ky * ty, i[5] - kz * tz, i[6], i[7],
    )  # fmt: skip
    lx, ly, lz, kx, ky, kz = _mobility_of(j, mobility, bodies, block, even, 1)
    tx, ty, tz = _cross(arm_j, reaction)
    j = (
        j[0] + lx * dx, j[1] + ly * dy, j[2] + lz * dz,
        j[3] + kx * tx, j[4] + ky * ty, j[5] + kz * tz, j[6], j[7],
    )  # fmt: skip
    scatter(motion, bodies, block, 0, i)
    scatter(motion, bodies, block, 1, j)
    return i, j


@compiled
def _mobility_of(body, mobility, bodies, block, even, side):
    """Six mobilities of the bodies on a `side` of a block; where `even`, of the two that their motion `body` brings."""
    if even:
        return body[6], body[6], body[6], body[7], body[7], body[7]
    lx, ly, lz, kx, ky, kz, _, _ = gather(mobility, bodies, block, side)
    return lx, ly, lz, kx, ky, kz


@compiled
def _opening(i, arm_i, j, arm_j):
    """Opening velocity u of bonds between bodies that move as i and j, velocity first and spin after."""
    ix, iy, iz = _cross((i[3], i[4], i[5]), arm_i)
    jx, jy, jz = _cross((j[3], j[4], j[5]), arm_j)
    return (j[0] - i[0]) + (jx - ix), (j[1] - i[1]) + (jy - iy), (j[2] - i[2]) + (jz - iz)


@compiled
def _cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
