# SPDX-License-Identifier: GPL-2.0-or-later
"""Speed of the wave in a row of dominoes for smaller and smaller time steps.

    PYTHONPATH=build/python:scripts/validation yade -n -x scripts/validation/dominoes.py [DOMINOES]
"""

import math
import sys

from masonry import *


def waveSpeed(h, count, height=1.0, thickness=0.15, distance=0.5):
    """Speed of the wave in the second half of the row [sqrt(g height)]."""
    O.reset()
    material = stone(0.3)
    O.bodies.append(wall(0, 2, material=material))
    outline = lambda x: [(x, 0), (x + thickness, 0), (x, height), (x + thickness, height)]  # noqa: E731
    row = [prism(outline(k * distance), material, depth=0.5) for k in range(count)]
    # The first one turns about its lower right edge.
    spin = 1.0
    first = O.bodies[row[0]].state
    first.angVel = (0, spin, 0)
    first.angMom = angularMomentum(first, spin)
    first.vel = Vector3(0, spin, 0).cross(first.pos - Vector3(thickness, 0, 0))
    equip(h)
    struck = [0.0] + [None] * (count - 1)
    upright = [Vector3(O.bodies[i].state.pos) for i in row]
    while struck[-1] is None and O.time < 60:
        O.step()
        for k in range(1, count):
            if struck[k] is None and O.bodies[row[k]].state.angVel.norm() > 0.05:
                struck[k] = O.time
    half = count // 2
    return (count - 1 - half) * distance / (struck[-1] - struck[half]) / math.sqrt(G * height)


def angularMomentum(state, spin):
    """Of a body that turns about the y axis."""
    axes = state.ori.toRotationMatrix()
    return axes * Vector3(*(state.inertia[i] * (axes.transpose() * Vector3(0, spin, 0))[i] for i in range(3)))


count = int(sys.argv[1]) if len(sys.argv) > 1 else 20
speeds = []
for h in (4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4):
    speeds.append(waveSpeed(h, count))
    change = f", change {speeds[-1] - speeds[-2]:+.4f}" if len(speeds) > 1 else ""
    print(f"h = {h:.2e} s: wave speed {speeds[-1]:.4f} sqrt(g H){change}", flush=True)
