# SPDX-License-Identifier: GPL-2.0-or-later
"""A soft contact beside Contact Dynamics: two viscoelastic balls bounce off each other while a hard floor carries them."""
from yade.utils import *

import contactdynamics

# start of the script
hard = O.materials.append(FrictMat(frictionAngle=0, label="hard"))
soft = O.materials.append(ViscElMat(tc=0.01, en=0.8, et=1, frictionAngle=0, density=2500, label="soft"))
O.bodies.append(wall(0, axis=2, material="hard"))
O.bodies.append([sphere((x, 0, 0.01), 0.01, material="soft") for x in (-0.02, 0.02)])
O.bodies[1].state.vel, O.bodies[2].state.vel = (0.1, 0, 0), (-0.1, 0, 0)
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
loop = next(engine for engine in O.engines if isinstance(engine, InteractionLoop))
loop.physDispatcher.functors += [Ip2_ViscElMat_ViscElMat_ViscElPhys()]  # both soft: spring and dashpot; else: Contact Dynamics
loop.lawDispatcher.functors += [Law2_ScGeom_ViscElPhys_Basic()]
O.dt = 1e-4  # the spring decides
O.run(5000, True)
# end of the script

speeds = [O.bodies[k].state.vel[0] for k in (1, 2)]
print("speeds after the impact:", speeds, "m/s; heights:", [O.bodies[k].state.pos[2] for k in (1, 2)], "m")
assert speeds[0] < -0.05 and speeds[1] > 0.05, "the soft contact should throw the balls back"
assert all(abs(O.bodies[k].state.pos[2] - 0.01) < 1e-5 for k in (1, 2)), "the hard floor should carry them"
