# SPDX-License-Identifier: GPL-2.0-or-later
"""A heap of disks in the plane zx, with the time step chosen by the motion."""
from math import atan

from yade.utils import *

import contactdynamics
from contactdynamics import plane

# start of the script
O.materials.append(FrictMat(frictionAngle=atan(0.4), density=2600))
O.bodies.append([wall(0, axis=2), wall(0, axis=0), wall(0.2, axis=0)])
for k in range(60):  # the coordinates in the plane zx are z, then x
    O.bodies.append(plane.disk((0.02 + 0.025 * (k // 6), 0.03 + 0.027 * (k % 6) + 0.003 * (k // 6 % 2)), 0.01, "zx", thickness=0.01))
stepper = contactdynamics.ContactDynamicsTimeStepper(maxTimeStep=5e-3)
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81), timeStepper=stepper, label="cd")
steps = 0
while O.time < 1.5:
    O.step()
    steps += 1
# end of the script
print(f"plane {cd.plane}, {steps} steps, last one {O.dt:.4f} s, overlap left {cd.remainingOverlap / 0.01:.1e} r")
assert cd.plane == "zx" and max(b.state.vel.norm() for b in O.bodies) < 0.01
