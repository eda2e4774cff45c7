# SPDX-License-Identifier: GPL-2.0-or-later
"""Facets: a ball rolls over the seams of a flat triangle mesh as over one plane."""
from yade.utils import *

import contactdynamics

# start of the script
corners = [(x, y, 0) for x in (0, 0.05, 0.1, 0.15, 0.2) for y in (-0.03, 0.03)]
for k in range(0, 8, 2):
    O.bodies.append([facet((corners[k], corners[k + 2], corners[k + 1])), facet((corners[k + 1], corners[k + 2], corners[k + 3]))])
ball = O.bodies.append(sphere((0.02, 0.001, 0.01), 0.01))
O.bodies[ball].state.vel, O.bodies[ball].state.angVel = (0.5, 0, 0), (0, 50, 0)  # rolls: v = r x angular velocity
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
O.dt = 5e-4
O.run(600, True)
# end of the script

state = O.bodies[ball].state
print("position:", state.pos, "m; velocity:", state.vel, "m/s")
assert abs(state.vel[0] - 0.5) < 1e-3 and abs(state.vel[1]) < 1e-3 and abs(state.pos[2] - 0.01) < 1e-5
