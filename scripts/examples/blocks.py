# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks: a bridge of three polyhedra, one lintel on two pillars, stands; its forces are read point by point."""
import itertools

import numpy as np
from yade import polyhedra_utils
from yade.utils import *

import contactdynamics

# start of the script
stone = O.materials[O.materials.append(PolyhedraMat(density=2400, frictionAngle=0.6, young=1e9))]


def block(x, z, length, height):
    """A cuboid of half a metre depth with its middle at x, z."""
    corners = itertools.product((x - length / 2, x + length / 2), (-0.25, 0.25), (z - height / 2, z + height / 2))
    return O.bodies.append(polyhedra_utils.polyhedra(stone, v=[Vector3(*corner) for corner in corners]))


ground = O.bodies.append(wall(0, axis=2, material=stone))
pillars = [block(-1, 0.5, 0.4, 1), block(1, 0.5, 0.4, 1)]
lintel = block(0, 1.15, 3, 0.3)
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
O.dt = 1e-3
O.run(500, True)

bearing = O.interactions[pillars[0], lintel]
for point, force in zip(bearing.geom.points, bearing.phys.pointForces):
    print("force on the lintel at", np.round(np.array(point), 3), ":", np.round(np.array(force), 1), "N")
# end of the script

weight = 9.81 * O.bodies[lintel].state.mass
assert len(bearing.geom.points) >= 4  # the four corners, and where edges that lie on each other cross by round-off
both = sum(O.interactions[pillar, lintel].phys.normalForce[2] for pillar in pillars)
assert abs(both - weight) < 1e-3 * weight
assert (O.bodies[lintel].state.pos - Vector3(0, 0, 1.15)).norm() < 1e-4
