# SPDX-License-Identifier: GPL-2.0-or-later
"""Four balls on one floor: one bounces, one hangs by a bond, one swings on its contact, one rolls to a stop; and where their energy goes."""
from math import atan, sqrt

from yade.utils import *

import contactdynamics
from contactdynamics import ContactDynamicsMat

# start of the script
floor = O.materials.append(FrictMat(frictionAngle=atan(0.5)))
rubber = O.materials.append(ContactDynamicsMat(normalRestitution=0.8, frictionAngle=atan(0.5)))
glue = O.materials.append(ContactDynamicsMat(cohesionForce=1.0, frictionAngle=atan(0.5)))
mortar = O.materials.append(ContactDynamicsMat(kn=100, frictionAngle=atan(0.5)))
felt = O.materials.append(ContactDynamicsMat(rollingFriction=0.1, frictionAngle=atan(0.5)))

O.bodies.append(wall(0, axis=2, material=floor))
bouncing = O.bodies.append(sphere((0, 0, 0.11), 0.01, material=rubber))
O.bodies.append(sphere((0.1, 0, 0.05), 0.01, material=glue, fixed=True))
hanging = O.bodies.append(sphere((0.1, 0, 0.03), 0.01, material=glue))  # 4 g: the bond would hold 100 g
swinging = O.bodies.append(sphere((0.2, 0, 0.01), 0.01, material=mortar))
rolling = O.bodies.append(sphere((0.3, 0, 0.01), 0.01, material=felt))
O.bodies[rolling].state.vel, O.bodies[rolling].state.angVel = (0.2, 0, 0), (0, 20, 0)

O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
O.trackEnergy = True
O.dt = 2e-4
heights = []
while O.time < 1:
    O.step()
    heights.append(O.bodies[bouncing].state.pos[2] - 0.01)
# end of the script

fall = sqrt(2 * 0.1 / 9.81)
apex = max(heights[int(fall / O.dt) + 10 :])
distance = 7 * 0.2**2 / (10 * 0.1 * 9.81)
print(f"first bounce: {apex:.5f} m, textbook {0.1 * 0.8**2:.5f} m")
print(f"way of the rolling ball: {O.bodies[rolling].state.pos[0] - 0.3:.5f} m, textbook {distance:.5f} m")
print(f"hanging ball: {O.bodies[hanging].state.pos[2]:.5f} m, bond {O.interactions[2, hanging].phys.bond}")
for name in sorted(O.energy.keys()):
    print(f"{name}: {O.energy[name]:.3e} J")
assert abs(apex - 0.1 * 0.8**2) < 2 * 1.4 * O.dt  # the way of a step
assert abs(O.bodies[rolling].state.pos[0] - 0.3 - distance) < 0.2 * O.dt
assert abs(O.bodies[hanging].state.pos[2] - 0.03) < 1e-12 and O.interactions[2, hanging].phys.bond == "intact"
assert O.energy["contactRestitution"] > 0 and O.energy["contactRolling"] > 0
