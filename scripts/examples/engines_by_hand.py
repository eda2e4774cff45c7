# SPDX-License-Identifier: GPL-2.0-or-later
"""The engine list written out, with YADE's own functors and a fixed proximity distance of five per cent of the radius."""
from yade.utils import *

from contactdynamics import *

# start of the script
O.bodies.append(box((0, 0, -0.005), (0.1, 0.1, 0.005), fixed=True))
O.bodies.append([sphere((0.005 * k, 0, 0.012 + 0.022 * k), 0.01) for k in range(3)])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.05), Bo1_Box_Aabb()]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.05), Ig2_Box_Sphere_ScGeom(interactionDetectionFactor=1.05)],
        [Ip2_FrictMat_FrictMat_ContactDynamicsPhys()],
        [Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb()],  # keeps the candidates, applies no force
    ),
    ContactDynamicsEngine(tolerance=1e-6, maxIterations=1000, label="cd"),  # solves, adds the reactions to O.forces
    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),
]
O.dt = 2e-4
O.run(1500, True)
# end of the script

print("heights:", [round(O.bodies[k].state.pos[2], 5) for k in (1, 2, 3)], "m; largest penetration:", cd.maxPenetration, "m")
assert all(abs(O.bodies[k].state.pos[2] - 0.01) < 1e-4 for k in (1, 2, 3)), "all three balls end on the floor"
