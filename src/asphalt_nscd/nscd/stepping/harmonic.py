"""Steady harmonic response in the frequency domain: an independent check of the time stepping."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, SuperLU, gmres

from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.implicit_operator import factorise, factors
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.system import BondedSystem

TOLERANCE = 1e-13  # of the equations times K^-1, relative to the static motion
MOST_ITERATIONS = 100  # a specimen takes a dozen, near its resonance too
MOST_STARTS = 3  # again from what was found: rounding within one start may leave more than the tolerance


def static_factor(system: BondedSystem) -> SuperLU | Multigrid:
    """What solves K on the free degrees of freedom: for all frequencies and moduli."""
    free = system.free
    return factorise(system.stiffness()[free][:, free], system)


def driving_force(
    system: BondedSystem,
    modulus: complex,
    omega: float,
    acceleration_factor: complex | None = None,
    static: SuperLU | Multigrid | None = None,
) -> complex:
    """Complex force [N] per unit driven amplitude [m] at angular frequency omega [1/s].

    Solves (E* K - omega^2 M) u = 0 with the driven degree of freedom at one, without damping other
    than that of the complex modulus E* [Pa]. acceleration_factor replaces -omega^2, e.g. by that of
    a time-stepping scheme. static: the `static_factor`, where it is known already.
    """
    factor = -(omega**2) if acceleration_factor is None else acceleration_factor
    static = static_factor(system) if static is None else static
    stiffness, free = system.stiffness(), system.free
    inertia = factor / modulus * system.mass
    motion = np.zeros(system.mass.size, complex)
    motion[system.driven] = 1.0
    motion[free] = _follow(stiffness, inertia, system, static)
    head = stiffness[[system.driven]].dot(motion)[0] + inertia[system.driven]
    return complex(modulus * head)


def _follow(
    stiffness: sparse.csc_matrix, inertia: np.ndarray, system: BondedSystem, static: SuperLU | Multigrid
) -> np.ndarray:
    """Motion of the free degrees of freedom that solves (K + diag(inertia)) u = 0, the driven one at one.

    Inertia is a small part of K below the resonance: the static factors, which are real, then solve it in a few
    steps. Factors of the whole complex matrix cost several times as much.
    """
    free = system.free
    coupling = stiffness[free][:, [system.driven]].toarray()[:, 0]

    def lag(motion: np.ndarray) -> np.ndarray:
        force = inertia[free] * motion
        parts = static.solve(np.column_stack([force.real, force.imag]))
        return np.asarray(motion + parts[:, 0] + 1j * parts[:, 1])

    near = LinearOperator((free.size, free.size), matvec=lag, dtype=complex)
    at_rest = -static.solve(coupling).astype(complex)
    motion, failed = gmres(near, at_rest, rtol=TOLERANCE, restart=MOST_ITERATIONS, maxiter=MOST_STARTS)
    if failed:
        whole = (stiffness + sparse.diags_array(inertia)).tocsc()[free][:, free]
        motion = factors(whole).solve(-coupling.astype(complex))
    return np.asarray(motion)


def actuator_stiffness(head: complex, devices: HeadDevices, omega: float) -> complex:
    """Complex force [N] per amplitude [m] of the actuator, `head` being that of the specimen's head.

    Without the slider, whose force does not grow with the motion.
    """
    clamp, spring, _, mass = devices.of_head
    return 1.0 / (clamp + 1.0 / (head + spring - mass * omega**2))
