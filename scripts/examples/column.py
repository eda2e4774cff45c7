# SPDX-License-Identifier: GPL-2.0-or-later
"""A column of ten balls: contact k carries the weight of the balls above it. The smallest complete script."""
from yade.utils import *

import contactdynamics

# start of the script
O.bodies.append(wall(0, axis=2))
O.bodies.append([sphere((0, 0, 0.01 + 0.02 * k), 0.01) for k in range(10)])
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81), tolerance=1e-10, maxIterations=100000)
O.dt = 1e-3  # seconds; chosen from the motion, the stiffness plays no part
O.run(20, True)
for contact in sorted(O.interactions, key=lambda contact: contact.id1):
    print(contact.id1, contact.id2, contact.phys.normalForce[2], "N", contact.phys.status, contact.phys.gap, "m")
# end of the script

weight = 9.81 * O.bodies[1].state.mass
for k in range(10):
    assert abs(abs(O.interactions[k, k + 1].phys.normalForce[2]) / weight - (10 - k)) < 1e-6, f"contact {k}-{k + 1}"
