"""Runs inside YADE: CPU time of a step while spheres begin to fall, and while they rest."""

import math
import sys
import time

import numpy as np
from yade import O, utils
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_MindlinPhys_Mindlin,
    NewtonIntegrator,
)

STEPS, WARM_UP = 400, 100
data = np.load("spheres.npz")
for state in ("start", "rest"):
    O.reset()
    O.materials.append(FrictMat(young=1e7, poisson=0.25, frictionAngle=math.atan(0.2), density=2600.0))
    O.bodies.append(
        [
            utils.sphere(tuple(x), r)
            for x, r in zip(data[state].tolist(), data["radius"].tolist(), strict=True)
        ]
    )
    for axis in range(3):
        for position, sense in ((0.0, 1), (float(data["box"][axis]), -1)):
            O.bodies.append(utils.wall(position, axis=axis, sense=sense))
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_MindlinPhys()],
            [Law2_ScGeom_MindlinPhys_Mindlin()],
        ),
        NewtonIntegrator(damping=0.2, gravity=(0.0, 0.0, -9.81)),
    ]
    O.dt = 8e-6
    O.run(WARM_UP, True)
    began = time.process_time()
    O.run(STEPS, True)
    print("\nper-step", (time.process_time() - began) / STEPS)
sys.stdout.flush()
