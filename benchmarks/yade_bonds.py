"""Runs inside YADE: CPU time of a step of bonded spheres, its critical time step, and the bonds."""

import sys
import time

import numpy as np
from yade import O, utils
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    CohFrictMat,
    ForceResetter,
    Ig2_Sphere_Sphere_ScGeom6D,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_CohFrictMat_CohFrictMat_CohFrictPhys,
    Law2_ScGeom6D_CohFrictPhys_CohesionMoment,
    NewtonIntegrator,
)

STEPS, WARM_UP, MODULUS = 100, 10, 24.3e9
data = np.load("specimen.npz")
O.materials.append(
    CohFrictMat(
        young=MODULUS,
        poisson=0.35,
        density=float(data["density"]),
        frictionAngle=0.6,
        normalCohesion=1e12,
        shearCohesion=1e12,
        isCohesive=True,
        momentRotationLaw=False,
    )
)
O.bodies.append(
    [
        utils.sphere(tuple(x), r)
        for x, r in zip(data["position"].tolist(), data["radius"].tolist(), strict=True)
    ]
)
# bonds reach over gaps, so boxes around spheres must overlap where there is one
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=2.0)]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom6D()],
        [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True, setCohesionOnNewContacts=False)],
        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment()],
    ),
    NewtonIntegrator(damping=0.0, gravity=(0.0, 0.0, -9.81)),
]
critical = utils.PWaveTimeStep()
O.dt = 1e-6 * critical  # the cost of a step is measured without motion: gaps would be taken for tension
for first, second in zip(data["first"].tolist(), data["second"].tolist(), strict=True):
    utils.createInteraction(first, second)
O.run(WARM_UP, True)
bonds = sum(1 for contact in O.interactions if contact.isReal)
began = time.process_time()
O.run(STEPS, True)
print("\nper-step", (time.process_time() - began) / STEPS, critical, bonds)
sys.stdout.flush()
