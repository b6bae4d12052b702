"""Steady harmonic response in the frequency domain: an independent check of the time stepping."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, SuperLU, gmres

from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.implicit_operator import factors
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.statics import static_factor
from asphalt_nscd.nscd.bonds.system import BondedSystem

TOLERANCE = 1e-13  # of the equations times K^-1, relative to the static motion
MOST_ITERATIONS = 100  # a specimen takes a dozen, near its resonance too
MOST_STARTS = 3  # again from what was found: rounding within one start may leave more than the tolerance


def driving_force(
    system: BondedSystem,
    modulus: complex | np.ndarray,
    omega: float,
    acceleration_factor: complex | None = None,
    static: SuperLU | Multigrid | None = None,
) -> complex:
    """Complex force per unit driven amplitude [N/m] at `omega` [rad/s].

    Solves (G^T E* w G - omega^2 M) u = 0 with the driven degree of freedom at one, without damping other than that of
    the complex modulus E* [Pa], one for all bonds or for each of their components (3 b,). `acceleration_factor`
    replaces -omega^2, e.g. by that of a time-stepping scheme; `static` solves the stiffness of bonds weighted by the
    sizes of these moduli, where that is known already (`static_factor`).
    """
    factor = -(omega**2) if acceleration_factor is None else acceleration_factor
    mean = complex(np.mean(modulus))
    if static is None:
        # real, as factors are: of each bond the size of its modulus; losses are left to the iteration
        static = static_factor(system, system.weight * (np.abs(modulus) / abs(mean)))
    # divided by the mean modulus, the system is real but for inertia and scatter of moduli, and static
    # factors serve all frequencies
    inertia = factor / mean * system.mass
    beyond = sparse.diags_array(inertia)
    if np.ndim(modulus):
        relative = modulus / mean
        whole = system.stiffness(system.weight * relative) + beyond
        beyond = beyond + system.stiffness(system.weight * (relative - np.abs(relative)))
    else:
        whole = system.stiffness() + beyond
    motion = np.zeros(system.mass.size, complex)
    motion[system.driven] = 1.0
    motion[system.free] = _follow(whole.tocsc(), beyond.tocsc(), system, static)
    return complex(mean * whole[[system.driven]].dot(motion)[0])


def _follow(
    whole: sparse.csc_matrix, beyond: sparse.csc_matrix, system: BondedSystem, static: SuperLU | Multigrid
) -> np.ndarray:
    """Motion of the free degrees of freedom that solves whole u = (P + beyond) u = 0, the driven one at one.

    P, real, is what `static` solves. What is beyond it is a small part below the resonance: inertia, and the loss in
    which bonds differ. P then takes a few steps. Factors of the whole complex matrix cost several times as much.
    """
    free = system.free
    coupling = whole[free][:, [system.driven]].toarray()[:, 0]
    beyond = beyond[free][:, free]

    def solve(force: np.ndarray) -> np.ndarray:
        # real factors take both parts at once, as two right-hand sides
        parts = static.solve(np.column_stack([force.real, force.imag]))
        return np.asarray(parts[:, 0] + 1j * parts[:, 1])

    near = LinearOperator(beyond.shape, matvec=lambda motion: motion + solve(beyond @ motion), dtype=complex)
    at_rest = solve(-coupling)
    motion, failed = gmres(near, at_rest, rtol=TOLERANCE, restart=MOST_ITERATIONS, maxiter=MOST_STARTS)
    # should the iteration not end, complex factors, which cost more, always serve
    if failed:
        motion = factors(whole[free][:, free]).solve(-coupling)
    return np.asarray(motion)


def actuator_stiffness(head: complex, devices: HeadDevices, omega: float) -> complex:
    """Complex force per amplitude of the actuator [N/m], with the complex stiffness `head` [N/m] of the specimen.

    The slider is left out: its force does not grow with the motion.
    """
    clamp, spring, _, mass = devices.of_head
    return 1.0 / (clamp + 1.0 / (head + spring - mass * omega**2))
