"""What a contact between rigid spheres answers: the law that the sweeps ask for its force and its couple.

Another law changes this file alone. The sweeps hand it eight contacts at once (lanes.py).
"""

from __future__ import annotations

from typing import NamedTuple

from asphalt_nscd.nscd.compiled import compiled_for_teams
from asphalt_nscd.nscd.contacts.coulomb import cut
from asphalt_nscd.nscd.lanes import broadcast, select_greater, zeros

FORCE, WITH_COUPLE = 8, 11  # numbers of a contact, see slabs.Workspace


class ContactLaw(NamedTuple):
    """Signorini's condition and Coulomb's friction, between spheres and with planes; and friction of rolling.

    A sphere of no inverse mass, which is fixed, is a part of the walls. A couple of at most `rolling` R p resists the
    angular velocity between two bodies that press each other by p, with 1/R the sum of 1/radius, of which a plane adds
    none.
    """

    friction: float = 0.0
    wall_friction: float = 0.0
    rolling: float = 0.0


@compiled_for_teams
def new_impulse(law, contact, i, j, relaxation):
    """(impulse x, y, z [N s], violation [m/s]) of contacts between bodies that move as i and j, eight at once.

    Signorini on velocities: opening >= target, impulse >= 0, complementary; Coulomb's limit. The violation is what the
    opening lacks of its target. A gap that is open may close, so its target is below zero. The local Delassus operator
    is diagonal: normal 1/m_i + 1/m_j, tangential 7/2 of it. The change of an impulse is multiplied by `relaxation`
    before the laws cut it; above one it over-relaxes. A cohesion must leave open gaps alone.
    """
    nx, ny, nz, px, py, pz, target, mass = contact
    # walls have no inverse mass; the driven one may have some, and stands alone in the last slab
    friction = select_greater(i[3] * j[3], zeros(), broadcast(law.friction), broadcast(law.wall_friction))
    vx, vy, vz = j[0] - i[0], j[1] - i[1], j[2] - i[2]
    surface_x, surface_y, surface_z = j[4] + i[4], j[5] + i[5], j[6] + i[6]
    mass = relaxation * mass
    opening = vx * nx + vy * ny + vz * nz
    violation = target - opening
    old_normal = px * nx + py * ny + pz * nz
    new_normal = old_normal + violation * mass
    new_normal = select_greater(new_normal, zeros(), new_normal, zeros())
    tangential_mass = mass / broadcast(3.5)
    along = old_normal - tangential_mass * opening
    qx = px - tangential_mass * (vx - (surface_y * nz - surface_z * ny)) - along * nx
    qy = py - tangential_mass * (vy - (surface_z * nx - surface_x * nz)) - along * ny
    qz = pz - tangential_mass * (vz - (surface_x * ny - surface_y * nx)) - along * nz
    qx, qy, qz = cut(qx, qy, qz, friction * new_normal)
    return qx + new_normal * nx, qy + new_normal * ny, qz + new_normal * nz, violation


@compiled_for_teams
def new_couple(law, contact, couple, radii, i, j, relaxation):
    """Couple x, y, z [N m s] on bodies j of eight contacts that had `couple` (3), by the impulse of `contact`.

    `radii` are those of both bodies [m], zero of a plane, whose spin counts for nothing. Spins are surface velocities.
    """
    one = broadcast(1.0)
    a, b = one / radii[0], select_greater(radii[1], zeros(), one / radii[1], zeros())
    response = a * a * i[7] + b * b * j[7]
    inertia = select_greater(response, zeros(), relaxation / response, zeros())
    pressed = contact[0] * contact[3] + contact[1] * contact[4] + contact[2] * contact[5]
    x = couple[0] - inertia * (b * j[4] - a * i[4])
    y = couple[1] - inertia * (b * j[5] - a * i[5])
    z = couple[2] - inertia * (b * j[6] - a * i[6])
    return cut(x, y, z, broadcast(law.rolling) * pressed / (a + b))
