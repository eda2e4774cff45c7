# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction by pair of materials: without a rule the smaller of the two angles counts, with a MatchMaker any value does."""
from math import atan

from yade.utils import *

import contactdynamics

# start of the script
floor = O.materials.append(FrictMat(frictionAngle=atan(0.5), label="floor"))
ice = O.materials.append(FrictMat(frictionAngle=atan(0.1), label="ice"))
stone = O.materials.append(FrictMat(frictionAngle=atan(0.8), label="stone"))
O.bodies.append(wall(0, axis=2, material="floor"))
for row, material in enumerate(("ice", "stone")):
    O.bodies.append(sphere((0, 0.1 * row, 0.01), 0.01, material=material))
    O.bodies[-1].state.vel, O.bodies[-1].state.blockedDOFs = (1, 0, 0), "XYZ"  # 1 m/s, may not roll
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
friction = MatchMaker(algo="min", matches=((floor, stone, atan(0.3)),))
loop = next(engine for engine in O.engines if isinstance(engine, InteractionLoop))
loop.physDispatcher.functors[0].frictAngle = friction
O.dt = 1e-3
O.run(100, True)
# end of the script

for body, mu in ((O.bodies[1], 0.1), (O.bodies[2], 0.3)):
    print(f"friction {mu}: velocity {body.state.vel[0]:.6f} m/s, textbook {1 - mu * 9.81 * O.time:.6f} m/s")
    assert abs(body.state.vel[0] - (1 - mu * 9.81 * O.time)) < 1e-6
