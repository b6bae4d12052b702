"""What a machine reads of a law on a cylinder of full size that is simulated from rest, with its facets and inertia."""

import numpy as np

from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.case import RunOptions
from asphalt_nscd.bending.excerpt import ModelExcerpt
from asphalt_nscd.bending.runs import path_run
from asphalt_nscd.bending.taring import SOFTNESS
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.rheology.as_run import Programme
from asphalt_nscd.rheology.chain import KelvinChain

STEPS = 60  # of implicit Euler between two samples of the record


def modulus_of_cylinder(
    cylinder: ModelExcerpt, chain: KelvinChain, frequency: float, programme: Programme
) -> complex:
    """E* [Pa] that is read of a commanded force, from rest, at `frequency` [Hz]."""
    shape, omega = cylinder.geometry, 2.0 * np.pi * frequency
    size = float(np.abs(chain.complex_modulus(omega)))
    # soft against the specimen, so that a motion of the actuator commands a force
    clamp = SOFTNESS * shape.form_factor() / size
    force = shape.usual_amplitude() * size / shape.form_factor()
    angle = programme.angles()
    fine = np.linspace(0.0, angle[-1], STEPS * (angle.size - 1) + 1)
    path = clamp * force * programme.stress(fine)[1:]
    run = path_run(cylinder, bond_law(chain), HeadDevices(clamp), float(fine[1]) / omega, path, RunOptions())
    forces = np.concatenate([[0.0], run.force[STEPS - 1 :: STEPS]])
    displacement = np.concatenate([[0.0], (path - clamp * run.force)[STEPS - 1 :: STEPS]])
    stiffness = programme.phasor(forces, angle) / programme.phasor(displacement, angle)
    return complex(shape.complex_modulus(frequency, abs(stiffness), 1.0, float(np.angle(stiffness))))
