# SPDX-License-Identifier: GPL-2.0-or-later
"""A packing made with YADE's soft contact law goes on as a packing of rigid grains."""
from math import atan

from yade import pack
from yade.utils import *

import contactdynamics
from contactdynamics.takeover import takeOver

radius = 0.01
O.materials.append(FrictMat(young=4e5, poisson=0.3, frictionAngle=atan(0.5), density=2600))
O.bodies.append([wall(0, axis=2)] + [wall(place, axis=axis) for axis in (0, 1) for place in (0, 0.1)])
cloud = pack.SpherePack()
cloud.makeCloud((0, 0, 0), (0.1, 0.1, 0.4), rMean=radius, rRelFuzz=0.2, num=80, seed=2)
cloud.toSimulation()
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_FrictPhys()],
        [Law2_ScGeom_FrictPhys_CundallStrack()],
    ),
    NewtonIntegrator(damping=0.4, gravity=(0, 0, -9.81)),
]
O.dt = 5e-4
O.run(6000, True)

overlaps = [contact.geom.penetrationDepth for contact in O.interactions if contact.isReal]
before = sum(overlaps) / len(overlaps)

# start of the script
takeOver(contactdynamics.engines(), dt=1e-3)
O.run(1000, True)
# end of the script
print(f"mean overlap from {before / radius:.1e} to {cd.meanPenetration / radius:.1e} radii")
assert before > 1e-3 * radius and cd.meanPenetration < 1e-4 * radius
