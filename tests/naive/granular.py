"""One NSCD step of spheres and planes with explicit contact Jacobians and contact frames."""

from __future__ import annotations

import numpy as np

AGAIN, RELAXATION, ROUND = 4, 1.5, 9  # of its own, as all published layers were made


def all_pairs(position, radius, plane_point, plane_normal, reach):
    """[(i, j)] of every pair with a gap below reach, by looking at all of them.

    The larger sphere (the lower index when equal) comes first; body n + k is plane k.
    """
    n = len(radius)
    pairs = []
    for i in range(n):
        for j in range(n):
            larger = radius[i] > radius[j] or (radius[i] == radius[j] and i < j)
            if larger and np.linalg.norm(position[j] - position[i]) < radius[i] + radius[j] + reach:
                pairs.append((i, j))
        for k in range(len(plane_point)):
            if plane_normal[k] @ (position[i] - plane_point[k]) - radius[i] < reach:
                pairs.append((i, n + k))
    return pairs


def naive_step(
    position, radius, velocity, mass, plane_point, plane_normal, gravity, impulses, *, dt, friction,
    restitution, recovery_speed, allowed_overlap, margin, tolerance, most_sweeps,
    penetration=np.inf, enough_sweeps=10**9, drive=(0.0, 0.0), slabs,
):  # fmt: skip
    """Returns (position, velocity, impulses) after dt. impulses: {(i, j): (3,)} acts on body j.

    friction: between spheres, with planes.
    slabs: {(i, j): number} of the slab of each pair in the order of visits, -1 where it is with the last body.
    velocity (n + p, 6): linear and angular velocity times radius; planes last, prescribed. A mass (n + 1,)
    is that of the last plane too, which its drive (speed, largest push) moves along z.
    """
    n = len(radius)
    free = velocity.copy()
    free[:n, :3] += dt * gravity
    # generalised masses: (1/2) (2/5 m) s^2 is the rotational energy in terms of s = radius * spin
    inverse = np.array(
        [[0.0] * 6 if k >= n else [1 / mass[k]] * 3 + [2.5 / mass[k]] * 3 for k in range(len(free))]
    )

    pushed = 0.0
    if len(mass) > n:
        inverse[-1] = [1 / mass[n]] * 3 + [2.5 / mass[n]] * 3  # as if it were a sphere, until it is led

    def lead():
        """The drive brings the wall to its speed as far as its push reaches; rails hold the rest."""
        nonlocal pushed
        if len(mass) > n:
            needed = pushed + mass[n] * (new[-1, 2] - drive[0])
            new[-1] = [0, 0, new[-1, 2] + (pushed - min(needed, drive[1])) / mass[n], 0, 0, 0]
            pushed = min(needed, drive[1])

    contacts = []
    for i, j in all_pairs(position, radius, plane_point, plane_normal, np.inf):
        if j < n:
            apart = position[j] - position[i]
            normal = apart / np.linalg.norm(apart)
            gap = np.linalg.norm(apart) - radius[i] - radius[j]
        else:
            normal = -plane_normal[j - n]
            gap = plane_normal[j - n] @ (position[i] - plane_point[j - n]) - radius[i]
        if gap + dt * min(normal @ (free[j, :3] - free[i, :3]), 0.0) >= margin:
            continue
        tangent = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
        tangent /= np.linalg.norm(tangent)
        frame = np.stack([normal, tangent, np.cross(normal, tangent)])
        # velocity of a body's point of contact: v + s x (arm / radius), the arms being +- normal
        cross = np.array([[0, normal[2], -normal[1]], [-normal[2], 0, normal[0]], [normal[1], -normal[0], 0]])
        on_first = -np.hstack([frame, frame @ cross])
        on_second = np.hstack([frame, -(frame @ cross)])
        delassus = on_first * inverse[i] @ on_first.T + on_second * inverse[j] @ on_second.T
        if j == len(free) - 1 and len(mass) > n:
            delassus = np.diag([1.0, 3.5, 3.5]) * (1 / mass[i] + 1 / mass[n])  # only sets the pace of sweeps
        before = normal @ (velocity[j, :3] - velocity[i, :3])
        target = -gap / dt if gap > 0 else min(max(-gap - allowed_overlap, 0) / dt, recovery_speed)
        if restitution > 0 and before < 0 and gap + dt * before <= 0:
            target = -restitution * before
        contacts.append((i, j, frame, on_first, on_second, delassus, target))

    contacts = in_order_of_visits(contacts, slabs)
    new = free
    local = [frame @ impulses.get((i, j), np.zeros(3)) for i, j, frame, *_ in contacts]
    for (i, j, _, on_first, on_second, *_), r in zip(contacts, local):
        new[i] += inverse[i] * (on_first.T @ r)
        new[j] += inverse[j] * (on_second.T @ r)
    lead()
    lively, size = [], sum(r @ r for r in local)
    for sweep in range(most_sweeps):
        turn = sweep % ROUND
        quiet = tolerance**2 * size / max(len(contacts), 1)
        if turn == 0:  # all
            order = range(len(contacts))
            changed, size, fastest = 0.0, 0.0, 0.0
        else:  # those whose impulse changed then, or when it was last looked at
            order = lively
        noted = []
        for c in order:
            i, j, _, on_first, on_second, delassus, target = contacts[c]
            opening = on_first @ new[i] + on_second @ new[j] - [target, 0, 0]
            violation = -opening[0]
            pace = delassus if turn in (0, ROUND - 1) else delassus / RELAXATION
            r = coulomb(pace, opening - pace @ local[c], friction[j >= n])
            delta, local[c] = r - local[c], r
            new[i] += inverse[i] * (on_first.T @ delta)
            new[j] += inverse[j] * (on_second.T @ delta)
            if turn == 0:
                changed, size = changed + delta @ delta, size + r @ r
                fastest = max(fastest, violation)
            if delta @ delta > quiet or (r.any() or delta.any()) and violation > penetration / dt:
                noted.append(c)
        if turn in (0, AGAIN):
            lively = noted
        lead()
        converged = size == 0 or np.sqrt(changed / size) < tolerance or sweep >= enough_sweeps
        if turn == 0 and converged and fastest < penetration / dt:
            break
    carried = {(i, j): frame.T @ r for (i, j, frame, *_), r in zip(contacts, local)}
    return position + dt * new[:n, :3], new, carried


