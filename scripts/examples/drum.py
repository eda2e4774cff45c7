# SPDX-License-Identifier: GPL-2.0-or-later
"""A drum of facets turned by an engine of YADE; the work it does is found again in the balls and in what contacts take."""
import math

from yade.utils import *
from yade import geom  # behind the line above, which has a name like it

import contactdynamics

# start of the script
shell = O.bodies.append(geom.facetCylinder((0, 0, 0), 0.1, 0.06, orientation=Quaternion((1, 0, 0), math.pi / 2), segmentsNumber=24))
balls = [O.bodies.append(sphere((0.022 * i - 0.033, 0.022 * j - 0.011, -0.06 + 0.022 * k), 0.01)) for i in range(4) for j in range(2) for k in range(3)]
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
turn = RotationEngine(ids=shell, rotationAxis=(0, 1, 0), angularVelocity=5, rotateAroundZero=True)
O.engines = O.engines[:1] + [turn] + O.engines[1:]
O.trackEnergy = True
O.dt = 1e-3
O.run(600, True)
# end of the script


def energy():
    """Kinetic and potential energy; the velocities belong to the middle of the last step."""
    states = [O.bodies[b].state for b in balls]
    kinetic = sum(0.5 * (s.mass * s.vel.squaredNorm() + s.inertia[0] * s.angVel.squaredNorm()) for s in states)
    return kinetic + sum(s.mass * 9.81 * (s.pos[2] - 0.5 * O.dt * s.vel[2]) for s in states)


start = sum(O.bodies[b].state.mass * 9.81 * (-0.06 + 0.022 * (n % 3)) for n, b in enumerate(balls))
terms = {name: O.energy[name] for name in O.energy.keys() if name.startswith("contact")}
work = -terms["contactBoundary"]
print("work of the drum:", work, "J; terms:", terms)
assert work > 0
assert abs(energy() - start + sum(terms.values())) < 1e-9 * work
assert all(math.hypot(O.bodies[b].state.pos[0], O.bodies[b].state.pos[2]) < 0.0901 for b in balls)
