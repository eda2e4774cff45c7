# SPDX-License-Identifier: GPL-2.0-or-later
"""Clumps: three balls in a row, one rigid body, falls askew on a floor and comes to rest lying flat."""
from yade.utils import *

import contactdynamics

# start of the script
O.bodies.append(wall(0, axis=2))
clump, members = O.bodies.appendClumped([sphere((0.012 * k, 0, 0.03 + 0.008 * k), 0.01) for k in range(3)])
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
O.dt = 5e-4
O.run(2000, True)
# end of the script

heights = [O.bodies[member].state.pos[2] for member in members]
print("heights of the members:", heights, "m; velocity:", O.bodies[clump].state.vel.norm(), "m/s")
assert max(abs(height - 0.01) for height in heights) < 1e-3 * 0.01
assert O.bodies[clump].state.vel.norm() < 1e-3
