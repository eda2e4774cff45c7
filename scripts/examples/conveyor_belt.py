# SPDX-License-Identifier: GPL-2.0-or-later
"""A conveyor belt: a boundary outside NewtonIntegrator.mask stays where it is, and drags along what lies on it."""
from math import atan

from yade.utils import *

import contactdynamics
from contactdynamics import ContactDynamicsMat

# start of the script
steel = O.materials.append(FrictMat(frictionAngle=atan(0.5)))
felt = O.materials.append(ContactDynamicsMat(frictionAngle=atan(0.5), rollingFriction=0.1))
belt = O.bodies.append(wall(0, axis=2, material=steel, mask=1))
O.bodies[belt].state.vel = (0.3, 0, 0)
smooth = O.bodies.append(sphere((0, 0, 0.01), 0.01, material=steel, mask=3))
rough = O.bodies.append(sphere((0, 0.1, 0.01), 0.01, material=felt, mask=3))
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
O.engines[-1].mask = 2  # of NewtonIntegrator: it moves the balls, mask 3, but not the belt; both have bit 1, so they meet
O.dt = 1e-3
O.run(200, True)
# end of the script

# Seen from the belt a ball has the momentum -0.3 m r about its contact when it is put there, 7/5 m r v when it rolls; the torque of rolling
# friction, 0.1 r m g, takes from it. Beside plain steel that of the felt counts alone.
for body, coefficient in ((O.bodies[smooth], 0), (O.bodies[rough], 0.1)):
    expected = 2 / 7 * 0.3 + 5 / 7 * coefficient * 9.81 * O.time
    print(f"velocity {body.state.vel[0]:.6f} m/s, textbook {expected:.6f} m/s")
    assert abs(body.state.vel[0] - expected) < 0.1 * 9.81 * O.dt
assert O.bodies[belt].state.pos == Vector3.Zero
