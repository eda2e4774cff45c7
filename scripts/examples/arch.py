# SPDX-License-Identifier: GPL-2.0-or-later
"""A semicircular arch of 21 voussoirs under its own weight, and a picture of its line of thrust."""
import math
import os

from yade import polyhedra_utils
from yade.utils import *

import contactdynamics
from contactdynamics import forcenetwork

# start of the script
stone = O.materials[O.materials.append(FrictMat(density=2000, frictionAngle=math.atan(0.8), young=1e9))]
ground = O.bodies.append(wall(0, axis=2, material=stone))
ring = []
for k in range(21):
    corners = [(r * math.cos(a), y, r * math.sin(a)) for r in (0.92, 1.08) for a in (math.pi * k / 21, math.pi * (k + 1) / 21) for y in (-0.25, 0.25)]
    ring.append(O.bodies.append(polyhedra_utils.polyhedra(stone, v=[Vector3(*corner) for corner in corners])))
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81), tolerance=1e-6, maxIterations=10000)
O.dt = 2e-3
O.run(500, True)
forcenetwork.draw(os.path.join("out", "arch.png"))
# end of the script

weight = 9.81 * sum(O.bodies[number].state.mass for number in ring)
thrusts = [O.interactions[ground, end].phys.normalForce + O.interactions[ground, end].phys.shearForce for end in (ring[0], ring[-1])]
print("thrust over weight at the abutments:", [round(abs(force[0]) / weight, 4) for force in thrusts])
total = thrusts[0] + thrusts[1]
assert abs(abs(total[2]) / weight - 1) < 1e-5 and abs(total[0]) < 1e-5 * weight  # equilibrium, to the tolerance of the solve
assert max(O.bodies[number].state.vel.norm() for number in ring) < 1e-6
assert os.path.getsize(os.path.join("out", "arch.png")) > 1000
