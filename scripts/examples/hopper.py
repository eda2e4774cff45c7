# SPDX-License-Identifier: GPL-2.0-or-later
"""A hopper imported from an STL file: balls run out of its orifice, and none leaves otherwise."""
import math
import tempfile

from yade import ymport
from yade.utils import *

import contactdynamics

# A stand-in for your own mesh: a funnel of 45 degrees below a square bin, written as a text STL file.
d = 0.01  # largest diameter of the balls
levels = [(2.5 * d, 0), (6 * d, 3.5 * d), (6 * d, 20 * d)]  # half width and height of the square sections
rings = [[(x * half, y * half, z) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))] for half, z in levels]
with tempfile.NamedTemporaryFile("w", suffix=".stl") as file:
    print("solid hopper", file=file)
    for lower, upper in zip(rings, rings[1:]):
        for k in range(4):
            a, b, c, e = lower[k], lower[k - 1], upper[k], upper[k - 1]
            for corners in ((a, b, c), (b, e, c)):
                print("facet normal 0 0 0\nouter loop", *("vertex %g %g %g" % corner for corner in corners), "endloop\nendfacet", sep="\n", file=file)
    print("endsolid hopper", file=file, flush=True)
    mesh = ymport.stl(file.name)

# start of the script
O.materials.append(FrictMat(density=2500, frictionAngle=math.atan(0.4)))
O.bodies.append(mesh)
balls = []
for k in range(180):
    layer, place = divmod(k, 36)
    x, y = place % 6 - 2.5, place // 6 - 2.5
    balls.append(O.bodies.append(sphere((1.2 * d * x, 1.2 * d * y, (4.8 + 1.2 * layer + 0.1 * ((x + y) % 2)) * d), (0.5 - 0.02 * (k % 3)) * d)))
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
O.dt = 0.05 * math.sqrt(0.5 * d / 9.81)
O.run(900, True)
# end of the script

places = [O.bodies[b].state.pos for b in balls]
out = sum(p[2] < 0 for p in places)
print(out, "of", len(balls), "balls are out after", O.time, "s")
assert out > 150
for p in places:
    assert p[2] < 0 or max(abs(p[0]), abs(p[1])) < min(6 * d, 2.5 * d + p[2]), "a ball behind the wall"