def in_order_of_visits(contacts, slabs):
    """The last body, slabs of even number, slabs of odd number; last, those too far apart for the list."""
    place = {pair: at for at, pair in enumerate(slabs)}

    def order(contact):
        pair = contact[:2]
        number = slabs.get(pair, 0)
        return pair not in slabs, number >= 0, number % 2, number, place.get(pair, 0)

    return sorted(contacts, key=order)


def coulomb(delassus, free, friction):
    """Impulse (normal, two tangents) of one contact: opening W r + free, W without coupling."""
    assert np.abs(delassus - np.diag(np.diag(delassus))).max() < 1e-12 * delassus[0, 0]
    normal = -free[0] / delassus[0, 0]
    if normal <= 0:
        return np.zeros(3)
    sticking = -free[1:] / delassus[1, 1]
    strength = np.linalg.norm(sticking)
    if strength > friction * normal:
        sticking *= friction * normal / strength
    return np.array([normal, *sticking])


def blocks_in_order(bodies, fixed, width=8):
    """[[contact]]: each in the first block with room after the last one that shares a body below `fixed` with it."""
    blocks = []
    for contact, pair in enumerate(bodies.tolist()):
        mine = {body for body in pair if body < fixed}
        at = max(
            (n + 1 for n, block in enumerate(blocks) if mine & set(bodies[block].ravel().tolist())), default=0
        )
        at = next((n for n in range(at, len(blocks)) if len(blocks[n]) < width), len(blocks))
        if at == len(blocks):
            blocks.append([])
        blocks[at].append(contact)
    return blocks


def sweep_one_by_one(bodies, packed, motion, friction, visits, relaxation, quiet, calm):
    """A sweep over contacts, one after another; rows as in `Workspace`, changed in place.

    Returns the sums of squares of the change of impulse and of the impulse, the largest violation, the noted contacts,
    and how many opened or stayed open, stuck and slipped.
    """
    changed, size, fastest, noted, kinds = 0.0, 0.0, 0.0, [], {"open": 0, "sticks": 0, "slips": 0}
    for c in visits:
        (i, j), (nx, ny, nz, px, py, pz, target, mass) = bodies[c], packed[c]
        mass = relaxation * mass
        vx, vy, vz = motion[j, :3] - motion[i, :3]
        surface_x, surface_y, surface_z = motion[j, 4:7] + motion[i, 4:7]
        opening = vx * nx + vy * ny + vz * nz
        violation = target - opening
        old_normal = px * nx + py * ny + pz * nz
        new_normal = old_normal + violation * mass
        if new_normal <= 0.0:
            kinds["open"] += 1
            if not packed[c, 3:6].any():
                continue
            qx = qy = qz = 0.0
        else:
            tangential_mass = mass / 3.5
            along = old_normal - tangential_mass * opening
            qx = px - tangential_mass * (vx - (surface_y * nz - surface_z * ny)) - along * nx
            qy = py - tangential_mass * (vy - (surface_z * nx - surface_x * nz)) - along * ny
            qz = pz - tangential_mass * (vz - (surface_x * ny - surface_y * nx)) - along * nz
            slips = qx * qx + qy * qy + qz * qz > (friction * new_normal) ** 2
            kinds["slips" if slips else "sticks"] += 1
            share = friction * new_normal / np.sqrt(qx * qx + qy * qy + qz * qz) if slips else 1.0
            qx, qy, qz = (
                share * qx + new_normal * nx,
                share * qy + new_normal * ny,
                share * qz + new_normal * nz,
            )
        dx, dy, dz = qx - px, qy - py, qz - pz
        turn = np.array([ny * dz - nz * dy, nz * dx - nx * dz, nx * dy - ny * dx])
        motion[i, :3] -= motion[i, 3] * np.array([dx, dy, dz])
        motion[i, 4:7] -= motion[i, 7] * turn
        motion[j, :3] += motion[j, 3] * np.array([dx, dy, dz])
        motion[j, 4:7] -= motion[j, 7] * turn
        packed[c, 3:6] = qx, qy, qz
        moved = dx * dx + dy * dy + dz * dz
        if moved > quiet or violation > calm:
            noted.append(c)
        changed, size, fastest = changed + moved, size + qx * qx + qy * qy + qz * qz, max(fastest, violation)
    return changed, size, fastest, noted, kinds
