"""Steady harmonic response in the frequency domain: an independent check of the time stepping."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.system import BondedSystem


def driving_force(
    system: BondedSystem, modulus: complex, omega: float, acceleration_factor: complex | None = None
) -> complex:
    """Complex force [N] per unit driven amplitude [m] at angular frequency omega [1/s].

    Solves (E* K - omega^2 M) u = 0 with the driven degree of freedom at one, without damping other
    than that of the complex modulus E* [Pa]. acceleration_factor replaces -omega^2, e.g. by that of
    a time-stepping scheme.
    """
    factor = -(omega**2) if acceleration_factor is None else acceleration_factor
    dynamic = (modulus * system.stiffness() + factor * sparse.diags_array(system.mass)).tocsc()
    free = system.free
    coupling = dynamic[free][:, [system.driven]].toarray()[:, 0]
    motion = np.zeros(system.mass.size, complex)
    motion[system.driven] = 1.0
    motion[free] = splu(
        dynamic[free][:, free],
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    ).solve(-coupling)
    return complex(dynamic[[system.driven]].dot(motion)[0])


def actuator_stiffness(head: complex, devices: HeadDevices, omega: float) -> complex:
    """Complex force [N] per amplitude [m] of the actuator, `head` being that of the specimen's head.

    Without the slider, whose force does not grow with the motion.
    """
    clamp, spring, _, mass = devices.of_head
    return 1.0 / (clamp + 1.0 / (head + spring - mass * omega**2))
